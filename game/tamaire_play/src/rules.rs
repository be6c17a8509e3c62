//! Conditions and routes of a win.

use crate::{Joints, Level, Route, Wish};
use fuwafuwa::inspect::Row;
use fuwafuwa::{
    DEFAULT_TICK, Dim, DimVector, ElementId, ObjectRef, PieceView, RigidBodyHandle, Shape,
    SoftBody, SoftBodyHandle, World,
};
use fuwafuwa_scenes::scene::{GameText, MAX_TOLD_BODIES};
use serde::{Deserialize, Serialize};

/// Speed below which a node counts as resting in the basket [m/s].
const RESTING: f32 = 0.4;
/// Share of the total mass below which a piece is a crumb. A crumb outside the basket does not count as lost.
pub const CRUMB: f32 = 0.002;
/// Value of [`Progress::kept`] from which the bodies count as whole.
const WHOLE: f32 = 0.99;
/// Mean strain above which the bars count as squeezing the bodies at rest in the basket. Before the
/// comparison, the strain from the bodies' own weight is added to this limit.
const SQUEEZED: f32 = 0.08;
/// Interval between two evaluations of the strain [ticks]. Evaluations take processor time, and pushing a
/// body in lasts longer than the interval.
const LOOK: u64 = 4;

/// Region to be filled.
#[derive(Clone, Debug, PartialEq)]
pub struct Basket<D: Dim> {
    /// Region.
    pub region: Shape<D>,
    /// Share of the mass of its bodies that must rest in the region.
    pub share: f32,
    /// Numbers of the bodies that have to rest in it, counted from 1. If empty, all bodies.
    pub bodies: Vec<usize>,
    /// Numbers of the bodies that must not be in it.
    pub refuses: Vec<usize>,
}

impl<D: Dim> Basket<D> {
    /// Returns the baskets of a level with their checked regions.
    pub(crate) fn all(rules: &GameText, regions: Vec<Shape<D>>) -> Vec<Self> {
        let texts = rules.all_baskets().into_iter().zip(regions);
        let baskets = texts.map(|(text, region)| Self {
            region,
            share: text.share.unwrap_or(rules.share),
            bodies: text.bodies,
            refuses: text.refuses,
        });
        baskets.collect()
    }

    /// Returns whether a body belongs into the basket, by its index.
    fn wants(&self, body: usize) -> bool {
        self.bodies.is_empty() || self.bodies.contains(&(body + 1))
    }
}

/// Progress of a round. All values are about the bodies that count; see [`GameText::bodies`]. With several baskets,
/// `inside` and `within` are those of the basket that lacks most, in proportion to its share.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Total mass of the bodies at the start [kg].
    pub mass: f32,
    /// Share of the mass at rest in the basket.
    pub inside: f32,
    /// Share of the mass in the basket, at rest or moving.
    pub within: f32,
    /// Sum of the masses of each body's largest piece, relative to the value of this sum at the start. That
    /// value may be below the total mass, because a body may start in several pieces.
    pub kept: f32,
    /// Number of pieces.
    pub pieces: usize,
    /// For each basket, the fill level: the share of the mass that it needs, 0 to 1.
    pub fills: Vec<f32>,
    /// Whether a basket holds mass of a body that it refuses.
    pub refused: bool,
    /// Time for which the basket has counted as full [s]. If the level has `alone`, a hand that touches the content
    /// resets it.
    pub held: f32,
    /// Whether a hand touches a piece in the basket; always false in a level without `alone`.
    pub touched: bool,
    /// Number of joints that broke.
    pub broken: usize,
    /// Bodies that were torn; see [`Outcome::torn`].
    pub torn: u32,
    /// Whether the bars stopped squeezing the content of the basket at some moment of the current hold, the
    /// time for which enough mass has rested there. If never, a win with a torn body counts as
    /// [`Route::Mix`].
    pub relaxed: bool,
    /// Outcome of the round; `None` before a win.
    pub outcome: Option<Outcome>,
    /// For each body, whether it counts.
    pub(crate) counts: Vec<bool>,
    /// Mass of the bodies of each basket at the start [kg].
    masses: Vec<f32>,
    /// Mass of the largest piece of each body at the start [kg]; empty if no goal asks for whole bodies.
    largest: Vec<f32>,
    /// Number of joints at the start.
    joints: usize,
    /// Mean strain above which the bars count as squeezing a body at rest, own weight included.
    squeezed: f32,
    /// Sum of the masses of each body's largest piece at the start [kg].
    whole: f32,
}

/// Outcome of a won round.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    /// Number of ticks from the first input that moved a hand to the win; 0 if no hand was moved.
    /// Files and links hold the number of all ticks up to the win instead.
    pub ticks: u64,
    /// Route of the win.
    pub route: Route,
    /// Sum of the masses of each body's largest piece, relative to the value of this sum at the start.
    pub kept: f32,
    /// Share of the total mass at rest in the basket.
    pub inside: f32,
    /// Number of pieces.
    pub pieces: usize,
    /// Number of pieces with their centre outside the basket. Crumbs do not count.
    pub lost: usize,
    /// Number of joints that broke.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub broken: usize,
    /// Bodies whose largest piece has less than 99 % of its mass at the start: the lowest bit is the first body. Always
    /// 0 in a level without goals about whole bodies.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub torn: u32,
}

/// Returns whether a number is 0.
pub(crate) fn is_zero<T: Default + PartialEq>(number: &T) -> bool {
    *number == T::default()
}

impl Outcome {
    /// Returns the duration of the round from the first input that moved a hand [s].
    pub fn seconds(&self) -> f32 {
        self.ticks as f32 * DEFAULT_TICK
    }

    /// Returns whether the round was won before any hand moved.
    pub fn is_by_itself(&self) -> bool {
        self.ticks == 0
    }

    /// Returns the numbers of the level's wishes that the outcome meets, counted from 1.
    pub fn wishes(&self, rules: &GameText) -> Vec<usize> {
        let wishes = rules.wish.iter().zip(1..);
        let met = wishes.filter(|(wish, _)| self.fulfils(wish));
        met.map(|(_, number)| number).collect()
    }

    /// Returns whether the outcome meets a wish of the level.
    pub fn fulfils(&self, wish: &Wish) -> bool {
        self.misses(wish) == Wish::default()
    }

    /// Returns the conditions of a wish that the outcome does not meet. The fields of met conditions are `None`.
    pub fn misses(&self, wish: &Wish) -> Wish {
        Wish {
            seconds: wish.seconds.filter(|most| self.seconds() > *most),
            kept: wish.kept.filter(|least| self.kept < *least),
            pieces: wish.pieces.filter(|least| self.pieces < *least),
            max_pieces: wish.max_pieces.filter(|most| self.pieces > *most),
            joints: wish
                .joints
                .filter(|joints| *joints != joints_of(self.broken)),
            whole: torn_among(&wish.whole, self.torn),
            inside: wish.inside.filter(|least| self.inside < *least),
            route: wish.route.filter(|route| self.route != *route),
        }
    }
}

/// State of a wish during a round.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum WishState {
    /// The wish can still be fulfilled.
    Open,
    /// The wish is fulfilled, or only the win is missing.
    Done,
    /// The wish cannot be fulfilled any more in this round.
    Missed,
}

impl Progress {
    /// Returns whether enough mass rests in the basket, but the rules demand that the hand lets go of it.
    pub fn waits_for_hand(&self, rules: &GameText) -> bool {
        rules.alone && self.touched && self.inside >= rules.share
    }

    /// Returns the state of a wish of the level, `seconds` [s] after the first push.
    pub fn state_of(&self, wish: &Wish, seconds: f32) -> WishState {
        if let Some(outcome) = &self.outcome {
            return match outcome.fulfils(wish) {
                true => WishState::Done,
                false => WishState::Missed,
            };
        }
        let is_late = wish.seconds.is_some_and(|most| seconds > most);
        let is_torn = wish.kept.is_some_and(|least| self.kept < least)
            || wish.route == Some(Route::Squeeze) && self.kept < WHOLE
            || wish.max_pieces.is_some_and(|most| self.pieces > most)
            || !torn_among(&wish.whole, self.torn).is_empty();
        let is_broken = wish.joints == Some(Joints::Whole) && self.broken > 0;
        // Before the win, only a minimum number of pieces and broken joints are certain: time passes, and bodies
        // and joints may still break.
        let certain = Wish {
            pieces: wish.pieces.filter(|least| self.pieces >= *least),
            joints: wish.joints.filter(|_| self.broken > 0),
            ..Wish::default()
        };
        match () {
            () if is_late || is_torn || is_broken => WishState::Missed,
            () if certain == *wish => WishState::Done,
            () => WishState::Open,
        }
    }

    pub(crate) fn of<D: Dim>(level: &Level, baskets: &[Basket<D>], world: &World<D>) -> Self {
        let rules = level.game();
        let counts = |body: usize| match baskets {
            [] => rules.bodies.is_empty() || rules.bodies.contains(&(body + 1)),
            baskets => baskets.iter().any(|basket| basket.wants(body)),
        };
        let counts: Vec<bool> = (0..world.soft_bodies().count()).map(counts).collect();
        let mass_of = |basket: &Basket<D>| {
            let bodies = world.soft_bodies().enumerate();
            let bodies = bodies.filter(|(index, _)| basket.wants(*index));
            bodies.map(|(_, (_, body))| body.total_mass() as f32).sum()
        };
        let bodies = counted(world, &counts);
        let views = views_of(&bodies);
        Self {
            mass: bodies
                .iter()
                .map(|(_, body)| body.total_mass() as f32)
                .sum(),
            inside: 0.0,
            within: 0.0,
            kept: 1.0,
            pieces: views.iter().map(Vec::len).sum(),
            held: 0.0,
            touched: false,
            broken: 0,
            torn: 0,
            relaxed: false,
            outcome: None,
            fills: vec![0.0; baskets.len()],
            refused: false,
            masses: baskets.iter().map(mass_of).collect(),
            largest: match asks_for_whole(rules) {
                true => largest_pieces(world),
                false => Vec::new(),
            },
            joints: world.joints().count(),
            squeezed: SQUEEZED + own_strain(world, &bodies, &views),
            whole: greatest(&views),
            counts,
        }
    }

    /// Updates the progress after a tick. `hands` are the hands of the players that have joined, and `clock` is the
    /// number of ticks since the first input that moved a hand.
    pub(crate) fn watch<D: Dim>(
        &mut self,
        level: &Level,
        baskets: &[Basket<D>],
        world: &World<D>,
        hands: &[RigidBodyHandle],
        clock: u64,
    ) {
        let bodies = counted(world, &self.counts);
        let views = views_of(&bodies);
        self.kept = greatest(&views) / self.whole;
        self.pieces = views.iter().map(Vec::len).sum();
        self.broken = self.joints.saturating_sub(world.joints().count());
        let rules = level.game();
        if !self.largest.is_empty() {
            let now = largest_pieces(world).into_iter().zip(&self.largest);
            let torn = now
                .enumerate()
                .filter(|(_, (now, start))| *now < WHOLE * *start);
            self.torn = torn.fold(0, |torn, (body, _)| torn | 1 << body);
        }
        if baskets.is_empty() {
            return;
        }
        let at_hands = match rules.alone {
            true => pieces_at(world, hands),
            false => Vec::new(),
        };
        let contents = baskets.iter().map(|basket| {
            let bodies = world.soft_bodies().enumerate();
            let bodies = bodies.filter(|(index, _)| basket.wants(*index));
            let bodies: Vec<_> = bodies.map(|(_, body)| body).collect();
            content(&bodies, &basket.region, &at_hands)
        });
        let contents: Vec<Content> = contents.collect();
        let resting: f32 = contents.iter().map(|content| content.resting).sum();
        let shares = |mass: fn(&Content) -> f32| {
            let needs = baskets.iter().zip(&self.masses).zip(&contents);
            let shares = needs.map(|((basket, total), content)| {
                // With one basket the factor is 1.
                mass(content) / total * (rules.share / basket.share)
            });
            shares.collect::<Vec<f32>>()
        };
        let least = |shares: &[f32]| shares.iter().copied().fold(f32::INFINITY, f32::min);
        let inside = shares(|content| content.resting);
        self.inside = least(&inside);
        self.within = least(&shares(|content| content.all));
        self.fills = inside
            .iter()
            .map(|share| (share / rules.share).clamp(0.0, 1.0))
            .collect();
        self.touched = contents.iter().any(|content| content.touched);
        self.refused = baskets
            .iter()
            .any(|basket| self.holds_refused(basket, world));
        let enough = self.inside >= rules.share && !self.refused && !self.waits_for_hand(rules);
        self.held = if enough {
            self.held + DEFAULT_TICK
        } else {
            0.0
        };
        self.relaxed &= enough;
        let looks = self.held == DEFAULT_TICK || world.ticks().is_multiple_of(LOOK);
        if enough && looks && !self.relaxed {
            let strains =
                { baskets.iter() }.map(|basket| strain_inside(&bodies, &views, &basket.region));
            self.relaxed = strains.fold(0.0, f32::max) <= self.squeezed;
        }
        if enough && self.held >= level.game().hold {
            let all = views.iter().flatten();
            let lost = all
                .filter(|view| view.mass > CRUMB * self.mass)
                .filter(|view| {
                    let centre = D::Vector::from_vec3(view.centre);
                    baskets
                        .iter()
                        .all(|basket| basket.region.distance(centre).0 > 0.0)
                })
                .count();
            let outcome = Outcome {
                ticks: clock,
                route: self.route(lost),
                kept: self.kept,
                inside: resting / self.mass,
                pieces: self.pieces,
                lost,
                broken: self.broken,
                torn: self.torn,
            };
            let is_allowed = |required: &Wish| outcome.fulfils(required);
            if rules.require.as_ref().is_none_or(is_allowed) {
                self.outcome = Some(outcome);
            }
        }
    }

    /// Returns whether a basket holds more than a crumb of a body that it refuses.
    fn holds_refused<D: Dim>(&self, basket: &Basket<D>, world: &World<D>) -> bool {
        if basket.refuses.is_empty() {
            return false;
        }
        let bodies = world.soft_bodies().zip(1..);
        let refused = bodies.filter(|(_, number)| basket.refuses.contains(number));
        let refused: Vec<_> = refused.map(|(body, _)| body).collect();
        content(&refused, &basket.region, &[]).all > CRUMB * self.mass
    }

    /// Returns the route of the win. It follows from the state of the bodies, not from the player's
    /// intention.
    fn route(&self, lost: usize) -> Route {
        let is_whole = self.kept >= WHOLE && lost == 0;
        match (is_whole, self.relaxed) {
            (true, _) => Route::Squeeze,
            (false, true) => Route::Shave,
            (false, false) => Route::Mix,
        }
    }
}

/// Returns whether a goal or the level itself asks for whole bodies.
fn asks_for_whole(rules: &GameText) -> bool {
    let mut wishes = rules.wish.iter().chain(&rules.require);
    wishes.any(|wish| !wish.whole.is_empty())
}

/// Returns the numbers among `bodies` that are torn.
fn torn_among(bodies: &[usize], torn: u32) -> Vec<usize> {
    let is_torn = |number: &&usize| torn >> (**number - 1) & 1 == 1;
    bodies.iter().filter(is_torn).copied().collect()
}

/// Returns the mass of the largest piece of each body that a goal can name [kg].
fn largest_pieces<D: Dim>(world: &World<D>) -> Vec<f32> {
    let bodies = world.soft_bodies().take(MAX_TOLD_BODIES);
    let masses = bodies.map(|(_, body)| {
        let views = body.piece_views();
        views.iter().map(|view| view.mass).fold(0.0, f32::max)
    });
    masses.collect()
}

/// Returns the state of the joints after `broken` of them broke.
fn joints_of(broken: usize) -> Joints {
    match broken {
        0 => Joints::Whole,
        _ => Joints::Broken,
    }
}

/// A body and its handle.
type Counted<'a, D> = (SoftBodyHandle, &'a SoftBody<D>);

/// Returns the bodies that count.
fn counted<'a, D: Dim>(world: &'a World<D>, counts: &[bool]) -> Vec<Counted<'a, D>> {
    let bodies = world.soft_bodies().zip(counts);
    bodies
        .filter_map(|(body, counts)| counts.then_some(body))
        .collect()
}

fn views_of<D: Dim>(bodies: &[Counted<'_, D>]) -> Vec<Vec<PieceView>> {
    bodies.iter().map(|(_, body)| body.piece_views()).collect()
}

/// Returns the pieces that touch one of the hands.
fn pieces_at<D: Dim>(world: &World<D>, hands: &[RigidBodyHandle]) -> Vec<ObjectRef> {
    let contacts = hands.iter().filter_map(|&hand| {
        let contacts = world.contacts_of(hand).ok()?;
        Some(contacts.filter_map(move |contact| contact.other(hand)))
    });
    contacts.flatten().collect()
}

/// Returns the sum of the masses of each body's largest piece [kg].
fn greatest(views: &[Vec<PieceView>]) -> f32 {
    let greatest = views
        .iter()
        .map(|views| views.iter().map(|view| view.mass).fold(0.0, f32::max));
    greatest.sum()
}

/// Returns an estimate of the largest mean strain of a body under its own weight. The estimate assumes a
/// column as high as the body. The column has the material of the body with the largest ratio of density to
/// stiffness. The stress is ρ g h at the foot of the column and zero at the top.
fn own_strain<D: Dim>(
    world: &World<D>,
    bodies: &[Counted<'_, D>],
    views: &[Vec<PieceView>],
) -> f32 {
    let gravity = world.config().gravity.to_vec3();
    let of = |body: &SoftBody<D>, pieces: &[PieceView]| {
        let materials = body.materials().iter();
        let heavy = materials.map(|m| m.density / m.elasticity.young as f32);
        let drops = pieces.iter().map(|piece| {
            let sides = piece.high - piece.low;
            (gravity * sides).abs().element_sum()
        });
        let softer = body.stiffness_scale() as f32;
        0.5 * heavy.fold(0.0, f32::max) * drops.fold(0.0, f32::max) / softer
    };
    let strains = bodies.iter().zip(views);
    let strains = strains.map(|((_, body), pieces)| of(body, pieces));
    strains.fold(0.0, f32::max)
}

/// Content of the basket.
#[derive(Default)]
struct Content {
    /// Mass of the nodes at rest in the basket [kg].
    resting: f32,
    /// Mass of all nodes in the basket [kg].
    all: f32,
    /// Whether a piece with nodes in the basket is touched by a hand.
    touched: bool,
}

/// Returns the content of a region. `touched` are the pieces that a hand touches.
fn content<D: Dim>(bodies: &[Counted<'_, D>], region: &Shape<D>, touched: &[ObjectRef]) -> Content {
    let mut sum = Content::default();
    for &(handle, body) in bodies {
        let mut own = Content::default();
        for (id, _) in body.mesh().nodes() {
            if !is_inside(region, body.positions()[id]) {
                continue;
            }
            let (_, velocity, mass) = body.node_state(id);
            own.all += mass;
            if velocity.dot(velocity) < RESTING * RESTING {
                own.resting += mass;
            }
            if !touched.is_empty() && !sum.touched {
                let piece = body.pieces().of_node(id);
                let piece = ObjectRef::Piece {
                    body: handle,
                    piece,
                };
                sum.touched = touched.contains(&piece);
            }
        }
        sum.all += own.all;
        sum.resting += own.resting;
    }
    sum
}

/// Returns the mean strain of the elements in a region, weighted by volume. Only pieces with more than 50
/// elements and with their centre in the region count.
fn strain_inside<D: Dim>(
    bodies: &[Counted<'_, D>],
    views: &[Vec<PieceView>],
    region: &Shape<D>,
) -> f32 {
    let (mut sum, mut volume) = (0.0, 0.0);
    for ((_, body), pieces) in bodies.iter().zip(views) {
        let counts = |id: ElementId| {
            let view = &pieces[body.pieces().of_element(id).index()];
            let centre = D::Vector::from_vec3(view.centre);
            region.distance(centre).0 < 0.0 && view.element_count > 50
        };
        for (id, element) in body.mesh().elements().filter(|(id, _)| counts(*id)) {
            let children = match element.cell.level {
                0 => D::CORNERS as u32,
                _ => element.children.count_ones(),
            };
            let child = (D::CORNERS as f32).powi(i32::from(element.cell.level) - 1);
            let strain = body.strain(id).expect("the mesh lists live elements");
            sum += children as f32 * child * strain;
            volume += children as f32 * child;
        }
    }
    if volume > 0.0 { sum / volume } else { 0.0 }
}

/// Returns whether a position is in a region. Avoids a square root for a box, which is the shape of all
/// baskets.
fn is_inside<D: Dim>(region: &Shape<D>, position: Row) -> bool {
    match *region {
        Shape::Box { centre, half } => {
            (0..D::N).all(|axis| (position[axis] - centre[axis]).abs() < half[axis])
        }
        _ => region.distance(D::Vector::from_vec3(position.xyz())).0 < 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::{SQUEEZED, counted, is_inside, strain_inside, views_of};
    use crate::{Bot, BotKind, InputFrame, Level, Round};
    use fuwafuwa::{Dim2, Dim3, Shape, Vec3};
    use std::sync::Arc;

    #[test]
    fn is_inside_agrees_with_the_distance() {
        let (centre, half) = (Vec3::new(1.05, 0.3, 0.0), Vec3::new(0.43, 0.3, 0.425));
        let basket = Shape::<Dim3>::Box { centre, half };
        let mut count = 0;
        for place in 0..11_usize.pow(3) {
            let steps = [place % 11, place / 11 % 11, place / 121];
            let shares = Vec3::from(steps.map(|step| 0.25 * step as f32 - 1.25));
            let at = centre + shares * half;
            let inside = is_inside(&basket, at.into());
            assert_eq!(inside, basket.distance(at).0 < 0.0, "{at:?}");
            count += usize::from(inside);
        }
        assert!((343..729).contains(&count), "{count}");
    }

    #[test]
    fn moving_mass_counts_as_within_only() {
        let mut round = Round::<Dim2>::new(Arc::new(Level::open("classic").unwrap()));
        let mut bot = Bot::new(BotKind::Squeeze, 1);
        let mut moved = 0.0_f32;
        for _ in 0..150 {
            let frame = bot.frame(&round);
            round.step(frame);
            let progress = round.progress();
            assert!(progress.inside <= progress.within && progress.within <= 1.001);
            moved = moved.max(progress.within - progress.inside);
        }
        assert!(moved > 0.1, "{moved}");
    }

    #[test]
    fn body_strained_by_its_own_weight_is_not_squeezed() {
        let mut round = Round::<Dim3>::new(Arc::new(Level::open("hoop").unwrap()));
        for _ in 0..120 {
            round.step(InputFrame::default());
        }
        let (world, [low, high]) = (round.world(), round.level().arena());
        let room = Shape::cuboid(0.5 * (high - low)).translated(0.5 * (low + high));
        let bodies = counted(world, &[true]);
        let strain = strain_inside(&bodies, &views_of(&bodies), &room);
        let limit = round.progress().squeezed;
        assert!(SQUEEZED < strain && strain < limit, "{strain}, {limit}");
        let flat = Round::<Dim2>::new(Arc::new(Level::open("classic").unwrap()));
        assert_eq!(flat.progress().squeezed, SQUEEZED);
    }
}

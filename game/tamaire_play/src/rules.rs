//! Conditions and routes of a win.

use crate::{Joints, Level, Route, Wish};
use fuwafuwa::inspect::Row;
use fuwafuwa::{
    DEFAULT_TICK, Dim, DimVector, ElementId, ObjectRef, PieceView, RigidBodyHandle, Shape,
    SoftBody, SoftBodyHandle, World,
};
use fuwafuwa_scenes::scene::GameText;
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

/// Progress of a round. All values are about the bodies that count; see [`GameText::bodies`].
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
    /// Time for which the basket has counted as full [s]. If the level has `alone`, a hand that touches the content
    /// resets it.
    pub held: f32,
    /// Whether a hand touches a piece in the basket.
    pub touched: bool,
    /// Number of joints that broke.
    pub broken: usize,
    /// Whether the bars stopped squeezing the content of the basket at some moment of the current hold, the
    /// time for which enough mass has rested there. If never, a win with a torn body counts as
    /// [`Route::Mix`].
    pub relaxed: bool,
    /// Outcome of the round; `None` before a win.
    pub outcome: Option<Outcome>,
    /// For each body, whether it counts.
    pub(crate) counts: Vec<bool>,
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
}

fn is_zero(number: &usize) -> bool {
    *number == 0
}

impl Outcome {
    /// Returns the duration of the round from the first input that moved a hand [s].
    pub fn seconds(&self) -> f32 {
        self.ticks as f32 * DEFAULT_TICK
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
            || wish.max_pieces.is_some_and(|most| self.pieces > most);
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

    pub(crate) fn of<D: Dim>(level: &Level, world: &World<D>) -> Self {
        let chosen = &level.game().bodies;
        let counts = |body: usize| chosen.is_empty() || chosen.contains(&(body + 1));
        let counts: Vec<bool> = (0..world.soft_bodies().count()).map(counts).collect();
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
            relaxed: false,
            outcome: None,
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
        basket: Option<&Shape<D>>,
        world: &World<D>,
        hands: &[RigidBodyHandle],
        clock: u64,
    ) {
        let bodies = counted(world, &self.counts);
        let views = views_of(&bodies);
        self.kept = greatest(&views) / self.whole;
        self.pieces = views.iter().map(Vec::len).sum();
        self.broken = self.joints.saturating_sub(world.joints().count());
        let Some(basket) = basket else {
            return;
        };
        let Content {
            resting,
            all,
            touched,
        } = content(&bodies, basket, &pieces_at(world, hands));
        self.inside = resting / self.mass;
        self.within = all / self.mass;
        self.touched = touched;
        let rules = level.game();
        let enough = self.inside >= rules.share && !self.waits_for_hand(rules);
        self.held = if enough {
            self.held + DEFAULT_TICK
        } else {
            0.0
        };
        self.relaxed &= enough;
        let looks = self.held == DEFAULT_TICK || world.ticks().is_multiple_of(LOOK);
        if enough && looks && !self.relaxed {
            self.relaxed = strain_inside(&bodies, &views, basket) <= self.squeezed;
        }
        if enough && self.held >= level.game().hold {
            let all = views.iter().flatten();
            let lost = all
                .filter(|view| view.mass > CRUMB * self.mass)
                .filter(|view| basket.distance(D::Vector::from_vec3(view.centre)).0 > 0.0)
                .count();
            self.outcome = Some(Outcome {
                ticks: clock,
                route: self.route(lost),
                kept: self.kept,
                inside: self.inside,
                pieces: self.pieces,
                lost,
                broken: self.broken,
            });
        }
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

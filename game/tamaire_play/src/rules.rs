//! Conditions and routes of a win.

use crate::{Level, Route, Wish};
use fuwafuwa::DEFAULT_TICK;
use fuwafuwa::inspect::vector::minus;
use fuwafuwa::{Dim, ElementId, PieceView, Shape, SoftBody, World};
use serde::{Deserialize, Serialize};

/// Speed below which a node counts as resting in the basket [m/s].
const RESTING: f32 = 0.4;
/// Share of the total mass below which a piece is a crumb. A crumb outside the basket does not count as lost.
pub const CRUMB: f32 = 0.002;
/// Minimum of [`Progress::kept`] at which the bodies count as whole.
const WHOLE: f32 = 0.99;
/// Mean strain above which bodies at rest in the basket count as squeezed by the bars. The strain by the
/// bodies' own weight is added to this limit.
const SQUEEZED: f32 = 0.08;
/// Interval between two evaluations of the strain [ticks]. They take time, and squeezing a body in lasts
/// longer than this.
const LOOK: u64 = 4;

/// Progress of a round.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Total mass of all bodies at the start [kg].
    pub mass: f32,
    /// Share of the mass at rest in the basket.
    pub inside: f32,
    /// Share of the mass in the basket, at rest or moving.
    pub within: f32,
    /// Sum of the masses of each body's largest piece, relative to this sum at the start. The sum at the
    /// start is not the total mass, because a body may start in several pieces.
    pub kept: f32,
    /// Number of pieces.
    pub pieces: usize,
    /// Time for which enough mass has rested in the basket [s].
    pub held: f32,
    /// Whether the content of the basket was free of squeezing by the bars at some moment since enough mass
    /// has rested there. If it never was, a win with a torn body counts as [`Route::Mix`].
    pub relaxed: bool,
    /// Outcome, if the round was won.
    pub outcome: Option<Outcome>,
    bodies: usize,
    /// Mean strain at rest above which a body counts as squeezed.
    squeezed: f32,
    /// Sum of the masses of each body's largest piece at the start [kg].
    whole: f32,
}

/// Outcome of a won round.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    /// Number of ticks from the start.
    pub ticks: u64,
    /// Route of the win.
    pub route: Route,
    /// Sum of the masses of each body's largest piece, relative to this sum at the start.
    pub kept: f32,
    /// Share of the mass at rest in the basket.
    pub inside: f32,
    /// Number of pieces.
    pub pieces: usize,
    /// Number of pieces with their centre outside the basket, except crumbs.
    pub lost: usize,
}

impl Outcome {
    /// Returns the duration of the round [s].
    pub fn seconds(&self) -> f32 {
        self.ticks as f32 * TICK
    }

    /// Returns whether the outcome meets a wish of the level.
    pub fn fulfils(&self, wish: &Wish) -> bool {
        wish.seconds.is_none_or(|most| self.seconds() <= most)
            && wish.kept.is_none_or(|least| self.kept >= least)
            && wish.pieces.is_none_or(|least| self.pieces >= least)
            && wish.route.is_none_or(|route| self.route == route)
    }
}

impl Progress {
    pub(crate) fn of<D: Dim>(world: &World<D>) -> Self {
        let views = views_of(world);
        Self {
            mass: total_mass(world),
            inside: 0.0,
            within: 0.0,
            kept: 1.0,
            pieces: world
                .soft_bodies()
                .map(|(_, body)| body)
                .map(|body| body.pieces().list.len())
                .sum(),
            held: 0.0,
            relaxed: false,
            outcome: None,
            bodies: world.soft_bodies().count(),
            squeezed: SQUEEZED + own_strain(world, &views),
            whole: greatest(&views),
        }
    }

    /// Updates the progress after a tick.
    pub(crate) fn watch<D: Dim>(
        &mut self,
        level: &Level,
        basket: Option<&Shape>,
        world: &World<D>,
    ) {
        let views = views_of(world);
        self.kept = greatest(&views) / self.whole;
        self.pieces = views.iter().map(Vec::len).sum();
        let Some(basket) = basket else {
            return;
        };
        let (resting, all) = masses_inside(world, basket);
        self.inside = resting / self.mass;
        self.within = all / self.mass;
        let enough = self.inside >= level.game().share;
        self.held = if enough { self.held + TICK } else { 0.0 };
        self.relaxed &= enough;
        let looks = self.held == TICK || world.ticks().is_multiple_of(LOOK);
        if enough && looks && !self.relaxed {
            self.relaxed = strain_inside(world, &views, basket) <= self.squeezed;
        }
        if enough && self.held >= level.game().hold {
            let all = views.iter().flatten();
            let lost = all
                .filter(|view| view.mass > CRUMB * self.mass)
                .filter(|view| basket.distance(view.centre).0 > 0.0)
                .count();
            self.outcome = Some(Outcome {
                ticks: world.ticks(),
                route: self.route(lost),
                kept: self.kept,
                inside: self.inside,
                pieces: self.pieces,
                lost,
            });
        }
    }

    /// Returns the route by the result, not by the player's intention.
    fn route(&self, lost: usize) -> Route {
        let is_whole = self.kept >= WHOLE && lost == 0;
        match (is_whole, self.relaxed) {
            (true, _) => Route::Squeeze,
            (false, true) => Route::Shave,
            (false, false) => Route::Mix,
        }
    }
}

fn views_of<D: Dim>(world: &World<D>) -> Vec<Vec<PieceView>> {
    world
        .soft_bodies()
        .map(|(_, body)| body)
        .map(SoftBody::piece_views)
        .collect()
}

/// Returns the sum of the masses of each body's largest piece [kg].
fn greatest(views: &[Vec<PieceView>]) -> f32 {
    let greatest = views
        .iter()
        .map(|views| views.iter().map(|view| view.mass).fold(0.0, f32::max));
    greatest.sum()
}

/// Returns the largest mean strain of a body under its own weight. The estimate assumes a column as high as
/// the body, of the body's material with the largest ratio of density to stiffness. The stress is ρ g h at
/// the foot of the column and zero at the top.
fn own_strain<D: Dim>(world: &World<D>, views: &[Vec<PieceView>]) -> f32 {
    let gravity = world.config().gravity;
    let of = |(body, pieces): (&SoftBody<D>, &Vec<PieceView>)| {
        let materials = body.materials().iter();
        let heavy = materials.map(|m| m.density / m.elasticity.young as f32);
        let drops = pieces.iter().map(|piece| {
            let sides = minus(piece.high, piece.low);
            (0..3).map(|axis| (gravity[axis] * sides[axis]).abs()).sum()
        });
        let softer = body.stiffness_scale() as f32;
        0.5 * heavy.fold(0.0, f32::max) * drops.fold(0.0, f32::max) / softer
    };
    let bodies = world.soft_bodies().map(|(_, body)| body).zip(views);
    bodies.map(of).fold(0.0, f32::max)
}

fn total_mass<D: Dim>(world: &World<D>) -> f32 {
    world
        .soft_bodies()
        .map(|(_, body)| body)
        .map(|body| body.total_mass() as f32)
        .sum()
}

/// Returns the mass of the nodes in a region [kg]: of those at rest, and of all.
fn masses_inside<D: Dim>(world: &World<D>, region: &Shape) -> (f32, f32) {
    let inside = |body: &SoftBody<D>| {
        let (mut resting, mut all) = (0.0, 0.0);
        for (id, _) in body.mesh().nodes() {
            if !is_inside(region, body.positions()[id]) {
                continue;
            }
            let (_, velocity, mass) = body.node_state(id);
            all += mass;
            let square: f32 = velocity.iter().map(|k| k * k).sum();
            if square < RESTING * RESTING {
                resting += mass;
            }
        }
        (resting, all)
    };
    let bodies = world.soft_bodies().map(|(_, body)| body).map(inside);
    bodies.fold((0.0, 0.0), |sum, of| (sum.0 + of.0, sum.1 + of.1))
}

/// Returns the mean strain of the elements in a region, weighted by volume. Counts only pieces of more than
/// 50 elements with their centre in the region.
fn strain_inside<D: Dim>(world: &World<D>, views: &[Vec<PieceView>], region: &Shape) -> f32 {
    let (mut sum, mut volume) = (0.0, 0.0);
    for (body, pieces) in world.soft_bodies().map(|(_, body)| body).zip(views) {
        let counts = |id: ElementId| {
            let view = &pieces[body.pieces().of_element(id).index()];
            region.distance(view.centre).0 < 0.0 && view.element_count > 50
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

/// Returns whether a position is in a region. For a box, the shape of all baskets, this needs no square root.
fn is_inside(region: &Shape, [x, y, z, _]: [f32; 4]) -> bool {
    match *region {
        Shape::Box { centre, half } => {
            let at = minus([x, y, z], centre);
            (0..3).all(|axis| at[axis].abs() < half[axis])
        }
        _ => region.distance([x, y, z]).0 < 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::{SQUEEZED, is_inside, strain_inside, views_of};
    use crate::{Bot, BotKind, InputFrame, Level, Round};
    use fuwafuwa::{Dim2, Dim3, Shape};
    use std::sync::Arc;

    #[test]
    fn is_inside_agrees_with_the_distance() {
        let (centre, half) = ([1.05, 0.3, 0.0], [0.43, 0.3, 0.425]);
        let basket = Shape::Box { centre, half };
        let mut count = 0;
        for place in 0..11_usize.pow(3) {
            let steps = [place % 11, place / 11 % 11, place / 121];
            let at = [0, 1, 2].map(|k| centre[k] + (0.25 * steps[k] as f32 - 1.25) * half[k]);
            let inside = is_inside(&basket, [at[0], at[1], at[2], 0.0]);
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
        let room = Shape::Box {
            centre: [0, 1, 2].map(|k| 0.5 * (low[k] + high[k])),
            half: [0, 1, 2].map(|k| 0.5 * (high[k] - low[k])),
        };
        let strain = strain_inside(world, &views_of(world), &room);
        let limit = round.progress().squeezed;
        assert!(SQUEEZED < strain && strain < limit, "{strain}, {limit}");
        let flat = Round::<Dim2>::new(Arc::new(Level::open("classic").unwrap()));
        assert_eq!(flat.progress().squeezed, SQUEEZED);
    }
}

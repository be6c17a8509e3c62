//! What counts as won, and by which route.

use crate::{Level, Route, Wish};
use fuwafuwa::vector::minus;
use fuwafuwa::world::TICK;
use fuwafuwa::{Dim, ElementId, PieceView, Shape, SoftBody, World};
use serde::{Deserialize, Serialize};

/// What moves faster than this does not rest in the basket [m/s].
const RESTING: f32 = 0.4;
/// What has less than this share of the mass is a crumb, which may get lost on the way.
pub const CRUMB: f32 = 0.002;
/// Share of the mass that must still hang together for a body to count as whole.
const WHOLE: f32 = 0.99;
/// What is strained by so much more than its own weight does it, on the mean while it rests, is held squeezed
/// by the bars.
const SQUEEZED: f32 = 0.08;
/// The strain is looked at this often [ticks]: squeezing in takes longer.
const LOOK: u64 = 4;

/// How far a round has come.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Mass of all bodies at the start [kg].
    pub mass: f32,
    /// Share of it that rests in the basket.
    pub inside: f32,
    /// Share of it in the basket, whether it rests or moves.
    pub within: f32,
    /// The mass in the largest piece of each body, as a share of what that was at the start: a body may
    /// begin in parts.
    pub kept: f32,
    /// Number of pieces.
    pub pieces: usize,
    /// For how long enough has rested in the basket [s].
    pub held: f32,
    /// Whether nothing squeezed what is in the basket at some moment since enough rests there: then the
    /// bars do not hold it when nobody pushes.
    pub relaxed: bool,
    /// How it ended, if it has.
    pub outcome: Option<Outcome>,
    bodies: usize,
    /// What rests and is strained by more than this on the mean is held squeezed.
    squeezed: f32,
    /// Mass of the largest piece of each body at the start, all together [kg].
    whole: f32,
}

/// How a round was won.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    /// Ticks from the start.
    pub ticks: u64,
    /// By squeezing, by shaving, or some of both.
    pub route: Route,
    /// The mass in the largest piece of each body, as a share of what that was at the start.
    pub kept: f32,
    /// Share of the mass in the basket.
    pub inside: f32,
    /// Number of pieces.
    pub pieces: usize,
    /// How many of them are not in the basket, crumbs aside.
    pub lost: usize,
}

impl Outcome {
    /// How long it took [s].
    pub fn seconds(&self) -> f32 {
        self.ticks as f32 * TICK
    }

    /// Whether a wish of the level came true.
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
                .iter()
                .map(|body| body.pieces().list.len())
                .sum(),
            held: 0.0,
            relaxed: false,
            outcome: None,
            bodies: world.soft_bodies().len(),
            squeezed: SQUEEZED + own_strain(world, &views),
            whole: greatest(&views),
        }
    }

    /// Looks at the world after a tick.
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

    /// Named from what happened, not from what was meant.
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
        .iter()
        .map(SoftBody::piece_views)
        .collect()
}

/// Mass of the largest piece of each body, all together [kg].
fn greatest(views: &[Vec<PieceView>]) -> f32 {
    let greatest = views
        .iter()
        .map(|views| views.iter().map(|view| view.mass).fold(0.0, f32::max));
    greatest.sum()
}

/// The mean strain of the body that its own weight strains most: of a column as high as it is, of its heaviest
/// and softest material, whose foot bears ρ g h and whose top nothing.
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
    let bodies = world.soft_bodies().iter().zip(views);
    bodies.map(of).fold(0.0, f32::max)
}

fn total_mass<D: Dim>(world: &World<D>) -> f32 {
    world
        .soft_bodies()
        .iter()
        .map(|body| body.total_mass() as f32)
        .sum()
}

/// The mass in a region [kg]: of the nodes that rest, and of all.
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
    let bodies = world.soft_bodies().iter().map(inside);
    bodies.fold((0.0, 0.0), |sum, of| (sum.0 + of.0, sum.1 + of.1))
}

/// The mean strain, by volume, of the pieces whose middle is in a region and that are more than crumbs.
fn strain_inside<D: Dim>(world: &World<D>, views: &[Vec<PieceView>], region: &Shape) -> f32 {
    let (mut sum, mut volume) = (0.0, 0.0);
    for (body, pieces) in world.soft_bodies().iter().zip(views) {
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

/// Whether a place is in a region. Of a box, as all baskets are, this is told without a root.
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
    fn what_is_inside_is_so_by_its_distance() {
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
    fn what_moves_in_the_basket_is_within_and_what_rests_is_inside() {
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
    fn what_only_its_own_weight_strains_is_not_squeezed() {
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

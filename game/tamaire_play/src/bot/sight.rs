//! What a bot sees: the basket, the piece that matters, and what is in the way.

use super::map::Map;
use crate::Round;
use fuwafuwa::vector::{dot, length, minus, plus, scaled};
use fuwafuwa::{Dim, PieceView, RigidBody, Shape, Vector};
use std::cell::LazyCell;

/// Pieces with less than this share of the mass are not worth the way.
const CRUMB: f32 = 0.003;
/// Of the others, as many are looked at as matter most.
const MOST: usize = 12;
/// What a step costs through something rigid, and how much more through all of the mass.
const RIGID: f32 = 1000.0;
const SOFT: f32 = 400.0;

/// What a bot looks at.
pub(super) struct Sight {
    /// Into the basket, of length 1.
    pub axis: Vector,
    /// Along its mouth, of length 1; level where the mouth is not.
    pub across: Vector,
    /// The piece that matters.
    pub piece: Piece,
    /// The mass in the largest piece of each body, as a share of what that was at the start.
    pub kept: f32,
    /// Number of pieces.
    pub pieces: usize,
    /// Share of it in the basket.
    pub within: f32,
    /// Share of it in the basket beyond what is needed, moving or not.
    pub surplus: f32,
    /// Where the hand is, and where it is to go [m].
    pub hand: Vector,
    pub goal: Vector,
    /// Where the hand waits: in front of the basket, as far as it can [m].
    pub away: Vector,
    /// Where a hand can go, and what is in its way.
    pub map: Map,
}

/// A piece, and what a hand has to do with it.
#[derive(Copy, Clone, Debug)]
pub(super) struct Piece {
    /// Its middle [m].
    pub centre: Vector,
    /// Where it has to go, of length 1.
    pub way: Vector,
    /// From its middle to that of a hand that touches it from behind [m].
    pub reach: f32,
    /// Where a hand begins to push it [m].
    pub behind: Vector,
    /// How far its middle is from that of the mouth [m].
    pub far: f32,
    /// Whether it is no wider than the mouth.
    pub fits: bool,
}

/// The basket as a bot sees it.
struct Basket {
    /// Into it, of length 1.
    axis: Vector,
    /// Middle of its mouth [m].
    mouth: Vector,
    /// Half of its width on each axis across that counts [m]; else infinite.
    half: Vector,
    /// The same of what goes through between the bars of its mouth [m].
    opening: Vector,
}

impl Sight {
    /// What there is to see; `skips` = how many pieces that matter more are passed over, `off` = how
    /// far off the middle of the mouth a wide piece may be to be pushed straight in [m].
    pub(super) fn of<D: Dim>(round: &Round<D>, skips: usize, off: f32) -> Option<Self> {
        let (world, arena) = (round.world(), round.level().arena());
        let region = round.basket()?;
        let obstacles: Vec<&Shape> = world.fixed_rigid_bodies().map(RigidBody::shape).collect();
        let obstacles = obstacles.as_slice();
        let basket = Basket::of::<D>(region, obstacles)?;
        let hand = round.hands().next()?;
        let radius = hand.shape().inradius();
        let mut map = Map::new::<D>(arena, |at| match clearance(at, obstacles) < 0.9 * radius {
            true => RIGID,
            false => 1.0,
        });

        let mass = round.progress().mass;
        let bodies = world.soft_bodies().iter();
        let mut views: Vec<PieceView> = bodies.flat_map(|body| body.piece_views()).collect();
        views.sort_by(|a, b| b.mass.total_cmp(&a.mass));
        let largest = views.first()?;
        let is_out = |view: &&PieceView| view.mass > CRUMB * mass && !basket.holds(view);
        let ways = LazyCell::new(|| map.ways_to(basket.front()));
        let ahead = |from: Vector| ways.next(from);
        let mut pieces: Vec<Piece> = (views.iter().filter(is_out).take(MOST))
            .map(|view| Piece::of::<D>(view, &basket, &ahead, off, radius))
            .collect();
        if pieces.is_empty() {
            pieces.push(Piece::of::<D>(largest, &basket, &ahead, off, radius));
        }
        // Stays in order of mass otherwise.
        pieces.sort_by_key(|piece| clearance(piece.behind, obstacles) < 0.5 * radius);
        let piece = pieces[skips % pieces.len()];

        let mut within = 0.0;
        for body in world.soft_bodies().iter() {
            for (id, _) in body.mesh().nodes() {
                let (at, _, share) = body.node_state(id);
                map.add(at, SOFT * share / mass);
                if region.distance(at).0 < 0.0 {
                    within += share / mass;
                }
            }
        }
        let out = minus(basket.mouth, scaled(basket.axis, 4.0));
        Some(Self {
            axis: basket.axis,
            across: across::<D>(basket.axis),
            piece,
            kept: round.progress().kept,
            pieces: views.len(),
            within,
            surplus: within - round.level().game().share,
            hand: hand.position(),
            goal: hand.target_position(),
            away: clamped(out, arena, radius),
            map,
        })
    }
}

impl Piece {
    /// `ahead`: the next place on the way from one to the front of the basket.
    fn of<D: Dim>(
        view: &PieceView,
        basket: &Basket,
        ahead: impl Fn(Vector) -> Vector,
        off: f32,
        hand: f32,
    ) -> Self {
        let centre = view.centre;
        let half = scaled(minus(view.high, view.low), 0.5);
        let (along, aside) = split(minus(centre, basket.mouth), basket.axis);
        let spare = basket.spare(half);
        // In space what fits on one of the axes across needs to be moved along the other only: what
        // lies on a floor is not lifted.
        let fits =
            |axis: usize| D::N == 3 && spare[axis].is_finite() && aside[axis].abs() < spare[axis];
        let off_mouth = length([0, 1, 2].map(|axis| if fits(axis) { 0.0 } else { aside[axis] }));
        let narrowest = spare.into_iter().fold(f32::INFINITY, f32::min);
        // Straight in, or first to a place in front of the mouth.
        let target = match off_mouth > narrowest.max(off) {
            true => ahead(centre),
            false => plus(basket.mouth, scaled(basket.axis, along + 0.6)),
        };
        let target = [0, 1, 2].map(|axis| {
            if fits(axis) {
                centre[axis]
            } else {
                target[axis]
            }
        });
        let way = unit(minus(target, centre));
        let reach = length([0, 1, 2].map(|k| way[k] * half[k])) + hand;
        Self {
            centre,
            way,
            reach,
            behind: minus(centre, scaled(way, 1.1 * reach)),
            far: length(minus(centre, basket.mouth)),
            fits: (0..3).all(|k| half[k] < basket.opening[k]),
        }
    }
}

impl Basket {
    fn of<D: Dim>(region: &Shape, obstacles: &[&Shape]) -> Option<Self> {
        let Shape::Box { centre, half } = *region else {
            return None;
        };
        let axis = inwards::<D>(centre, half, obstacles);
        let mouth = minus(centre, scaled(axis, dot(half, axis).abs()));
        let is_across = |k: usize| k < D::N && axis[k] == 0.0;
        let half = [0, 1, 2].map(|k| if is_across(k) { half[k] } else { f32::INFINITY });
        let opening = [0, 1, 2].map(|k| match half[k].is_finite() {
            true => half[k].min(opening(mouth, axis, k, obstacles)),
            false => half[k],
        });
        Some(Self {
            axis,
            mouth,
            half,
            opening,
        })
    }

    /// How much wider it is on each axis than something, half by half [m]; negative where it is too
    /// narrow.
    fn spare(&self, half: Vector) -> Vector {
        minus(self.half, half)
    }

    /// A place in front of its mouth [m].
    fn front(&self) -> Vector {
        minus(self.mouth, scaled(self.axis, 0.5))
    }

    /// Whether all of a piece is in it.
    fn holds(&self, piece: &PieceView) -> bool {
        let half = scaled(minus(piece.high, piece.low), 0.5);
        let middle = scaled(plus(piece.high, piece.low), 0.5);
        let (along, aside) = split(minus(middle, self.mouth), self.axis);
        along > dot(half, self.axis).abs()
            && self.spare(aside.map(f32::abs)).iter().all(|&k| k > 0.0)
    }
}

/// The way into a basket: against the direction in which one sees farthest out of it.
fn inwards<D: Dim>(centre: Vector, half: Vector, obstacles: &[&Shape]) -> Vector {
    const WAYS: [Vector; 6] = [
        [1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    let sees = |way: &Vector| {
        let place = |step: usize| minus(centre, scaled(*way, 0.05 * step as f32));
        let free = (0..100).take_while(|&step| clearance(place(step), obstacles) > 0.0);
        free.count() as f32 * 0.05 - dot(half, *way).abs()
    };
    let ways = WAYS.into_iter().take(2 * D::N);
    ways.max_by(|a, b| sees(a).total_cmp(&sees(b)))
        .expect("there are four at least")
}

/// How far one sees on an axis across, from the middle of a mouth and a bit before and behind it [m].
fn opening(mouth: Vector, axis: Vector, across: usize, obstacles: &[&Shape]) -> f32 {
    let sees = |from: Vector, way: Vector| {
        let mut far = 0.0;
        for _ in 0..20 {
            far += clearance(plus(from, scaled(way, far)), obstacles).max(0.0);
        }
        far
    };
    let mut least = f32::INFINITY;
    for step in -4..=4 {
        let from = plus(mouth, scaled(axis, 0.05 * step as f32));
        for side in [-1.0, 1.0] {
            let mut way = [0.0; 3];
            way[across] = side;
            least = least.min(sees(from, way));
        }
    }
    least
}

/// A direction across an axis: from the first axis to the last that counts, and else to the first.
fn across<D: Dim>(axis: Vector) -> Vector {
    let mut across = [-axis[1] - axis[2], 0.0, 0.0];
    across[D::N - 1] = axis[0];
    across
}

/// How far the nearest obstacle is [m]; negative in it.
fn clearance(at: Vector, obstacles: &[&Shape]) -> f32 {
    let distances = obstacles.iter().map(|shape| shape.distance(at).0);
    distances.fold(f32::INFINITY, f32::min)
}

/// The place nearest to one that is in the room.
fn clamped(place: Vector, [low, high]: [Vector; 2], margin: f32) -> Vector {
    [0, 1, 2].map(|axis| {
        let margin = margin.min(0.5 * (high[axis] - low[axis]));
        place[axis].clamp(low[axis] + margin, high[axis] - margin)
    })
}

/// The share of a vector along an axis of length 1, and the rest.
pub(super) fn split(v: Vector, axis: Vector) -> (f32, Vector) {
    let along = dot(v, axis);
    (along, minus(v, scaled(axis, along)))
}

/// The same direction, of length 1.
pub(super) fn unit(v: Vector) -> Vector {
    scaled(v, 1.0 / length(v).max(1e-6))
}

//! A bot's view of a round: the basket, the most important piece, and the obstacles.

use super::map::Map;
use crate::Round;
use fuwafuwa::inspect::vector::{dot, length, minus, plus, scaled};
use fuwafuwa::{Dim, PieceView, RigidBody, Shape, Vector};
use std::cell::LazyCell;

/// Share of the total mass below which a piece is ignored.
const CRUMB: f32 = 0.003;
/// Maximum number of pieces to consider, in order of mass.
const MOST: usize = 12;
/// Cost of a path cell in an obstacle (`RIGID`), and additional cost of a cell with mass (`SOFT` times its
/// share of the total mass).
const RIGID: f32 = 1000.0;
const SOFT: f32 = 400.0;

/// A bot's view of a round.
pub(super) struct Sight {
    /// Unit vector into the basket.
    pub axis: Vector,
    /// Unit vector along the mouth; horizontal in 3D.
    pub across: Vector,
    /// The piece to push: the heaviest one outside the basket with free space behind it, after the skipped
    /// ones.
    pub piece: Piece,
    /// Mass kept in the largest pieces, [`Progress::kept`](crate::Progress::kept).
    pub kept: f32,
    /// Number of pieces.
    pub pieces: usize,
    /// Share of the mass in the basket.
    pub within: f32,
    /// Share of the mass in the basket, at rest or moving, minus the required share.
    pub surplus: f32,
    /// Position and target of the hand [m].
    pub hand: Vector,
    pub goal: Vector,
    /// Waiting position of the hand: in front of the basket, as far away as possible [m].
    pub away: Vector,
    /// Costs for the path of a hand.
    pub map: Map,
}

/// A piece, and the positions for pushing it.
#[derive(Copy, Clone, Debug)]
pub(super) struct Piece {
    /// Centre [m].
    pub centre: Vector,
    /// Unit vector in the direction to push.
    pub direction: Vector,
    /// Distance between its centre and that of a hand that touches it from behind [m].
    pub reach: f32,
    /// Position from which a hand starts to push [m].
    pub behind: Vector,
    /// Distance between its centre and that of the mouth [m].
    pub far: f32,
    /// Whether the piece is narrower than the mouth.
    pub fits: bool,
}

/// A bot's view of the basket.
struct Basket {
    /// Unit vector into the basket.
    axis: Vector,
    /// Centre of the mouth [m].
    mouth: Vector,
    /// Half width on each used axis across the mouth [m]; infinite on other axes.
    half: Vector,
    /// Half width of the opening between the bars of the mouth, on the same axes [m].
    opening: Vector,
}

impl Sight {
    /// Returns the view of a round. `skips` is the number of more important pieces to pass over. A piece as
    /// wide as the mouth is pushed straight in if its centre is at most `off` beside the mouth's axis [m].
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
        let bodies = world.soft_bodies().map(|(_, body)| body);
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
        // Pieces without space for a hand behind them come last. The sort is stable, so mass decides among
        // the others.
        pieces.sort_by_key(|piece| clearance(piece.behind, obstacles) < 0.5 * radius);
        let piece = pieces[skips % pieces.len()];

        let mut within = 0.0;
        for body in world.soft_bodies().map(|(_, body)| body) {
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
    /// Returns the piece of a view. `ahead` returns the next position on the path from a position to the
    /// front of the basket, `off` is the argument of [`Sight::of`], and `hand` is the radius of the hand [m].
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
        // In 3D, a piece that fits on one of the two axes across the mouth is moved on the other one only. So
        // a piece on a floor is not lifted.
        let fits =
            |axis: usize| D::N == 3 && spare[axis].is_finite() && aside[axis].abs() < spare[axis];
        let off_mouth = length([0, 1, 2].map(|axis| if fits(axis) { 0.0 } else { aside[axis] }));
        let narrowest = spare.into_iter().fold(f32::INFINITY, f32::min);
        // Straight in, or first to a position in front of the mouth.
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
            direction: way,
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

    /// Returns the half width of the basket minus `half` on each axis [m]; negative where the basket is
    /// narrower.
    fn spare(&self, half: Vector) -> Vector {
        minus(self.half, half)
    }

    /// Returns a position in front of the mouth [m].
    fn front(&self) -> Vector {
        minus(self.mouth, scaled(self.axis, 0.5))
    }

    /// Returns whether the whole piece is in the basket.
    fn holds(&self, piece: &PieceView) -> bool {
        let half = scaled(minus(piece.high, piece.low), 0.5);
        let middle = scaled(plus(piece.high, piece.low), 0.5);
        let (along, aside) = split(minus(middle, self.mouth), self.axis);
        along > dot(half, self.axis).abs()
            && self.spare(aside.map(f32::abs)).iter().all(|&k| k > 0.0)
    }
}

/// Returns the direction into a basket: opposite to the direction with the longest line of sight out of it.
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
        .expect("there are at least four directions")
}

/// Returns the half width of the opening on an axis across the mouth [m]: the shortest line of sight to an
/// obstacle from points near the mouth's centre.
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

/// Returns a direction perpendicular to the coordinate direction `axis`: along the last used axis (y in 2D, z
/// in 3D) if `axis` is along x, otherwise along x.
fn across<D: Dim>(axis: Vector) -> Vector {
    let mut across = [-axis[1] - axis[2], 0.0, 0.0];
    across[D::N - 1] = axis[0];
    across
}

/// Returns the distance to the nearest obstacle [m]; negative inside one.
fn clearance(at: Vector, obstacles: &[&Shape]) -> f32 {
    let distances = obstacles.iter().map(|shape| shape.distance(at).0);
    distances.fold(f32::INFINITY, f32::min)
}

/// Returns the nearest position in the room, at least `margin` away from the walls [m].
fn clamped(place: Vector, [low, high]: [Vector; 2], margin: f32) -> Vector {
    [0, 1, 2].map(|axis| {
        let margin = margin.min(0.5 * (high[axis] - low[axis]));
        place[axis].clamp(low[axis] + margin, high[axis] - margin)
    })
}

/// Splits a vector into its component along a unit vector and the remainder.
pub(super) fn split(v: Vector, axis: Vector) -> (f32, Vector) {
    let along = dot(v, axis);
    (along, minus(v, scaled(axis, along)))
}

/// Returns the vector normalized to length 1.
pub(super) fn unit(v: Vector) -> Vector {
    scaled(v, 1.0 / length(v).max(1e-6))
}

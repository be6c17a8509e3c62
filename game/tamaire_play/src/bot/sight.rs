//! A bot's view of a round: the basket, the piece to push, and the obstacles.

use super::map::Map;
use crate::Round;
use fuwafuwa::{Dim, DimVector, MotionType, PieceView, Shape, Vec3};
use std::cell::LazyCell;

/// Share of the total mass below which a bot ignores a piece.
const CRUMB: f32 = 0.003;
/// Maximum number of pieces that a bot considers, in order of mass.
const MOST: usize = 12;
/// Cost of a step through a cell in an obstacle, relative to a free cell.
const RIGID: f32 = 1000.0;
/// Additional cost of a step through a cell with soft matter, times the cell's share of the total mass.
const SOFT: f32 = 400.0;

/// A bot's view of a round.
pub(super) struct Sight {
    /// Unit vector through the mouth into the basket.
    pub axis: Vec3,
    /// Unit vector across the basket's axis, along the mouth; horizontal in 3D.
    pub across: Vec3,
    /// Piece to push. It is the heaviest piece outside the basket with free space behind it, not counting the
    /// pieces that the bot skips.
    pub piece: Piece,
    /// Value of [`Progress::kept`](crate::Progress::kept): mass kept in the largest pieces.
    pub kept: f32,
    /// Number of pieces.
    pub pieces: usize,
    /// Share of the mass in the basket, at rest or moving.
    pub within: f32,
    /// Value of `within` minus the share of the mass required for a win.
    pub surplus: f32,
    /// Position of the hand [m].
    pub hand: Vec3,
    /// Target position of the hand [m].
    pub goal: Vec3,
    /// Position where the hand waits [m]: in front of the basket, as far away as possible.
    pub away: Vec3,
    /// Map for finding the path of the hand.
    pub map: Map,
}

/// A piece, and the positions for pushing it.
#[derive(Copy, Clone, Debug)]
pub(super) struct Piece {
    /// Centre of the piece [m].
    pub centre: Vec3,
    /// Unit vector in the direction in which to push the piece.
    pub direction: Vec3,
    /// Distance between the piece's centre and the centre of a hand that touches the piece from behind [m].
    pub reach: f32,
    /// Position from which a hand starts to push [m].
    pub behind: Vec3,
    /// Distance between the piece's centre and the mouth's centre [m].
    pub far: f32,
    /// Whether the piece is narrower than the mouth.
    pub fits: bool,
}

/// A bot's view of the basket.
struct Basket {
    /// Unit vector through the mouth into the basket.
    axis: Vec3,
    /// Centre of the mouth [m].
    mouth: Vec3,
    /// Half width of the basket on each used axis across the mouth [m]; infinite on other axes.
    half: Vec3,
    /// Half width of the opening between the bars of the mouth [m], on the same axes as `half`.
    opening: Vec3,
}

impl Sight {
    /// Returns a bot's view of a round, without the first `skips` pieces by importance. A piece as wide as
    /// the mouth is pushed straight in if its centre is at most `off` [m] from the mouth's axis.
    pub(super) fn of<D: Dim>(round: &Round<D>, skips: usize, off: f32) -> Option<Self> {
        let (world, arena) = (round.world(), round.level().arena());
        let region = &round.baskets().first()?.region;
        let obstacles = &obstacles_of(round)[..];
        let basket = Basket::of(region, obstacles)?;
        let hand = round.hands().next()?;
        let radius = hand.shape().inradius();
        let mut map = room_for(arena, obstacles, radius);

        let mass = round.progress().mass;
        let counted = round.counted_bodies();
        let mut views: Vec<PieceView> = counted.flat_map(|body| body.piece_views()).collect();
        views.sort_by(|a, b| b.mass.total_cmp(&a.mass));
        let largest = views.first()?;
        let is_out = |view: &&PieceView| view.mass > CRUMB * mass && !basket.holds(view);
        let ways = LazyCell::new(|| map.ways_to(basket.front()));
        let ahead = |from: Vec3| ways.next(from);
        let mut pieces: Vec<Piece> = (views.iter().filter(is_out).take(MOST))
            .map(|view| Piece::of::<D>(view, &basket, &ahead, off, radius))
            .collect();
        if pieces.is_empty() {
            pieces.push(Piece::of::<D>(largest, &basket, &ahead, off, radius));
        }
        // Moves pieces without space for a hand behind them to the end. The sort is stable, so all other
        // pieces stay sorted by mass.
        pieces.sort_by_key(|piece| clearance(piece.behind, obstacles) < 0.5 * radius);
        let piece = pieces[skips % pieces.len()];

        for (_, body) in world.soft_bodies() {
            for (id, _) in body.mesh().nodes() {
                let (at, _, share) = body.node_state(id);
                map.add(at.to_vec3(), SOFT * share / mass);
            }
        }
        let within = round.progress().within;
        let out = basket.mouth - basket.axis * 4.0;
        Some(Self {
            axis: basket.axis,
            across: across::<D>(basket.axis),
            piece,
            kept: round.progress().kept,
            pieces: views.len(),
            within,
            surplus: within - round.level().game().share,
            hand: hand.position().to_vec3(),
            goal: hand.target_position().to_vec3(),
            away: clamped(out, arena, radius),
            map,
        })
    }
}

impl Piece {
    /// Returns a bot's view of a piece. `ahead` returns the next position on the path from a position to the
    /// front of the basket. `off` is the argument of [`Sight::of`], and `hand` is the radius of the hand [m].
    fn of<D: Dim>(
        view: &PieceView,
        basket: &Basket,
        ahead: impl Fn(Vec3) -> Vec3,
        off: f32,
        hand: f32,
    ) -> Self {
        let centre = view.centre;
        let half = (view.high - view.low) * 0.5;
        let (along, aside) = split(centre - basket.mouth, basket.axis);
        let spare = basket.spare(half);
        // In 3D, the mouth has two axes. A piece that is narrow enough on one of them is moved along the
        // other one only, so that a piece on a floor is not lifted.
        let fits =
            |axis: usize| D::N == 3 && spare[axis].is_finite() && aside[axis].abs() < spare[axis];
        let off_mouth = [0, 1, 2].map(|axis| if fits(axis) { 0.0 } else { aside[axis] });
        let off_mouth = Vec3::from(off_mouth).length();
        // Pushes the piece straight in, or first to a position in front of the mouth if it is too far from
        // the axis.
        let target = match off_mouth > spare.min_element().max(off) {
            true => ahead(centre),
            false => basket.mouth + basket.axis * (along + 0.6),
        };
        let target = [0, 1, 2].map(|axis| {
            if fits(axis) {
                centre[axis]
            } else {
                target[axis]
            }
        });
        let way = unit(Vec3::from(target) - centre);
        let reach = (way * half).length() + hand;
        Self {
            centre,
            direction: way,
            reach,
            behind: centre - way * (1.1 * reach),
            far: (centre - basket.mouth).length(),
            fits: half.cmplt(basket.opening).all(),
        }
    }
}

impl Basket {
    fn of<D: Dim>(region: &Shape<D>, obstacles: &[Shape<D>]) -> Option<Self> {
        let Shape::Box { centre, half } = *region else {
            return None;
        };
        let (centre, half) = (centre.to_vec3(), half.to_vec3());
        let axis = inwards(centre, half, obstacles);
        let mouth = centre - axis * half.dot(axis).abs();
        let is_across = |k: usize| k < D::N && axis[k] == 0.0;
        let half = [0, 1, 2].map(|k| if is_across(k) { half[k] } else { f32::INFINITY });
        let opening = [0, 1, 2].map(|k| match half[k].is_finite() {
            true => half[k].min(opening(mouth, axis, k, obstacles)),
            false => half[k],
        });
        Some(Self {
            axis,
            mouth,
            half: half.into(),
            opening: opening.into(),
        })
    }

    /// Returns by how much the basket's half width exceeds `half` on each axis [m]; negative where the basket
    /// is narrower.
    fn spare(&self, half: Vec3) -> Vec3 {
        self.half - half
    }

    /// Returns a position in front of the mouth [m].
    fn front(&self) -> Vec3 {
        self.mouth - self.axis * 0.5
    }

    /// Returns whether the whole piece is in the basket.
    fn holds(&self, piece: &PieceView) -> bool {
        let half = (piece.high - piece.low) * 0.5;
        let middle = (piece.high + piece.low) * 0.5;
        let (along, aside) = split(middle - self.mouth, self.axis);
        along > half.dot(self.axis).abs() && self.spare(aside.abs()).min_element() > 0.0
    }
}

/// Returns the direction into a basket. It is opposite to the direction with the longest line of sight from
/// the basket's centre.
fn inwards<D: Dim>(centre: Vec3, half: Vec3, obstacles: &[Shape<D>]) -> Vec3 {
    const WAYS: [Vec3; 6] = [
        Vec3::X,
        Vec3::NEG_Y,
        Vec3::NEG_X,
        Vec3::Y,
        Vec3::Z,
        Vec3::NEG_Z,
    ];
    let sees = |way: &Vec3| {
        let place = |step: usize| centre - *way * (0.05 * step as f32);
        let free = (0..100).take_while(|&step| clearance(place(step), obstacles) > 0.0);
        free.count() as f32 * 0.05 - half.dot(*way).abs()
    };
    let ways = WAYS.into_iter().take(2 * D::N);
    ways.max_by(|a, b| sees(a).total_cmp(&sees(b)))
        .expect("there are at least four directions")
}

/// Returns the half width of the mouth's opening on the axis `across` [m]. It is the shortest distance to an
/// obstacle along that axis from points near the mouth's centre.
fn opening<D: Dim>(mouth: Vec3, axis: Vec3, across: usize, obstacles: &[Shape<D>]) -> f32 {
    let sees = |from: Vec3, way: Vec3| {
        let mut far = 0.0;
        for _ in 0..20 {
            far += clearance(from + way * far, obstacles).max(0.0);
        }
        far
    };
    let mut least = f32::INFINITY;
    for step in -4..=4 {
        let from = mouth + axis * (0.05 * step as f32);
        for side in [-1.0, 1.0] {
            least = least.min(sees(from, Vec3::AXES[across] * side));
        }
    }
    least
}

/// Returns a direction perpendicular to the coordinate direction `axis`: along the last used axis (y in 2D, z
/// in 3D) if `axis` is along x, otherwise along x.
fn across<D: Dim>(axis: Vec3) -> Vec3 {
    let mut across = Vec3::new(-axis.y - axis.z, 0.0, 0.0);
    across[D::N - 1] = axis.x;
    across
}

/// Returns the shapes of the fixed rigid bodies.
pub(super) fn obstacles_of<D: Dim>(round: &Round<D>) -> Vec<Shape<D>> {
    let fixed = round.world().rigid_bodies().map(|(_, body)| body);
    let fixed = fixed.filter(|body| body.motion_type() == MotionType::Fixed);
    fixed.map(|body| body.shape()).collect()
}

/// Returns a map of a room with obstacles for a hand of a radius [m].
pub(super) fn room_for<D: Dim>(arena: [Vec3; 2], obstacles: &[Shape<D>], radius: f32) -> Map {
    Map::new::<D>(arena, |at| match clearance(at, obstacles) < 0.9 * radius {
        true => RIGID,
        false => 1.0,
    })
}

/// Returns the distance from a position to the nearest obstacle [m]; negative inside an obstacle.
fn clearance<D: Dim>(at: Vec3, obstacles: &[Shape<D>]) -> f32 {
    let at = D::Vector::from_vec3(at);
    let distances = obstacles.iter().map(|shape| shape.distance(at).0);
    distances.fold(f32::INFINITY, f32::min)
}

/// Returns the position nearest to `place` that is in the room and at least `margin` [m] from its walls.
pub(super) fn clamped(place: Vec3, [low, high]: [Vec3; 2], margin: f32) -> Vec3 {
    let margin = Vec3::splat(margin).min((high - low) * 0.5);
    place.clamp(low + margin, high - margin)
}

/// Returns the component of a vector along the unit vector `axis`, and the remaining vector.
pub(super) fn split(v: Vec3, axis: Vec3) -> (f32, Vec3) {
    let along = v.dot(axis);
    (along, v - axis * along)
}

/// Returns the vector normalized to length 1.
pub(super) fn unit(v: Vec3) -> Vec3 {
    v * (1.0 / v.length().max(1e-6))
}

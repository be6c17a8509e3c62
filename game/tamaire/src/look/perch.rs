//! Position of a face on the skin of a 3D body.
//!
//! The face sticks to the skin and rolls with it. It shrinks and reappears at a better place if too much of
//! the skin below it is torn or if it is turned away from the camera.

use fuwafuwa::IndexVec;
use fuwafuwa::inspect::vector::{cross, dot, length, minus, plus, scaled};
use fuwafuwa::{Dim, PieceId, Point, SoftBody, Vector};
use fuwafuwa_render::anchor_at;
use std::f32::consts::PI;

/// Axes to the right, up, and towards the camera.
pub(super) const UPRIGHT: [Vector; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Size of a face in radii of a ball with the volume of its piece. [`FITS`] lists smaller sizes for small
/// areas of skin, as factors.
const LARGE: f32 = 0.55;
const FITS: [f32; 4] = [1.0, 0.8, 0.6, 0.45];
/// Radius of a face along the skin, and tolerated depth of the skin below it; both in units of its size.
const WIDE: f32 = 0.9;
const DEEP: f32 = 0.6;
/// Share of original skin below a face: required for a new place, and below which the face leaves its place.
const COVERED: [f32; 2] = [0.82, 0.68];
/// Mass ratio at which a face leaves its piece for a heavier one. Candidates are the first [`PIECES`] pieces
/// that are not lighter than the heaviest by more than this ratio.
const HEAVIER: f32 = 1.6;
const PIECES: usize = 4;
/// Advantage in score that another place must have, and interval of the search [s].
const BETTER: f32 = 0.1;
const AGAIN: f32 = 0.5;
/// Number of places that are scored; once more as many near the best one.
const PLACES: usize = 120;
/// Upward tilt of the ideal direction of a face, relative to the direction to the camera: bars stand low.
const ABOVE: f32 = 0.4;
/// Cosine below which a face counts as turned away from the camera or tilted, and the time until it moves to
/// a visible place [s]. It does not move while its body turns faster than [`FAST`] [rad/s]. Tilt counts only
/// if the body turns slower than [`CALM`] [rad/s].
const LOST: f32 = 0.6;
const PATIENCE: f32 = 0.12;
const FAST: f32 = 3.0;
const CALM: f32 = 0.8;
/// Prediction time for a rolling body [s]: the best place is the one that faces the camera after it.
/// [`NEAR_AXIS`] weights places near the axis of rotation, which stay visible for longer.
const AHEAD: f32 = 0.4;
const NEAR_AXIS: f32 = 0.4;
/// Durations of shrinking and of reappearing [s].
const SHRINK: f32 = 0.08;
const RISE: f32 = 0.14;
/// Depth of the face's centre inside the body, in units of its size; it is below all skin that the face
/// covers.
const INSIDE: f32 = 0.8;
/// Minimum radius of the surroundings that determine the rotation of the face [voxels].
const LEAST_REACH: f32 = 3.0;

/// Position of a face on the skin of a 3D body.
#[derive(Clone, Debug, Default)]
pub struct FaceAnchor {
    /// Centre, inside the body [m].
    pub at: Vector,
    /// Unit axes: to the right, up, and outwards.
    pub axes: [Vector; 3],
    /// Size [m]; 0 if there is no skin left for it.
    pub size: f32,
    /// Piece that carries the face.
    pub piece: PieceId,
    /// Approximate centre of the piece [m].
    pub middle: Vector,
    place: Option<SkinPlace>,
    next: Option<SkinPlace>,
    /// Full size of a face on the piece [m].
    full: f32,
    /// Progress of reappearing, 0 to 1.
    up: f32,
    /// Angular velocity [rad/s]. `lost` is the time since the face has been turned away [s].
    spin: Vector,
    turned_away_seconds: f32,
    /// Time until the next search for another place [s].
    wait: f32,
}

/// Place on the original skin, in the rest shape of the body.
#[derive(Copy, Clone, Debug)]
struct SkinPlace {
    /// Voxel with a face at this place. A voxel belongs to a piece at all times.
    voxel: Point,
    /// Centre of the voxel's face [voxels].
    rest: Vector,
    /// Axes of the face in the frame of its surroundings.
    worn: [Vector; 3],
    /// Size factor, one of `FITS`.
    fit: f32,
}

/// Face of a voxel on the original skin.
struct SkinFace {
    voxel: Point,
    rest: Vector,
    at: Vector,
    normal: Vector,
}

/// Original skin of a piece, where a face can stick, and the camera that sees it.
struct PieceSkin {
    spots: Vec<SkinFace>,
    piece: PieceId,
    middle: Vector,
    /// Full size of a face on the piece [m].
    full: f32,
    voxel: f32,
    eye: Option<Vector>,
    /// Angular velocity of the skin [rad/s].
    spin: Vector,
}

impl FaceAnchor {
    /// Chooses the place that the camera at `eye` sees best.
    pub fn new<D: Dim>(body: &SoftBody<D>, eye: Option<Vector>) -> Self {
        let mut perch = Self {
            axes: UPRIGHT,
            up: 1.0,
            ..Self::default()
        };
        perch.check_place(body, eye);
        perch.update_position(body);
        perch
    }

    /// Advances by `seconds`. Searches another place only if `looks` is set, because the search takes time.
    pub fn follow<D: Dim>(
        &mut self,
        body: &SoftBody<D>,
        eye: Option<Vector>,
        looks: bool,
        seconds: f32,
    ) {
        self.wait -= seconds;
        if looks {
            self.check_place(body, eye);
        }
        if self.next.is_some() {
            self.up -= seconds / SHRINK;
            if self.up <= 0.0 {
                (self.place, self.next, self.up) = (self.next, None, 0.0);
                self.turned_away_seconds = 0.0;
                self.check_place(body, eye);
                self.update_position(body);
            }
        } else {
            self.up = (self.up + seconds / RISE).min(1.0);
        }
        let before = self.axes;
        self.update_position(body);
        let turned = [0, 1, 2].map(|k| cross(before[k], self.axes[k]));
        let spin = scaled(turned.into_iter().fold([0.0; 3], plus), 0.5 / seconds);
        self.spin = plus(self.spin, scaled(minus(spin, self.spin), 0.2));
        let [facing, upright] = eye.map_or([1.0; 2], |eye| seen(self.at, self.axes, eye));
        let spin = length(self.spin);
        let is_lost = facing < LOST || upright < LOST && spin < CALM;
        self.turned_away_seconds = match is_lost && spin < FAST {
            true => self.turned_away_seconds + seconds,
            false => 0.0,
        };
    }

    /// Moves the face with the skin.
    fn update_position<D: Dim>(&mut self, body: &SoftBody<D>) {
        let voxel = body.grid().voxel_size();
        let found = self.place.and_then(|place| {
            let piece = body.pieces().of_element(body.mesh().owner(place.voxel)?);
            let reach = (place.fit * self.full / voxel).max(LEAST_REACH);
            let (at, turn) = anchor_at(body, piece, place.rest, reach)?;
            Some((place, piece, at, turn))
        });
        let Some((place, piece, at, turn)) = found else {
            self.size = 0.0;
            return;
        };
        self.axes = place
            .worn
            .map(|axis| (0..3).fold([0.0; 3], |sum, k| plus(sum, scaled(turn[k], axis[k]))));
        self.piece = piece;
        let size = place.fit * self.full;
        self.at = minus(at, scaled(self.axes[2], INSIDE * size));
        // Overshoots while it reappears.
        self.size = size * self.up * (1.0 + 0.6 * self.up * (1.0 - self.up));
    }

    /// Checks the current place, and searches another one if it has become bad.
    fn check_place<D: Dim>(&mut self, body: &SoftBody<D>, eye: Option<Vector>) {
        let masses = masses(body);
        let largest = largest(&masses);
        let own = self.place.and_then(|place| body.mesh().owner(place.voxel));
        let own = own.map(|element| body.pieces().of_element(element));
        let spin = self.spin;
        let on = |piece: PieceId| PieceSkin {
            spin,
            ..PieceSkin::of(body, piece, &masses, eye)
        };
        let mut is_small = true;
        let mut score = 0.0;
        if let (Some(own), Some(place)) = (own, self.place) {
            let skin = on(own);
            is_small = HEAVIER * masses[own] < masses[largest];
            let inside = INSIDE * place.fit * self.full;
            let at = plus(self.at, scaled(self.axes[2], inside));
            let size = place.fit * skin.full;
            (self.full, self.middle) = (skin.full, skin.middle);
            let covered = skin.cover(at, self.axes[2], size);
            if !is_small && covered > COVERED[1] && self.turned_away_seconds < PATIENCE {
                return;
            }
            score = skin.score(at, self.axes[2], place.fit, covered) + BETTER;
        }
        if self.next.is_some() || self.wait > 0.0 {
            return;
        }
        self.wait = AGAIN;
        let is_heavy = |&piece: &PieceId| HEAVIER * masses[piece] >= masses[largest];
        let heavy = masses.ids().filter(is_heavy);
        let places = heavy.take(PIECES).filter_map(|piece| {
            let skin = on(piece);
            let (spot, score, fit, out) = skin.best()?;
            let place = skin.place(body, spot, out, fit)?;
            Some((score, place, skin.full, skin.middle))
        });
        let best = places.max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, place, full, middle)) = best.filter(|best| is_small || best.0 > score) else {
            return;
        };
        match self.place {
            Some(_) => self.next = Some(place),
            None => {
                (self.place, self.full, self.middle) = (Some(place), full, middle);
            }
        }
    }
}

impl PieceSkin {
    fn of<D: Dim>(
        body: &SoftBody<D>,
        piece: PieceId,
        masses: &IndexVec<PieceId, f32>,
        eye: Option<Vector>,
    ) -> Self {
        let facets = body
            .facets()
            .filter(|facet| facet.piece == piece && !facet.is_torn);
        let spots = facets.filter_map(|facet| {
            let mean = |of: [Vector; 4]| scaled(of.into_iter().fold([0.0; 3], plus), 0.25);
            let rest = facet
                .nodes
                .map(|id| body.mesh().node(id).at.map(|k| k as f32));
            Some(SkinFace {
                voxel: body.mesh().element(facet.element)?.cell.at,
                rest: mean(rest),
                at: mean(facet.corners),
                normal: facet.normal,
            })
        });
        let own = masses[piece];
        let share = own / masses.iter().sum::<f32>();
        let (voxel, voxels) = (
            body.grid().voxel_size(),
            body.grid().left_count() as f32 * share,
        );
        let nodes = body.mesh().nodes();
        let nodes = nodes.filter(|&(id, _)| body.pieces().of_node(id) == piece);
        let middle = nodes.fold([0.0; 3], |sum, (id, _)| {
            let (at, _, mass) = body.node_state(id);
            plus(sum, scaled(at, mass / own))
        });
        Self {
            spots: spots.collect(),
            piece,
            middle,
            full: LARGE * voxel * (0.75 * voxels / PI).cbrt(),
            voxel,
            eye,
            spin: [0.0; 3],
        }
    }

    /// Ideal direction of a face at `at`, with the rotation of the body predicted; unit length.
    fn ideal_direction(&self, at: Vector) -> Vector {
        let wish = self.eye.map_or(UPRIGHT[2], |eye| ideal_direction(at, eye));
        let early = minus(wish, scaled(cross(self.spin, wish), AHEAD));
        let along = dot(self.spin, wish) / length(self.spin).max(1e-9);
        let early = plus(early, scaled(self.spin, NEAR_AXIS * along));
        scaled(early, 1.0 / length(early))
    }

    /// Share of a face of this size that lies on original skin, 0 to 1.
    fn cover(&self, at: Vector, out: Vector, size: f32) -> f32 {
        let radius = WIDE * size;
        let mut area = 0.0;
        for spot in &self.spots {
            let by = minus(spot.at, at);
            let (depth, facing) = (dot(by, out), dot(spot.normal, out));
            if facing > 0.0
                && depth.abs() < DEEP * size
                && dot(by, by) - depth * depth < radius * radius
            {
                area += facing * self.voxel * self.voxel;
            }
        }
        (area / (PI * radius * radius)).min(1.0)
    }

    /// Score of a place: large, covered, turned to the camera, and in the middle of the visible side.
    fn score(&self, at: Vector, out: Vector, fit: f32, covered: f32) -> f32 {
        let wish = self.ideal_direction(self.middle);
        let by = minus(at, self.middle);
        let aside = length(minus(by, scaled(wish, dot(by, wish))));
        fit * covered + 0.5 * dot(out, wish) - 0.2 * LARGE * aside / self.full.max(1e-9)
    }

    /// Returns the best place: its spot, score, size factor, and outward direction.
    fn best(&self) -> Option<(&SkinFace, f32, f32, Vector)> {
        let wish = self.ideal_direction(self.middle);
        let turned = self.spots.iter();
        let turned: Vec<&SkinFace> = turned.filter(|spot| dot(spot.normal, wish) > 0.0).collect();
        let first = self.best_of(&turned)?;
        let near = |spot: &&&SkinFace| length(minus(spot.at, first.0.at)) < 0.5 * self.full;
        let near: Vec<&SkinFace> = turned.iter().filter(near).copied().collect();
        self.best_of(&near)
            .filter(|second| second.1 > first.1)
            .or(Some(first))
    }

    fn best_of<'a>(&self, spots: &[&'a SkinFace]) -> Option<(&'a SkinFace, f32, f32, Vector)> {
        let judged = spots.iter().step_by(1 + spots.len() / PLACES).map(|spot| {
            // Single voxel faces point along the axes; the average over the surroundings gives the direction
            // of the skin.
            let near = self.spots.iter().filter(|other| {
                let by = minus(other.at, spot.at);
                dot(by, by) < (0.6 * self.full).powi(2) && dot(other.normal, spot.normal) > -0.5
            });
            let out = near.fold([0.0; 3], |sum, other| plus(sum, other.normal));
            let out = scaled(out, 1.0 / length(out).max(1e-9));
            let (mut fit, mut covered) = (0.0, 0.0);
            for smaller in FITS {
                (fit, covered) = (smaller, self.cover(spot.at, out, smaller * self.full));
                if covered > COVERED[0] {
                    break;
                }
            }
            (*spot, self.score(spot.at, out, fit, covered), fit, out)
        });
        judged.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Returns where to put a face at `spot`, upright as seen from the camera; `None` if the body there is too
    /// small to define a rotation.
    fn place<D: Dim>(
        &self,
        body: &SoftBody<D>,
        spot: &SkinFace,
        out: Vector,
        fit: f32,
    ) -> Option<SkinPlace> {
        let reach = (fit * self.full / self.voxel).max(LEAST_REACH);
        let (_, turn) = anchor_at(body, self.piece, spot.rest, reach)?;
        let axes = upright(out, self.eye.map_or(UPRIGHT[2], |eye| minus(eye, spot.at)));
        Some(SkinPlace {
            voxel: spot.voxel,
            rest: spot.rest,
            worn: axes.map(|axis| turn.map(|own| dot(own, axis))),
            fit,
        })
    }
}

/// Ideal direction of a face at `at`, as a unit vector: towards the camera, tilted upwards.
fn ideal_direction(at: Vector, eye: Vector) -> Vector {
    let by = minus(eye, at);
    let high = plus(by, [0.0, ABOVE * length(by), 0.0]);
    scaled(high, 1.0 / length(high).max(1e-9))
}

/// Axes of a face with outward direction `out` that is upright for a camera in the direction `towards`.
fn upright(out: Vector, towards: Vector) -> [Vector; 3] {
    // On top of a body, up points away from the camera.
    let back = scaled(towards, 0.1 / length(towards).max(1e-9));
    square([[0.0; 3], minus(UPRIGHT[1], back), out])
}

/// Cosines of the angles to the ideal direction and to the upright orientation.
fn seen(at: Vector, axes: [Vector; 3], eye: Vector) -> [f32; 2] {
    let up = upright(axes[2], minus(eye, at))[1];
    [dot(axes[2], ideal_direction(at, eye)), dot(axes[1], up)]
}

/// Orthonormal axes: the third keeps its direction, the second is kept as far as possible, the first follows.
pub(super) fn square([_, up, out]: [Vector; 3]) -> [Vector; 3] {
    let unit = |of: Vector| scaled(of, 1.0 / length(of).max(1e-9));
    let out = unit(out);
    let right = unit(cross(up, out));
    [right, cross(out, right), out]
}

/// Returns the piece with the largest mass; of equal ones the first.
pub(super) fn largest(masses: &IndexVec<PieceId, f32>) -> PieceId {
    let heavier = |best, piece| match masses[piece] > masses[best] {
        true => piece,
        false => best,
    };
    masses.ids().fold(PieceId(0), heavier)
}

/// Returns the mass of each piece [kg].
pub(super) fn masses<D: Dim>(body: &SoftBody<D>) -> IndexVec<PieceId, f32> {
    let mut masses = IndexVec::from(vec![0.0f32; body.pieces().list.len()]);
    for (id, _) in body.mesh().nodes() {
        masses[body.pieces().of_node(id)] += body.node_state(id).2;
    }
    masses
}

#[cfg(test)]
mod tests;

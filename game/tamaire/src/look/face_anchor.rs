//! Position of a face on the skin of a 3D body.
//!
//! The face sticks to the skin and rolls with it. It shrinks and reappears at a better place if too much of
//! the skin below it is torn or if it is turned away from the camera.

use fuwafuwa::{Dim, DimVector, IndexVec, PieceId, Point, SoftBody, Vec3};
use fuwafuwa_render::anchor_at;
use std::f32::consts::PI;

/// Axes of an upright face: to the right, up, and towards a camera in front.
pub(super) const UPRIGHT: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];

/// Full size of a face, in radii of a ball with the volume of its piece.
const LARGE: f32 = 0.55;
/// Factors on the size, tried in this order until the face fits on the skin.
const FITS: [f32; 4] = [1.0, 0.8, 0.6, 0.45];
/// Radius of the skin that a face covers, in units of the face's size.
const WIDE: f32 = 0.9;
/// Maximum height of the skin above or below the middle of the face, in units of the face's size. Skin beyond
/// it does not count as covered.
const DEEP: f32 = 0.6;
/// Shares of original skin below a face. At a new place the face gets smaller until the first is reached;
/// below the second it leaves its place.
const COVERED: [f32; 2] = [0.82, 0.68];
/// Mass ratio at which a face leaves its piece for a heavier one.
const HEAVIER: f32 = 1.6;
/// Maximum number of pieces searched for a place; all of them are heavy according to [`HEAVIER`].
const PIECES: usize = 4;
/// Advantage in score that another place must have.
const BETTER: f32 = 0.1;
/// Minimum interval between two searches for a place [s].
const AGAIN: f32 = 0.5;
/// Maximum number of places that are scored. A second pass scores as many near the best of them.
const PLACES: usize = 120;
/// Upward tilt of the ideal direction of a face, relative to the direction to the camera. The bars of a
/// basket are low and would hide a face that looks down.
const ABOVE: f32 = 0.4;
/// Cosine below which a face counts as turned away from the camera, or as tilted.
const LOST: f32 = 0.6;
/// Time that a face stays turned away or tilted before it moves to another place [s].
const PATIENCE: f32 = 0.12;
/// Angular speed above which a face that is turned away stays, because it may soon be visible again [rad/s].
const FAST: f32 = 3.0;
/// Angular speed below which a tilted face moves to another place [rad/s].
const CALM: f32 = 0.8;
/// Time by which the rotation of a body is predicted [s]: a face moves to the place that will face the camera
/// then.
const AHEAD: f32 = 0.4;
/// Weight of the axis of rotation in the ideal direction: places near the axis stay visible for longer.
const NEAR_AXIS: f32 = 0.4;
/// Duration of shrinking before a face moves [s].
const SHRINK: f32 = 0.08;
/// Duration of reappearing at the new place [s].
const RISE: f32 = 0.14;
/// Depth of the face's centre inside the body, in units of the face's size. The centre is below all skin that
/// the face covers.
const INSIDE: f32 = 0.8;
/// Minimum radius of the part of the body whose rotation turns the face [voxels].
const LEAST_REACH: f32 = 3.0;

/// Position of a face on the skin of a 3D body.
#[derive(Clone, Debug, Default)]
pub struct FaceAnchor {
    /// Centre, inside the body [m].
    pub at: Vec3,
    /// Unit axes: to the right, up, and outwards.
    pub axes: [Vec3; 3],
    /// Size [m]; 0 if there is no skin left for it.
    pub size: f32,
    /// Piece that carries the face.
    pub piece: PieceId,
    /// Approximate centre of the piece [m].
    pub middle: Vec3,
    place: Option<SkinPlace>,
    next: Option<SkinPlace>,
    /// Full size of a face on the piece [m].
    full: f32,
    /// Progress of reappearing, 0 to 1.
    up: f32,
    /// Angular velocity of the face, smoothed [rad/s].
    spin: Vec3,
    /// Time since the face turned away from the camera or tilted [s].
    turned_away_seconds: f32,
    /// Time until the next search for another place [s].
    wait: f32,
}

/// Place on the original skin, in the rest shape of the body.
#[derive(Copy, Clone, Debug)]
struct SkinPlace {
    /// Voxel below this place. Its element tells which piece the place belongs to after tears.
    voxel: Point,
    /// Rest position of the centre of the voxel's side [voxels].
    rest: Vec3,
    /// Axes of the face, relative to the rotation of the body around the place.
    worn: [Vec3; 3],
    /// Size factor, one of [`FITS`].
    fit: f32,
}

/// Side of a voxel that is part of the original skin.
struct SkinFace {
    voxel: Point,
    rest: Vec3,
    at: Vec3,
    normal: Vec3,
}

/// Original skin of a piece as a camera sees it; a face sticks to one place of it.
struct PieceSkin {
    spots: Vec<SkinFace>,
    piece: PieceId,
    middle: Vec3,
    /// Full size of a face on the piece [m].
    full: f32,
    voxel: f32,
    eye: Option<Vec3>,
    /// Angular velocity of the skin [rad/s].
    spin: Vec3,
}

impl FaceAnchor {
    /// Chooses the place that the camera at `eye` sees best.
    pub fn new<D: Dim>(body: &SoftBody<D>, eye: Option<Vec3>) -> Self {
        let mut anchor = Self {
            axes: UPRIGHT,
            up: 1.0,
            ..Self::default()
        };
        anchor.check_place(body, eye);
        anchor.update_position(body);
        anchor
    }

    /// Advances by `seconds`. Searches for another place only if `looks` is set, because the search takes
    /// time.
    pub fn follow<D: Dim>(
        &mut self,
        body: &SoftBody<D>,
        eye: Option<Vec3>,
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
        let turned = [0, 1, 2].map(|k| before[k].cross(self.axes[k]));
        let spin = turned.into_iter().sum::<Vec3>() * (0.5 / seconds);
        self.spin += (spin - self.spin) * 0.2;
        let [facing, upright] = eye.map_or([1.0; 2], |eye| seen(self.at, self.axes, eye));
        let spin = self.spin.length();
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
            .map(|axis| (0..3).map(|k| turn[k] * axis[k]).sum());
        self.piece = piece;
        let size = place.fit * self.full;
        self.at = at - self.axes[2] * (INSIDE * size);
        // The size overshoots while the face reappears.
        self.size = size * self.up * (1.0 + 0.6 * self.up * (1.0 - self.up));
    }

    /// Keeps the current place if it is good; otherwise searches for a better one.
    fn check_place<D: Dim>(&mut self, body: &SoftBody<D>, eye: Option<Vec3>) {
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
            let at = self.at + self.axes[2] * inside;
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
        eye: Option<Vec3>,
    ) -> Self {
        let facets = body
            .facets()
            .filter(|facet| facet.piece == piece && !facet.is_torn);
        let spots = facets.filter_map(|facet| {
            let mean = |of: [Vec3; 4]| of.into_iter().sum::<Vec3>() * 0.25;
            let rest = facet
                .nodes
                .map(|id| Vec3::from(body.mesh().node(id).at.map(|k| k as f32)));
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
        let weighted = nodes.map(|(id, _)| {
            let (at, _, mass) = body.node_state(id);
            at.to_vec3() * (mass / own)
        });
        Self {
            spots: spots.collect(),
            piece,
            middle: weighted.sum(),
            full: LARGE * voxel * (0.75 * voxels / PI).cbrt(),
            voxel,
            eye,
            spin: Vec3::ZERO,
        }
    }

    /// Ideal outward direction of a face at `at`, as a unit vector. Takes the predicted rotation of the body
    /// into account.
    fn ideal_direction(&self, at: Vec3) -> Vec3 {
        let wish = self.eye.map_or(UPRIGHT[2], |eye| ideal_direction(at, eye));
        let early = wish - self.spin.cross(wish) * AHEAD;
        let along = self.spin.dot(wish) / self.spin.length().max(1e-9);
        let early = early + self.spin * (NEAR_AXIS * along);
        early * (1.0 / early.length())
    }

    /// Share of a face of this size that lies on original skin, 0 to 1.
    fn cover(&self, at: Vec3, out: Vec3, size: f32) -> f32 {
        let radius = WIDE * size;
        let mut area = 0.0;
        for spot in &self.spots {
            let by = spot.at - at;
            let (depth, facing) = (by.dot(out), spot.normal.dot(out));
            if facing > 0.0
                && depth.abs() < DEEP * size
                && by.dot(by) - depth * depth < radius * radius
            {
                area += facing * self.voxel * self.voxel;
            }
        }
        (area / (PI * radius * radius)).min(1.0)
    }

    /// Score of a place. It is high if the face is large, on original skin, turned to the camera, and in the
    /// middle of the visible side.
    fn score(&self, at: Vec3, out: Vec3, fit: f32, covered: f32) -> f32 {
        let wish = self.ideal_direction(self.middle);
        let by = at - self.middle;
        let aside = (by - wish * by.dot(wish)).length();
        fit * covered + 0.5 * out.dot(wish) - 0.2 * LARGE * aside / self.full.max(1e-9)
    }

    /// Returns the best place: voxel side, score, size factor, and outward direction.
    fn best(&self) -> Option<(&SkinFace, f32, f32, Vec3)> {
        let wish = self.ideal_direction(self.middle);
        let turned = self.spots.iter();
        let turned: Vec<&SkinFace> = turned.filter(|spot| spot.normal.dot(wish) > 0.0).collect();
        let first = self.best_of(&turned)?;
        let near = |spot: &&&SkinFace| (spot.at - first.0.at).length() < 0.5 * self.full;
        let near: Vec<&SkinFace> = turned.iter().filter(near).copied().collect();
        self.best_of(&near)
            .filter(|second| second.1 > first.1)
            .or(Some(first))
    }

    fn best_of<'a>(&self, spots: &[&'a SkinFace]) -> Option<(&'a SkinFace, f32, f32, Vec3)> {
        let judged = spots.iter().step_by(1 + spots.len() / PLACES).map(|spot| {
            // Single voxel faces point along the axes; the average over the surroundings gives the direction
            // of the skin.
            let near = self.spots.iter().filter(|other| {
                let by = other.at - spot.at;
                by.dot(by) < (0.6 * self.full).powi(2) && other.normal.dot(spot.normal) > -0.5
            });
            let out: Vec3 = near.map(|other| other.normal).sum();
            let out = out * (1.0 / out.length().max(1e-9));
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
        out: Vec3,
        fit: f32,
    ) -> Option<SkinPlace> {
        let reach = (fit * self.full / self.voxel).max(LEAST_REACH);
        let (_, turn) = anchor_at(body, self.piece, spot.rest, reach)?;
        let axes = upright(out, self.eye.map_or(UPRIGHT[2], |eye| eye - spot.at));
        Some(SkinPlace {
            voxel: spot.voxel,
            rest: spot.rest,
            worn: axes.map(|axis| turn.map(|own| own.dot(axis)).into()),
            fit,
        })
    }
}

/// Ideal outward direction of a face at `at`, as a unit vector: towards the camera, tilted upwards.
fn ideal_direction(at: Vec3, eye: Vec3) -> Vec3 {
    let by = eye - at;
    let high = by + Vec3::Y * (ABOVE * by.length());
    high * (1.0 / high.length().max(1e-9))
}

/// Axes of a face with outward direction `out` that is upright for a camera in the direction `towards`.
fn upright(out: Vec3, towards: Vec3) -> [Vec3; 3] {
    // At the top of a body, the upper edge of a face points away from the camera.
    let back = towards * (0.1 / towards.length().max(1e-9));
    square([Vec3::ZERO, UPRIGHT[1] - back, out])
}

/// Cosines of the face's angles to the ideal direction and to the upright orientation.
fn seen(at: Vec3, axes: [Vec3; 3], eye: Vec3) -> [f32; 2] {
    let up = upright(axes[2], eye - at)[1];
    [axes[2].dot(ideal_direction(at, eye)), axes[1].dot(up)]
}

/// Orthonormal axes: the third keeps its direction, the second is kept as far as possible, the first follows.
pub(super) fn square([_, up, out]: [Vec3; 3]) -> [Vec3; 3] {
    let unit = |of: Vec3| of * (1.0 / of.length().max(1e-9));
    let out = unit(out);
    let right = unit(up.cross(out));
    [right, out.cross(right), out]
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

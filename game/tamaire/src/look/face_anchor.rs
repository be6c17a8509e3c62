//! Position of the drawn face (eyes and mouth) on the skin of a 3D body.
//!
//! A drawn face sticks to the skin and rolls with the body. If too much of the skin below it is torn, or if
//! it is turned away from the camera, the face shrinks and reappears at a better place.

use fuwafuwa::{Dim, DimVector, IndexVec, PieceId, Point, SoftBody, Vec3};
use fuwafuwa_render::anchor_at;
use std::f32::consts::PI;

/// Axes of an upright drawn face: to the right, up, and towards a camera in front of the body.
pub(super) const UPRIGHT: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];

/// Full size of a drawn face. Unit: radius of a ball with the volume of the piece that carries the face.
const LARGE: f32 = 0.55;
/// Factors on the full size of a drawn face. They are tried in this order until enough of the face lies on
/// original skin.
const FITS: [f32; 4] = [1.0, 0.8, 0.6, 0.45];
/// Radius of the area of skin that a drawn face covers, in units of the face's size.
const WIDE: f32 = 0.9;
/// Maximum height of skin above or below the centre of a drawn face, in units of the face's size. Skin at a
/// greater height does not count as covered by the face.
const DEEP: f32 = 0.6;
/// Limits on the share of a drawn face that lies on original skin. At a new place the face is shrunk until
/// its share exceeds the first limit. A face whose share falls to the second limit moves to another place.
const COVERED: [f32; 2] = [0.82, 0.68];
/// Ratio of the heaviest piece's mass to that of the piece that carries the drawn face. Above this ratio the
/// face moves to a heavy piece.
const HEAVIER: f32 = 1.6;
/// Maximum number of pieces on which a place for the drawn face is searched. All of them are heavy enough
/// according to [`HEAVIER`].
const PIECES: usize = 4;
/// Difference by which the score of another place must exceed that of the current place before the drawn face
/// moves.
const BETTER: f32 = 0.1;
/// Minimum interval between two searches for a better place of the drawn face [s].
const AGAIN: f32 = 0.5;
/// Maximum number of skin places that one pass of the search scores. A second pass scores up to this number
/// near the best place of the first pass.
const PLACES: usize = 120;
/// Upward component that is added to the unit direction from a drawn face to the camera. The sum is the ideal
/// direction of the face. The bars of a basket are low and would hide a face that looks down.
const ABOVE: f32 = 0.4;
/// Cosine below which a drawn face counts as turned away (angle to the ideal direction) or as tilted (angle
/// to the upright orientation).
const LOST: f32 = 0.6;
/// Time for which a drawn face must be turned away or tilted before it moves to another place [s].
const PATIENCE: f32 = 0.12;
/// Angular speed above which a drawn face that is turned away keeps its place, because it may soon be visible
/// again [rad/s].
const FAST: f32 = 3.0;
/// Angular speed below which a drawn face that is only tilted moves to another place [rad/s].
const CALM: f32 = 0.8;
/// Time by which the rotation of a body is predicted when a place for its drawn face is chosen [s]. The
/// chosen place will face the camera after this time.
const AHEAD: f32 = 0.4;
/// Weight of the body's axis of rotation in the ideal direction of its drawn face. Places near the axis stay
/// visible for longer.
const NEAR_AXIS: f32 = 0.4;
/// Time in which a drawn face shrinks before it moves to another place [s].
const SHRINK: f32 = 0.08;
/// Time in which a drawn face grows at its new place [s].
const RISE: f32 = 0.14;
/// Depth of a drawn face's centre inside the body, in units of the face's size. At this depth the centre is
/// below all skin that the face covers.
const INSIDE: f32 = 0.8;
/// Minimum radius of the part of a body whose rotation a drawn face follows [voxels].
const LEAST_REACH: f32 = 3.0;

/// Position of a drawn face on the skin of a 3D body.
#[derive(Clone, Debug, Default)]
pub struct FaceAnchor {
    /// Centre of the drawn face, inside the body [m].
    pub at: Vec3,
    /// Unit axes of the drawn face: to the right, up, and outwards.
    pub axes: [Vec3; 3],
    /// Size of the drawn face [m]; 0 if no skin is left for the face.
    pub size: f32,
    /// Piece that carries the drawn face.
    pub piece: PieceId,
    /// Approximate centre of the piece that carries the drawn face [m].
    pub middle: Vec3,
    place: Option<SkinPlace>,
    next: Option<SkinPlace>,
    /// Full size of a drawn face on the piece that carries it [m].
    full: f32,
    /// Progress of growing at a new place, 0 (invisible) to 1 (complete).
    up: f32,
    /// Angular velocity of the drawn face, smoothed over time [rad/s].
    spin: Vec3,
    /// Time for which the drawn face has been turned away from the camera or tilted [s].
    turned_away_seconds: f32,
    /// Time until the next search for a better place of the drawn face is allowed [s].
    wait: f32,
}

/// Place of a drawn face on the original skin, in the rest shape of the body.
#[derive(Copy, Clone, Debug)]
struct SkinPlace {
    /// Voxel below the place. After a tear, the voxel's element tells to which piece the place belongs.
    voxel: Point,
    /// Rest position of the place, which is the centre of a side of the voxel [voxels].
    rest: Vec3,
    /// Axes of the drawn face, relative to the rotation of the body around the place.
    worn: [Vec3; 3],
    /// Factor on the full size of the drawn face, one of [`FITS`].
    fit: f32,
}

/// Voxel side on the original skin, where a drawn face can be placed.
struct SkinFace {
    voxel: Point,
    rest: Vec3,
    at: Vec3,
    normal: Vec3,
}

/// Original skin of a piece, with the camera for which a place of the drawn face is searched.
struct PieceSkin {
    spots: Vec<SkinFace>,
    piece: PieceId,
    middle: Vec3,
    /// Full size of a drawn face on the piece [m].
    full: f32,
    voxel: f32,
    eye: Option<Vec3>,
    /// Angular velocity of the skin [rad/s].
    spin: Vec3,
}

impl FaceAnchor {
    /// Creates the anchor of a drawn face, at the place that the camera at `eye` [m] sees best.
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

    /// Advances the drawn face by `seconds`. A better place is searched only if `looks` is set, because the
    /// search takes time.
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

    /// Updates position, axes and size of the drawn face from the deformed skin.
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
        // While a drawn face reappears, it is briefly larger than its final size.
        self.size = size * self.up * (1.0 + 0.6 * self.up * (1.0 - self.up));
    }

    /// Searches for a better place, unless the current place of the drawn face is good.
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
            body.grid().remaining_count() as f32 * share,
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

    /// Ideal outward direction of a drawn face at `at` [m], as a unit vector. The direction takes the
    /// predicted rotation of the body into account.
    fn ideal_direction(&self, at: Vec3) -> Vec3 {
        let wish = self.eye.map_or(UPRIGHT[2], |eye| ideal_direction(at, eye));
        let early = wish - self.spin.cross(wish) * AHEAD;
        let along = self.spin.dot(wish) / self.spin.length().max(1e-9);
        let early = early + self.spin * (NEAR_AXIS * along);
        early * (1.0 / early.length())
    }

    /// Share of a drawn face of `size` [m] that lies on original skin, 0 to 1.
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

    /// Score of a place. It is high for a drawn face that is large, on original skin, turned to the camera,
    /// and in the middle of the visible side.
    fn score(&self, at: Vec3, out: Vec3, fit: f32, covered: f32) -> f32 {
        let wish = self.ideal_direction(self.middle);
        let by = at - self.middle;
        let aside = (by - wish * by.dot(wish)).length();
        fit * covered + 0.5 * out.dot(wish) - 0.2 * LARGE * aside / self.full.max(1e-9)
    }

    /// Returns the best place for a drawn face: voxel side, score, size factor, and outward direction.
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
            // The normal of a single voxel side is parallel to an axis. The mean normal of the surroundings
            // gives the direction of the skin.
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

    /// Returns the place of a drawn face at `spot`, upright as seen from the camera. `None` if the body
    /// around `spot` is too small to define a rotation.
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

/// Ideal outward direction of a drawn face at `at` [m], as a unit vector: towards the camera at `eye`, tilted
/// upwards.
fn ideal_direction(at: Vec3, eye: Vec3) -> Vec3 {
    let by = eye - at;
    let high = by + Vec3::Y * (ABOVE * by.length());
    high * (1.0 / high.length().max(1e-9))
}

/// Axes of a drawn face with outward direction `out`, upright as seen by a camera in the direction `towards`.
fn upright(out: Vec3, towards: Vec3) -> [Vec3; 3] {
    // On top of a body, where `out` points up, the upper edge of the face points away from the camera.
    let back = towards * (0.1 / towards.length().max(1e-9));
    square([Vec3::ZERO, UPRIGHT[1] - back, out])
}

/// Cosines of two angles of a drawn face: to the ideal direction, and to the upright orientation.
fn seen(at: Vec3, axes: [Vec3; 3], eye: Vec3) -> [f32; 2] {
    let up = upright(axes[2], eye - at)[1];
    [axes[2].dot(ideal_direction(at, eye)), axes[1].dot(up)]
}

/// Returns orthonormal axes. The third axis keeps its direction, the second is kept as far as possible, and
/// the first is perpendicular to both.
pub(super) fn square([_, up, out]: [Vec3; 3]) -> [Vec3; 3] {
    let unit = |of: Vec3| of * (1.0 / of.length().max(1e-9));
    let out = unit(out);
    let right = unit(up.cross(out));
    [right, out.cross(right), out]
}

/// Returns the piece with the largest mass. Of several such pieces, returns the first.
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

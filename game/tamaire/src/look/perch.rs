//! Where the face of a body in space sticks to its skin.
//!
//! It keeps its place there and rolls with it. Once too much of that place is torn, or who looks sees it from behind, it
//! shrinks and comes up again where there is a better one.

use fuwafuwa::ids::IndexVec;
use fuwafuwa::vector::{cross, dot, length, minus, plus, scaled};
use fuwafuwa::{Dim, PieceId, Point, SoftBody, Vector};
use fuwafuwa_render::anchor_at;
use std::f32::consts::PI;

/// To the right, up and towards who looks.
pub(super) const UPRIGHT: [Vector; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A face is so large, in radii of a ball of the volume of its piece, or a share of that where the skin is small.
const LARGE: f32 = 0.55;
const FITS: [f32; 4] = [1.0, 0.8, 0.6, 0.45];
/// How far it reaches from its middle along the skin, and how far the skin may fall off below it, in its sizes.
const WIDE: f32 = 0.9;
const DEEP: f32 = 0.6;
/// A place is fit for it when so much of it is original skin; it stays until that is less than the second.
const COVERED: [f32; 2] = [0.82, 0.68];
/// It leaves its piece when another has so many times its mass; of so many that are no lighter than that it takes the best.
const HEAVIER: f32 = 1.6;
const PIECES: usize = 4;
/// Another place must be better by so much, and is looked for so often [s].
const BETTER: f32 = 0.1;
const AGAIN: f32 = 0.5;
/// So many places are looked at, and as many once more near the best.
const PLACES: usize = 120;
/// A face looks at who looks, and so much above: bars stand low.
const ABOVE: f32 = 0.4;
/// One that is turned farther away, as a cosine, for so long [s], goes to where it is seen; while its body turns faster than
/// this [rad/s] it rolls with it. One that is tilted as much does so once its body hardly turns any more.
const LOST: f32 = 0.6;
const PATIENCE: f32 = 0.12;
const FAST: f32 = 3.0;
const CALM: f32 = 0.8;
/// Of a body that rolls it takes the place that is seen best so much later [s], and so much nearer to its axis: there it is
/// seen for longer.
const AHEAD: f32 = 0.4;
const NEAR_AXIS: f32 = 0.4;
/// How long it takes to shrink and to come up [s].
const SHRINK: f32 = 0.08;
const RISE: f32 = 0.14;
/// How far inside the body its middle is, in its sizes: below all skin that it lies on.
const INSIDE: f32 = 0.8;
/// How much of the body around it tells how it is turned, at least [voxels].
const LEAST_REACH: f32 = 3.0;

/// Where a face sticks to a skin, and how it is seen there.
#[derive(Clone, Debug, Default)]
pub struct Perch {
    /// Its middle, inside the body [m].
    pub at: Vector,
    /// To the right in it, up, and out of the skin; of length 1.
    pub axes: [Vector; 3],
    /// How large it is [m]; 0 where there is no skin left for it.
    pub size: f32,
    /// The piece that it is on.
    pub piece: PieceId,
    /// The middle of the piece, nearly [m].
    pub middle: Vector,
    place: Option<Place>,
    next: Option<Place>,
    /// How large it would be on its piece [m].
    full: f32,
    /// How much of it has come up, 0 to 1.
    up: f32,
    /// How it turns [rad/s], and for how long it has been lost [s].
    spin: Vector,
    lost: f32,
    /// When another place may be looked for [s].
    wait: f32,
}

/// A place on the original skin, in the body at rest.
#[derive(Copy, Clone, Debug)]
struct Place {
    /// A voxel with a side there: it always belongs to some piece.
    voxel: Point,
    /// The middle of that side [voxels].
    rest: Vector,
    /// The axes of the face that sticks to it.
    worn: [Vector; 3],
    /// One of `FITS`.
    fit: f32,
}

/// A side of a voxel on the original skin.
struct Spot {
    voxel: Point,
    rest: Vector,
    at: Vector,
    normal: Vector,
}

/// What of a piece a face could stick to, and for whom.
struct Skin {
    spots: Vec<Spot>,
    piece: PieceId,
    middle: Vector,
    /// How large a face would be on it [m].
    full: f32,
    voxel: f32,
    eye: Option<Vector>,
    /// How what sticks to it turns [rad/s].
    spin: Vector,
}

impl Perch {
    /// The place where it is seen best.
    pub fn new<D: Dim>(body: &SoftBody<D>, eye: Option<Vector>) -> Self {
        let mut perch = Self {
            axes: UPRIGHT,
            up: 1.0,
            ..Self::default()
        };
        perch.review(body, eye);
        perch.sit(body);
        perch
    }

    /// Lets time pass; it is looked for another place only where `looks` says so, for that takes time.
    pub fn follow<D: Dim>(
        &mut self,
        body: &SoftBody<D>,
        eye: Option<Vector>,
        looks: bool,
        seconds: f32,
    ) {
        self.wait -= seconds;
        if looks {
            self.review(body, eye);
        }
        if self.next.is_some() {
            self.up -= seconds / SHRINK;
            if self.up <= 0.0 {
                (self.place, self.next, self.up) = (self.next, None, 0.0);
                self.lost = 0.0;
                self.review(body, eye);
                self.sit(body);
            }
        } else {
            self.up = (self.up + seconds / RISE).min(1.0);
        }
        let before = self.axes;
        self.sit(body);
        let turned = [0, 1, 2].map(|k| cross(before[k], self.axes[k]));
        let spin = scaled(turned.into_iter().fold([0.0; 3], plus), 0.5 / seconds);
        self.spin = plus(self.spin, scaled(minus(spin, self.spin), 0.2));
        let [facing, upright] = eye.map_or([1.0; 2], |eye| seen(self.at, self.axes, eye));
        let spin = length(self.spin);
        let is_lost = facing < LOST || upright < LOST && spin < CALM;
        self.lost = match is_lost && spin < FAST {
            true => self.lost + seconds,
            false => 0.0,
        };
    }

    /// Follows the skin.
    fn sit<D: Dim>(&mut self, body: &SoftBody<D>) {
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
        // It comes up a little too far, as what pops does.
        self.size = size * self.up * (1.0 + 0.6 * self.up * (1.0 - self.up));
    }

    /// Looks whether it is well where it is.
    fn review<D: Dim>(&mut self, body: &SoftBody<D>, eye: Option<Vector>) {
        let masses = masses(body);
        let largest = largest(&masses);
        let own = self.place.and_then(|place| body.mesh().owner(place.voxel));
        let own = own.map(|element| body.pieces().of_element(element));
        let spin = self.spin;
        let on = |piece: PieceId| Skin {
            spin,
            ..Skin::of(body, piece, &masses, eye)
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
            if !is_small && covered > COVERED[1] && self.lost < PATIENCE {
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

impl Skin {
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
            Some(Spot {
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

    /// Where a face would best look from a place.
    fn wish(&self, at: Vector) -> Vector {
        let wish = self.eye.map_or(UPRIGHT[2], |eye| wish(at, eye));
        let early = minus(wish, scaled(cross(self.spin, wish), AHEAD));
        let along = dot(self.spin, wish) / length(self.spin).max(1e-9);
        let early = plus(early, scaled(self.spin, NEAR_AXIS * along));
        scaled(early, 1.0 / length(early))
    }

    /// How much of a face would lie on this skin, 0 to 1.
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

    /// How good a place is: large, whole, seen, and in the middle of what is seen.
    fn score(&self, at: Vector, out: Vector, fit: f32, covered: f32) -> f32 {
        let wish = self.wish(self.middle);
        let by = minus(at, self.middle);
        let aside = length(minus(by, scaled(wish, dot(by, wish))));
        fit * covered + 0.5 * dot(out, wish) - 0.2 * LARGE * aside / self.full.max(1e-9)
    }

    /// The best place: its spot, its score, its fit, and what is out of it.
    fn best(&self) -> Option<(&Spot, f32, f32, Vector)> {
        let wish = self.wish(self.middle);
        let turned = self.spots.iter();
        let turned: Vec<&Spot> = turned.filter(|spot| dot(spot.normal, wish) > 0.0).collect();
        let first = self.best_of(&turned)?;
        let near = |spot: &&&Spot| length(minus(spot.at, first.0.at)) < 0.5 * self.full;
        let near: Vec<&Spot> = turned.iter().filter(near).copied().collect();
        self.best_of(&near)
            .filter(|second| second.1 > first.1)
            .or(Some(first))
    }

    fn best_of<'a>(&self, spots: &[&'a Spot]) -> Option<(&'a Spot, f32, f32, Vector)> {
        let judged = spots.iter().step_by(1 + spots.len() / PLACES).map(|spot| {
            // Stairs have the direction of the skin only together.
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

    /// The place at a spot, upright for who looks.
    fn place<D: Dim>(
        &self,
        body: &SoftBody<D>,
        spot: &Spot,
        out: Vector,
        fit: f32,
    ) -> Option<Place> {
        let reach = (fit * self.full / self.voxel).max(LEAST_REACH);
        let (_, turn) = anchor_at(body, self.piece, spot.rest, reach)?;
        let axes = upright(out, self.eye.map_or(UPRIGHT[2], |eye| minus(eye, spot.at)));
        Some(Place {
            voxel: spot.voxel,
            rest: spot.rest,
            worn: axes.map(|axis| turn.map(|own| dot(own, axis))),
            fit,
        })
    }
}

/// Where a face at a place best looks, of length 1.
fn wish(at: Vector, eye: Vector) -> Vector {
    let by = minus(eye, at);
    let high = plus(by, [0.0, ABOVE * length(by), 0.0]);
    scaled(high, 1.0 / length(high).max(1e-9))
}

/// The axes of a face that looks out of a skin and is upright for who looks along `towards`.
fn upright(out: Vector, towards: Vector) -> [Vector; 3] {
    // On top of a body, up is away from who looks.
    let back = scaled(towards, 0.1 / length(towards).max(1e-9));
    square([[0.0; 3], minus(UPRIGHT[1], back), out])
}

/// How well a face is seen, as cosines: turned towards who looks, and upright.
fn seen(at: Vector, axes: [Vector; 3], eye: Vector) -> [f32; 2] {
    let up = upright(axes[2], minus(eye, at))[1];
    [dot(axes[2], wish(at, eye)), dot(axes[1], up)]
}

/// Axes of length 1 and square to each other: the third as it is, the second nearly, the first as it must be.
pub(super) fn square([_, up, out]: [Vector; 3]) -> [Vector; 3] {
    let unit = |of: Vector| scaled(of, 1.0 / length(of).max(1e-9));
    let out = unit(out);
    let right = unit(cross(up, out));
    [right, cross(out, right), out]
}

/// The piece with the most mass; of several the first.
pub(super) fn largest(masses: &IndexVec<PieceId, f32>) -> PieceId {
    let heavier = |best, piece| match masses[piece] > masses[best] {
        true => piece,
        false => best,
    };
    masses.ids().fold(PieceId(0), heavier)
}

/// The mass of each piece [kg].
pub(super) fn masses<D: Dim>(body: &SoftBody<D>) -> IndexVec<PieceId, f32> {
    let mut masses = IndexVec::from(vec![0.0f32; body.pieces().list.len()]);
    for (id, _) in body.mesh().nodes() {
        masses[body.pieces().of_node(id)] += body.node_state(id).2;
    }
    masses
}

#[cfg(test)]
mod tests;

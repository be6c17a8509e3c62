//! Skins that were forced into another piece, and the way out.
//!
//! There is no skin inside a piece that would hold anything off: a crumb that was pressed through a
//! stretched skin would stay. So once a tick the elements of the larger pieces are asked whose
//! middle lies in them. Such a skin is a *captive*: it no longer touches the skins of the piece around
//! it, but for the nearest, its *exit*, which lets it out.

use super::bins::Bins;
use super::skins::Skins;
use crate::body::Body;
use crate::dim::Dim;
use crate::shape::Vector;
use crate::solve::Row;
use crate::vector::{dot, minus, plus, scaled, three};
use std::collections::BTreeMap;

/// Exits are looked for so many voxels around first.
const EXIT_REACH: f32 = 2.0;

/// A skin whose middle is inside another piece.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Captive {
    /// Its place among the skins.
    pub skin: u32,
    /// The nearest skin of the piece around it.
    pub exit: u32,
}

impl Skins {
    /// Finds out who is inside a piece that is larger than its own.
    pub(super) fn find_captives<D: Dim>(&mut self, bodies: &[Body<D>]) {
        self.captives.clear();
        self.captors.clear();
        self.captors.resize(self.list.len(), None);
        let counts: Vec<Vec<u32>> = bodies.iter().map(element_counts).collect();
        let largest = counts.iter().flatten().copied().max().unwrap_or(0);
        let own = |skin: u32| {
            let skin = &self.list[skin as usize];
            counts[skin.body as usize][skin.piece as usize]
        };
        let small = self.awake.iter().copied();
        let small: Vec<u32> = small.filter(|&skin| own(skin) < largest).collect();
        if small.is_empty() {
            return;
        }
        // Surface elements hold skins that are close to their own.
        for pair in &self.pairs {
            let [a, b] = pair.skins.map(|skin| &self.list[skin as usize]);
            let [at, other] = pair.skins.map(|skin| self.centres[skin as usize]);
            let (apart, reach) = (minus(at, other), a.radius + b.radius);
            if dot(apart, apart) > reach * reach {
                continue;
            }
            for (inner, outer, at) in [(0, b, at), (1, a, other)] {
                let skin = pair.skins[inner];
                let captor = (outer.body, outer.piece);
                let is_smaller = own(skin) < own(pair.skins[1 - inner]);
                let body = &bodies[outer.body as usize];
                if is_smaller && body.holds(outer.element, three(at)) {
                    self.captors[skin as usize] = Some(captor);
                }
            }
        }
        let centres = small.iter().map(|&skin| self.centres[skin as usize]);
        let centres: Vec<Row> = centres.collect();
        for same in inner_elements(bodies, &counts).chunk_by(|a, b| a.level == b.level) {
            let widest = same.iter().map(|inner| inner.radius).fold(0.0, f32::max);
            let bins = Bins::new::<D>(&centres, widest);
            for inner in same {
                bins.near::<D>(inner.centre, inner.radius, |place| {
                    let (skin, at) = (small[place as usize], three(centres[place as usize]));
                    let body = &bodies[inner.captor.0 as usize];
                    if own(skin) < inner.count && body.holds(inner.element, at) {
                        self.captors[skin as usize] = Some(inner.captor);
                    }
                });
            }
        }
        let mut exits: BTreeMap<(u32, u32), Exits> = BTreeMap::new();
        for skin in small {
            let Some(captor) = self.captors[skin as usize] else {
                continue;
            };
            let exits = exits.entry(captor);
            let exits = exits.or_insert_with(|| Exits::of::<D>(captor, self, bodies));
            match exits.nearest::<D>(self.centres[skin as usize]) {
                Some(exit) => self.captives.push(Captive { skin, exit }),
                None => self.captors[skin as usize] = None,
            }
        }
    }

    /// Whether one of two skins is inside the piece of the other.
    #[inline(always)]
    pub fn is_inside(&self, a: usize, b: usize) -> bool {
        let inside = |a: usize, b: usize| {
            let (captor, skin) = (self.captors[a], &self.list[b]);
            captor.is_some_and(|captor| captor == (skin.body, skin.piece))
        };
        inside(a, b) || inside(b, a)
    }
}

/// The skins of a piece that lead out.
struct Exits {
    /// Their places among all skins, ascending.
    skins: Vec<u32>,
    centres: Vec<Row>,
    bins: Bins,
    /// How far the bins are looked through [m].
    reach: f32,
}

impl Exits {
    fn of<D: Dim>((body, piece): (u32, u32), skins: &Skins, bodies: &[Body<D>]) -> Self {
        let all = skins.list.iter().zip(0..);
        let exits =
            all.filter(|(skin, _)| (skin.body, skin.piece) == (body, piece) && skin.leads_out());
        let exits: Vec<u32> = exits.map(|(_, place)| place).collect();
        let centres = exits.iter().map(|&place| skins.centres[place as usize]);
        let centres: Vec<Row> = centres.collect();
        let reach = EXIT_REACH * bodies[body as usize].grid.voxel_size();
        Self {
            bins: Bins::new::<D>(&centres, reach),
            skins: exits,
            centres,
            reach,
        }
    }

    /// The one that is nearest to a place [m], of equals the first.
    fn nearest<D: Dim>(&self, at: Row) -> Option<u32> {
        let nearer = |nearest: (f32, u32), number: u32| {
            let apart = minus(self.centres[number as usize], at);
            let found = (dot(apart, apart), number);
            if found < nearest { found } else { nearest }
        };
        let none = (f32::INFINITY, u32::MAX);
        let mut nearest = none;
        self.bins.near::<D>(at, self.reach, |number| {
            nearest = nearer(nearest, number);
        });
        if nearest == none {
            nearest = (0..self.skins.len() as u32).fold(none, nearer);
        }
        self.skins.get(nearest.1 as usize).copied()
    }
}

/// An element that has no bare face, and a ball around it.
struct Inner {
    level: u8,
    element: u32,
    /// Body and number of its piece, and how many elements that has.
    captor: (u32, u32),
    count: u32,
    centre: Row,
    radius: f32,
}

/// The elements without a bare face, by level.
fn inner_elements<D: Dim>(bodies: &[Body<D>], counts: &[Vec<u32>]) -> Vec<Inner> {
    let mut found = Vec::new();
    for (place, body) in bodies.iter().enumerate() {
        for (id, element) in body.mesh.elements() {
            let level = element.cell.level;
            if level == 0 && body.bare[id as usize] != 0 {
                continue;
            }
            let piece = body.pieces.of_element(id);
            let nodes = element.nodes.iter();
            let places = nodes.map(|&node| body.position[node as usize]);
            let sum = places.clone().fold([0.0; 4], plus);
            let centre = scaled(sum, 1.0 / element.nodes.len() as f32);
            let furthest = places.map(|at| minus(at, centre)).map(|way| dot(way, way));
            found.push(Inner {
                level,
                element: id,
                captor: (place as u32, piece),
                count: counts[place][piece as usize],
                centre,
                radius: furthest.fold(0.0, f32::max).sqrt(),
            });
        }
    }
    found.sort_by_key(|inner| inner.level);
    found
}

/// The number of elements of each piece.
fn element_counts<D: Dim>(body: &Body<D>) -> Vec<u32> {
    let mut counts = vec![0; body.pieces.list.len()];
    for (id, _) in body.mesh.elements() {
        counts[body.pieces.of_element(id) as usize] += 1;
    }
    counts
}

impl<D: Dim> Body<D> {
    /// Whether a place [m] lies in an element, taken for evenly deformed.
    fn holds(&self, id: u32, at: Vector) -> bool {
        let Some(element) = self.mesh.element(id) else {
            return false;
        };
        let child = self.child_at(element, at);
        child.is_some_and(|child| element.children >> child & 1 == 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::Dim3;

    #[test]
    fn the_nearest_exit_is_found_near_and_far() {
        let mut seed = 7u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32
        };
        let centres: Vec<Row> = (0..400)
            .map(|_| [random(), random(), random(), 0.0])
            .collect();
        let reach = 0.1;
        let exits = Exits {
            skins: (0..400).map(|number| 3 * number).collect(),
            bins: Bins::new::<Dim3>(&centres, reach),
            centres,
            reach,
        };
        let (mut near, mut far) = (0, 0);
        for _ in 0..400 {
            let at = [2.0 * random(), random(), random(), 0.0];
            let apart = |number: &usize| {
                let apart = minus(exits.centres[*number], at);
                dot(apart, apart)
            };
            let all = 0..exits.centres.len();
            let nearest = all.min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap();
            assert_eq!(exits.nearest::<Dim3>(at), Some(3 * nearest as u32));
            let is_near = apart(&nearest) <= reach * reach;
            (near, far) = (near + u32::from(is_near), far + u32::from(!is_near));
        }
        assert!(near > 100 && far > 100, "{near} near, {far} far");
    }
}

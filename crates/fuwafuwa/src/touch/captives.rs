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
use crate::mesh::Element;
use crate::shape::Vector;
use crate::solve::Row;
use crate::stencil::slot_at;
use crate::vector::{cross, dot, length, minus, plus, scaled, three};

/// An element that is flatter than this holds nobody: its volume over that at rest.
const FLAT: f32 = 0.01;

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
        let count = |body: u32, piece: u32| counts[body as usize][piece as usize];
        let own = |skin: u32| {
            let skin = &self.list[skin as usize];
            count(skin.body, skin.piece)
        };
        let small = self.awake.iter().copied();
        let small: Vec<u32> = small.filter(|&skin| own(skin) < largest).collect();
        if small.is_empty() {
            return;
        }
        let centres: Vec<Row> = small
            .iter()
            .map(|&skin| self.centres[skin as usize])
            .collect();
        for level in 0.. {
            let holders = holders(bodies, &counts, level);
            let Some(widest) = holders.iter().map(|holder| holder.radius).reduce(f32::max) else {
                break;
            };
            let bins = Bins::new::<D>(&centres, widest);
            for holder in &holders {
                let body = &bodies[holder.body as usize];
                let piece = body.pieces.of_element(holder.element);
                bins.near::<D>(holder.centre, holder.radius, |place| {
                    let skin = small[place as usize];
                    let is_smaller = own(skin) < count(holder.body, piece);
                    let at = three(centres[place as usize]);
                    if is_smaller && body.holds(holder.element, at) {
                        self.captors[skin as usize] = Some((holder.body, piece));
                    }
                });
            }
        }
        for skin in small {
            self.captors[skin as usize] = self.captors[skin as usize].and_then(|captor| {
                let exit = self.exit::<D>(self.centres[skin as usize], captor)?;
                self.captives.push(Captive { skin, exit });
                Some(captor)
            });
        }
    }

    /// The skin of a piece that is nearest to a place [m] and leads out.
    fn exit<D: Dim>(&self, at: Row, captor: (u32, u32)) -> Option<u32> {
        let skins = self.list.iter().enumerate();
        let exits = skins.filter(|(_, skin)| (skin.body, skin.piece) == captor && skin.leads_out());
        let mut nearest = (f32::INFINITY, None);
        for (place, _) in exits {
            let apart = minus(self.centres[place], at);
            let squared = dot(apart, apart);
            if squared < nearest.0 {
                nearest = (squared, Some(place as u32));
            }
        }
        nearest.1
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

/// An element that may have somebody inside, and a ball around it.
struct Holder {
    body: u32,
    element: u32,
    centre: Row,
    radius: f32,
}

/// The elements of a level, but for crumbs; nothing above the highest level.
fn holders<D: Dim>(bodies: &[Body<D>], counts: &[Vec<u32>], level: u8) -> Vec<Holder> {
    let mut holders = Vec::new();
    for (place, body) in bodies.iter().enumerate() {
        for (id, element) in body.mesh.elements() {
            let count = counts[place][body.pieces.of_element(id) as usize];
            if element.cell.level != level || count == 1 {
                continue;
            }
            let nodes = element.nodes.iter();
            let places = nodes.map(|&node| body.position[node as usize]);
            let sum = places.clone().fold([0.0; 4], plus);
            let centre = scaled(sum, 1.0 / element.nodes.len() as f32);
            let radius = places.map(|at| length(minus(at, centre)));
            holders.push(Holder {
                body: place as u32,
                element: id,
                centre,
                radius: radius.fold(0.0, f32::max),
            });
        }
    }
    holders
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
        let element = self.mesh.element(id);
        element.is_some_and(|element| {
            self.child_at(element, at)
                .is_some_and(|child| element.children >> child & 1 == 1)
        })
    }

    /// The child of an element's cell that a place [m] lies in.
    fn child_at(&self, element: &Element, at: Vector) -> Option<usize> {
        let (centre, [x, y, z]) = self.deformation(element);
        let volume = dot(x, cross(y, z));
        if !(volume.abs() > FLAT) {
            return None;
        }
        // Cramer's rule: where the place was at rest, as seen from the centroid.
        let by = scaled(minus(at, centre), 1.0 / volume);
        let columns = [cross(y, z), cross(z, x), cross(x, y)];
        let child_width = 0.5 * self.grid.voxel_size() * element.cell.width() as f32;
        let stencil = self.mesh.stencil(element);
        let corner = slot_at(stencil.slots[0] as usize);
        let mut child = 0;
        for axis in 0..D::N {
            let from_centroid: f32 = (0..3).map(|k| columns[k][axis] * by[k]).sum();
            let from_corner = from_centroid / child_width - stencil.offsets[0][axis] as f32;
            let along = from_corner + corner[axis] as f32;
            if !(0.0..=2.0).contains(&along) {
                return None;
            }
            child |= usize::from(along > 1.0) << axis;
        }
        Some(child)
    }
}

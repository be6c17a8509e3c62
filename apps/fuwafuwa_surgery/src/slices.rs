//! Slices through an organ as it is now, deformed and cut: what a radiologist would see of it.
//!
//! ```text
//!   axial, from above     coronal, from behind     sagittal, from the left
//!        A                      S                        S
//!      L   R                  L   R                    A   P
//!        P                      I                        I
//! ```
//!
//! Left is left, as in the picture beside it, in which the patient is seen from behind; many stations show axial and coronal
//! slices the other way round. Letters stand at each.

use fuwafuwa::vector::{minus, plus, scaled};
use fuwafuwa::{Dim3, ElementId, SoftBody, Vector};

/// Which way a slice lies.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Cut {
    /// Across the long axis of the patient.
    Axial,
    /// From side to side, along it.
    Coronal,
    /// From front to back, along it.
    Sagittal,
}

/// A part of a slice that is of one element.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Its corners, three or four [m], to the right and up.
    pub corners: Vec<[f32; 2]>,
    /// Number of its material.
    pub material: u8,
    /// How far the element is strained: ‖F − R‖.
    pub strain: f32,
}

/// A slice.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slice {
    /// What is cut through.
    pub patches: Vec<Patch>,
    /// Where the skin is, from point to point [m].
    pub rim: Vec<[[f32; 2]; 2]>,
    /// The same of what was inside before it was cut or torn.
    pub cracks: Vec<[[f32; 2]; 2]>,
}

/// The tetrahedra that a block of eight corners falls into, all around the diagonal from the first to the last: blocks that
/// meet in a face part it alike.
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 3, 7],
    [0, 3, 2, 7],
    [0, 2, 6, 7],
    [0, 6, 4, 7],
    [0, 4, 5, 7],
    [0, 5, 1, 7],
];

impl Cut {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Axial, Self::Coronal, Self::Sagittal];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Axial => "Axial",
            Self::Coronal => "Coronal",
            Self::Sagittal => "Sagittal",
        }
    }

    /// The engine's axis across it.
    pub fn axis(self) -> usize {
        match self {
            Self::Axial => 1,
            Self::Coronal => 2,
            Self::Sagittal => 0,
        }
    }

    /// What stands at its left, right, upper and lower edge: left, right, anterior, posterior, superior, inferior.
    pub fn letters(self) -> [&'static str; 4] {
        match self {
            Self::Axial => ["L", "R", "A", "P"],
            Self::Coronal => ["L", "R", "S", "I"],
            Self::Sagittal => ["A", "P", "S", "I"],
        }
    }

    /// Where a place [m] is on it, to the right and up.
    pub fn on_page(self, [x, y, z]: Vector) -> [f32; 2] {
        match self {
            Self::Axial => [x, -z],
            Self::Coronal => [x, y],
            Self::Sagittal => [z, y],
        }
    }
}

impl Slice {
    /// That through an organ at a place along its axis [m].
    pub fn of(organ: &SoftBody<Dim3>, cut: Cut, at: f32) -> Self {
        let mut slice = Self::default();
        let axis = cut.axis();
        let positions = organ.positions();
        let crossed = organ.mesh().elements().filter(|(_, element)| {
            let mut sides = element
                .nodes
                .iter()
                .map(|&node| positions[node][axis] >= at);
            let first = sides.next();
            sides.any(|side| Some(side) != first)
        });
        let crossed: Vec<ElementId> = crossed.map(|(id, _)| id).collect();
        for id in crossed {
            slice.add(organ, id, cut, at);
        }
        for facet in organ.facets() {
            let line = [[0, 1, 2], [0, 2, 3]].map(|three| {
                let corners = three.map(|k: usize| facet.corners[k]);
                segment(corners, axis, at)
            });
            let lines = match facet.is_torn {
                true => &mut slice.cracks,
                false => &mut slice.rim,
            };
            let line = line.into_iter().flatten();
            lines.extend(line.map(|ends| ends.map(|end| cut.on_page(end))));
        }
        slice
    }

    fn add(&mut self, organ: &SoftBody<Dim3>, id: ElementId, cut: Cut, at: f32) {
        let Some(view) = organ.element_view(id) else {
            return;
        };
        let children = if view.level == 0 { 1 } else { 8 };
        let filled =
            (0..children).filter(|&child| view.level == 0 || view.children >> child & 1 == 1);
        for child in filled {
            let corners = view.child_corners::<Dim3>(child);
            for tetrahedron in TETRAHEDRA {
                let corners = tetrahedron.map(|k| corners[k]);
                let section = section(corners, cut.axis(), at).into_iter();
                let patch = Patch {
                    corners: section.map(|place| cut.on_page(place)).collect(),
                    material: view.material,
                    strain: view.strain,
                };
                // A plane through corners cuts some of them in a line or a point.
                if patch.area() > 0.0 {
                    self.patches.push(patch);
                }
            }
        }
    }

    /// The material at a place of it [m]; none outside.
    pub fn material_at(&self, at: [f32; 2]) -> Option<u8> {
        let patch = self.patches.iter().find(|patch| patch.holds(at));
        patch.map(|patch| patch.material)
    }

    /// Its area [m²].
    pub fn area(&self) -> f32 {
        self.patches.iter().map(Patch::area).sum()
    }
}

impl Patch {
    /// Its area [m²].
    pub fn area(&self) -> f32 {
        let [first, ..] = self.corners[..] else {
            return 0.0;
        };
        let doubled = |pair: &[[f32; 2]]| {
            let [a, b] = [minus(pair[0], first), minus(pair[1], first)];
            a[0] * b[1] - a[1] * b[0]
        };
        0.5 * self.corners.windows(2).map(doubled).sum::<f32>().abs()
    }

    /// Whether a place is in it: on the same side of all its edges.
    fn holds(&self, at: [f32; 2]) -> bool {
        let count = self.corners.len();
        let sides = (0..count).map(|k| {
            let [a, b] = [self.corners[k], self.corners[(k + 1) % count]];
            let ([x, y], [u, v]) = (minus(b, a), minus(at, a));
            x * v - y * u
        });
        let (mut left, mut right) = (true, true);
        for side in sides {
            left &= side >= 0.0;
            right &= side <= 0.0;
        }
        left || right
    }
}

/// Where the line between two places crosses a plane, which is between them.
fn crossing(a: Vector, b: Vector, axis: usize, at: f32) -> Vector {
    let share = (at - a[axis]) / (b[axis] - a[axis]);
    plus(a, scaled(minus(b, a), share.clamp(0.0, 1.0)))
}

/// Where a plane cuts a tetrahedron: three or four corners in their order, or none.
fn section(corners: [Vector; 4], axis: usize, at: f32) -> Vec<Vector> {
    let (above, below): (Vec<Vector>, Vec<Vector>) =
        corners.into_iter().partition(|corner| corner[axis] >= at);
    let cross = |a: Vector, b: Vector| crossing(a, b, axis, at);
    match (&above[..], &below[..]) {
        (&[a], others) | (others, &[a]) => others.iter().map(|&other| cross(a, other)).collect(),
        (&[a, b], &[c, d]) => vec![cross(a, c), cross(a, d), cross(b, d), cross(b, c)],
        _ => Vec::new(),
    }
}

/// Where a plane cuts a triangle.
fn segment(corners: [Vector; 3], axis: usize, at: f32) -> Option<[Vector; 2]> {
    let is_above = corners.map(|corner| corner[axis] >= at);
    let alone = (0..3)
        .find(|&k| is_above[k] != is_above[(k + 1) % 3] && is_above[k] != is_above[(k + 2) % 3])?;
    let others = [corners[(alone + 1) % 3], corners[(alone + 2) % 3]];
    Some(others.map(|other| crossing(corners[alone], other, axis, at)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_is_cut_into_a_triangle_or_a_quad() {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(section(corners, 2, 0.5).len(), 3);
        assert_eq!(section(corners, 2, 2.0).len(), 0);
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]];
        let quad = Patch {
            corners: section(corners, 2, 0.5)
                .into_iter()
                .map(|[x, y, _]| [x, y])
                .collect(),
            material: 1,
            strain: 0.0,
        };
        // Half of each of two edges of length 1 that stand upright on each other.
        assert!((quad.area() - 0.25).abs() < 1e-6, "{quad:?}");
        assert!(quad.holds([0.25, 0.25]) && !quad.holds([0.6, 0.25]));
    }
}

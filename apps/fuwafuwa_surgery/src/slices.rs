//! Slices through the deformed and cut organ, as in radiology.
//!
//! ```text
//!   axial, from above     coronal, from behind     sagittal, from the left
//!        A                      S                        S
//!      L   R                  L   R                    A   P
//!        P                      I                        I
//! ```
//!
//! The patient's left is on the left of the page, as in the main view, which shows the patient from behind.
//! Many workstations show axial and coronal slices mirrored. Letters at the edges of every slice name the
//! directions.

use fuwafuwa::{Dim3, ElementId, SoftBody, Vec2, Vec3};

/// Orientation of a slice.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Cut {
    /// Perpendicular to the long axis of the patient.
    Axial,
    /// Perpendicular to the front-back axis.
    Coronal,
    /// Perpendicular to the left-right axis.
    Sagittal,
}

/// Part of a slice within one element.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Three or four corners in page coordinates (right, up) [m].
    pub corners: Vec<Vec2>,
    /// Material number.
    pub material: u8,
    /// Strain ‖F − R‖ of the element: deformation gradient minus its rotation (dimensionless).
    pub strain: f32,
}

/// A slice. All corners and segments are in page coordinates (right, up) [m].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slice {
    /// Cross-sections of elements.
    pub patches: Vec<Patch>,
    /// Segments in which the plane of the slice cuts the original surface of the organ.
    pub rim: Vec<[Vec2; 2]>,
    /// Segments in which the plane of the slice cuts surfaces created by cutting or tearing.
    pub cracks: Vec<[Vec2; 2]>,
}

/// Six tetrahedra that fill a block with eight corners. All six contain the diagonal from the first to the
/// last corner, so that adjacent blocks divide their common face in the same way.
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 3, 7],
    [0, 3, 2, 7],
    [0, 2, 6, 7],
    [0, 6, 4, 7],
    [0, 4, 5, 7],
    [0, 5, 1, 7],
];

impl Cut {
    /// All orientations.
    pub const ALL: [Self; 3] = [Self::Axial, Self::Coronal, Self::Sagittal];

    /// Returns the name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Axial => "Axial",
            Self::Coronal => "Coronal",
            Self::Sagittal => "Sagittal",
        }
    }

    /// Returns the engine axis perpendicular to the slice.
    pub fn axis(self) -> usize {
        match self {
            Self::Axial => 1,
            Self::Coronal => 2,
            Self::Sagittal => 0,
        }
    }

    /// Returns the letters at the left, right, upper and lower edge. They stand for left (L), right (R),
    /// anterior (A), posterior (P), superior (S) and inferior (I).
    pub fn letters(self) -> [&'static str; 4] {
        match self {
            Self::Axial => ["L", "R", "A", "P"],
            Self::Coronal => ["L", "R", "S", "I"],
            Self::Sagittal => ["A", "P", "S", "I"],
        }
    }

    /// Returns the page coordinates (right, up) of a point [m].
    pub fn on_page(self, at: Vec3) -> Vec2 {
        match self {
            Self::Axial => Vec2::new(at.x, -at.z),
            Self::Coronal => Vec2::new(at.x, at.y),
            Self::Sagittal => Vec2::new(at.z, at.y),
        }
    }
}

impl Slice {
    /// Computes the slice through an organ. `at` is the position of the plane along the perpendicular axis
    /// [m].
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
                // Skips empty patches: a plane through corners may cut a tetrahedron only in a line or a
                // point.
                if patch.area() > 0.0 {
                    self.patches.push(patch);
                }
            }
        }
    }

    /// Returns the material at page coordinates [m], or `None` outside the organ.
    pub fn material_at(&self, at: Vec2) -> Option<u8> {
        let patch = self.patches.iter().find(|patch| patch.holds(at));
        patch.map(|patch| patch.material)
    }

    /// Returns the area of the organ in the slice [m²].
    pub fn area(&self) -> f32 {
        self.patches.iter().map(Patch::area).sum()
    }
}

impl Patch {
    /// Returns the area [m²].
    pub fn area(&self) -> f32 {
        let [first, ..] = self.corners[..] else {
            return 0.0;
        };
        let doubled = |pair: &[Vec2]| (pair[0] - first).perp_dot(pair[1] - first);
        0.5 * self.corners.windows(2).map(doubled).sum::<f32>().abs()
    }

    /// Returns whether a point is inside the patch, that is, on the same side of all its edges.
    fn holds(&self, at: Vec2) -> bool {
        let count = self.corners.len();
        let sides = (0..count).map(|k| {
            let [a, b] = [self.corners[k], self.corners[(k + 1) % count]];
            (b - a).perp_dot(at - a)
        });
        let (mut left, mut right) = (true, true);
        for side in sides {
            left &= side >= 0.0;
            right &= side <= 0.0;
        }
        left || right
    }
}

/// Returns the point in which the line from `a` to `b` crosses a plane between these two points.
fn crossing(a: Vec3, b: Vec3, axis: usize, at: f32) -> Vec3 {
    let share = (at - a[axis]) / (b[axis] - a[axis]);
    a + (b - a) * share.clamp(0.0, 1.0)
}

/// Returns the polygon in which a plane cuts a tetrahedron: three or four corners in order, or none.
fn section(corners: [Vec3; 4], axis: usize, at: f32) -> Vec<Vec3> {
    let (above, below): (Vec<Vec3>, Vec<Vec3>) =
        corners.into_iter().partition(|corner| corner[axis] >= at);
    let cross = |a: Vec3, b: Vec3| crossing(a, b, axis, at);
    match (&above[..], &below[..]) {
        (&[a], others) | (others, &[a]) => others.iter().map(|&other| cross(a, other)).collect(),
        (&[a, b], &[c, d]) => vec![cross(a, c), cross(a, d), cross(b, d), cross(b, c)],
        _ => Vec::new(),
    }
}

/// Returns the segment in which a plane cuts a triangle.
fn segment(corners: [Vec3; 3], axis: usize, at: f32) -> Option<[Vec3; 2]> {
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
    fn section_of_a_tetrahedron_is_a_triangle_or_a_quad() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        assert_eq!(section(corners, 2, 0.5).len(), 3);
        assert_eq!(section(corners, 2, 2.0).len(), 0);
        let corners = [Vec3::ZERO, Vec3::X, Vec3::new(0.0, 1.0, 1.0), Vec3::Z];
        let quad = Patch {
            corners: section(corners, 2, 0.5)
                .into_iter()
                .map(Vec3::truncate)
                .collect(),
            material: 1,
            strain: 0.0,
        };
        // The quad is a square with sides of 0.5.
        assert!((quad.area() - 0.25).abs() < 1e-6, "{quad:?}");
        assert!(quad.holds(Vec2::new(0.25, 0.25)) && !quad.holds(Vec2::new(0.6, 0.25)));
    }
}

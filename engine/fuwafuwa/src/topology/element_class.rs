//! Element class: the children that an element fills, and the slots that carry a node.
//!
//! Every node of an element lies on its 3 × 3 (× 3) lattice of slots. The coordinates of a slot are 0, 1 or
//! 2. The number of 1s among them gives the kind of the slot: 0 corner, 1 edge middle, 2 face centre, 3 cell
//! centre. Rest offsets, gradients, volumes and masses depend on the class only, and scale with powers of the
//! element size. They are therefore computed once per class.

use crate::foundation::dim::{Dim, Point, add, corner};
use crate::foundation::hash::hash_state;
use glam::DVec3;
use std::fmt;
use std::marker::PhantomData;

/// Coordinates of a slot: along each axis, 0 = low side of the cell, 1 = middle, 2 = high side.
pub fn slot_at(slot: usize) -> Point {
    [
        (slot % 3) as i32,
        (slot / 3 % 3) as i32,
        (slot / 9 % 3) as i32,
    ]
}

/// Returns the slot at the given coordinates.
pub fn slot_index(at: Point) -> usize {
    (at[0] + 3 * at[1] + 9 * at[2]) as usize
}

/// Returns the mask of the slots that are corners of at least one child in the mask `children`.
pub fn closure<D: Dim>(children: u8) -> u32 {
    let mut slots = 0;
    for child in (0..D::CORNERS).filter(|child| children >> child & 1 == 1) {
        for vertex in 0..D::CORNERS {
            slots |= 1 << slot_index(add(corner(child), corner(vertex)));
        }
    }
    slots
}

/// Returns the mask of the slots at the corners of the whole cell.
pub fn cell_corners<D: Dim>() -> u32 {
    (0..D::CORNERS).fold(0, |slots, vertex| {
        slots | 1 << slot_index(corner(vertex).map(|k| 2 * k))
    })
}

/// Error: a slot at a corner receives a part of the volume or of the surface of the element, but carries no
/// node.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MissingCorner {
    /// Slot without a node.
    pub slot: usize,
}

impl fmt::Display for MissingCorner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "slot {:?} is a corner without a node",
            slot_at(self.slot)
        )
    }
}

impl std::error::Error for MissingCorner {}

/// Geometry of an element class. Lengths are in widths of a child, that is, half widths of the cell.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct ElementClass<D: Dim> {
    /// Mask of the filled children; every bit set for a whole cell.
    pub children: u8,
    /// Slots that carry a node, ascending.
    pub slots: Vec<u8>,
    /// Mask of the slots that carry a node: bit s for slot s.
    pub mask: u32,
    /// Offset of each node from the volume centroid of the undeformed element.
    pub offsets: Vec<DVec3>,
    /// Gradient b of each node: the derivative ∂V/∂x of the volume at rest. With the node positions x and the
    /// deformation gradient F, Σ x bᵀ = V F for every affine motion and every polygon or polyhedron [Beirao
    /// da Veiga 2013].
    pub gradients: Vec<DVec3>,
    /// Part of `volume` that each node represents; it determines the mass of the node.
    pub volumes: Vec<f64>,
    /// Volume of the undeformed element: the number of filled children.
    pub volume: f64,
    /// Stiffness of the hourglass modes relative to that of a plain element, which fills a whole cell and has
    /// nodes only at its corners: see [`ElementClass::new`].
    pub hourglass: f64,
    dim: PhantomData<D>,
}

hash_state! {
    [D: Dim] struct ElementClass<D> {
        children, slots, mask, offsets, gradients, volumes, volume, hourglass,
    } skip { dim }
}

impl<D: Dim> ElementClass<D> {
    /// Computes the class that fills `children` and carries nodes on the slots of the mask `slots`.
    ///
    /// Each filled child distributes its volume in equal parts to its corners. Each face of the element's
    /// surface distributes its area vector in equal parts to its corners; the sums are the gradients. A slot
    /// without a node passes its share in equal parts to its neighbours: the centre to the face centres, a
    /// face centre to its edge middles, an edge middle to the two corners of the edge. The distribution
    /// depends only on the slots in the face itself. The elements on both sides of a face therefore agree,
    /// and a graded mesh passes the patch test.
    ///
    /// The stiffness of the hourglass modes follows from the energy of pure bending, in the direction in
    /// which the element is softest.
    ///
    /// # Errors
    /// [`MissingCorner`] if a corner slot without a node would receive a share.
    #[inline(never)]
    pub fn new(children: u8, slots: u32) -> Result<Self, MissingCorner> {
        let mut gradients = [[0.0; 3]; 27];
        let mut volumes = [[0.0; 1]; 27];
        let vertex_share = 1.0 / D::CORNERS as f64;
        for child in (0..D::CORNERS).filter(|child| children >> child & 1 == 1) {
            for vertex in 0..D::CORNERS {
                volumes[slot_index(add(corner(child), corner(vertex)))][0] += vertex_share;
                for axis in 0..D::N {
                    let far = vertex >> axis & 1 == 1;
                    let sibling = child ^ 1 << axis;
                    let faces_sibling = far != (child >> axis & 1 == 1);
                    if faces_sibling && children >> sibling & 1 == 1 {
                        continue;
                    }
                    let share = if far {
                        2.0 * vertex_share
                    } else {
                        -2.0 * vertex_share
                    };
                    gradients[slot_index(add(corner(child), corner(vertex)))][axis] += share;
                }
            }
        }
        distribute_shares::<D, 3>(&mut gradients, slots)?;
        distribute_shares::<D, 1>(&mut volumes, slots)?;

        let slots: Vec<u8> = (0..D::SLOTS as u8)
            .filter(|slot| slots >> slot & 1 == 1)
            .collect();
        let volume = f64::from(children.count_ones());
        let at = |slot: u8| DVec3::from(slot_at(slot as usize).map(f64::from));
        let mut centroid = DVec3::ZERO;
        for &slot in &slots {
            centroid += at(slot) * volumes[slot as usize][0] / volume;
        }
        let mut element_class = Self {
            children,
            mask: slots.iter().fold(0, |mask, slot| mask | 1 << slot),
            offsets: slots.iter().map(|&slot| at(slot) - centroid).collect(),
            gradients: slots
                .iter()
                .map(|&slot| gradients[slot as usize].into())
                .collect(),
            volumes: slots
                .iter()
                .map(|&slot| volumes[slot as usize][0])
                .collect(),
            slots,
            volume,
            hourglass: 1.0,
            dim: PhantomData,
        };
        element_class.hourglass = element_class.least_bending();
        Ok(element_class)
    }

    /// Returns the index, among the nodes of the class, of the node on a slot; `None` if the slot carries no
    /// node.
    #[inline(always)]
    pub fn node_at(&self, slot: usize) -> Option<usize> {
        let before = self.mask & ((1 << slot) - 1);
        (self.mask >> slot & 1 == 1).then_some(before.count_ones() as usize)
    }

    /// Returns the stiffness of the hourglass modes, relative to a plain element, that gives them the energy
    /// of pure bending. It is the minimum over all bending modes, so that the element is too stiff in none of
    /// them.
    ///
    /// Bending along axis a towards axis b is u = x_a x_b e_a − ½ x_a² e_b. Without lateral contraction its
    /// energy is Y/2 ∫ x_b² dV, and the hourglass term of [`crate::soft_body::element_law`] stores k/2 Σ V_i
    /// |h_i|². A plain element has Σ V_i |h_i|² = V = 3 ∫ x_b² dV. The sum is smaller relative to the
    /// integral if mid nodes take volume from the corners, or if children are missing. Such an element needs
    /// a larger k.
    fn least_bending(&self) -> f64 {
        let mut least = f64::INFINITY;
        for towards in 0..D::N {
            let due = 3.0 * self.second_moment(towards);
            for along in (0..D::N).filter(|&along| along != towards) {
                let bent = |r: &DVec3| {
                    let mut moved = DVec3::ZERO;
                    moved[along] = r[along] * r[towards];
                    moved[towards] = -0.5 * r[along] * r[along];
                    moved
                };
                let moved: Vec<DVec3> = self.offsets.iter().map(bent).collect();
                least = least.min(due / self.not_affine(&moved));
            }
        }
        least
    }

    /// Returns the second moment ∫ x² dV of the filled children along an axis, about their centroid.
    fn second_moment(&self, axis: usize) -> f64 {
        let sides = (0..D::CORNERS).filter(|child| self.children >> child & 1 == 1);
        let sides: Vec<f64> = sides.map(|child| (child >> axis & 1) as f64).collect();
        let mean = sides.iter().sum::<f64>() / self.volume;
        let parts = sides.iter().map(|side| (side - mean) * (side - mean));
        parts.sum::<f64>() + self.volume / 12.0
    }

    /// Returns Σ V_i |h_i|² for the displacements `moved` of the nodes. h_i is the displacement of node i
    /// without its affine part, and V_i is the volume of the node.
    fn not_affine(&self, moved: &[DVec3]) -> f64 {
        let (mut slope, mut mean) = ([DVec3::ZERO; 3], DVec3::ZERO);
        for (k, u) in moved.iter().enumerate() {
            for i in 0..D::N {
                mean[i] += u[i] * self.volumes[k] / self.volume;
                for j in 0..D::N {
                    slope[i][j] += u[i] * self.gradients[k][j] / self.volume;
                }
            }
        }
        let mut sum = 0.0;
        for (k, u) in moved.iter().enumerate() {
            for i in 0..D::N {
                let turned: f64 = (0..D::N).map(|j| slope[i][j] * self.offsets[k][j]).sum();
                let h = u[i] - mean[i] - turned;
                sum += self.volumes[k] * h * h;
            }
        }
        sum
    }

    /// Returns whether the element is plain: it fills a whole cell and has nodes only at its corners.
    pub fn is_plain(&self) -> bool {
        self.children == D::ALL_CORNERS && self.slots.len() == D::CORNERS
    }
}

/// Distributes the share of each slot without a node in equal parts to adjacent slots: from the cell centre
/// to face centres, from these to edge middles, from these to corners.
fn distribute_shares<D: Dim, const K: usize>(
    shares: &mut [[f64; K]; 27],
    nodes: u32,
) -> Result<(), MissingCorner> {
    let middles = |slot: usize| slot_at(slot).iter().filter(|&&k| k == 1).count();
    for order in (1..=D::N).rev() {
        for slot in (0..D::SLOTS).filter(|&slot| nodes >> slot & 1 == 0 && middles(slot) == order) {
            let share = std::mem::replace(&mut shares[slot], [0.0; K]);
            for axis in (0..D::N).filter(|&axis| slot_at(slot)[axis] == 1) {
                for end in [0, 2] {
                    let mut at = slot_at(slot);
                    at[axis] = end;
                    for (to, from) in shares[slot_index(at)].iter_mut().zip(share) {
                        *to += from / (2 * order) as f64;
                    }
                }
            }
        }
    }
    let stranded = |&slot: &usize| nodes >> slot & 1 == 0 && shares[slot].iter().any(|&v| v != 0.0);
    match (0..D::SLOTS).find(stranded) {
        Some(slot) => Err(MissingCorner { slot }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};

    /// Checks that Σ x bᵀ = V·I, with the offset x and gradient b of each node, the volume V and the identity
    /// I. `slots` must contain at least the corners of the outline of `children`.
    fn check_gradient_is_exact<D: Dim>(children: u8, slots: u32) {
        let element_class = ElementClass::<D>::new(children, slots).unwrap();
        for i in 0..D::N {
            for j in 0..D::N {
                let sum: f64 = (0..element_class.slots.len())
                    .map(|k| element_class.offsets[k][i] * element_class.gradients[k][j])
                    .sum();
                let expected = if i == j { element_class.volume } else { 0.0 };
                assert!(
                    (sum - expected).abs() < 1e-12,
                    "{children:b} {slots:b}: {sum}"
                );
            }
        }
    }

    #[test]
    fn element_class_gradient_is_exact_with_hanging_nodes() {
        let square = cell_corners::<Dim2>();
        check_gradient_is_exact::<Dim2>(15, square);
        check_gradient_is_exact::<Dim2>(15, square | 1 << slot_index([1, 0, 0]));
        check_gradient_is_exact::<Dim2>(0b0111, closure::<Dim2>(0b0111));
        let cube = cell_corners::<Dim3>();
        for extra in 0..27 {
            check_gradient_is_exact::<Dim3>(255, cube | 1 << extra);
        }
        for children in [0b0111_1111, 0b0000_1111, 0b0001_0111, 0b0110_1111] {
            check_gradient_is_exact::<Dim3>(children, closure::<Dim3>(children));
        }
    }

    /// Compares the stiffness of the hourglass modes with values computed by hand.
    #[test]
    fn hourglass_stiffness_matches_bending_energy() {
        fn check<D: Dim>(children: u8, slots: u32, expected: f64) {
            let element_class = ElementClass::<D>::new(children, slots).unwrap();
            assert!(
                (element_class.hourglass - expected).abs() < 1e-12,
                "{element_class:?}"
            );
        }
        let (square, cube) = (cell_corners::<Dim2>(), cell_corners::<Dim3>());
        check::<Dim2>(15, square, 1.0);
        check::<Dim3>(255, cube, 1.0);
        // A single child is a plain element of half the width. Compared with a plain element of full width,
        // |h|² is 16 times smaller and x² only 4 times, so the stiffness is 4.
        check::<Dim2>(1, closure::<Dim2>(1), 4.0);
        check::<Dim3>(1, closure::<Dim3>(1), 4.0);
        // Nodes on all edge middles leave a quarter of the volume to the corners. The term ½ x_a² of the
        // bending mode adds 15/256 to Σ V_i |h_i|².
        let middles = [[1, 0, 0], [0, 1, 0], [2, 1, 0], [1, 2, 0]];
        let all = middles
            .iter()
            .fold(square, |all, &at| all | 1 << slot_index(at));
        check::<Dim2>(15, all, 4.0 / (1.0 + 15.0 / 64.0));
    }

    #[test]
    fn element_class_new_fails_for_corner_without_node() {
        let slots = cell_corners::<Dim2>() & !1;
        assert_eq!(
            ElementClass::<Dim2>::new(15, slots),
            Err(MissingCorner { slot: 0 })
        );
    }
}

//! Tension of the cuts through a node, from the forces of the elements on the node.
//!
//! A cut through a breakable node divides the voxels that share the node into sides A and B. The elements of
//! side A pull at the node with the force F_A, those of side B with F_B:
//!
//! ```text
//!       A │ B        T = (F_B − F_A) / 2      n = mean rotation · axis
//!     ────●────      σ = √(Tₙ² + ¼ Tₛ²) / area of the opened faces, both sides pulling apart
//!       A │ B
//! ```
//!
//! T is the pull across the cut, with the part Tₙ along the normal n of the cut and the part Tₛ in its plane.
//!
//! The nodal tension depends on the size and the direction of the voxels. It therefore decides only which cuts
//! are pulled open, and [`near_field`](super::near_field) decides when a crack starts or grows. Under
//! [`Law::Endo2004`](crate::Law::Endo2004), the nodal tension decides alone.

use crate::foundation::dim::Dim;
use crate::foundation::ids::NodeId;
use crate::fracture::breakable_nodes::{BreakableNode, NodeCut};
use crate::soft_body::SoftBody;
use crate::soft_body::element_forces::Row;
use fearless_simd::Simd;
use glam::Vec3;

/// Factor on the threshold of cuts that would make a crumb or leave a voxel attached by a single face.
/// Without it, cracks leave a trail of crumbs.
pub const CRUMB_FACTOR: f32 = 1.3;

/// Forces on a node, by octant, and the rotation at the node.
pub struct NodalForces {
    forces: [Row; 8],
    total: Row,
    /// Sum of the rotations of the elements around the node.
    rotation: [Vec3; 3],
    /// Unit normals of the cuts across each axis.
    normals: [Vec3; 3],
}

/// Tension of one cut.
#[derive(Copy, Clone, Debug)]
pub struct CutTension {
    /// Tension σ [Pa].
    pub tension: f32,
    /// Tension divided by the threshold of the cut.
    pub excess: f32,
    /// The cut.
    pub cut: NodeCut,
}

impl NodalForces {
    /// Returns the forces of the last substep on a node. `None` if the tension of every cut through the node is below
    /// `least` [Pa]: no tension exceeds the pull divided by the area.
    pub fn on<D: Dim>(
        body: &SoftBody<D>,
        id: NodeId,
        node: &BreakableNode,
        least: f32,
    ) -> Option<Self> {
        let mut forces = [Row::ZERO; 8];
        for (octant, force) in octants(node.group).zip(body.element_forces().parts_on(id)) {
            forces[octant] = force;
        }
        let mut all = Self {
            forces,
            total: forces.into_iter().sum::<Row>(),
            rotation: [Vec3::ZERO; 3],
            normals: [Vec3::ZERO; 3],
        };
        let face = face_area::<D>(body.grid().voxel_size());
        let may_open = |cut: &NodeCut| {
            let [far, near] = all.sides(cut);
            let pull = (far - near) * 0.5;
            let least = least * f32::from(cut.faces) * face;
            pull.dot(pull) >= least * least
        };
        if !body.breakable_nodes().cuts(node).iter().any(may_open) {
            return None;
        }
        for owner in body.mesh().carrier_ids(id) {
            let own = body.element_forces().rotation(owner);
            for row in 0..3 {
                all.rotation[row] += own[row];
            }
        }
        all.normals = [0, 1, 2].map(|axis: usize| {
            let [x, y, z] = all.rotation.map(|row| row[axis]);
            Vec3::new(x, y, z).normalize_or_zero()
        });
        Some(all)
    }

    /// Returns the forces on the two sides of a cut: on the octants of `cut.side`, and on the others.
    fn sides(&self, cut: &NodeCut) -> [Row; 2] {
        let forces = octants(cut.side).map(|octant| self.forces[octant]);
        let far = forces.sum::<Row>();
        [far, self.total - far]
    }

    /// Returns the mean rotation of the elements around the node, by rows.
    pub fn mean_rotation(&self) -> [Vec3; 3] {
        let [first, second, _] = self.rotation;
        let first = first.normalize_or(Vec3::X);
        let second =
            (second - first * first.dot(second)).normalize_or(first.any_orthonormal_vector());
        [first, second, first.cross(second)]
    }

    /// Returns the tension of a cut. `None` if the sides are not pulled apart.
    pub fn tension<D: Dim>(
        &self,
        body: &SoftBody<D>,
        node: &BreakableNode,
        cut: &NodeCut,
    ) -> Option<CutTension> {
        let [far, near] = self.sides(cut);
        let normal = self.normals[cut.axis as usize];
        if far.xyz().dot(normal) <= 0.0 || near.xyz().dot(normal) >= 0.0 {
            return None;
        }
        let area = f32::from(cut.faces) * face_area::<D>(body.grid().voxel_size());
        let tension = tension((far - near) * 0.5, Row::from(normal)) / area;
        Some(CutTension {
            tension,
            excess: tension / (node.threshold * crumb_factor(node, cut)),
            cut: *cut,
        })
    }

    /// Returns the cut with the highest tension relative to its threshold, if that is above `least`.
    pub fn worst_cut<D: Dim>(
        &self,
        body: &SoftBody<D>,
        node: &BreakableNode,
        least: f32,
    ) -> Option<CutTension> {
        let mut worst: Option<CutTension> = None;
        for cut in body.breakable_nodes().cuts(node) {
            let least = worst.map_or(least, |worst| worst.excess);
            if let Some(tension) = self.tension(body, node, cut)
                && tension.excess > least
            {
                worst = Some(tension);
            }
        }
        worst
    }
}

/// Returns the factor on the threshold of a cut: [`CRUMB_FACTOR`] if it would make a crumb, otherwise 1.
pub fn crumb_factor(node: &BreakableNode, cut: &NodeCut) -> f32 {
    let is_crumb = cut.single_voxel_octants & node.crumbs != 0;
    if is_crumb { CRUMB_FACTOR } else { 1.0 }
}

/// Returns whether the tension of every cut through a node is certain to be below `least` [Pa], from a bound that
/// is fast to compute. The pull of a cut is at most half the sum of the force magnitudes |f| of the n voxels around
/// the node, and (Σ|f|)² ≤ n Σ|f|². The factor 0.2501 is ¼ and a margin for rounding. The area is that of one face,
/// the least that a cut opens.
#[inline(always)]
pub fn is_surely_below<D: Dim, S: Simd>(
    simd: S,
    body: &SoftBody<D>,
    id: NodeId,
    node: &BreakableNode,
    least: f32,
) -> bool {
    let threshold = face_area::<D>(body.grid().voxel_size()) * least;
    let squares = body.element_forces().squares_on(simd, id);
    0.2501 * node.group.count_ones() as f32 * squares <= threshold * threshold
}

/// Iterates over the octants whose bits are set in a mask.
fn octants(mask: u8) -> impl Iterator<Item = usize> {
    (0..8).filter(move |octant| mask >> octant & 1 == 1)
}

/// Returns the part of a voxel's face that belongs to one of its corners [m in 2D, m² in 3D]: half an edge in
/// 2D, a quarter of a square in 3D.
pub fn face_area<D: Dim>(size: f32) -> f32 {
    (1..D::N).fold(1.0, |area, _| area * 0.5 * size)
}

/// Returns √(Tₙ² + ¼ Tₛ²) [N] for a pull with the part Tₙ along a unit normal and the part Tₛ across it.
fn tension(pull: Row, normal: Row) -> f32 {
    let opening = pull.dot(normal);
    let shear = (pull.dot(pull) - opening * opening).max(0.0);
    (opening * opening + 0.25 * shear).sqrt()
}

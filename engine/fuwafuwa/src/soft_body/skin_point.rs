//! Points of the smooth surface that belong to the nodes of a body.

use super::SoftBody;
use crate::foundation::dim::{Dim, Point, voxel_around};
use crate::foundation::ids::{Id, IndexVec, NodeId};
use crate::soft_body::element_forces::Row;
use glam::Vec3;

/// Offsets shorter than this are ignored [voxels].
const MIN_OFFSET: f32 = 1e-3;

/// Point of the smooth surface that belongs to a node. Its position is a weighted mean of the position of the
/// node and those of its neighbours along the axes of one element, so the point turns and strains with the body.
/// An impulse on the point acts on these nodes by the same weights, which keeps linear and angular momentum.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SkinPoint<I = NodeId> {
    /// Neighbour of the node along each axis.
    pub neighbours: [I; 3],
    /// Weight of each neighbour: the offset along its axis [voxels], negative away from the neighbour. The node
    /// has the rest, so that all weights have the sum 1.
    pub weights: [f32; 3],
}

impl SkinPoint {
    /// Returns the point at the node itself, as in the interior and on flat faces.
    #[inline(always)]
    pub fn at(node: NodeId) -> Self {
        Self {
            neighbours: [node; 3],
            weights: [0.0; 3],
        }
    }

    /// Sum of the absolute weights of the neighbours: an upper bound of the distance between node and point
    /// [voxels].
    #[inline(always)]
    pub fn reach(&self) -> f32 {
        self.weights[0].abs() + self.weights[1].abs() + self.weights[2].abs()
    }

    /// Upper bound of the distance that the point moves, as a multiple of that of the fastest node.
    #[inline(always)]
    pub fn stretch(&self) -> f32 {
        self.own_weight().abs() + self.reach()
    }

    /// Returns the inverse effective mass of the point [1/kg].
    #[inline(always)]
    pub fn inverse_mass(&self, node: NodeId, inverse_masses: &IndexVec<NodeId, f32>) -> f32 {
        if self.is_node() {
            return inverse_masses[node];
        }
        let own = self.own_weight();
        let mut sum = inverse_masses[node] * (own * own);
        for axis in 0..3 {
            let weight = self.weights[axis];
            sum += inverse_masses[self.neighbours[axis]] * (weight * weight);
        }
        sum
    }
}

impl<I: Id> SkinPoint<I> {
    /// Returns whether the point is the node itself.
    #[inline(always)]
    pub fn is_node(&self) -> bool {
        self.weights == [0.0; 3]
    }

    /// Weight of the node itself.
    #[inline(always)]
    pub fn own_weight(&self) -> f32 {
        1.0 - self.weights[0] - self.weights[1] - self.weights[2]
    }

    /// Returns the value at the point of a quantity that `rows` holds for each node.
    #[inline(always)]
    pub fn mean(&self, node: I, rows: &IndexVec<I, Row>) -> Row {
        if self.is_node() {
            return rows[node];
        }
        let mut sum = rows[node] * self.own_weight();
        for axis in 0..3 {
            sum += rows[self.neighbours[axis]] * self.weights[axis];
        }
        sum
    }

    /// Returns the same point among other indices.
    #[inline(always)]
    pub fn map<J>(self, index: impl FnMut(I) -> J) -> SkinPoint<J> {
        SkinPoint {
            neighbours: self.neighbours.map(index),
            weights: self.weights,
        }
    }
}

impl<D: Dim> SoftBody<D> {
    /// Point of the smooth surface that belongs to a node.
    #[inline(always)]
    pub(crate) fn skin_point(&self, node: NodeId) -> &SkinPoint {
        &self.cache.skin_points[node]
    }

    /// Position of the smooth surface at a node [m]. For inner nodes and on new crack faces, the position of the
    /// node.
    ///
    /// # Panics
    /// If the id was never used.
    pub fn skin_position(&self, node: NodeId) -> Vec3 {
        self.skin_row(node).xyz()
    }

    /// Offset of the smooth surface from a lattice point of the undeformed grid [voxels]. Zero away from the original
    /// surface. A deformed body carries its offsets along, see [`SoftBody::skin_position`].
    pub fn skin_offset(&self, at: Point) -> Vec3 {
        self.cache.skin.offset(at)
    }

    #[inline(always)]
    pub(crate) fn skin_row(&self, node: NodeId) -> Row {
        self.skin_point(node).mean(node, &self.state.position)
    }

    /// Velocity of the smooth surface at a node [m/s].
    #[inline(always)]
    pub(crate) fn skin_velocity(&self, node: NodeId) -> Row {
        self.skin_point(node).mean(node, &self.state.velocity)
    }

    /// Recomputes the skin points of nodes.
    pub(super) fn update_skin_points(&mut self, nodes: &[NodeId]) {
        let capacity = self.topology.mesh.node_capacity();
        self.cache
            .skin_points
            .edit()
            .resize(capacity, SkinPoint::at(NodeId(0)));
        for &node in nodes {
            let point = self
                .topology
                .mesh
                .is_alive(node)
                .then(|| self.skin_point_of(node));
            self.cache.skin_points.edit()[node] = point.flatten().unwrap_or(SkinPoint::at(node));
        }
    }

    /// Returns the skin point of a node; `None` for a node without an offset, or in an element above level 0.
    fn skin_point_of(&self, id: NodeId) -> Option<SkinPoint> {
        let mesh = &self.topology.mesh;
        let node = mesh.node(id);
        let offset = self.cache.skin.offset(node.at);
        if offset.length_squared() < MIN_OFFSET * MIN_OFFSET {
            return None;
        }
        // Coordinates relative to the node grow towards the voxel on the high side of each axis.
        let side = |octant: usize, axis: usize| (octant >> axis & 1) as f32 * 2.0 - 1.0;
        let along = |octant: usize| -> f32 {
            let sum: f32 = (0..D::N)
                .map(|axis| side(octant, axis) * offset[axis])
                .sum();
            sum.abs()
        };
        // The element from which the offset leads away, or into which it leads.
        let octants = (0..D::CORNERS).filter(|octant| node.group >> octant & 1 == 1);
        let octant = octants.reduce(|a, b| if along(b) > along(a) { b } else { a })?;
        let element = mesh.element_at(voxel_around::<D>(node.at, octant))?;
        let own = D::CORNERS - 1 - octant;
        if element.cell.level > 0 || element.nodes[own] != id {
            return None;
        }
        let mut point = SkinPoint::at(id);
        for axis in 0..D::N {
            point.neighbours[axis] = element.nodes[own ^ 1 << axis];
            point.weights[axis] = offset[axis] * side(octant, axis);
        }
        Some(point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};
    use crate::material::Material;
    use crate::topology::grid::VoxelGrid;

    fn check_tears<D: Dim>(n: usize) {
        let grid = VoxelGrid::<D>::ball(n, 1.0).unwrap();
        let mut body = SoftBody::new(grid, &[Material::default()]).unwrap();
        let mut seed = 3u32;
        let mut random = |below: usize| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as usize % below
        };
        let offsets = |body: &SoftBody<D>| {
            let nodes = body.mesh().nodes().map(|(node, _)| node);
            nodes
                .filter(|&node| !body.skin_point(node).is_node())
                .count()
        };
        let before = offsets(&body);
        for _ in 0..40 {
            let sides = (0..4).map(|_| {
                let mut at = [0; 3];
                (0..D::N).for_each(|axis| at[axis] = random(n + 1) as i32);
                (at, 1 + random((1 << D::CORNERS) - 2) as u8)
            });
            body.tear(&sides.collect::<Vec<_>>());
            let mut fresh = body.clone();
            fresh.rebuild();
            let nodes = body.mesh().nodes().map(|(node, _)| node);
            for node in nodes {
                assert_eq!(body.skin_point(node), fresh.skin_point(node));
                let sum = body.skin_position(node) - body.positions()[node].xyz();
                let most = body.grid().voxel_size() * 1.01;
                assert!(sum.length() <= most, "{node:?} {sum}");
            }
        }
        // Torn nodes of the original surface keep its offset.
        assert!(offsets(&body) > before, "{} {before}", offsets(&body));
    }

    #[test]
    fn skin_points_after_tears_equal_those_of_a_rebuilt_body() {
        check_tears::<Dim2>(16);
        check_tears::<Dim3>(8);
    }
}

//! Affine motion of elements: maps between the undeformed body and the deformed body in world space.

use crate::foundation::dim::Dim;
use crate::foundation::ids::{ElementId, NodeId};
use crate::math::row::Row;
use crate::soft_body::SoftBody;
use crate::topology::element_class::slot_at;
use crate::topology::mesh::Element;
use glam::Vec3;

/// Volume ratio below which an element counts as flat. The deformation gradient of a flat element is not
/// inverted: the inverse would amplify rounding errors of positions from about 1e-5 to more than 1e-2 of a
/// voxel.
const FLAT: f32 = 0.01;

impl<D: Dim> SoftBody<D> {
    /// Returns the volume centroid [m] of an element in its present shape, and the rows of its deformation
    /// gradient F.
    pub(crate) fn deformation(&self, element: &Element) -> (Vec3, [Vec3; 3]) {
        let element_class = self.topology.mesh.element_class(element);
        let half = 0.5 * self.topology.grid.voxel_size() * element.cell.width() as f32;
        let scale = 1.0 / (element_class.volume as f32 * half);
        let (mut centre, mut gradient) = (Vec3::ZERO, [Vec3::ZERO; 3]);
        for (place, &node) in element.nodes.iter().enumerate() {
            let at = self.state.position[node].xyz();
            let share = (element_class.volumes[place] / element_class.volume) as f32;
            centre += at * share;
            let b = element_class.gradients[place].as_vec3();
            for i in 0..D::N {
                gradient[i] += b * (at[i] * scale);
            }
        }
        gradient
            .iter_mut()
            .enumerate()
            .skip(D::N)
            .for_each(|(k, row)| row[k] = 1.0);
        (centre, gradient)
    }

    /// Returns the rows of the elastic part F G of an element's deformation gradient F; G is the plastic
    /// inverse.
    pub(crate) fn elastic_part(&self, id: ElementId, element: &Element) -> [Vec3; 3] {
        let (_, gradient) = self.deformation(element);
        let Some(plastic_inverse) = self.state.batches.plastic_inverse(id) else {
            return gradient;
        };
        let column = |j: usize| {
            Vec3::new(
                plastic_inverse[0][j],
                plastic_inverse[1][j],
                plastic_inverse[2][j],
            )
        };
        gradient.map(|row| Vec3::from([0, 1, 2].map(|j: usize| row.dot(column(j)))))
    }

    /// Returns the affine motion of an element: a function that maps a point of the undeformed body, in
    /// voxels from the low corner of the grid, to its present position [m].
    pub(crate) fn affine_map(&self, element: &Element) -> impl Fn(Vec3) -> Vec3 + use<D> {
        let (centre, gradient) = self.deformation(element);
        let element_class = self.topology.mesh.element_class(element);
        let size = self.topology.grid.voxel_size();
        let half = 0.5 * size * element.cell.width() as f32;
        // `origin` is the offset [m], in the undeformed body, of the cell's low corner from the volume
        // centroid of the element.
        let steps = Vec3::from(slot_at(element_class.slots[0] as usize).map(|k| k as f32)) * half;
        let origin = element_class.offsets[0].as_vec3() * half - steps;
        let low = element.cell.first_voxel().map(|k| k as f32);
        move |point| {
            let mut rest = origin;
            for axis in 0..D::N {
                rest[axis] += (point[axis] - low[axis]) * size;
            }
            let mut carried = Vec3::ZERO;
            for axis in 0..D::N {
                carried[axis] = centre[axis] + gradient[axis].dot(rest);
            }
            carried
        }
    }

    /// Maps a position [m] back to the undeformed body by the motion of an element, to a point in voxels from
    /// the low corner of the grid. Inverse of [`SoftBody::affine_map`]. `None` if the element is flat.
    pub(crate) fn at_rest(&self, element: &Element, at: Vec3) -> Option<Vec3> {
        let element_class = self.topology.mesh.element_class(element);
        let size = self.topology.grid.voxel_size();
        let half = 0.5 * size * element.cell.width() as f32;
        let from_centroid = self.offset_at_rest(element, at)?;
        let corner = slot_at(element_class.slots[0] as usize);
        let mut place = Vec3::from(element.cell.first_voxel().map(|k| k as f32));
        for axis in 0..D::N {
            let from_corner = from_centroid[axis] / half - element_class.offsets[0][axis] as f32;
            place[axis] += (from_corner + corner[axis] as f32) * half / size;
        }
        Some(place)
    }

    /// Returns the weight of each node of an element at the point `at` of the undeformed body, in voxels from
    /// the low corner of the grid. Interpolation with these weights is exact for linear functions. An impulse
    /// at the point that is distributed with the weights therefore exerts the same torque.
    pub(crate) fn weights(&self, element: &Element, at: Vec3) -> Vec<(NodeId, f32)> {
        let element_class = self.topology.mesh.element_class(element);
        let half = 0.5 * element.cell.width() as f32;
        let corner = slot_at(element_class.slots[0] as usize);
        let low = element.cell.first_voxel();
        let mut rest = Vec3::ZERO;
        for axis in 0..D::N {
            let from_corner = (at[axis] - low[axis] as f32) / half - corner[axis] as f32;
            rest[axis] = from_corner + element_class.offsets[0][axis] as f32;
        }
        let scale = 1.0 / element_class.volume as f32;
        let weight = |place: usize| {
            let share = (element_class.volumes[place] / element_class.volume) as f32;
            share + scale * element_class.gradients[place].as_vec3().dot(rest)
        };
        let nodes = element.nodes.iter().enumerate();
        nodes.map(|(place, &node)| (node, weight(place))).collect()
    }

    /// Velocity [m/s] of a point of an element, interpolated between the nodes with `weights`, which
    /// [`SoftBody::weights`] returned for the point.
    pub(crate) fn velocity_of(&self, weights: &[(NodeId, f32)]) -> Vec3 {
        let share = |&(node, weight): &(NodeId, f32)| self.state.velocity[node] * weight;
        let velocity = weights.iter().map(share).sum::<Row>().xyz();
        match self.responses().is_empty() {
            true => velocity,
            false => velocity + self.response_velocity(weights),
        }
    }

    /// Maps a present position [m] to an offset [m] from the volume centroid of the undeformed element.
    /// `None` if the element is flat.
    fn offset_at_rest(&self, element: &Element, at: Vec3) -> Option<Vec3> {
        let (centre, undo) = self.inverse_deformation(element)?;
        Some(undo(at - centre))
    }

    /// Returns the volume centroid [m] of an element in its present shape, and the inverse of its deformation
    /// gradient. The inverse is a function that maps world-space vectors to vectors of the undeformed body.
    /// `None` if the element is flat.
    pub(crate) fn inverse_deformation(
        &self,
        element: &Element,
    ) -> Option<(Vec3, impl Fn(Vec3) -> Vec3 + use<D>)> {
        let (centre, [x, y, z]) = self.deformation(element);
        let volume = x.dot(y.cross(z));
        if volume.abs() < FLAT {
            return None;
        }
        // Inverts the deformation gradient by Cramer's rule.
        let columns = [y.cross(z), z.cross(x), x.cross(y)];
        let undo = move |way: Vec3| {
            let by = way * (1.0 / volume);
            let along = |axis: usize| (0..3).map(|k| columns[k][axis] * by[k]).sum();
            Vec3::from([0, 1, 2].map(along))
        };
        Some((centre, undo))
    }

    /// Returns the index of the child of an element's cell that contains a position [m]. `None` if the
    /// position is outside the cell, or if the element is flat.
    pub(crate) fn child_at(&self, element: &Element, at: Vec3) -> Option<usize> {
        let from_centroid = self.offset_at_rest(element, at)?;
        let child_width = 0.5 * self.topology.grid.voxel_size() * element.cell.width() as f32;
        let element_class = self.topology.mesh.element_class(element);
        let corner = slot_at(element_class.slots[0] as usize);
        let mut child = 0;
        for axis in 0..D::N {
            let from_corner =
                from_centroid[axis] / child_width - element_class.offsets[0][axis] as f32;
            let along = from_corner + corner[axis] as f32;
            if !(0.0..=2.0).contains(&along) {
                return None;
            }
            child |= usize::from(along > 1.0) << axis;
        }
        Some(child)
    }
}

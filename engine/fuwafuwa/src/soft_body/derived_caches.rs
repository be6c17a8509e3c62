//! Data that a body derives from its mesh, initially and after releases.

use super::SoftBody;
use super::body_topology::Topology;
use crate::foundation::dim::{Dim, Point};
use crate::foundation::ids::NodeId;
use crate::material::Material;

impl<D: Dim> SoftBody<D> {
    pub(crate) fn make_room(&mut self) {
        let Self {
            topology,
            state,
            cache,
        } = self;
        state.make_room(topology.mesh.node_capacity());
        cache
            .exposed_faces
            .edit()
            .resize(topology.mesh.element_capacity(), 0);
        cache
            .connected_voxels
            .edit()
            .resize(topology.mesh.element_capacity(), 0);
        topology.pieces.make_room(&topology.mesh);
    }

    /// Fixes a new node if all nodes from which its state is interpolated are fixed.
    pub(crate) fn inherit_hold(&mut self, node: NodeId, from: &[(NodeId, f64)]) {
        self.state.fixed[node] = from.iter().all(|&(old, _)| self.state.fixed[old]);
    }

    /// Recomputes the masses and the inverse masses of nodes.
    pub(crate) fn weigh(&mut self, nodes: &[NodeId]) {
        for &id in nodes {
            self.state.mass[id] = self.mass_of(id);
            self.state.inverse_mass[id] = self.inverse_mass_of(id);
        }
    }

    /// Mass of a node [kg], summed over the elements that carry it.
    pub(super) fn mass_of(&self, id: NodeId) -> f32 {
        self.sum_over_carriers(id, &|material| f64::from(material.density)) as f32
    }

    /// Sums a quantity per volume over the part of the body whose mass a node carries. `density` returns the
    /// quantity per volume of a material.
    pub(super) fn sum_over_carriers(&self, id: NodeId, density: &dyn Fn(&Material) -> f64) -> f64 {
        let half = f64::from(self.topology.grid.voxel_size()) * 0.5;
        let mut sum = 0.0;
        for (element, place) in self.topology.mesh.carriers_of(id) {
            let density = density(self.material(element));
            let child = half * f64::from(element.cell.width());
            let volume = (0..D::N).fold(1.0, |volume, _| volume * child);
            sum += density * volume * self.topology.mesh.element_class(element).volumes[place];
        }
        sum
    }

    /// Inverse mass of a node [1/kg] for the motion of the node alone, which the mass scale of the body makes
    /// heavier; 0 while the node is fixed or sleeps.
    pub(super) fn inverse_mass_of(&self, id: NodeId) -> f32 {
        let free = !self.state.fixed[id] && !self.topology.pieces.sleeps(id);
        match free {
            true => scaled_inverse(self.state.mass[id], self.topology.mass_scale),
            false => 0.0,
        }
    }

    /// Updates the exposed faces of the level-0 elements that fill some of the given voxels.
    pub(crate) fn expose(&mut self, voxels: &[Point]) {
        for &voxel in voxels
            .iter()
            .filter(|&&voxel| self.topology.grid.is_present(voxel))
        {
            let owner = self
                .topology
                .mesh
                .owner(voxel)
                .expect("every remaining voxel has an owner");
            let element = self.topology.mesh.element(owner).expect("owners are alive");
            if element.cell.level > 0 {
                continue;
            }
            // Lattice point at the low corner of the voxel. Seen from this point, the voxel is on the high
            // side along every axis, that is, in the last octant.
            let (around, octant) = (self.topology.connectivity.around(voxel), D::CORNERS - 1);
            let mut exposed_faces = 0;
            for axis in 0..D::N {
                exposed_faces |= u8::from(!around.is_closed(octant, axis)) << (2 * axis);
                exposed_faces |=
                    u8::from(!around.is_far_face_closed(octant, axis)) << (2 * axis + 1);
            }
            self.cache.exposed_faces.edit()[owner] = exposed_faces;
            if exposed_faces != 0 {
                self.cache.connected_voxels.edit()[owner] =
                    self.topology.connectivity.connected_voxels(voxel);
            }
        }
    }

    /// Updates the breakable nodes of the body after changes around `nodes`.
    pub(crate) fn find_breakable(&mut self, nodes: &[NodeId]) {
        let Topology {
            grid,
            connectivity,
            mesh,
            materials,
            ..
        } = &self.topology;
        let breakable = self.cache.breakable.edit();
        breakable.update(nodes, grid, connectivity, mesh, materials);
    }
}

/// Returns 1 / (`mass` · `mass_scale`) [1/kg].
pub(super) fn scaled_inverse(mass: f32, mass_scale: f64) -> f32 {
    (1.0 / (f64::from(mass) * mass_scale)) as f32
}

//! What a body works out from its mesh, in the beginning and where a release changed something.

use super::Body;
use crate::dim::{Dim, Point};

impl<D: Dim> Body<D> {
    pub(crate) fn make_room(&mut self) {
        let capacity = self.mesh.node_capacity();
        self.position.resize(capacity, [0.0; 4]);
        self.ahead.resize(capacity, [0.0; 4]);
        self.velocity.resize(capacity, [0.0; 4]);
        self.mass.resize(capacity, 0.0);
        self.inverse_mass.resize(capacity, 0.0);
        self.held.resize(capacity, false);
        self.damage.resize(capacity, 0.0);
        self.bare.resize(self.mesh.element_capacity(), 0);
        self.bound.resize(self.mesh.element_capacity(), 0);
        self.pieces.make_room(&self.mesh);
    }

    /// A new node is held when every node it comes from was.
    pub(crate) fn inherit_hold(&mut self, node: u32, from: &[(u32, f64)]) {
        self.held[node as usize] = from.iter().all(|&(old, _)| self.held[old as usize]);
    }

    /// Adds up the masses of nodes from the elements that carry them.
    pub(crate) fn weigh(&mut self, nodes: &[u32]) {
        let half = f64::from(self.grid.voxel_size()) * 0.5;
        for &id in nodes {
            let mut mass = 0.0;
            for (element, place) in self.mesh.carriers_of(id) {
                let density = f64::from(self.material(element).density);
                let child = half * f64::from(element.cell.width());
                let volume = (0..D::N).fold(1.0, |volume, _| volume * child);
                mass += density * volume * self.mesh.stencil(element).volumes[place];
            }
            let node = id as usize;
            self.mass[node] = mass as f32;
            let free = !self.held[node] && !self.pieces.sleeps(id);
            self.inverse_mass[node] = if free { 1.0 / self.mass[node] } else { 0.0 };
        }
    }

    /// Notes which faces of the elements of level 0 on these voxels are bare.
    pub(crate) fn expose(&mut self, voxels: &[Point]) {
        for &voxel in voxels.iter().filter(|&&voxel| self.grid.is_solid(voxel)) {
            let owner = self.mesh.owner(voxel).expect("a solid voxel has an owner");
            let element = self.mesh.element(owner).expect("owners are alive");
            if element.cell.level > 0 {
                continue;
            }
            // Seen from its low corner, the voxel stands on the far side of every axis.
            let (around, octant) = (self.sharing.around(voxel), D::CORNERS - 1);
            let mut bare = 0;
            for axis in 0..D::N {
                bare |= u8::from(!around.is_closed(octant, axis)) << (2 * axis);
                bare |= u8::from(!around.is_far_face_closed(octant, axis)) << (2 * axis + 1);
            }
            self.bare[owner as usize] = bare;
            if bare != 0 {
                self.bound[owner as usize] = self.sharing.bound(voxel);
            }
        }
    }

    /// Looks again which of `nodes` are breakable nodes.
    pub(crate) fn find_breakable(&mut self, nodes: &[u32]) {
        let Self {
            grid,
            sharing,
            mesh,
            materials,
            ..
        } = self;
        self.breakable.look(nodes, grid, sharing, mesh, materials);
    }
}

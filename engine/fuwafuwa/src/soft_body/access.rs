//! Access to the state of bodies, for contacts, fracture and the world.

use super::SoftBody;
use super::body_topology::Topology;
use super::cooldowns::Cooldowns;
use crate::foundation::dim::{Dim, Point};
use crate::foundation::ids::{ElementId, IndexVec, NodeId};
use crate::fracture::breakable_nodes::BreakableNodes;
use crate::fracture::tip_deviations::TipDeviations;
use crate::rigid_body::layers::Layers;
use crate::soft_body::element_forces::{ElementBatches, Row};
use crate::topology::changes::History;
use crate::topology::pieces::Pieces;

impl<D: Dim> SoftBody<D> {
    /// Returns the velocity of each node [m/s], by id.
    #[inline(always)]
    pub(crate) fn velocities(&self) -> &IndexVec<NodeId, Row> {
        &self.state.velocity
    }

    #[inline(always)]
    pub(crate) fn velocities_mut(&mut self) -> &mut IndexVec<NodeId, Row> {
        &mut self.state.velocity
    }

    #[cfg(test)]
    pub(crate) fn positions_mut(&mut self) -> &mut IndexVec<NodeId, Row> {
        &mut self.state.position
    }

    /// Returns the mass of each node [kg], by id.
    #[inline(always)]
    pub(crate) fn masses(&self) -> &IndexVec<NodeId, f32> {
        &self.state.mass
    }

    /// Returns the inverse mass of each node [1/kg], by id; 0 while the node is fixed or sleeps.
    #[inline(always)]
    pub(crate) fn inverse_masses(&self) -> &IndexVec<NodeId, f32> {
        &self.state.inverse_mass
    }

    /// Returns the ids of the nodes of awake pieces, ascending.
    #[inline(always)]
    pub(crate) fn awake_nodes(&self) -> &[NodeId] {
        &self.cache.awake
    }

    #[inline(always)]
    pub(crate) fn pieces_mut(&mut self) -> &mut Pieces {
        &mut self.topology.pieces
    }

    /// Returns the mask of the exposed faces of an element, with bit 2 · axis + side (0 = low, 1 = high), or
    /// `None` if the id was never used. Valid only for elements of level 0; the mask of a larger element may
    /// be outdated.
    #[inline(always)]
    pub(crate) fn exposed_faces(&self, element: ElementId) -> Option<u8> {
        self.cache.exposed_faces.get(element.index()).copied()
    }

    /// Returns the mask of the voxels around an element that share a node with the element, with the bits of
    /// [`Connectivity::connected_voxels`](crate::topology::connectivity::Connectivity::connected_voxels).
    /// Valid only if the element has exposed faces.
    #[inline(always)]
    pub(crate) fn connected_voxels(&self, element: ElementId) -> u32 {
        self.cache.connected_voxels[element]
    }

    /// Returns the batches of all elements, with their rotations and their forces.
    #[inline(always)]
    pub(crate) fn element_forces(&self) -> &ElementBatches<D> {
        &self.state.batches
    }

    /// Returns the nodes at which a crack can start or continue.
    #[inline(always)]
    pub(crate) fn breakable_nodes(&self) -> &BreakableNodes {
        &self.cache.breakable
    }

    /// Returns the damage of each node, by id: 0 = intact, 1 = split.
    pub(crate) fn damage_mut(&mut self) -> &mut IndexVec<NodeId, f32> {
        &mut self.state.damage
    }

    #[inline(always)]
    pub(crate) fn cooldowns(&self) -> &Cooldowns {
        &self.state.cooldowns
    }

    pub(crate) fn cooldowns_mut(&mut self) -> &mut Cooldowns {
        &mut self.state.cooldowns
    }

    #[inline(always)]
    pub(crate) fn tip_deviations(&self) -> &TipDeviations {
        &self.state.tip_deviations
    }

    pub(crate) fn tip_deviations_mut(&mut self) -> &mut TipDeviations {
        &mut self.state.tip_deviations
    }

    /// Returns whether a node at a lattice point is a crack tip.
    pub(crate) fn has_tip(&self, at: Point) -> bool {
        let Topology {
            connectivity, mesh, ..
        } = &self.topology;
        let mut nodes = mesh.nodes_at(at, connectivity);
        nodes.any(|id| self.cache.breakable.is_tip(id))
    }

    /// Removes the deviations at the lattice points of `nodes` that are no longer crack tips.
    pub(crate) fn forget_former_tips(&mut self, nodes: &[NodeId]) {
        let mut deviations = std::mem::take(&mut self.state.tip_deviations);
        let points = nodes.iter().map(|&id| self.topology.mesh.node(id).at);
        deviations.keep_tips(points, |at| self.has_tip(at));
        self.state.tip_deviations = deviations;
    }

    pub(crate) fn set_layers(&mut self, layers: Layers) {
        self.state.layers = layers;
    }

    pub(crate) fn set_user_data(&mut self, user_data: u64) {
        self.state.user_data = user_data;
    }

    pub(crate) fn set_gravity_scale(&mut self, gravity_scale: f32) {
        self.state.gravity_scale = gravity_scale;
    }

    /// Clears the history of changes, so that all bookmarks become invalid.
    pub(crate) fn forget_history(&mut self) {
        self.cache.history = History::default();
    }
}

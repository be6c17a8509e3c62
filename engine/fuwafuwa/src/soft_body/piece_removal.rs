//! Removal of pieces from a body: voxels, connectivity, cells, elements and nodes.
//!
//! A piece shares no node with other pieces. Therefore the remaining pieces keep their elements, nodes,
//! numbers, masses and motion.

use crate::foundation::dim::{Dim, Point};
use crate::foundation::ids::{ElementId, PieceId};
use crate::soft_body::SoftBody;
use crate::topology::changes::Changes;

impl<D: Dim> SoftBody<D> {
    /// Returns whether the body has a piece with this number that was not removed.
    pub fn has_piece(&self, piece: PieceId) -> bool {
        let piece = self.topology.pieces.list.get(piece.index());
        piece.is_some_and(|piece| !piece.removed)
    }

    /// Removes pieces, given in ascending order. At least one of them must not have been removed before.
    /// Returns all changes of the body.
    pub(crate) fn remove_pieces(&mut self, pieces: &[PieceId]) -> Changes {
        let topology = &mut self.topology;
        let of_element = |id: &ElementId| topology.pieces.of_element(*id);
        let elements = topology.mesh.elements().map(|(id, _)| id);
        let elements: Vec<ElementId> = elements
            .filter(|id| pieces.binary_search(&of_element(id)).is_ok())
            .collect();
        let own = elements.iter().filter_map(|&id| topology.mesh.element(id));
        let voxels = own.flat_map(|element| topology.mesh.voxels(element));
        let voxels: Vec<Point> = voxels.collect();
        topology.grid.edit().remove_voxels(&voxels);
        topology.connectivity.edit().remove_voxels(&voxels);
        topology
            .hierarchy
            .edit()
            .remove_voxels(&topology.grid, &topology.connectivity, &voxels);
        let nodes = topology
            .mesh
            .edit()
            .remove_elements(&topology.connectivity, &elements);
        for &piece in pieces {
            let piece = &mut topology.pieces.list[piece];
            // A removed piece is also marked as asleep, so that no code treats it as moving.
            (piece.removed, piece.asleep) = (true, true);
        }
        let batches = &mut self.state.batches;
        batches.update(&topology.mesh, &topology.grid, &elements, &[], |_| false);
        self.find_breakable(&nodes);
        self.forget_former_tips(&nodes);
        self.cache.awake_is_stale = true;
        self.refresh_awake();
        let changes = Changes {
            nodes,
            elements,
            detached: Vec::new(),
            removed: pieces.to_vec(),
        };
        let most = self.topology.mesh.element_capacity();
        self.cache.history.add(&changes, most);
        changes
    }
}

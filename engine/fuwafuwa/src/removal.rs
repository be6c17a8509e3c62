//! What it does to a body that some of its pieces are taken out of it: voxels, connections, cells, elements, nodes.
//!
//! A piece shares no node with the rest, so nothing of the rest changes but who is beyond the crack: its elements and
//! nodes keep their numbers, their places, their masses and their motion.

use crate::body::Body;
use crate::changes::Changes;
use crate::dim::{Dim, Point};
use crate::ids::{ElementId, PieceId};

impl<D: Dim> Body<D> {
    /// Whether it has a piece of this number that is still there.
    pub fn has_piece(&self, piece: PieceId) -> bool {
        let piece = self.truth.pieces.list.get(piece.index());
        piece.is_some_and(|piece| !piece.removed)
    }

    /// Takes pieces out, given in ascending order, of which one at least is left; tells all that it changed.
    pub(crate) fn take_out(&mut self, pieces: &[PieceId]) -> Changes {
        let truth = &mut self.truth;
        let of_element = |id: &ElementId| truth.pieces.of_element(*id);
        let elements = truth.mesh.elements().map(|(id, _)| id);
        let elements: Vec<ElementId> = elements
            .filter(|id| pieces.binary_search(&of_element(id)).is_ok())
            .collect();
        let own = elements.iter().filter_map(|&id| truth.mesh.element(id));
        let voxels = own.flat_map(|element| truth.mesh.voxels(element));
        let voxels: Vec<Point> = voxels.collect();
        truth.grid.take_out(&voxels);
        truth.sharing.take_out(&voxels);
        truth.pyramid.take_out(&truth.grid, &truth.sharing, &voxels);
        let nodes = truth.mesh.take_out(&truth.sharing, &elements);
        for &piece in pieces {
            let piece = &mut truth.pieces.list[piece];
            // Nobody waits for it to come to rest.
            (piece.removed, piece.asleep) = (true, true);
        }
        let blocks = &mut self.state.blocks;
        blocks.update(&truth.mesh, &truth.grid, &elements, &[], |_| false);
        self.find_breakable(&nodes);
        self.cache.awake_is_stale = true;
        self.refresh_awake();
        let changes = Changes {
            nodes,
            elements,
            parted: Vec::new(),
            removed: pieces.to_vec(),
        };
        let most = self.truth.mesh.element_capacity();
        self.cache.history.add(&changes, most);
        changes
    }
}

//! What is worked out from the truth and the state of a body, and kept so that it need not be again.

use super::blend::Blend;
use crate::breakable::BreakableNodes;
use crate::changes::History;
use crate::dim::Point;
use crate::ids::{ElementId, NodeId, PieceId, Table};
use crate::momentum::RoughMotion;
use crate::solve::Row;

/// What is worked out from the truth and the state of a body, and kept so that it need not be again. No
/// snapshot has it: `Body::rebuild` makes it anew, and each tick begins by noting what was `before`.
#[derive(Clone, Debug, Default)]
pub struct Cache {
    /// What its materials come to as a whole.
    pub blend: Blend,
    /// The nodes that move, ascending; stale after a remodelling.
    pub awake: Vec<NodeId>,
    pub awake_is_stale: bool,
    /// Nodes where a crack can start or go on, and what they bear.
    pub breakable: BreakableNodes,
    /// Which faces of an element of level 0 are bare: bit 2 · axis + side.
    pub bare: Table<ElementId, u8>,
    /// Of those with bare faces, the voxels around that share a node: see [`Sharing::bound`].
    ///
    /// [`Sharing::bound`]: crate::sharing::Sharing::bound
    pub bound: Table<ElementId, u32>,
    /// What tears changed lately.
    pub history: History,
    /// The rigid motion of each piece, as of the last round of damping: every tick begins with one.
    pub rigid: Table<PieceId, RoughMotion>,
    /// The lattice point and the position [m] of every node, by id, as the tick began; no position where there was none.
    pub before: Vec<(Point, Row)>,
}

//! Data derived from the topology and the state of a body.

use super::body_properties::BodyProperties;
use crate::foundation::copy_on_write::CopyOnWrite;
use crate::foundation::dim::Point;
use crate::foundation::ids::{ElementId, IndexVec, NodeId, PieceId};
use crate::fracture::breakable_nodes::BreakableNodes;
use crate::soft_body::element_forces::Row;
use crate::soft_body::fast_motion::Pace;
use crate::soft_body::momentum::RigidMotionF32;
use crate::soft_body::piece_response::PieceResponse;
use crate::soft_body::skin_point::SkinPoint;
use crate::topology::changes::History;
use crate::topology::skin::Skin;
use std::sync::Arc;

/// Data derived from the topology and the state of a body. Snapshots do not contain these data.
/// `SoftBody::rebuild` recomputes them after loading, except the last six fields: `history` starts empty,
/// each tick begins by setting `rigid`, `before` and `fastest`, and ends by clearing `paces`; each substep begins
/// by setting `responses`.
#[derive(Clone, Debug, Default)]
pub struct Cache {
    /// Properties of the body, combined from its materials.
    pub properties: BodyProperties,
    /// Nodes of awake pieces, ascending; outdated while `awake_is_stale`.
    pub awake: Vec<NodeId>,
    /// Whether `awake` must be recomputed before use.
    pub awake_is_stale: bool,
    /// Mass damping of each node [1/s], by id; empty if all materials in use have the same.
    pub mass_damping: CopyOnWrite<IndexVec<NodeId, f32>>,
    /// Nodes at which a crack can start or continue, with their possible cuts and limits.
    pub breakable: CopyOnWrite<BreakableNodes>,
    /// Mask of the exposed faces of each level-0 element: bit 2 · axis + side (0 = low, 1 = high).
    pub exposed_faces: CopyOnWrite<IndexVec<ElementId, u8>>,
    /// For each element with exposed faces, mask of the voxels around the element that share a node with the
    /// element; see
    /// [`Connectivity::connected_voxels`](crate::topology::connectivity::Connectivity::connected_voxels).
    pub connected_voxels: CopyOnWrite<IndexVec<ElementId, u32>>,
    /// Smooth surface of the voxels. It stays the same after cracks.
    pub skin: Arc<Skin>,
    /// Point of the smooth surface of each node, by id.
    pub skin_points: CopyOnWrite<IndexVec<NodeId, SkinPoint>>,
    /// History of recent cracks and removals, which callers read through bookmarks.
    pub history: History,
    /// Rigid motion of each piece at the last damping round, relative to which positions are extrapolated.
    /// Every tick begins with a damping round.
    pub rigid: IndexVec<PieceId, RigidMotionF32>,
    /// Lattice point and position [m] of every node at the start of the tick, by id. The position of an
    /// unused id is NaN.
    pub before: Vec<(Point, Row)>,
    /// Highest speed at which a node moved in the last substep [m/s]; infinite at the start of a tick.
    pub fastest: f32,
    /// Paces of the pieces; empty if the body is not fast.
    pub paces: Vec<Pace>,
    /// Responses of the pieces in this substep; empty in a body without a mass scale.
    pub responses: IndexVec<PieceId, PieceResponse>,
}

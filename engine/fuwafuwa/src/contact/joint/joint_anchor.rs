//! Attachment points and kinds of joints.

use crate::foundation::arena::{BodySlot, RigidBodyHandle, RigidSlot, SoftBodyHandle};
use crate::foundation::hash::hash_state;
use crate::foundation::ids::PieceId;
use crate::rigid_body::shape::Vector;

/// Attachment point of a joint. Positions are world-space positions at the time when the joint is added.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum JointAnchor {
    /// Point of the world [m].
    Position(Vector),
    /// Point of a rigid body, on its surface or elsewhere.
    RigidBody {
        /// Handle of the rigid body.
        rigid: RigidBodyHandle,
        /// Position [m].
        at: Vector,
    },
    /// Mean of some nodes of a soft body.
    Soft {
        /// Handle of the body.
        body: SoftBodyHandle,
        /// Position [m].
        at: Vector,
        /// Radius within which nodes are attached [m], or the nearest node if it contains none. With more
        /// nodes a pull tears off less.
        radius: f32,
    },
}

hash_state! { enum JointAnchor { Position(at), RigidBody { rigid, at }, Soft { body, at, radius } } }

/// Kind of a joint.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum JointKind {
    /// Pin: keeps the anchors together and lets them rotate. A soft anchor that is pinned to a rigid body or
    /// a point is held where it is; other anchors that are apart are drawn together.
    Pin,
    /// Spring with a rest length.
    Spring {
        /// Stiffness [N/m], positive.
        stiffness: f32,
        /// Damping [N s/m], 0 or more.
        damping: f32,
        /// Rest length [m], 0 or more.
        length: f32,
    },
    /// Rope: limits the distance of the anchors.
    Rope {
        /// Maximum distance [m], positive.
        length: f32,
    },
}

hash_state! { enum JointKind { Pin, Spring { stiffness, damping, length }, Rope { length } } }

/// Sleepers to wake because the other anchor of their joint moves.
#[derive(Debug, Default)]
pub(crate) struct Woken {
    pub(crate) pieces: Vec<(BodySlot, PieceId)>,
    pub(crate) rigids: Vec<RigidSlot>,
}

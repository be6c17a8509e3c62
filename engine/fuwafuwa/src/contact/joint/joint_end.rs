//! Attachment points of joints in three coordinates.

use crate::foundation::arena::{BodySlot, RigidBodyHandle, RigidSlot, SoftBodyHandle};
use crate::foundation::hash::hash_state;
use crate::foundation::ids::PieceId;
use glam::Vec3;

/// [`JointAnchor`](super::JointAnchor) in three coordinates.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum JointEnd {
    Position(Vec3),
    RigidBody {
        rigid: RigidBodyHandle,
        at: Vec3,
    },
    Soft {
        body: SoftBodyHandle,
        at: Vec3,
        radius: f32,
    },
}

hash_state! { enum JointEnd { Position(at), RigidBody { rigid, at }, Soft { body, at, radius } } }

/// Sleepers to wake because the other anchor of their joint moves.
#[derive(Debug, Default)]
pub(crate) struct Woken {
    pub(crate) pieces: Vec<(BodySlot, PieceId)>,
    pub(crate) rigids: Vec<RigidSlot>,
}

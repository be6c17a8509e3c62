//! Attachment points of joints, with vectors of three coordinates in 2D and in 3D.

use crate::foundation::arena::{BodySlot, RigidBodyHandle, RigidSlot, SoftBodyHandle};
use crate::foundation::hash::hash_state;
use crate::foundation::ids::PieceId;
use glam::Vec3;

/// Internal counterpart of [`JointAnchor`](super::JointAnchor); the third coordinate is 0 in 2D.
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

/// Sleeping pieces and rigid bodies to wake, because one of their joints is strained or the joint's other
/// anchor moves.
#[derive(Debug, Default)]
pub(crate) struct Woken {
    pub(crate) pieces: Vec<(BodySlot, PieceId)>,
    pub(crate) rigids: Vec<RigidSlot>,
}

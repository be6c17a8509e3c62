//! References to the objects of a world.

use crate::foundation::arena::{RigidBodyHandle, SoftBodyHandle};
use crate::foundation::hash::hash_state;
use crate::foundation::ids::PieceId;
use crate::world::BodyHandle;

/// Object that takes part in contacts, sensor overlaps and queries: a piece of a soft body, or a rigid body.
///
/// All pieces precede all rigid bodies. Pieces are ordered by body handle, then by piece number; rigid bodies
/// by handle. The reference of a rigid body does not contain its [`MotionType`](crate::MotionType);
/// `world.rigid_body(handle)?.motion_type()` returns it.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ObjectRef {
    /// Piece of a soft body.
    Piece {
        /// Handle of the soft body that the piece belongs to.
        body: SoftBodyHandle,
        /// Number of the piece within the body.
        piece: PieceId,
    },
    /// Rigid body.
    RigidBody(RigidBodyHandle),
}

hash_state! { enum ObjectRef { Piece { body, piece }, RigidBody(rigid) } }

impl ObjectRef {
    /// Returns the handle of a rigid body, or `None` for a piece.
    pub fn rigid_body(self) -> Option<RigidBodyHandle> {
        match self {
            Self::RigidBody(rigid) => Some(rigid),
            Self::Piece { .. } => None,
        }
    }

    /// Returns the handle of the soft body of a piece, or `None` for a rigid body.
    pub fn soft_body(self) -> Option<SoftBodyHandle> {
        match self {
            Self::Piece { body, .. } => Some(body),
            Self::RigidBody(_) => None,
        }
    }

    /// Returns the number of a piece, or `None` for a rigid body.
    pub fn piece(self) -> Option<PieceId> {
        match self {
            Self::Piece { piece, .. } => Some(piece),
            Self::RigidBody(_) => None,
        }
    }
}

impl From<RigidBodyHandle> for ObjectRef {
    fn from(rigid: RigidBodyHandle) -> Self {
        Self::RigidBody(rigid)
    }
}

/// Converts a piece to the handle of its soft body, and a rigid body to its own handle.
impl From<ObjectRef> for BodyHandle {
    fn from(object: ObjectRef) -> Self {
        match object {
            ObjectRef::Piece { body, .. } => Self::Soft(body),
            ObjectRef::RigidBody(rigid) => Self::Rigid(rigid),
        }
    }
}

/// Selection of objects: a rigid body, one piece of a soft body, or all pieces of a soft body. Handles and
/// [`ObjectRef`] convert into it.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash)]
pub enum ObjectSelector {
    /// All pieces of a soft body.
    SoftBody(SoftBodyHandle),
    /// A rigid body, or one piece of a soft body.
    Object(ObjectRef),
}

impl ObjectSelector {
    /// Returns whether the selection contains an object.
    pub fn contains(self, object: ObjectRef) -> bool {
        match self {
            Self::SoftBody(body) => object.soft_body() == Some(body),
            Self::Object(own) => own == object,
        }
    }
}

impl From<SoftBodyHandle> for ObjectSelector {
    fn from(body: SoftBodyHandle) -> Self {
        Self::SoftBody(body)
    }
}

impl From<RigidBodyHandle> for ObjectSelector {
    fn from(rigid: RigidBodyHandle) -> Self {
        Self::Object(rigid.into())
    }
}

impl From<BodyHandle> for ObjectSelector {
    fn from(body: BodyHandle) -> Self {
        match body {
            BodyHandle::Soft(body) => body.into(),
            BodyHandle::Rigid(rigid) => rigid.into(),
        }
    }
}

impl From<ObjectRef> for ObjectSelector {
    fn from(object: ObjectRef) -> Self {
        Self::Object(object)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::arena::Arena;

    #[test]
    fn selector_of_soft_body_contains_each_of_its_pieces_only() {
        let mut bodies = Arena::<SoftBodyHandle, ()>::default();
        let [body, other] = [(), ()].map(|()| bodies.insert(()));
        let rigid = Arena::<RigidBodyHandle, ()>::default().insert(());
        let piece = |body, piece| ObjectRef::Piece {
            body,
            piece: PieceId(piece),
        };
        let whole = ObjectSelector::from(body);
        assert!(whole.contains(piece(body, 0)) && whole.contains(piece(body, 3)));
        assert!(!whole.contains(piece(other, 0)) && !whole.contains(rigid.into()));
        let one = ObjectSelector::from(piece(body, 3));
        assert!(one.contains(piece(body, 3)) && !one.contains(piece(body, 0)));
        assert!(ObjectSelector::from(rigid).contains(ObjectRef::RigidBody(rigid)));
        assert!(piece(other, 9) < ObjectRef::RigidBody(rigid));
    }
}

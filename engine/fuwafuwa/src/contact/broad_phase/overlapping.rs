//! Pairs of objects without contacts, because they were placed inside each other.

use super::contact_sphere::ContactSphere;
use crate::foundation::arena::{BodySlot, RigidSlot};
use crate::foundation::ids::PieceId;
use crate::object_ref::ObjectRef;

/// Piece: body and piece number.
type PieceKey = (BodySlot, PieceId);

/// Pairs of overlapping objects in this tick, which the world moves apart. They have no contacts.
#[derive(Clone, Debug, Default)]
pub struct Overlapping {
    /// Pairs of pieces, ascending.
    soft: Vec<[PieceKey; 2]>,
    /// Pairs of a piece and a rigid body, ascending.
    rigid: Vec<(PieceKey, RigidSlot)>,
}

impl Overlapping {
    /// Adds a pair. Pairs must be added in ascending order.
    pub fn add(&mut self, [first, second]: [ObjectRef; 2]) {
        let key = |object: ObjectRef| Some((object.soft_body()?.slot(), object.piece()?));
        match (key(first), key(second), second.rigid_body()) {
            (Some(first), Some(second), _) => self.soft.push([first, second]),
            (Some(first), None, Some(rigid)) => self.rigid.push((first, rigid.slot())),
            _ => {}
        }
    }

    /// Returns whether there is no pair.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.soft.is_empty() && self.rigid.is_empty()
    }

    /// Returns whether the pieces of two contact spheres overlap.
    pub fn has_spheres(&self, both: [&ContactSphere; 2]) -> bool {
        let [a, b] = both.map(|sphere| (sphere.body, sphere.piece));
        self.soft.contains(&[a, b]) || self.soft.contains(&[b, a])
    }

    /// Returns whether a piece and a rigid body overlap.
    pub fn has_rigid(&self, piece: PieceKey, rigid: RigidSlot) -> bool {
        self.rigid.contains(&(piece, rigid))
    }

    /// Iterates over the overlapping pieces. A piece may occur several times.
    pub fn pieces(&self) -> impl Iterator<Item = PieceKey> + '_ {
        let soft = self.soft.iter().flatten().copied();
        soft.chain(self.rigid.iter().map(|&(piece, _)| piece))
    }

    /// Iterates over the overlapping rigid bodies. A body may occur several times.
    pub fn rigids(&self) -> impl Iterator<Item = RigidSlot> + '_ {
        self.rigid.iter().map(|&(_, rigid)| rigid)
    }
}

//! Handles of soft and rigid bodies as one type, and removal by handle.

use super::{Grip, World};
use crate::contact::joint::Joint;
use crate::error::Error;
use crate::foundation::arena::{
    GripHandle, Handle, JointHandle, KnifeHandle, RigidBodyHandle, SoftBodyHandle,
};
use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::fracture::knife::Knife;
use crate::rigid_body::RigidBody;
use crate::soft_body::SoftBody;

/// Handle of a soft body or a rigid body. Methods that act on both kinds accept the handle of either.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum BodyHandle {
    /// Handle of a soft body.
    Soft(SoftBodyHandle),
    /// Handle of a rigid body.
    Rigid(RigidBodyHandle),
}

hash_state! { enum BodyHandle { Soft(body), Rigid(rigid) } }

impl From<SoftBodyHandle> for BodyHandle {
    fn from(body: SoftBodyHandle) -> Self {
        Self::Soft(body)
    }
}

impl From<RigidBodyHandle> for BodyHandle {
    fn from(rigid: RigidBodyHandle) -> Self {
        Self::Rigid(rigid)
    }
}

/// Handle of an item that [`World::remove`] can remove: a soft body, a rigid body, a joint, a knife or a grip.
pub trait Removable<D: Dim>: Handle {
    /// Type that [`World::remove`] returns for a handle of this type.
    type Item;

    #[doc(hidden)]
    fn remove_from(self, world: &mut World<D>) -> Result<Self::Item, Error>;
}

impl<D: Dim> Removable<D> for SoftBodyHandle {
    type Item = SoftBody<D>;

    fn remove_from(self, world: &mut World<D>) -> Result<SoftBody<D>, Error> {
        world.remove_soft_body(self)
    }
}

impl<D: Dim> Removable<D> for RigidBodyHandle {
    type Item = RigidBody<D>;

    fn remove_from(self, world: &mut World<D>) -> Result<RigidBody<D>, Error> {
        world.remove_rigid_body(self)
    }
}

impl<D: Dim> Removable<D> for JointHandle {
    type Item = Joint<D>;

    fn remove_from(self, world: &mut World<D>) -> Result<Joint<D>, Error> {
        world.remove_joint(self)
    }
}

impl<D: Dim> Removable<D> for KnifeHandle {
    type Item = Knife<D>;

    fn remove_from(self, world: &mut World<D>) -> Result<Knife<D>, Error> {
        world.remove_knife(self)
    }
}

impl<D: Dim> Removable<D> for GripHandle {
    type Item = Grip<D>;

    fn remove_from(self, world: &mut World<D>) -> Result<Grip<D>, Error> {
        world.remove_grip(self)
    }
}

impl<D: Dim> World<D> {
    /// Removes a soft body, a rigid body, a joint, a knife or a grip, and returns it. All other objects keep their
    /// handles and state, except that some wake: sleeping objects in contact with a removed body, and the
    /// bodies of a removed joint or grip. The rigid body that holds a removed knife stays.
    ///
    /// A rigid body, a joint, a knife or a grip is returned as its definition, which can be added again under a new
    /// handle. The definition of a joint contains the anchor positions at which the joint was added.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn remove<H: Removable<D>>(&mut self, handle: H) -> Result<H::Item, Error> {
        handle.remove_from(self)
    }
}

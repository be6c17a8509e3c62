//! Joints of a world: insertion, removal, access.

use super::World;
use crate::contact::joint::{Joint, JointAnchor, Joints};
use crate::error::Error;
use crate::event::Event;
use crate::foundation::arena::JointHandle;
use crate::foundation::dim::Dim;
use crate::rigid_body::shape::Vector;

impl<D: Dim> World<D> {
    /// Adds a joint between two anchors at their present positions. Both attached bodies wake.
    ///
    /// # Errors
    /// [`Error`] if a handle is stale or a parameter is out of range.
    #[inline(never)]
    pub fn add_joint(&mut self, mut joint: Joint) -> Result<JointHandle, Error> {
        joint.check()?;
        joint.hold(&self.bodies, &self.rigids)?;
        self.wake_ends(&joint);
        Ok(self.joints.insert(joint))
    }

    /// Removes a joint, see [`World::remove`].
    #[inline(never)]
    pub(crate) fn remove_joint(&mut self, joint: JointHandle) -> Result<Joint, Error> {
        let joint = self.joints.remove(joint)?;
        self.wake_ends(&joint);
        Ok(joint)
    }

    /// Returns the joints.
    pub fn joints(&self) -> &Joints {
        &self.joints
    }

    /// Returns the world-space positions of both anchors of a joint [m]. `None` if an attached body is gone,
    /// which can happen in the tick in which the joint is removed.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    #[inline(never)]
    pub fn joint_anchor_positions(&self, joint: JointHandle) -> Result<Option<[Vector; 2]>, Error> {
        Ok(self.joints.get(joint)?.places(&self.bodies, &self.rigids))
    }

    /// Removes broken joints, and reports an event for each.
    pub(super) fn part_joints(&mut self, broken: Vec<JointHandle>) {
        for joint in broken {
            // A joint can be in two lists of the same substep.
            if let Ok(parted) = self.joints.remove(joint) {
                self.events.push(Event::JointBroke { joint });
                self.wake_ends(&parted);
            }
        }
    }

    fn wake_ends(&mut self, joint: &Joint) {
        for end in &joint.ends {
            match *end {
                JointAnchor::Position(_) => {}
                JointAnchor::RigidBody { rigid, .. } => {
                    if self.rigids.get(rigid).is_ok_and(|rigid| rigid.is_asleep()) {
                        self.wake_rigids(&[rigid.slot()]);
                    }
                }
                JointAnchor::Soft { body, .. } => {
                    if self.bodies.get(body).is_ok() {
                        self.wake_body(body);
                    }
                }
            }
        }
    }
}

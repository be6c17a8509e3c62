//! Joints of a world: insertion, removal, access.

use super::World;
use crate::contact::joint::{Joint, JointEnd, JointRef, JointState};
use crate::error::Error;
use crate::event::Event;
use crate::foundation::arena::JointHandle;
use crate::foundation::dim::{Dim, DimVector};

impl<D: Dim> World<D> {
    /// Adds a joint. Its anchors stay attached to the points of the bodies where the anchors are now. Both
    /// attached bodies wake.
    ///
    /// # Errors
    /// [`Error`] if a handle is stale or a parameter is out of range.
    #[inline(never)]
    pub fn add_joint(&mut self, joint: Joint<D>) -> Result<JointHandle, Error> {
        let mut joint = JointState::from(&joint);
        joint.check()?;
        joint.attach(&self.bodies, &self.rigids)?;
        self.wake_ends(&joint);
        Ok(self.joints.insert(joint))
    }

    /// Removes a joint, see [`World::remove`].
    #[inline(never)]
    pub(crate) fn remove_joint(&mut self, joint: JointHandle) -> Result<Joint<D>, Error> {
        let joint = self.joints.remove(joint)?;
        self.wake_ends(&joint);
        Ok(joint.definition())
    }

    /// Returns a joint.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn joint(&self, joint: JointHandle) -> Result<JointRef<'_, D>, Error> {
        self.joints.get(joint).map(JointRef::new)
    }

    /// Iterates over the handles and joints, in the order of their arena slots.
    pub fn joints(&self) -> impl Iterator<Item = (JointHandle, JointRef<'_, D>)> + Clone {
        let joints = self.joints.entries();
        joints.map(|(id, joint)| (id, JointRef::new(joint)))
    }

    /// Returns the world-space positions of both anchors of a joint [m]. `None` if an attached body was
    /// removed; the next tick then removes the joint, too.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    #[inline(never)]
    pub fn joint_anchor_positions(
        &self,
        joint: JointHandle,
    ) -> Result<Option<[D::Vector; 2]>, Error> {
        let positions = self
            .joints
            .get(joint)?
            .anchor_positions(&self.bodies, &self.rigids);
        Ok(positions.map(|both| both.map(D::Vector::from_vec3)))
    }

    /// Removes broken joints, and reports an event for each.
    pub(super) fn remove_broken_joints(&mut self, broken: Vec<JointHandle>) {
        for joint in broken {
            // `broken` may list a joint twice: it broke when velocities were solved, and again when positions
            // were corrected. The second removal fails and is ignored.
            if let Ok(removed) = self.joints.remove(joint) {
                self.events.push(Event::JointBroke { joint });
                self.wake_ends(&removed);
            }
        }
    }

    fn wake_ends(&mut self, joint: &JointState) {
        for end in &joint.anchors {
            match *end {
                JointEnd::Position(_) => {}
                JointEnd::RigidBody { rigid, .. } => {
                    if self.rigids.get(rigid).is_ok_and(|rigid| rigid.is_asleep()) {
                        self.wake_rigids(&[rigid.slot()]);
                    }
                }
                JointEnd::Soft { body, .. } => {
                    if self.bodies.get(body).is_ok() {
                        self.wake_body(body);
                    }
                }
            }
        }
    }
}

//! What ties things together: put in, taken out, looked at.

use super::{Refused, World};
use crate::dim::Dim;
use crate::event::Event;
use crate::handle::{Gone, JointId};
use crate::joint::{End, Joint, Joints};
use crate::shape::Vector;

impl<D: Dim> World<D> {
    /// Ties two ends together as they are now. Both wake.
    ///
    /// # Errors
    /// [`Refused`] when an end is not there, or when a number is out of range.
    #[inline(never)]
    pub fn add_joint(&mut self, mut joint: Joint) -> Result<JointId, Refused> {
        let refused = |(field, expected)| Refused::Argument { field, expected };
        joint.check().map_err(refused)?;
        joint.hold(&self.bodies, &self.rigids)?;
        self.wake_ends(&joint);
        Ok(self.joints.insert(joint))
    }

    /// Takes a joint out of the world. Both ends wake.
    ///
    /// # Errors
    /// [`Gone`] when there is no such joint.
    #[inline(never)]
    pub fn remove_joint(&mut self, joint: JointId) -> Result<Joint, Gone> {
        let joint = self.joints.remove(joint)?;
        self.wake_ends(&joint);
        Ok(joint)
    }

    /// What ties things together.
    pub fn joints(&self) -> &Joints {
        &self.joints
    }

    /// Where the ends of a joint are [m]; nothing when one is gone, as in the tick in which it goes.
    ///
    /// # Errors
    /// [`Gone`] when there is no such joint.
    #[inline(never)]
    pub fn joint_places(&self, joint: JointId) -> Result<Option<[Vector; 2]>, Gone> {
        Ok(self.joints.get(joint)?.places(&self.bodies, &self.rigids))
    }

    /// Takes out joints that broke, and tells of them.
    pub(super) fn part_joints(&mut self, broken: Vec<JointId>) {
        for joint in broken {
            // It may have been told of in this substep before.
            if let Ok(parted) = self.joints.remove(joint) {
                self.events.push(Event::JointBroke { joint });
                self.wake_ends(&parted);
            }
        }
    }

    fn wake_ends(&mut self, joint: &Joint) {
        for end in &joint.ends {
            match *end {
                End::Position(_) => {}
                End::Rigid { rigid, .. } => {
                    if self.rigids.get(rigid).is_ok_and(|rigid| rigid.is_asleep()) {
                        self.wake_rigids(&[rigid.slot()]);
                    }
                }
                End::Soft { body, .. } => {
                    if self.bodies.get(body).is_ok() {
                        self.wake_body(body);
                    }
                }
            }
        }
    }
}

//! State of a joint in the simulation.

use super::attached_anchor::AttachedAnchor;
use super::joint_end::{JointEnd, Woken};
use super::{Joint, JointAnchor, JointKind};
use crate::contact::rest_speeds::RestSpeeds;
use crate::error::{Error, require};
use crate::foundation::arena::{Arena, JointHandle};
use crate::foundation::dim::{Dim, DimVector};
use crate::foundation::hash::hash_state;
use crate::object_ref::ObjectRef;
use crate::rigid_body::solid::flat;
use crate::rigid_body::{FARTHEST, RigidBodies, is_within_reach};
use crate::soft_body::SoftBodies;
use glam::Vec3;

/// Solver iterations over all joints per substep. Chains of joints need more than one iteration, because
/// their links depend on each other.
const ITERATIONS: usize = 4;

/// Joints of a world.
pub type Joints = Arena<JointHandle, JointState>;

/// State of a joint in the simulation. The first fields are those of [`Joint`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct JointState {
    /// Attachment points as they were when the joint was added.
    pub anchors: [JointEnd; 2],
    /// Joint kind.
    pub kind: JointKind,
    /// Force above which the joint breaks [N], in tension or compression; infinite (default) = never.
    pub breaking_force: f32,
    pub(super) attached: [AttachedAnchor; 2],
    /// Impulse on the first anchor in the last substep [N s].
    pub(super) impulse: Vec3,
    /// Force on the first anchor in the last substep in which an anchor could move [N].
    pub(super) force: Vec3,
}

hash_state! { struct JointState { anchors, kind, breaking_force, attached, impulse, force } }

impl<D: Dim> From<&Joint<D>> for JointState {
    fn from(joint: &Joint<D>) -> Self {
        let end = |anchor: JointAnchor<D>| match anchor {
            JointAnchor::Point(point) => JointEnd::Position(point.to_vec3()),
            JointAnchor::RigidBody { body, point } => JointEnd::RigidBody {
                rigid: body,
                at: point.to_vec3(),
            },
            JointAnchor::SoftBody {
                body,
                point,
                radius,
            } => JointEnd::Soft {
                body,
                at: point.to_vec3(),
                radius,
            },
        };
        Self {
            anchors: joint.anchors.map(end),
            kind: joint.kind,
            breaking_force: joint.breaking_force,
            attached: [
                AttachedAnchor::Position(Vec3::ZERO),
                AttachedAnchor::Position(Vec3::ZERO),
            ],
            impulse: Vec3::ZERO,
            force: Vec3::ZERO,
        }
    }
}

impl JointState {
    /// Returns the definition of the joint, with the anchors at the positions at which it was added.
    pub fn definition<D: Dim>(&self) -> Joint<D> {
        let anchor = |end: JointEnd| match end {
            JointEnd::Position(at) => JointAnchor::Point(D::Vector::from_vec3(at)),
            JointEnd::RigidBody { rigid, at } => JointAnchor::RigidBody {
                body: rigid,
                point: D::Vector::from_vec3(at),
            },
            JointEnd::Soft { body, at, radius } => JointAnchor::SoftBody {
                body,
                point: D::Vector::from_vec3(at),
                radius,
            },
        };
        Joint {
            anchors: self.anchors.map(anchor),
            kind: self.kind,
            breaking_force: self.breaking_force,
        }
    }

    /// Returns the magnitude of the joint force in the last substep [N].
    pub fn force(&self) -> f32 {
        self.force.length()
    }

    /// Returns the force on the first anchor in the last substep [N]; the force on the second one is opposite.
    pub fn reaction(&self) -> Vec3 {
        self.force
    }

    /// Attaches the anchors to their bodies at the present positions.
    pub(crate) fn attach<D: Dim>(
        &mut self,
        bodies: &SoftBodies<D>,
        rigids: &RigidBodies,
    ) -> Result<(), Error> {
        for (anchor, end) in self.attached.iter_mut().zip(&self.anchors) {
            *anchor = AttachedAnchor::of(end, bodies, rigids)?;
        }
        if self.kind == JointKind::Pin {
            self.move_to_soft_anchor(bodies, rigids);
        }
        (self.impulse, self.force) = (Vec3::ZERO, Vec3::ZERO);
        Ok(())
    }

    /// For a pin between a soft body and a rigid body or the world: moves the anchor that is not on the soft
    /// body to the other anchor. So nothing jumps at the first step.
    fn move_to_soft_anchor<D: Dim>(&mut self, bodies: &SoftBodies<D>, rigids: &RigidBodies) {
        let is_soft = self.attached.each_ref().map(AttachedAnchor::is_soft);
        for (own, other) in [(0, 1), (1, 0)] {
            if is_soft[own] && !is_soft[other] {
                let at = self.attached[own]
                    .state(bodies, rigids)
                    .map(|state| state.at);
                at.into_iter()
                    .for_each(|at| self.attached[other].move_to(at, rigids));
            }
        }
    }

    /// Returns the positions of both anchors [m]; `None` if an attached body is gone.
    pub(crate) fn anchor_positions<D: Dim>(
        &self,
        bodies: &SoftBodies<D>,
        rigids: &RigidBodies,
    ) -> Option<[Vec3; 2]> {
        let [first, second] = &self.attached;
        let at = |anchor: &AttachedAnchor| Some(anchor.state(bodies, rigids)?.at);
        Some([at(first)?, at(second)?])
    }

    /// Returns the objects that the anchors are attached to; `None` for points of the world. For an anchor on
    /// several pieces, the piece of its first node.
    pub(crate) fn attached_objects<D: Dim>(
        &self,
        bodies: &SoftBodies<D>,
    ) -> [Option<ObjectRef>; 2] {
        self.attached.each_ref().map(|anchor| anchor.object(bodies))
    }

    /// Checks that all parameters are in range.
    pub(crate) fn check(&self) -> Result<(), Error> {
        for (number, end) in (1..).zip(&self.anchors) {
            let (at, radius) = match *end {
                JointEnd::Position(at) | JointEnd::RigidBody { at, .. } => (at, 0.0),
                JointEnd::Soft { at, radius, .. } => (at, radius),
            };
            let is_near = is_within_reach(at);
            let of_anchor = |error: Error| error.of(format_args!("joint anchor {number}"));
            let expected = "within 1e6 m of the origin";
            require(is_near, "point", expected, at).map_err(of_anchor)?;
            let is_valid = (0.0..=FARTHEST).contains(&radius);
            require(is_valid, "radius", "0 to 1e6 m", radius).map_err(of_anchor)?;
        }
        let wrong = match self.anchors {
            [JointEnd::Position(_), JointEnd::Position(_)] => Some("two points of the world"),
            [
                JointEnd::RigidBody { rigid, .. },
                JointEnd::RigidBody { rigid: other, .. },
            ] if rigid == other => Some("twice the same rigid body"),
            _ => None,
        };
        if let Some(given) = wrong {
            let expected = "not two points of the world, and not twice the same rigid body";
            return Err(Error::parameter(
                "joint anchors",
                expected,
                format_args!("{given}"),
            ));
        }
        let force = self.breaking_force;
        require(force > 0.0, "breaking_force", "positive", force)?;
        let is_within = |k: f32, min: f32, max: f32| (min..=max).contains(&k);
        match self.kind {
            JointKind::Pin => Ok(()),
            JointKind::Rope { length } => require(
                is_within(length, f32::MIN_POSITIVE, FARTHEST),
                "length",
                "positive, at most 1e6 m",
                length,
            ),
            JointKind::Spring {
                stiffness,
                damping,
                length,
            } => {
                let is_stiff = is_within(stiffness, 1e-6, 1e12);
                let expected = "1e-6 to 1e12 N/m";
                require(is_stiff, "stiffness", expected, stiffness)?;
                let is_damped = is_within(damping, 0.0, 1e12);
                require(is_damped, "damping", "0 to 1e12 N s/m", damping)?;
                let is_long = is_within(length, 0.0, FARTHEST);
                require(is_long, "length", "0 to 1e6 m", length)
            }
        }
    }

    /// Returns whether a joint that was read from a file has valid values.
    #[cfg(feature = "serde")]
    pub(crate) fn is_sound<D: Dim>(&self) -> bool {
        let vectors = [self.impulse, self.force];
        let is_finite = vectors.iter().all(|vector| vector.is_finite());
        let is_flat = vectors.iter().all(|&vector| flat::<D>(vector) == vector);
        let mut both = self.attached.iter().zip(&self.anchors);
        self.check().is_ok()
            && is_finite
            && is_flat
            && both.all(|(own, end)| own.is_sound::<D>(end))
    }
}

/// Applies the joint impulses of a substep of `duration` [s]. Returns the joints that lost an anchor, and the
/// sleepers to wake.
pub(crate) fn solve<D: Dim>(
    joints: &mut Joints,
    bodies: &mut SoftBodies<D>,
    rigids: &mut RigidBodies,
    rest: RestSpeeds,
    duration: f32,
) -> (Vec<JointHandle>, Woken) {
    let (mut broken, mut woken) = (Vec::new(), Woken::default());
    for (id, joint) in joints.entries_mut() {
        match joint.start(bodies, rigids, rest, &mut woken) {
            true => {}
            false => broken.push(id),
        }
    }
    for _ in 0..ITERATIONS {
        for joint in joints.iter_mut() {
            joint.solve(bodies, rigids, duration, true);
        }
    }
    (broken, woken)
}

/// After the position update, removes the velocity by which pins and ropes corrected position errors. Returns
/// the joints that exceeded their breaking force.
pub(crate) fn relax<D: Dim>(
    joints: &mut Joints,
    bodies: &mut SoftBodies<D>,
    rigids: &mut RigidBodies,
    duration: f32,
) -> Vec<JointHandle> {
    let mut broken = Vec::new();
    for _ in 0..ITERATIONS {
        for joint in joints.iter_mut() {
            joint.solve(bodies, rigids, duration, false);
        }
    }
    for (id, joint) in joints.entries_mut() {
        if !joint.can_move(bodies, rigids) {
            // Keeps the last force of a joint if none of its attached bodies can move.
            continue;
        }
        joint.force = flat::<D>(joint.impulse) / duration;
        if joint.force() > joint.breaking_force {
            broken.push(id);
        }
    }
    broken
}

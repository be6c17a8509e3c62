//! State of a rigid body in the simulation.

use crate::error::{Error, require};
use crate::foundation::arena::{Arena, RigidBodyHandle};
use crate::foundation::dim::{Dim, DimVector};
use crate::foundation::hash::hash_state;
use crate::math::rotation::Rotation;
use crate::math::twist::Twist;
use crate::math::velocity::Velocity;
use crate::rigid_body::inertia::{Inertia, Matrix};
use crate::rigid_body::layers::Layers;
use crate::rigid_body::reach::is_within_reach;
use crate::rigid_body::rigid_state_check::check_motion_type;
use crate::rigid_body::shape::Shape;
use crate::rigid_body::solid::Solid;
use crate::rigid_body::{MotionType, RigidBody};
use glam::Vec3;
use std::mem::discriminant;

/// Rigid bodies of a world.
pub type RigidBodies = Arena<RigidBodyHandle, RigidState>;

/// State of a rigid body in the simulation: the fields of [`RigidBody`], quantities derived from these
/// fields, and quantities that change in each substep. Vectors have three coordinates in 2D, too.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RigidState {
    pub friction: f32,
    pub restitution: f32,
    pub motion_type: MotionType,
    pub layers: Layers,
    pub is_sensor: bool,
    pub user_data: u64,
    /// Shape in local coordinates.
    pub(super) local_shape: Solid,
    /// Shape in world coordinates, derived from `local_shape` and the pose.
    pub(super) shape: Solid,
    /// Position of the local origin [m].
    pub(crate) position: Vec3,
    /// Linear velocity [m/s].
    pub(crate) velocity: Vec3,
    /// Rotation from local to world axes.
    pub(crate) rotation: Rotation,
    /// Angular velocity [rad/s].
    pub(crate) angular_velocity: Vec3,
    /// Whether the body sleeps.
    pub(crate) asleep: bool,
    /// Sleep timer: time for which the body has been at rest [s].
    pub(crate) sleep_timer: f32,
    /// Position of the body, low-pass filtered over half a second [m]; see `world::sleep`.
    pub(crate) settled_at: Vec3,
    /// Position at the start of the tick [m]; an invalid body is reset to it.
    pub(super) position_before: Vec3,
    /// Rotation at the start of the tick; an invalid body is reset to it.
    pub(super) rotation_before: Rotation,
    /// Principal moments of inertia; `None` unless the body is dynamic.
    pub(super) inertia: Option<Inertia>,
    /// Inverse inertia matrix about the world axes [1/(kg m²)].
    pub(super) inverse_inertia: Matrix,
    /// Target position for the end of the tick [m].
    pub(super) target_at_tick_end: Vec3,
    /// Target rotation for the end of the tick.
    pub(super) target_rotation: Rotation,
    /// Target position in the present substep [m]. During a tick it moves linearly to `target`.
    pub(super) target_now: Vec3,
    /// Velocity of the target in this tick [m/s].
    pub(super) target_velocity: Vec3,
    /// Force and torque on the body in each substep of the last tick.
    pub(crate) reactions: Vec<ReactionSum>,
}

hash_state! {
    struct RigidState {
        friction, restitution, motion_type, layers, is_sensor, user_data, local_shape, shape, position, velocity,
        rotation, angular_velocity, asleep, sleep_timer, settled_at, position_before, rotation_before, inertia,
        inverse_inertia, target_at_tick_end, target_rotation, target_now, target_velocity, reactions,
    }
}

/// Force and torque on a rigid body in one substep.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ReactionSum {
    /// Contact force on the body [N]. Discontinuous when a soft body tears.
    pub contact: Vec3,
    /// Torque of contacts and knives on the body about its position [N m]; in 2D only the third component.
    pub torque: Vec3,
    /// Force of the virtual coupling on the target, opposite to its force on the body [N]. A force-feedback
    /// device should play this force.
    pub coupling: Vec3,
}

hash_state! { struct ReactionSum { contact, torque, coupling } }

impl<D: Dim> From<&RigidBody<D>> for RigidState {
    fn from(body: &RigidBody<D>) -> Self {
        let position = body.position.to_vec3();
        let rotation = body.rotation.seen_in::<D>();
        let Twist { linear, angular } = body.velocity.twist();
        let local_shape = body.shape.solid();
        let target = body.target_position.unwrap_or(body.position).to_vec3();
        let target_rotation = body.target_rotation.map(Rotation::seen_in::<D>);
        let mut state = Self {
            friction: body.friction,
            restitution: body.restitution,
            motion_type: body.motion_type,
            layers: body.layers,
            is_sensor: body.is_sensor,
            user_data: body.user_data,
            local_shape,
            shape: local_shape,
            position,
            velocity: linear,
            rotation,
            angular_velocity: angular,
            asleep: false,
            sleep_timer: 0.0,
            settled_at: position,
            position_before: position,
            rotation_before: rotation,
            inertia: body.motion_type.inertia::<D>(&local_shape),
            inverse_inertia: [Vec3::ZERO; 3],
            target_at_tick_end: target,
            target_rotation: target_rotation.unwrap_or(rotation),
            target_now: target,
            target_velocity: Vec3::ZERO,
            reactions: Vec::new(),
        };
        state.clear_unused_motion();
        state.move_to(position, rotation);
        state
    }
}

impl RigidState {
    /// Returns the definition of the body with its present pose, velocity and target.
    pub fn definition<D: Dim>(&self) -> RigidBody<D> {
        let follows = self.follows_target();
        RigidBody {
            motion_type: self.motion_type,
            shape: Shape::of(&self.local_shape),
            position: D::Vector::from_vec3(self.position),
            rotation: self.rotation,
            velocity: Velocity::from(self.twist()),
            target_position: follows.then(|| D::Vector::from_vec3(self.target_at_tick_end)),
            target_rotation: follows.then_some(self.target_rotation),
            friction: self.friction,
            restitution: self.restitution,
            layers: self.layers,
            is_sensor: self.is_sensor,
            user_data: self.user_data,
        }
    }

    /// Clears the velocities that the motion type excludes: both velocities of a fixed body, and the angular
    /// velocity of a coupled body.
    pub(super) fn clear_unused_motion(&mut self) {
        if self.motion_type == MotionType::Fixed {
            // The body may have moved before its motion type became fixed.
            (self.velocity, self.target_velocity) = (Vec3::ZERO, Vec3::ZERO);
            self.target_present_pose();
        }
        if matches!(
            self.motion_type,
            MotionType::Fixed | MotionType::Coupled { .. }
        ) {
            self.angular_velocity = Vec3::ZERO;
        }
    }

    /// Sets the motion type in a world of dimension `D`. If only parameters change, for example the mass, the
    /// body keeps its target. A different type replaces the target by the present pose.
    pub(crate) fn set_motion_type<D: Dim>(&mut self, motion_type: MotionType) -> Result<(), Error> {
        let inertia = motion_type.inertia::<D>(&self.local_shape);
        check_motion_type(motion_type, &self.local_shape, inertia.as_ref())?;
        if discriminant(&motion_type) != discriminant(&self.motion_type) {
            self.target_present_pose();
        }
        (self.motion_type, self.inertia) = (motion_type, inertia);
        self.clear_unused_motion();
        self.move_to(self.position, self.rotation);
        Ok(())
    }

    /// Returns the position of the local origin [m].
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// Returns the linear and angular velocity.
    pub fn twist(&self) -> Twist {
        Twist {
            linear: self.velocity,
            angular: self.angular_velocity,
        }
    }

    /// Returns the linear velocity [m/s].
    pub fn velocity(&self) -> Vec3 {
        self.velocity
    }

    /// Returns the rotation from local to world axes.
    pub fn rotation(&self) -> Rotation {
        self.rotation
    }

    /// Returns the target position [m].
    pub fn target_position(&self) -> Vec3 {
        self.target_at_tick_end
    }

    /// Returns the target rotation.
    pub fn target_rotation(&self) -> Rotation {
        self.target_rotation
    }

    /// Returns the force and torque on the body in each substep of the last tick.
    pub fn reactions(&self) -> &[ReactionSum] {
        &self.reactions
    }

    /// Returns the shape in local coordinates.
    pub fn local_shape(&self) -> &Solid {
        &self.local_shape
    }

    /// Returns the shape in world coordinates.
    pub fn shape(&self) -> &Solid {
        &self.shape
    }

    /// Returns whether the body follows a target: it is kinematic or coupled.
    pub fn follows_target(&self) -> bool {
        self.motion_type.follows_target()
    }

    /// Returns an error unless the body follows a target.
    pub(super) fn require_target(&self) -> Result<(), Error> {
        let expected = "kinematic or coupled";
        require(
            self.follows_target(),
            "motion_type",
            expected,
            self.motion_type,
        )
    }

    /// Sets the target position [m] for the end of the next tick.
    pub(crate) fn set_target_position(&mut self, target: Vec3) -> Result<(), Error> {
        self.require_target()?;
        let expected = "within 1e6 m of the origin";
        require(is_within_reach(target), "position", expected, target)?;
        self.target_at_tick_end = target;
        Ok(())
    }

    /// Returns the inverse mass for contacts [1/kg]; 0 for fixed, kinematic and sleeping bodies.
    #[inline(always)]
    pub(crate) fn inverse_mass(&self) -> f32 {
        match self.motion_type {
            MotionType::Fixed | MotionType::Kinematic => 0.0,
            MotionType::Dynamic { .. } if self.asleep => 0.0,
            MotionType::Coupled { mass, .. } | MotionType::Dynamic { mass } => 1.0 / mass,
        }
    }

    /// Starts a tick of `duration` [s]: sets constant velocities with which the target, and the rotation of a
    /// kinematic or coupled body, reach their goals at the end of the tick.
    pub(crate) fn start_tick(&mut self, duration: f32) {
        (self.position_before, self.rotation_before) = (self.position, self.rotation);
        self.target_velocity = (self.target_at_tick_end - self.target_now) * (1.0 / duration);
        if self.follows_target() && self.rotation != self.target_rotation
            || self.motion_type == MotionType::Kinematic
        {
            let way = self.rotation.inverse().then(self.target_rotation);
            self.angular_velocity = way.scaled_axis() * (1.0 / duration);
        }
        self.reactions.clear();
    }

    /// Ends a tick: the target stops, and a kinematic or coupled body takes its target rotation. A body that
    /// is non-finite or out of range is reset to its pose at the start of the tick, with velocity 0. Returns
    /// whether the body was reset.
    pub(crate) fn end_tick(&mut self) -> bool {
        self.target_now = self.target_at_tick_end;
        if self.follows_target() && self.rotation != self.target_rotation {
            self.move_to(self.position, self.target_rotation);
        }
        if matches!(self.motion_type, MotionType::Coupled { .. }) {
            self.angular_velocity = Vec3::ZERO;
        }
        let is_finite = self.velocity.is_finite() && self.angular_velocity.is_finite();
        let is_out = !is_finite || !is_within_reach(self.position);
        if is_out {
            self.move_to(self.position_before, self.rotation_before);
            (self.velocity, self.angular_velocity) = (Vec3::ZERO, Vec3::ZERO);
            self.reactions.fill(ReactionSum::default());
        }
        is_out
    }

    /// Starts a substep of `duration` [s]: moves the target by its velocity, and appends an empty reaction.
    /// Accelerates a coupled body towards the target. Gives a kinematic body the velocity with which it
    /// reaches the target in this substep.
    pub(crate) fn start_substep(&mut self, duration: f32) {
        self.target_now += self.target_velocity * duration;
        let mut reaction = ReactionSum::default();
        match self.motion_type {
            MotionType::Fixed => return,
            MotionType::Dynamic { .. } => {}
            MotionType::Kinematic => {
                self.velocity = (self.target_now - self.position) * (1.0 / duration);
            }
            MotionType::Coupled {
                mass,
                stiffness,
                damping,
                max_force,
            } => {
                // Reduces the stiffness to the stability limit of this substep.
                let stiffness = stiffness.min(0.25 * mass / (duration * duration));
                let damper = 2.0 * damping * (stiffness * mass).sqrt();
                let stretch = self.target_now - self.position;
                let slip = self.target_velocity - self.velocity;
                let wish = stretch * stiffness + slip * damper;
                let strength = wish.length();
                let force = if strength > max_force {
                    wish * (max_force / strength)
                } else {
                    wish
                };
                self.velocity += force * (duration / mass);
                reaction.coupling = -force;
            }
        }
        self.reactions.push(reaction);
    }

    /// Applies a contact impulse [N s]. Adds the mean contact force, the impulse divided by the substep
    /// length `duration` [s], to the reaction of this substep.
    #[inline(always)]
    pub(crate) fn apply_contact_impulse(&mut self, impulse: Vec3, duration: f32) {
        let inverse_mass = self.inverse_mass();
        for axis in 0..3 {
            if inverse_mass > 0.0 {
                self.velocity[axis] += impulse[axis] * inverse_mass;
            }
            if let Some(reaction) = self.reactions.last_mut() {
                reaction.contact[axis] += impulse[axis] / duration;
            }
        }
    }

    /// Adds a torque [N m] to the reaction of this substep.
    pub(crate) fn add_torque(&mut self, torque: Vec3) {
        if let Some(reaction) = self.reactions.last_mut() {
            reaction.torque += torque;
        }
    }

    pub(super) fn move_to(&mut self, position: Vec3, rotation: Rotation) {
        (self.position, self.rotation) = (position, rotation);
        self.shape = self.local_shape.rotated(rotation).translated(position);
        if let Some(inertia) = &self.inertia {
            self.inverse_inertia = inertia.inverse(rotation);
        }
    }
}

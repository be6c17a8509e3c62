//! Motion of rigid bodies: integration, impulses, sleep.

use super::inertia::times;
use super::reach::is_within_reach;
use super::{MotionType, RigidState};
use crate::error::{Error, require};
use crate::foundation::dim::Dim;
use crate::math::rotation::Rotation;
use crate::rigid_body::layers::Layers;
use crate::rigid_body::solid::flat;
use glam::Vec3;

impl RigidState {
    /// Returns whether the body is dynamic.
    pub fn is_dynamic(&self) -> bool {
        matches!(self.motion_type, MotionType::Dynamic { .. })
    }

    /// Returns the mass of a dynamic body [kg], also while it sleeps; `None` for all other bodies.
    pub(crate) fn dynamic_mass(&self) -> Option<f32> {
        match self.motion_type {
            MotionType::Dynamic { mass } => Some(mass),
            _ => None,
        }
    }

    /// Translates the body by `by` [m], and adds a velocity [m/s].
    pub(crate) fn shift(&mut self, by: Vec3, velocity: Vec3) {
        self.velocity += velocity;
        self.move_to(self.position + by, self.rotation);
    }

    /// Returns whether the body is dynamic and asleep.
    pub fn is_asleep(&self) -> bool {
        self.asleep
    }

    /// Returns whether the body keeps objects in contact with it awake: a coupled body always, a kinematic
    /// body while it moves.
    pub(crate) fn pushes(&self) -> bool {
        match self.motion_type {
            MotionType::Coupled { .. } => true,
            MotionType::Kinematic => {
                self.velocity != Vec3::ZERO || self.angular_velocity != Vec3::ZERO
            }
            MotionType::Fixed | MotionType::Dynamic { .. } => false,
        }
    }

    /// Returns whether the body is at rest: it sleeps, is fixed, or is kinematic with zero velocity.
    pub(crate) fn rests(&self) -> bool {
        match self.motion_type {
            MotionType::Kinematic => !self.pushes(),
            _ => !self.moves(),
        }
    }

    /// Returns whether the body collides with soft bodies of the given layers. Sensors do not collide.
    #[inline(always)]
    pub(crate) fn meets(&self, layers: Layers) -> bool {
        !self.is_sensor && self.layers.meet(layers)
    }

    /// Returns whether the body collides with another rigid body. Sensors do not collide.
    #[inline(always)]
    pub(crate) fn meets_rigid(&self, other: &Self) -> bool {
        !self.is_sensor && other.meets(self.layers)
    }

    /// Returns whether the body may move in this substep: it is neither fixed nor asleep.
    #[inline(always)]
    pub(crate) fn moves(&self) -> bool {
        !matches!(self.motion_type, MotionType::Fixed) && !self.asleep
    }

    /// Returns the velocity [m/s] of the point of the body at the offset `lever` [m] from the body's
    /// position.
    #[inline(always)]
    pub(crate) fn velocity_at(&self, lever: Vec3) -> Vec3 {
        match self.turns() {
            true => self.velocity + self.angular_velocity.cross(lever),
            false => self.velocity,
        }
    }

    /// Returns the velocity [m/s] of the body at a world-space point [m].
    #[inline(always)]
    pub(crate) fn velocity_near(&self, at: Vec3) -> Vec3 {
        match self.turns() {
            true => self.velocity_at(at - self.position),
            false => self.velocity,
        }
    }

    /// Returns an upper bound of the speed of all body points [m/s].
    pub(crate) fn top_speed(&self) -> f32 {
        let speed = self.velocity.length();
        match self.turns() && self.angular_velocity != Vec3::ZERO {
            true => speed + self.angular_velocity.length() * self.extent(),
            false => speed,
        }
    }

    /// Returns an upper bound of the distance from the local origin to any point of the shape [m].
    pub(crate) fn extent(&self) -> f32 {
        let [low, high] = self.local_shape.bounds();
        let furthest = [0, 1, 2].map(|axis: usize| low[axis].abs().max(high[axis].abs()));
        Vec3::from(furthest).length()
    }

    /// Returns the size of the body for [`RestSpeeds`](crate::contact::rest_speeds::RestSpeeds) [m]: a quarter of
    /// the inradius, which is the width of a voxel of a body with eight voxels across.
    pub(crate) fn rest_size(&self) -> f32 {
        0.25 * self.local_shape.inner_radius().min(1.0)
    }

    /// Sets the target rotation.
    pub(crate) fn set_target_rotation<D: Dim>(&mut self, rotation: Rotation) -> Result<(), Error> {
        self.require_target()?;
        self.target_rotation = rotation.seen_in::<D>();
        Ok(())
    }

    /// Sets the pose immediately, makes it the target, and wakes the body. The velocity does not change.
    pub(crate) fn set_pose<D: Dim>(
        &mut self,
        position: Vec3,
        rotation: Rotation,
    ) -> Result<(), Error> {
        let expected = "within 1e6 m of the origin";
        require(is_within_reach(position), "position", expected, position)?;
        let (position, rotation) = (flat::<D>(position), rotation.seen_in::<D>());
        self.move_to(position, rotation);
        (self.position_before, self.rotation_before) = (position, rotation);
        self.target_present_pose();
        self.wake();
        Ok(())
    }

    /// Sets the target pose to the present pose.
    pub(crate) fn target_present_pose(&mut self) {
        (self.target_at_tick_end, self.target_now) = (self.position, self.position);
        self.target_rotation = self.rotation;
    }

    /// Wakes the body and restarts its sleep timer.
    pub(crate) fn wake(&mut self) {
        (self.asleep, self.sleep_timer) = (false, 0.0);
    }

    /// Stops the body and puts it to sleep.
    pub(crate) fn fall_asleep(&mut self) {
        (self.velocity, self.angular_velocity) = (Vec3::ZERO, Vec3::ZERO);
        self.asleep = true;
    }

    /// Rotates the vectors of the linear and the angular velocity; the pose stays.
    pub(crate) fn rotate_velocity(&mut self, rotation: Rotation) {
        self.velocity = rotation.apply(self.velocity);
        self.angular_velocity = rotation.apply(self.angular_velocity);
    }

    /// Integrates `acceleration` [m/s²] and air drag over `duration` [s]. Drag reduces the linear and the
    /// angular velocity at the decay rate `drag` [1/s].
    pub(crate) fn integrate_forces<D: Dim>(
        &mut self,
        acceleration: Vec3,
        drag: f32,
        duration: f32,
    ) {
        let change = flat::<D>(acceleration) * duration;
        let kept = 1.0 / (1.0 + drag * duration);
        self.velocity = (self.velocity + change) * kept;
        self.angular_velocity *= kept;
    }

    /// Returns the position and the rotation of the body after `duration` [s] at its present velocity.
    pub(crate) fn pose_after(&self, duration: f32) -> (Vec3, Rotation) {
        if !self.moves() {
            return (self.position, self.rotation);
        }
        let position = self.position + self.velocity * duration;
        if self.angular_velocity == Vec3::ZERO {
            return (position, self.rotation);
        }
        let way = Rotation::about(
            self.angular_velocity,
            self.angular_velocity.length() * duration,
        );
        (position, self.rotation.then(way))
    }

    /// Integrates position and rotation over `duration` [s].
    pub(crate) fn integrate_pose(&mut self, duration: f32) {
        if !self.moves() {
            return;
        }
        let (position, rotation) = self.pose_after(duration);
        if let Some(inertia) = &self.inertia
            && self.angular_velocity != Vec3::ZERO
        {
            // No torque acts, so the angular momentum is preserved. The inertia about the world axes has
            // changed with the rotation, so the angular velocity changes.
            self.angular_velocity =
                inertia.angular_velocity_after(self.angular_velocity, self.rotation, rotation);
        }
        self.move_to(position, rotation);
    }

    /// Applies an impulse [N s] at the offset `lever` [m] from the body's position.
    pub(crate) fn apply_impulse(&mut self, impulse: Vec3, lever: Vec3) {
        self.velocity += impulse * self.inverse_mass();
        self.apply_angular_impulse(impulse, lever);
    }

    /// Applies a contact impulse [N s] at the offset `lever` [m] from the body's position. Adds the mean
    /// contact force, the impulse divided by the substep length `duration` [s], to the reaction of this
    /// substep.
    #[inline(always)]
    pub(crate) fn apply_contact_impulse_at(&mut self, impulse: Vec3, lever: Vec3, duration: f32) {
        self.apply_contact_impulse(impulse, duration);
        self.apply_angular_impulse(impulse, lever);
    }

    #[inline(always)]
    fn apply_angular_impulse(&mut self, impulse: Vec3, lever: Vec3) {
        if self.can_be_turned() {
            let twist = times(&self.inverse_inertia, lever.cross(impulse));
            self.angular_velocity += twist;
        }
    }

    /// Returns the inverse effective mass [1/kg] at the offset `lever` [m] from the body's position, along
    /// the unit direction `way`.
    pub(crate) fn inverse_effective_mass(&self, lever: Vec3, way: Vec3) -> f32 {
        let mut inverse_mass = self.inverse_mass();
        if self.can_be_turned() {
            let arm = lever.cross(way);
            let turned = times(&self.inverse_inertia, arm);
            inverse_mass += arm.dot(turned);
        }
        inverse_mass
    }

    /// Returns the velocity change of a body point per unit impulse on that point along the unit direction
    /// `way` [1/kg]. The point is at the offset `lever` [m] from the body's position.
    pub(crate) fn velocity_per_impulse(&self, lever: Vec3, way: Vec3) -> Vec3 {
        let linear = way * self.inverse_mass();
        match self.can_be_turned() {
            true => {
                let spin = times(&self.inverse_inertia, lever.cross(way));
                linear + spin.cross(lever)
            }
            false => linear,
        }
    }

    /// Returns an upper bound of the inverse effective mass at a world-space point [m], valid for all
    /// directions of an impulse [1/kg].
    #[inline(always)]
    pub(crate) fn max_inverse_effective_mass(&self, at: Vec3) -> f32 {
        let inverse_mass = self.inverse_mass();
        if !self.can_be_turned() {
            return inverse_mass;
        }
        let lever = at - self.position;
        let [x, y, z] = self.inverse_inertia;
        inverse_mass + (x[0] + y[1] + z[2]) * lever.dot(lever)
    }

    /// Returns whether contacts can change the angular velocity: the body is dynamic and awake.
    #[inline(always)]
    fn can_be_turned(&self) -> bool {
        self.is_dynamic() && !self.asleep
    }

    /// Returns whether the angular velocity may differ from 0. A coupled body has an angular velocity only in
    /// ticks in which it rotates to its target rotation.
    #[inline(always)]
    fn turns(&self) -> bool {
        match self.motion_type {
            MotionType::Fixed => false,
            MotionType::Kinematic | MotionType::Dynamic { .. } => true,
            MotionType::Coupled { .. } => self.angular_velocity != Vec3::ZERO,
        }
    }
}

//! What falls: how it is moved, turned, pushed and put to sleep.

use super::bad::{BadRigid, is_within_reach, require};
use super::inertia::{Inertia, times};
use super::{Drive, Rigid};
use crate::dim::Dim;
use crate::layers::Layers;
use crate::rotation::Rotation;
use crate::shape::{Vector, flat};
use crate::vector::{cross, dot, length, minus, plus, scaled};

impl Rigid {
    /// Whether it is free to fall.
    pub fn is_free(&self) -> bool {
        matches!(self.drive, Drive::Free { .. })
    }

    /// Whether it is free and came to rest, until something moves against it.
    pub fn is_asleep(&self) -> bool {
        self.asleep
    }

    /// Whether it keeps awake what it touches: a hand does, and so does what is moved, however slowly.
    pub(crate) fn pushes(&self) -> bool {
        match self.drive {
            Drive::Coupled { .. } => true,
            Drive::Kinematic => self.velocity != [0.0; 3] || self.spin != [0.0; 3],
            Drive::Fixed | Drive::Free { .. } => false,
        }
    }

    /// Whether it touches something soft of these layers.
    #[inline(always)]
    pub(crate) fn meets(&self, layers: Layers) -> bool {
        !self.is_sensor && self.layers.meet(layers)
    }

    /// Whether it touches something rigid.
    #[inline(always)]
    pub(crate) fn meets_rigid(&self, other: &Self) -> bool {
        !self.is_sensor && other.meets(self.layers)
    }

    /// Whether it may be somewhere else a moment later.
    #[inline(always)]
    pub(crate) fn moves(&self) -> bool {
        !matches!(self.drive, Drive::Fixed) && !self.asleep
    }

    /// Velocity of a place on it [m/s], so far from its [`position`](Rigid::position) [m].
    #[inline(always)]
    pub(crate) fn velocity_at(&self, lever: Vector) -> Vector {
        match self.turns() {
            true => plus(self.velocity, cross(self.spin, lever)),
            false => self.velocity,
        }
    }

    /// The same of a place of the world [m].
    #[inline(always)]
    pub(crate) fn velocity_near(&self, at: Vector) -> Vector {
        match self.turns() {
            true => self.velocity_at(minus(at, self.position)),
            false => self.velocity,
        }
    }

    /// The speed that none of its places exceeds [m/s].
    pub(crate) fn top_speed(&self) -> f32 {
        let speed = length(self.velocity);
        match self.turns() && self.spin != [0.0; 3] {
            true => speed + length(self.spin) * self.extent(),
            false => speed,
        }
    }

    /// How far its form reaches from its position [m].
    pub(crate) fn extent(&self) -> f32 {
        let [low, high] = self.form.bounds();
        length([0, 1, 2].map(|axis: usize| low[axis].abs().max(high[axis].abs())))
    }

    /// Lets it turn to a rotation.
    pub(crate) fn turn_to<D: Dim>(&mut self, rotation: Rotation) -> Result<(), BadRigid> {
        require(self.is_driven(), "drive", "one that follows a goal")?;
        self.rotation_goal = rotation.seen_in::<D>();
        Ok(())
    }

    /// Puts it somewhere at once, turned in a way, awake, with the velocity that it has.
    pub(crate) fn place<D: Dim>(
        &mut self,
        position: Vector,
        rotation: Rotation,
    ) -> Result<(), BadRigid> {
        let expected = "within 1e6 m of the origin";
        require(is_within_reach(position), "position", expected)?;
        (self.position, self.rotation) = (position, rotation);
        (self.position_before, self.rotation_before) = (position, rotation);
        self.stay();
        *self = self.clone().seen_in::<D>();
        self.wake();
        Ok(())
    }

    /// Its goal is where it is.
    pub(crate) fn stay(&mut self) {
        (self.goal, self.goal_before) = (self.position, self.position);
        self.rotation_goal = self.rotation;
    }

    /// It does not rest any more.
    pub(crate) fn wake(&mut self) {
        (self.asleep, self.still) = (false, 0.0);
    }

    /// Works out anew what it turns by, as a world of `D` sees it.
    pub(super) fn take_inertia<D: Dim>(&mut self) {
        self.inertia = match self.drive {
            Drive::Free { mass } => Some(Inertia::of::<D>(&self.form, mass)),
            _ => None,
        };
    }

    /// Lets what is free gain speed for `duration` [s]; everything loses a share `drag` [1/s] of it to the air.
    pub(crate) fn fall<D: Dim>(&mut self, acceleration: Vector, drag: f32, duration: f32) {
        let gain = scaled(flat::<D>(acceleration), duration);
        let left = 1.0 / (1.0 + drag * duration);
        self.velocity = scaled(plus(self.velocity, gain), left);
        self.spin = scaled(self.spin, left);
    }

    /// Moves and turns it by its velocities.
    pub(crate) fn drift(&mut self, duration: f32) {
        if !self.moves() {
            return;
        }
        let position = plus(self.position, scaled(self.velocity, duration));
        if self.spin == [0.0; 3] {
            return self.stand_at(position, self.rotation);
        }
        let way = Rotation::about(self.spin, length(self.spin) * duration);
        let rotation = self.rotation.then(way);
        if let Some(inertia) = &self.inertia {
            // No torque: the angular momentum stays.
            self.spin = inertia.spin_kept(self.spin, self.rotation, rotation);
        }
        self.stand_at(position, rotation);
    }

    /// Gains what an impulse [N s] gives it so far from its position [m].
    pub(crate) fn kick(&mut self, impulse: Vector, lever: Vector) {
        self.velocity = plus(self.velocity, scaled(impulse, self.inverse_mass()));
        self.twirl(impulse, lever);
    }

    /// Feels an impulse [N s] of something that touches it so far from its position [m], within a substep of `duration`
    /// [s].
    #[inline(always)]
    pub(crate) fn push_at(&mut self, impulse: Vector, lever: Vector, duration: f32) {
        self.push(impulse, duration);
        self.twirl(impulse, lever);
    }

    #[inline(always)]
    fn twirl(&mut self, impulse: Vector, lever: Vector) {
        if self.can_be_turned() {
            let twist = times(&self.inverse_inertia, cross(lever, impulse));
            self.spin = plus(self.spin, twist);
        }
    }

    /// The speed [m/s] that an impulse of 1 N s at a place so far from its position [m] gives that place along a direction
    /// of length 1.
    pub(crate) fn yields(&self, lever: Vector, way: Vector) -> f32 {
        let mut gain = self.inverse_mass();
        if self.can_be_turned() {
            let arm = cross(lever, way);
            let turned = times(&self.inverse_inertia, arm);
            gain += dot(arm, turned);
        }
        gain
    }

    /// The velocity that an impulse of 1 N s along a direction gives a place so far from its position [1/kg].
    pub(crate) fn gain(&self, lever: Vector, way: Vector) -> Vector {
        let gain = scaled(way, self.inverse_mass());
        match self.can_be_turned() {
            true => {
                let spin = times(&self.inverse_inertia, cross(lever, way));
                plus(gain, cross(spin, lever))
            }
            false => gain,
        }
    }

    /// No less than that at a place of the world [m], whatever the direction.
    #[inline(always)]
    pub(crate) fn yields_near(&self, at: Vector) -> f32 {
        let gain = self.inverse_mass();
        if !self.can_be_turned() {
            return gain;
        }
        let lever = minus(at, self.position);
        let [x, y, z] = self.inverse_inertia;
        gain + (x[0] + y[1] + z[2]) * dot(lever, lever)
    }

    /// Whether what touches it can turn it.
    #[inline(always)]
    fn can_be_turned(&self) -> bool {
        self.is_free() && !self.asleep
    }

    /// Whether it turns.
    #[inline(always)]
    fn turns(&self) -> bool {
        match self.drive {
            Drive::Fixed => false,
            Drive::Kinematic | Drive::Free { .. } => true,
            Drive::Coupled { .. } => self.spin != [0.0; 3],
        }
    }
}

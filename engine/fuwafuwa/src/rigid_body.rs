//! Rigid bodies: fixed, kinematic, coupled and dynamic.
//!
//! A coupled rigid body follows its target through a spring and a damper, the *virtual coupling* [Colgate
//! 1995]. Because the body has inertia, the coupling force is smooth, and it is the force that a
//! force-feedback device should play. The raw contact force jumps. Contacts turn only dynamic rigid bodies;
//! kinematic and coupled ones turn to their target rotation.

pub mod layers;
pub mod shape;

mod dynamics;
mod inertia;
mod reach;
mod rigid_validation;

use crate::error::{Error, require};
use crate::foundation::arena::{Arena, RigidBodyHandle};
use crate::foundation::dim::{Dim, turning};
use crate::foundation::hash::hash_state;
use crate::math::rotation::Rotation;
use crate::math::velocity::Velocity;
use crate::rigid_body::layers::Layers;
use crate::rigid_body::shape::{Shape, Vector, flat};
use inertia::{Inertia, Matrix};
pub use reach::FARTHEST;
pub(crate) use reach::is_within_reach;
use rigid_validation::check_motion_type;
pub(crate) use rigid_validation::{check_friction, check_restitution};

/// Rigid bodies of a world.
pub type RigidBodies = Arena<RigidBodyHandle, RigidBody>;

/// Motion type of a rigid body.
#[derive(Copy, Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MotionType {
    /// Fixed: never moves. Bodies resting on it may sleep.
    Fixed,
    /// Kinematic: reaches its target pose at the end of each tick, through any obstacle.
    Kinematic,
    /// Coupled: pulled towards its target position by a spring and a damper, and stopped by contacts.
    /// Contacts do not turn it; it turns to its target rotation.
    Coupled {
        /// Mass [kg], 1e-6 to 1e6, default 2. A lighter body follows faster and feels rougher.
        mass: f32,
        /// Spring stiffness [N/m], default 3000. Values above a quarter of mass / substep² are limited to it.
        stiffness: f32,
        /// Damping ratio, above 0 and up to 10, default 0.9. Below 0.5 the body oscillates around its target.
        damping: f32,
        /// Maximum force of the coupling [N], default 1000; infinite = no limit.
        limit: f32,
    },
    /// Dynamic: moved and turned by gravity and contacts. The shape must be bounded and centred on its
    /// origin, see [`RigidBody::dynamic`].
    Dynamic {
        /// Mass [kg], 1e-6 to 1e6, with uniform density. A body ten times as heavy as its soft or rigid
        /// support sinks into it.
        mass: f32,
    },
}

hash_state! {
    enum MotionType {
        Fixed,
        Kinematic,
        Coupled { mass, stiffness, damping, limit },
        Dynamic { mass },
    }
}

impl MotionType {
    /// Returns the moments of inertia of a dynamic body of the shape `form` in a world of `D`.
    fn inertia<D: Dim>(self, form: &Shape) -> Option<Inertia> {
        match self {
            Self::Dynamic { mass } => Some(Inertia::of::<D>(form, mass)),
            _ => None,
        }
    }
}

impl Default for MotionType {
    fn default() -> Self {
        Self::Coupled {
            mass: 2.0,
            stiffness: 3000.0,
            damping: 0.9,
            limit: 1000.0,
        }
    }
}

/// Rigid body. In contacts with soft bodies it collides with their nodes, so a rigid body thinner than three
/// of their voxels may slip in between.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RigidBody {
    /// Coulomb friction coefficient; usual value 0.2. Contacts with soft bodies use this value alone, not
    /// that of the material. Contacts between two rigid bodies use the mean of both, except against a fixed
    /// body. There, a dynamic body uses the value of the fixed body, and a kinematic or coupled body its own.
    pub friction: f32,
    /// Restitution coefficient of contacts between rigid bodies of which one is dynamic, 0 to 1, default 0.
    /// The larger of both values counts. Soft bodies rebound by their elasticity.
    pub restitution: f32,
    /// Motion type.
    pub motion_type: MotionType,
    /// Collision layers.
    pub layers: Layers,
    /// Whether the body is a sensor. A sensor has no contacts, but reports
    /// [`Event::SensorEntered`](crate::Event::SensorEntered) and [`Event::SensorExited`](crate::Event::SensorExited).
    pub is_sensor: bool,
    /// Number for use by the program; the engine ignores it.
    pub user_data: u64,
    /// Shape in local coordinates, and in the world.
    form: Shape,
    shape: Shape,
    /// Position of the local origin [m].
    pub(crate) position: Vector,
    /// Linear velocity [m/s].
    pub(crate) velocity: Vector,
    /// Rotation from local to world axes.
    pub(crate) rotation: Rotation,
    /// Angular velocity [rad/s].
    pub(crate) angular_velocity: Vector,
    /// Whether the body sleeps, and its sleep timer: for how long it has been slow [s].
    pub(crate) asleep: bool,
    pub(crate) sleep_timer: f32,
    /// Position [m] and rotation at the start of the tick.
    position_before: Vector,
    rotation_before: Rotation,
    /// Moments of inertia, for dynamic bodies only, and the inverse inertia matrix about the world axes.
    inertia: Option<Inertia>,
    inverse_inertia: Matrix,
    /// Target position [m] and target rotation.
    goal: Vector,
    rotation_goal: Rotation,
    /// Interpolated target position [m] and its velocity in this tick [m/s].
    goal_before: Vector,
    goal_velocity: Vector,
    /// Reaction of each substep of the last tick.
    pub(crate) reactions: Vec<Reaction>,
}

hash_state! {
    struct RigidBody {
        friction, restitution, motion_type, layers, is_sensor, user_data, form, shape, position, velocity,
        rotation, angular_velocity, asleep, sleep_timer, position_before, rotation_before, inertia,
        inverse_inertia, goal, rotation_goal, goal_before, goal_velocity, reactions,
    }
}

/// Force and torque on a rigid body in one substep.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Reaction {
    /// Contact force [N]; jumps when something tears.
    pub contact: Vector,
    /// Torque of the contacts and knives about [`position`](RigidBody::position) [N m]; in 2D only the third
    /// component.
    pub torque: Vector,
    /// Reversed force of the virtual coupling [N]: the force to play on a force-feedback device.
    pub coupling: Vector,
}

hash_state! { struct Reaction { contact, torque, coupling } }

impl RigidBody {
    /// Returns a fixed rigid body; usual friction 0.2.
    pub fn fixed(shape: Shape, friction: f32) -> Self {
        Self {
            friction,
            ..Self::new(shape, Vector::ZERO, MotionType::Fixed)
        }
    }

    /// Returns a coupled rigid body with the default coupling, at rest at `position` [m]: a ball (2D: a disc)
    /// of the given radius [m].
    pub fn coupled_ball(position: Vector, radius: f32) -> Self {
        let centre = Vector::ZERO;
        Self::new(
            Shape::Ball { centre, radius },
            position,
            MotionType::default(),
        )
    }

    /// Returns a rigid body of any bounded shape and motion type, at rest at `position` [m]. `form` is the
    /// shape in local coordinates, preferably centred on the origin.
    pub fn new(form: Shape, position: Vector, drive: MotionType) -> Self {
        Self {
            friction: 0.2,
            motion_type: drive,
            layers: Layers::default(),
            is_sensor: false,
            user_data: 0,
            form,
            shape: form.translated(position),
            position,
            restitution: 0.0,
            velocity: Vector::ZERO,
            rotation: Rotation::NONE,
            angular_velocity: Vector::ZERO,
            asleep: false,
            sleep_timer: 0.0,
            position_before: position,
            rotation_before: Rotation::NONE,
            inertia: None,
            inverse_inertia: [Vector::ZERO; 3],
            goal: position,
            rotation_goal: Rotation::NONE,
            goal_before: position,
            goal_velocity: Vector::ZERO,
            reactions: Vec::new(),
        }
    }

    /// Returns a dynamic rigid body of a mass [kg], at rest at the position of `shape`; friction 0.5.
    ///
    /// ```
    /// use fuwafuwa::{Dim3, RigidBody, Rotation, WorldConfig, Shape, World};
    ///
    /// let mut world = World::<Dim3>::new(WorldConfig::default())?;
    /// world.add_rigid_body(RigidBody::fixed(Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]), 0.5))?;
    /// let cube = Shape::Box { centre: [0.0, 2.0, 0.0], half: [0.5; 3] };
    /// let turned = Rotation::about([1.0, 1.0, 0.0], 0.4);
    /// let cube = world.add_rigid_body(RigidBody::dynamic(cube, 10.0).rotated(turned))?;
    /// for _ in 0..180 {
    ///     world.step();
    /// }
    /// let cube = &world.rigid_bodies()[cube];
    /// assert!((cube.position()[1] - 0.5).abs() < 0.01 && cube.is_asleep());
    /// # Ok::<(), fuwafuwa::Error>(())
    /// ```
    pub fn dynamic(shape: Shape, mass: f32) -> Self {
        let [low, high] = shape.bounds();
        let middle = (low + high) * 0.5;
        let middle = if middle.is_finite() {
            middle
        } else {
            Vector::ZERO
        };
        let form = shape.translated(-middle);
        Self {
            friction: 0.5,
            ..Self::new(form, middle, MotionType::Dynamic { mass })
        }
    }

    /// Returns the body rotated about its [`position`](RigidBody::position), target included.
    #[must_use]
    pub fn rotated(self, by: Rotation) -> Self {
        let rotation = self.rotation.then(by);
        Self {
            rotation,
            rotation_before: rotation,
            rotation_goal: rotation,
            shape: self.form.rotated(rotation).translated(self.position),
            ..self
        }
    }

    /// Returns the body rotated about a point [m], velocities and target included.
    #[must_use]
    pub fn rotated_about(self, rotation: Rotation, point: Vector) -> Self {
        let apart = rotation.apply_about(self.position, point) - self.position;
        let mut rotated = self.translated(apart).rotated(rotation);
        rotated.rotate_velocity(rotation);
        rotated
    }

    /// Returns the body translated `by` [m], target included.
    #[must_use]
    pub fn translated(self, by: Vector) -> Self {
        let position = self.position + by;
        let goal = self.goal + by;
        Self {
            position,
            position_before: position,
            goal,
            goal_before: goal,
            shape: self.form.rotated(self.rotation).translated(position),
            ..self
        }
    }

    /// Returns the body with a velocity: linear, or linear and angular. Only dynamic bodies keep it.
    #[must_use]
    pub fn with_velocity(self, velocity: impl Into<Velocity>) -> Self {
        let Velocity { linear, angular } = velocity.into();
        Self {
            velocity: linear,
            angular_velocity: angular,
            ..self
        }
    }

    /// Returns the body with another motion type.
    #[must_use]
    pub fn with_motion_type(self, motion_type: MotionType) -> Self {
        Self {
            motion_type,
            ..self
        }
    }

    /// Returns the body with another [friction](RigidBody::friction) coefficient.
    #[must_use]
    pub fn with_friction(self, friction: f32) -> Self {
        Self { friction, ..self }
    }

    /// Returns the body with another [restitution](RigidBody::restitution) coefficient.
    #[must_use]
    pub fn with_restitution(self, restitution: f32) -> Self {
        Self {
            restitution,
            ..self
        }
    }

    /// Returns the body with other collision layers.
    #[must_use]
    pub fn with_layers(self, layers: Layers) -> Self {
        Self { layers, ..self }
    }

    /// Returns the body as a [sensor](RigidBody::is_sensor), or as a body with contacts.
    #[must_use]
    pub fn with_sensor(self, is_sensor: bool) -> Self {
        Self { is_sensor, ..self }
    }

    /// Returns the body with other [user data](RigidBody::user_data).
    #[must_use]
    pub fn with_user_data(self, user_data: u64) -> Self {
        Self { user_data, ..self }
    }

    /// Returns the body for a world of `D`: in 2D third coordinates are set to 0.
    pub(crate) fn seen_in<D: Dim>(mut self) -> Self {
        self.form = self.form.seen_in::<D>();
        let positions = [&mut self.position, &mut self.goal, &mut self.goal_before];
        let others = [&mut self.position_before, &mut self.velocity];
        for vector in positions.into_iter().chain(others) {
            *vector = flat::<D>(*vector);
        }
        let rotations = [&mut self.rotation_before, &mut self.rotation_goal];
        for rotation in rotations.into_iter().chain([&mut self.rotation]) {
            *rotation = rotation.seen_in::<D>();
        }
        self.angular_velocity = turning::<D>(self.angular_velocity);
        self.clear_unused_motion();
        self.inertia = self.motion_type.inertia::<D>(&self.form);
        self.stand_at(self.position, self.rotation);
        self
    }

    /// Sets the velocities to 0 that a body of this motion type cannot have.
    fn clear_unused_motion(&mut self) {
        if self.motion_type == MotionType::Fixed {
            // The body may have been kinematic or coupled before.
            (self.velocity, self.goal_velocity) = (Vector::ZERO, Vector::ZERO);
            self.stay();
        }
        if matches!(
            self.motion_type,
            MotionType::Fixed | MotionType::Coupled { .. }
        ) {
            self.angular_velocity = Vector::ZERO;
        }
    }

    /// Sets the motion type in a world of `D`. If it differs from the present one, the present pose becomes the target.
    pub(crate) fn set_motion_type<D: Dim>(&mut self, motion_type: MotionType) -> Result<(), Error> {
        let inertia = motion_type.inertia::<D>(&self.form);
        check_motion_type(motion_type, &self.form, inertia.as_ref())?;
        if motion_type != self.motion_type {
            self.stay();
        }
        (self.motion_type, self.inertia) = (motion_type, inertia);
        self.clear_unused_motion();
        self.stand_at(self.position, self.rotation);
        Ok(())
    }

    /// Returns the position of the local origin [m]: the centre of a [`RigidBody::coupled_ball`].
    pub fn position(&self) -> Vector {
        self.position
    }

    /// Returns the linear velocity [m/s].
    pub fn velocity(&self) -> Vector {
        self.velocity
    }

    /// Returns the rotation from local to world axes.
    pub fn rotation(&self) -> Rotation {
        self.rotation
    }

    /// Returns the angular velocity [rad/s]; in 2D only the third component.
    pub fn angular_velocity(&self) -> Vector {
        self.angular_velocity
    }

    /// Returns the target position [m].
    pub fn target_position(&self) -> Vector {
        self.goal
    }

    /// Returns the reactions, one for each substep of the last tick.
    pub fn reactions(&self) -> &[Reaction] {
        &self.reactions
    }

    /// Returns the shape in local coordinates.
    pub fn form(&self) -> &Shape {
        &self.form
    }

    /// Returns the shape in world coordinates.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Returns whether the body follows a target: it is kinematic or coupled.
    pub fn follows_target(&self) -> bool {
        matches!(
            self.motion_type,
            MotionType::Kinematic | MotionType::Coupled { .. }
        )
    }

    /// Returns an error unless the body follows a target.
    fn require_target(&self) -> Result<(), Error> {
        let expected = "kinematic or coupled";
        require(
            self.follows_target(),
            "motion_type",
            expected,
            self.motion_type,
        )
    }

    /// Sets the target position [m]; in 2D the third coordinate is ignored.
    pub(crate) fn send<D: Dim>(&mut self, goal: Vector) -> Result<(), Error> {
        self.require_target()?;
        let expected = "within 1e6 m of the origin";
        require(is_within_reach(goal), "position", expected, goal)?;
        self.goal = flat::<D>(goal);
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

    /// Starts a tick of `duration` [s], in which the target moves at a constant velocity.
    pub(crate) fn start_tick(&mut self, duration: f32) {
        (self.position_before, self.rotation_before) = (self.position, self.rotation);
        self.goal_velocity = (self.goal - self.goal_before) * (1.0 / duration);
        if self.follows_target() && self.rotation != self.rotation_goal
            || self.motion_type == MotionType::Kinematic
        {
            let way = self.rotation.inverse().then(self.rotation_goal);
            self.angular_velocity = way.scaled_axis() * (1.0 / duration);
        }
        self.reactions.clear();
    }

    /// Ends a tick: the target stops, and the rotation is set to its target. A body that is non-finite or out
    /// of range is reset to its pose at the start of the tick, at rest.
    pub(crate) fn end_tick(&mut self) {
        self.goal_before = self.goal;
        if self.follows_target() && self.rotation != self.rotation_goal {
            self.stand_at(self.position, self.rotation_goal);
        }
        if matches!(self.motion_type, MotionType::Coupled { .. }) {
            self.angular_velocity = Vector::ZERO;
        }
        let is_finite = self.velocity.is_finite() && self.angular_velocity.is_finite();
        if !is_finite || !is_within_reach(self.position) {
            self.stand_at(self.position_before, self.rotation_before);
            (self.velocity, self.angular_velocity) = (Vector::ZERO, Vector::ZERO);
            self.reactions.fill(Reaction::default());
        }
    }

    /// Applies the virtual coupling, or the velocity of a kinematic body, for `duration` [s].
    pub(crate) fn pull(&mut self, duration: f32) {
        self.goal_before += self.goal_velocity * duration;
        let mut reaction = Reaction::default();
        match self.motion_type {
            MotionType::Fixed => return,
            MotionType::Dynamic { .. } => {}
            MotionType::Kinematic => {
                self.velocity = (self.goal_before - self.position) * (1.0 / duration);
            }
            MotionType::Coupled {
                mass,
                stiffness,
                damping,
                limit,
            } => {
                // Limits the stiffness to the stability limit of this substep.
                let stiffness = stiffness.min(0.25 * mass / (duration * duration));
                let damper = 2.0 * damping * (stiffness * mass).sqrt();
                let stretch = self.goal_before - self.position;
                let slip = self.goal_velocity - self.velocity;
                let wish = stretch * stiffness + slip * damper;
                let strength = wish.length();
                let force = if strength > limit {
                    wish * (limit / strength)
                } else {
                    wish
                };
                self.velocity += force * (duration / mass);
                reaction.coupling = -force;
            }
        }
        self.reactions.push(reaction);
    }

    /// Applies an impulse [N s] of a contact, within a substep of `duration` [s].
    #[inline(always)]
    pub(crate) fn push(&mut self, impulse: Vector, duration: f32) {
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
    pub(crate) fn twist(&mut self, torque: Vector) {
        if let Some(reaction) = self.reactions.last_mut() {
            reaction.torque += torque;
        }
    }

    fn stand_at(&mut self, position: Vector, rotation: Rotation) {
        (self.position, self.rotation) = (position, rotation);
        self.shape = self.form.rotated(rotation).translated(position);
        if let Some(inertia) = &self.inertia {
            self.inverse_inertia = inertia.inverse(rotation);
        }
    }
}

//! What is rigid: walls, bars and floors that stand, and the hands that players move.
//!
//! Between the goal of a hand, which the input moves, and the hand stands a spring with a damper, the
//! *virtual coupling* [Colgate 1995]. Its force is smooth, because the hand has inertia, and it is
//! what a force-feedback device should play; the raw contact force jumps. What is *free* falls, turns and is pushed
//! around; hands and what is kinematic turn as they are told.

mod bad;
mod check;
mod free;
mod inertia;

use crate::dim::{Dim, turning};
use crate::handle::{Arena, RigidId};
use crate::layers::Layers;
use crate::rotation::Rotation;
use crate::shape::{Shape, Vector};
use crate::vector::{is_finite, length, minus, plus, scaled};
pub use bad::{BadRigid, FARTHEST};
use bad::{is_within_reach, require};
use inertia::{Inertia, Matrix};

/// The rigid things of a world.
pub type Rigids = Arena<RigidId, Rigid>;

/// What moves a rigid thing.
#[derive(Copy, Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Drive {
    /// Nothing: it stays where it is, and what rests on it may sleep.
    Fixed,
    /// It is at its goal at the end of each tick, whatever is in the way.
    Kinematic,
    /// It is pulled by a spring and a damper and stopped by what it touches; it turns as it is told, whatever that does.
    Coupled {
        /// Mass of the hand, 1e-6 to 1e6 [kg]; about 2. Lighter is livelier, and rougher to feel.
        mass: f32,
        /// Stiffness of the spring [N/m]; about 3000. What is more than a quarter of
        /// mass / substep² counts as that much.
        stiffness: f32,
        /// Damping ratio, up to 10; about 0.9. Below 0.5 the hand swings around its goal.
        damping: f32,
        /// The strongest pull of the coupling [N]; infinite = no limit.
        limit: f32,
    },
    /// It falls, and is moved and turned by what it touches. Its shape has an end, and its middle at the origin: see
    /// [`Rigid::free`].
    Free {
        /// Its mass, 1e-6 to 1e6 [kg], spread evenly. What is ten times as heavy as what bears it, soft or rigid,
        /// sinks into it.
        mass: f32,
    },
}

impl Default for Drive {
    fn default() -> Self {
        Self::Coupled {
            mass: 2.0,
            stiffness: 3000.0,
            damping: 0.9,
            limit: 1000.0,
        }
    }
}

/// Something rigid: an obstacle, which stands still, a hand, which follows its goal, or what is free. Of a soft body it meets
/// the nodes: what is thinner than three of its voxels may slip in between them.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Rigid {
    /// Coulomb friction with what it touches; about 0.2. With soft bodies it counts alone, whatever their materials say.
    /// Of two rigid things the mean counts, but with what is fixed that of the fixed one where the other is free, and that
    /// of the hand where it is a hand.
    pub friction: f32,
    /// Share of its speed with which it bounces off something else that is rigid, 0 to 1, where one of both is free; the
    /// larger one counts. About 0; soft bodies bounce by themselves.
    pub restitution: f32,
    /// What moves it.
    pub drive: Drive,
    /// Who touches it.
    pub layers: Layers,
    /// Whether it touches nobody, and tells who comes into it: [`Event::Entered`](crate::Event::Entered) and
    /// [`Event::Left`](crate::Event::Left).
    pub is_sensor: bool,
    /// What whoever put it into a world wants to know of it.
    pub user_data: u64,
    /// As it would be at the origin, and where it is.
    form: Shape,
    shape: Shape,
    /// How far from the origin it is [m].
    pub(crate) position: Vector,
    /// [m/s]
    pub(crate) velocity: Vector,
    /// How it is turned from its form.
    pub(crate) rotation: Rotation,
    /// [rad/s]
    pub(crate) spin: Vector,
    /// Whether it rests, and for how long it has been slow [s].
    pub(crate) asleep: bool,
    pub(crate) still: f32,
    /// Where it was at the start of the tick [m], and how it was turned.
    position_before: Vector,
    rotation_before: Rotation,
    /// What it turns by, if it is free, and the inverse of that about the axes of the world.
    inertia: Option<Inertia>,
    inverse_inertia: Matrix,
    /// Where it is to go [m].
    goal: Vector,
    rotation_goal: Rotation,
    /// Where the goal was at the end of the last tick [m], and how fast it moves [m/s].
    goal_before: Vector,
    goal_velocity: Vector,
    /// For each substep of the last tick.
    pub(crate) reactions: Vec<Reaction>,
}

/// What a hand feels in one substep.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Reaction {
    /// Force of everything it touches [N]; jumps when something tears.
    pub contact: Vector,
    /// Torque of the bodies that it touches, about its [`position`](Rigid::position) [N m]; in the plane the third
    /// component alone.
    pub torque: Vector,
    /// Force of the coupling towards the goal, reversed [N]: what a stick should push back with.
    pub coupling: Vector,
}

impl Rigid {
    /// A shape that stands still where it is; of friction about 0.2.
    pub fn fixed(shape: Shape, friction: f32) -> Self {
        Self {
            friction,
            ..Self::driven(shape, [0.0; 3], Drive::Fixed)
        }
    }

    /// A hand: a ball (2D: a disc) of the given radius [m], at rest at `position` [m], with the usual coupling.
    pub fn hand(position: Vector, radius: f32) -> Self {
        let centre = [0.0; 3];
        Self::driven(Shape::Ball { centre, radius }, position, Drive::default())
    }

    /// A hand of any shape that ends somewhere, at rest at `position` [m]. `form` is what it would be at the origin,
    /// best with its middle there.
    pub fn driven(form: Shape, position: Vector, drive: Drive) -> Self {
        Self {
            friction: 0.2,
            drive,
            layers: Layers::default(),
            is_sensor: false,
            user_data: 0,
            form,
            shape: form.moved(position),
            position,
            restitution: 0.0,
            velocity: [0.0; 3],
            rotation: Rotation::NONE,
            spin: [0.0; 3],
            asleep: false,
            still: 0.0,
            position_before: position,
            rotation_before: Rotation::NONE,
            inertia: None,
            inverse_inertia: [[0.0; 3]; 3],
            goal: position,
            rotation_goal: Rotation::NONE,
            goal_before: position,
            goal_velocity: [0.0; 3],
            reactions: Vec::new(),
        }
    }

    /// Something that falls, of a mass [kg], at rest where the shape is.
    ///
    /// ```
    /// use fuwafuwa::{Dim3, Rigid, Rotation, Settings, Shape, World};
    ///
    /// let mut world = World::<Dim3>::new(Settings::default())?;
    /// world.add_rigid(Rigid::fixed(Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]), 0.5))?;
    /// let cube = Shape::Box { centre: [0.0, 2.0, 0.0], half: [0.5; 3] };
    /// let turned = Rotation::about([1.0, 1.0, 0.0], 0.4);
    /// let cube = world.add_rigid(Rigid::free(cube, 10.0).rotated(turned))?;
    /// for _ in 0..180 {
    ///     world.step();
    /// }
    /// let cube = &world.rigids()[cube];
    /// assert!((cube.position()[1] - 0.5).abs() < 0.01 && cube.is_asleep());
    /// # Ok::<(), fuwafuwa::Refused>(())
    /// ```
    pub fn free(shape: Shape, mass: f32) -> Self {
        let [low, high] = shape.bounds();
        let middle = scaled(plus(low, high), 0.5);
        let middle = if is_finite(middle) { middle } else { [0.0; 3] };
        let form = shape.moved(scaled(middle, -1.0));
        Self {
            friction: 0.5,
            ..Self::driven(form, middle, Drive::Free { mass })
        }
    }

    /// The same turned about its [`position`](Rigid::position).
    #[must_use]
    pub fn rotated(self, by: Rotation) -> Self {
        let rotation = self.rotation.then(by);
        Self {
            rotation,
            rotation_before: rotation,
            rotation_goal: rotation,
            shape: self.form.rotated(rotation).moved(self.position),
            ..self
        }
    }

    /// The same with another drive.
    pub fn with_drive(self, drive: Drive) -> Self {
        Self { drive, ..self }
    }

    /// As a world of `D` sees it: in the plane third coordinates do not count.
    pub(crate) fn seen_in<D: Dim>(mut self) -> Self {
        self.form = self.form.seen_in::<D>();
        let positions = [&mut self.position, &mut self.goal, &mut self.goal_before];
        let others = [&mut self.position_before, &mut self.velocity];
        for vector in positions.into_iter().chain(others) {
            vector[D::N..].fill(0.0);
        }
        let rotations = [&mut self.rotation_before, &mut self.rotation_goal];
        for rotation in rotations.into_iter().chain([&mut self.rotation]) {
            *rotation = rotation.seen_in::<D>();
        }
        self.spin = turning::<D>(self.spin);
        if self.drive == Drive::Fixed {
            // It may have been a hand.
            (self.velocity, self.goal_velocity) = ([0.0; 3], [0.0; 3]);
            self.stay();
        }
        if matches!(self.drive, Drive::Fixed | Drive::Coupled { .. }) {
            self.spin = [0.0; 3];
        }
        self.take_inertia::<D>();
        self.stand_at(self.position, self.rotation);
        self
    }

    /// How far what it would be at the origin was moved [m]: of a hand of the usual form, its middle.
    pub fn position(&self) -> Vector {
        self.position
    }

    /// Velocity [m/s].
    pub fn velocity(&self) -> Vector {
        self.velocity
    }

    /// How it is turned from its form.
    pub fn rotation(&self) -> Rotation {
        self.rotation
    }

    /// Angular velocity [rad/s]; in the plane the third component alone.
    pub fn angular_velocity(&self) -> Vector {
        self.spin
    }

    /// Where it is to go [m].
    pub fn goal(&self) -> Vector {
        self.goal
    }

    /// What it felt, one entry for each substep of the last tick.
    pub fn reactions(&self) -> &[Reaction] {
        &self.reactions
    }

    /// What it would be at the origin.
    pub fn form(&self) -> &Shape {
        &self.form
    }

    /// Its shape where it is now.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Whether it follows a goal: a hand, no obstacle.
    pub fn is_driven(&self) -> bool {
        matches!(self.drive, Drive::Kinematic | Drive::Coupled { .. })
    }

    /// Sends it to a goal [m]; the third coordinate does not count in the plane.
    pub(crate) fn send<D: Dim>(&mut self, goal: Vector) -> Result<(), BadRigid> {
        require(self.is_driven(), "drive", "one that follows a goal")?;
        require(is_within_reach(goal), "goal", "within 1e6 m of the origin")?;
        self.goal[..D::N].copy_from_slice(&goal[..D::N]);
        Ok(())
    }

    /// One over its mass as contact sees it [1/kg]; 0 when nothing can push it.
    #[inline(always)]
    pub(crate) fn inverse_mass(&self) -> f32 {
        match self.drive {
            Drive::Fixed | Drive::Kinematic => 0.0,
            Drive::Free { .. } if self.asleep => 0.0,
            Drive::Coupled { mass, .. } | Drive::Free { mass } => 1.0 / mass,
        }
    }

    /// Takes up the goal at the start of a tick of `duration` [s]: it moves there evenly.
    pub(crate) fn start_tick(&mut self, duration: f32) {
        (self.position_before, self.rotation_before) = (self.position, self.rotation);
        self.goal_velocity = scaled(minus(self.goal, self.goal_before), 1.0 / duration);
        if self.is_driven() && self.rotation != self.rotation_goal || self.drive == Drive::Kinematic
        {
            let way = self.rotation.inverse().then(self.rotation_goal);
            self.spin = scaled(way.scaled_axis(), 1.0 / duration);
        }
        self.reactions.clear();
    }

    /// The goal stands still at the end of a tick. A hand that was thrown out of the world is back
    /// where it was, at rest.
    pub(crate) fn end_tick(&mut self) {
        self.goal_before = self.goal;
        if self.is_driven() && self.rotation != self.rotation_goal {
            self.stand_at(self.position, self.rotation_goal);
        }
        if matches!(self.drive, Drive::Coupled { .. }) {
            self.spin = [0.0; 3];
        }
        let is_finite = is_finite(self.velocity) && is_finite(self.spin);
        if !is_finite || !is_within_reach(self.position) {
            self.stand_at(self.position_before, self.rotation_before);
            (self.velocity, self.spin) = ([0.0; 3], [0.0; 3]);
            self.reactions.fill(Reaction::default());
        }
    }

    /// Pulls the hand towards its goal for `duration` [s].
    pub(crate) fn pull(&mut self, duration: f32) {
        self.goal_before = plus(self.goal_before, scaled(self.goal_velocity, duration));
        let mut reaction = Reaction::default();
        match self.drive {
            Drive::Fixed => return,
            Drive::Free { .. } => {}
            Drive::Kinematic => {
                self.velocity = scaled(minus(self.goal_before, self.position), 1.0 / duration);
            }
            Drive::Coupled {
                mass,
                stiffness,
                damping,
                limit,
            } => {
                // A coupling stiffer than the substep bears is as stiff as it bears.
                let stiffness = stiffness.min(0.25 * mass / (duration * duration));
                let damper = 2.0 * damping * (stiffness * mass).sqrt();
                let stretch = minus(self.goal_before, self.position);
                let slip = minus(self.goal_velocity, self.velocity);
                let wish = plus(scaled(stretch, stiffness), scaled(slip, damper));
                let strength = length(wish);
                let force = if strength > limit {
                    scaled(wish, limit / strength)
                } else {
                    wish
                };
                self.velocity = plus(self.velocity, scaled(force, duration / mass));
                reaction.coupling = scaled(force, -1.0);
            }
        }
        self.reactions.push(reaction);
    }

    /// Feels an impulse [N s] of something that it touches, within a substep of `duration` [s].
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

    /// Feels a torque [N m] of bodies that it touches.
    pub(crate) fn twist(&mut self, torque: Vector) {
        if let Some(reaction) = self.reactions.last_mut() {
            reaction.torque = plus(reaction.torque, torque);
        }
    }

    fn stand_at(&mut self, position: Vector, rotation: Rotation) {
        (self.position, self.rotation) = (position, rotation);
        self.shape = self.form.rotated(rotation).moved(position);
        if let Some(inertia) = &self.inertia {
            self.inverse_inertia = inertia.inverse(rotation);
        }
    }
}

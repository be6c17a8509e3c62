//! The player's rigid hand: a ball that follows a goal and is stopped by what it touches.
//!
//! Between the goal, which the input moves, and the hand stands a spring with a damper, the
//! *virtual coupling* [Colgate 1995]. Its force is smooth, because the hand has inertia, and it is
//! what a force-feedback device should play; the raw contact force jumps.

use crate::shape::{Shape, Vector};
use crate::vector::{length, minus, plus, scaled};
use std::fmt;

/// Hands and goals further from the origin than this on an axis [m] are refused, like those that
/// are no place at all: single precision has no millimetres out there, and no such speeds.
pub const FARTHEST: f32 = 1e6;

/// How a manipulator follows its goal.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Drive {
    /// It is at its goal at the end of each tick, whatever is in the way.
    Kinematic,
    /// It is pulled by a spring and a damper and stopped by what it touches.
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

/// A rigid ball (2D: a disc) that a player moves.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Manipulator {
    /// Radius [m].
    pub radius: f32,
    /// Coulomb friction with what it touches; about 0.2.
    pub friction: f32,
    /// How it follows its goal.
    pub drive: Drive,
    /// Middle [m].
    pub(crate) position: Vector,
    /// [m/s]
    pub(crate) velocity: Vector,
    /// Where it was at the start of the tick [m].
    pub(crate) position_before: Vector,
    /// Where it is to go [m].
    pub(crate) goal: Vector,
    /// Where the goal was at the end of the last tick [m], and how fast it moves [m/s].
    pub(crate) goal_before: Vector,
    pub(crate) goal_velocity: Vector,
    /// For each substep of the last tick.
    pub(crate) reactions: Vec<Reaction>,
}

/// What a manipulator feels in one substep.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Reaction {
    /// Force of everything it touches [N]; jumps when something tears.
    pub contact: Vector,
    /// Force of the coupling towards the goal, reversed [N]: what a stick should push back with.
    pub coupling: Vector,
}

/// A manipulator that cannot be: which field, and what it must be.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct BadManipulator {
    /// The field.
    pub field: &'static str,
    /// What was expected.
    pub expected: &'static str,
}

impl fmt::Display for BadManipulator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { field, expected } = self;
        write!(f, "the manipulator's {field} must be {expected}")
    }
}

impl std::error::Error for BadManipulator {}

impl Manipulator {
    /// A hand of the given radius [m], at rest at `position` [m], with the usual coupling.
    pub fn new(position: Vector, radius: f32) -> Self {
        Self {
            radius,
            friction: 0.2,
            drive: Drive::default(),
            position,
            velocity: [0.0; 3],
            position_before: position,
            goal: position,
            goal_before: position,
            goal_velocity: [0.0; 3],
            reactions: Vec::new(),
        }
    }

    /// The same hand with another drive.
    pub fn driven(self, drive: Drive) -> Self {
        Self { drive, ..self }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// [`BadManipulator`] names the first field that is out of range.
    pub fn check(&self) -> Result<(), BadManipulator> {
        let within = |field, k: f32, low: f32, high: f32, expected| {
            let good = k >= low && k <= high;
            good.then_some(()).ok_or(BadManipulator { field, expected })
        };
        let (tiny, huge) = (f32::MIN_POSITIVE, f32::MAX);
        let is_place = is_place(self.position);
        let (field, expected) = ("position", "within 1e6 m of the origin");
        is_place
            .then_some(())
            .ok_or(BadManipulator { field, expected })?;
        within(
            "radius",
            self.radius,
            tiny,
            FARTHEST,
            "positive, at most 1e6 m",
        )?;
        within(
            "friction",
            self.friction,
            0.0,
            huge,
            "0 or more, and finite",
        )?;
        match self.drive {
            Drive::Kinematic => Ok(()),
            Drive::Coupled {
                mass,
                stiffness,
                damping,
                limit,
            } => {
                within("mass", mass, 1e-6, 1e6, "1e-6 to 1e6 kg")?;
                within("stiffness", stiffness, tiny, huge, "positive and finite")?;
                within("damping", damping, tiny, 10.0, "positive, at most 10")?;
                within("limit", limit, tiny, f32::INFINITY, "positive")
            }
        }
    }

    /// Middle [m].
    pub fn position(&self) -> Vector {
        self.position
    }

    /// Velocity [m/s].
    pub fn velocity(&self) -> Vector {
        self.velocity
    }

    /// Where it is to go [m].
    pub fn goal(&self) -> Vector {
        self.goal
    }

    /// What it felt, one entry for each substep of the last tick.
    pub fn reactions(&self) -> &[Reaction] {
        &self.reactions
    }

    /// The ball that it is.
    pub fn shape(&self) -> Shape {
        Shape::Ball {
            centre: self.position,
            radius: self.radius,
        }
    }

    /// One over its mass as contact sees it [1/kg]; 0 when nothing can push it.
    pub(crate) fn inverse_mass(&self) -> f32 {
        match self.drive {
            Drive::Kinematic => 0.0,
            Drive::Coupled { mass, .. } => 1.0 / mass,
        }
    }

    /// Takes up the goal at the start of a tick of `duration` [s]: it moves there evenly.
    pub(crate) fn start_tick(&mut self, duration: f32) {
        self.position_before = self.position;
        self.goal_velocity = scaled(minus(self.goal, self.goal_before), 1.0 / duration);
        self.reactions.clear();
    }

    /// The goal stands still at the end of a tick. A hand that was thrown out of the world is back
    /// where it was, at rest.
    pub(crate) fn end_tick(&mut self) {
        self.goal_before = self.goal;
        let is_finite = self.velocity.iter().all(|k| k.is_finite());
        if !is_finite || !is_place(self.position) {
            self.position = self.position_before;
            self.velocity = [0.0; 3];
            self.reactions.fill(Reaction::default());
        }
    }

    /// Pulls the hand towards its goal for `duration` [s].
    pub(crate) fn pull(&mut self, duration: f32) {
        self.goal_before = plus(self.goal_before, scaled(self.goal_velocity, duration));
        let mut reaction = Reaction::default();
        match self.drive {
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

    /// Moves the hand by its velocity.
    pub(crate) fn drift(&mut self, duration: f32) {
        self.position = plus(self.position, scaled(self.velocity, duration));
    }
}

/// Whether a hand or its goal may be there.
pub(crate) fn is_place(at: Vector) -> bool {
    at.iter().all(|k| k.abs() <= FARTHEST)
}

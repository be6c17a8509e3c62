//! Configuration of a world: gravity, air drag, substeps, tick length and sleep.

use crate::contact::rest_speeds::RestSpeeds;
use crate::error::{Error, require};
use crate::foundation::dim::{Dim, DimVector};
use crate::foundation::hash::hash_state;
use glam::Vec3;

/// Default tick length [s]; see [`WorldConfig::tick`].
pub const DEFAULT_TICK: f32 = 1.0 / 60.0;
/// Minimum number of substeps in 1/60 s, unless [`WorldConfig::max_substeps`] is lower. 16 substeps give a
/// force-feedback device 960 force updates a second.
pub const DEFAULT_SUBSTEPS: u32 = 16;
/// Smallest value of [`WorldConfig::max_substeps`]. Half of the default minimum suffices: a soft ball is
/// squashed no further with 8 substeps than with 16.
pub const MIN_SUBSTEPS: u32 = 8;
/// Shortest tick length [s]. Fracture and damping run at 240 Hz, but at least once per tick, so they would
/// run too often in shorter ticks.
pub const MIN_TICK: f32 = 1.0 / 240.0;
/// Longest tick length [s]. Kinematic targets, embedded contact spheres and sleep are updated only once per
/// tick, so longer ticks would delay them visibly.
pub const MAX_TICK: f32 = 1.0 / 30.0;
/// Rate at which nodes are tested for fracture and damping is applied [1/s]: once per four substeps at the
/// usual 960 substeps a second. An overloaded node takes about 1/240 s to fail, so testing more often would
/// gain little.
const ROUNDS: f64 = 240.0;

/// Maximum number of substeps in 1/60 s under [`StiffBodies::Exact`]. It bounds the time of a tick. A body of
/// the default material, 0.5 mm wide in 32 voxels, requires 15,000; single precision no longer resolves the
/// motion in substeps much shorter than the limit.
pub const MAX_EXACT_SUBSTEPS: u32 = 65_536;

/// Treatment of soft bodies that require more substeps than [`WorldConfig::max_substeps`]: bodies that are
/// stiff, light, or made of small voxels.
///
/// [`StepReport::scaled_bodies`](crate::StepReport::scaled_bodies) and
/// [`Event::StiffBodyScaled`](crate::Event::StiffBodyScaled) tell when a body is scaled.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum StiffBodies {
    /// As many substeps as the stiffest body requires, up to [`MAX_EXACT_SUBSTEPS`] in 1/60 s.
    /// [`WorldConfig::max_substeps`] does not limit them. The time of a tick grows in proportion to the
    /// substeps. Bodies that require still more have their mass scaled.
    Exact,
    /// *Selective mass scaling*: the inertia of deformation is multiplied by the
    /// [mass scale](crate::SoftBody::mass_scale) s, the squared ratio of the required and the allowed number
    /// of substeps. Deformation is √s times slower, uniform stretching at most √s times. Rigid motion keeps the true mass, so shape and stress at
    /// rest, the load of fracture, momentum and free fall are exact. Bounces lose height from s = 2 on.
    ///
    /// A piece with fixed nodes, or with nodes that a grip holds, has no free rigid motion. It is exact at rest;
    /// it swings √s times slower, and a moving fixed node feels s times its inertia.
    #[default]
    MassScaled,
    /// Young's modulus is multiplied by the [stiffness scale](crate::SoftBody::stiffness_scale), 1/s. The
    /// body sags as if it were made of a softer material.
    Softened,
}

hash_state! { enum StiffBodies { Exact, MassScaled, Softened } }

/// Configuration of a world.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct WorldConfig<D: Dim> {
    /// Gravity [m/s²], default 9.81 downwards, along the negative second axis.
    pub gravity: D::Vector,
    /// Air drag: decay rate of all velocities [1/s], 0 to 10, default 0. Without gravity and with a drag of
    /// about 1, bodies float.
    pub drag: f32,
    /// Maximum number of substeps in 1/60 s, 8 to 1024, default 64; scaled in proportion for other tick
    /// lengths. [`WorldConfig::stiff_bodies`] says what happens to soft bodies that require more. Values below
    /// 16 reduce the cost of large soft bodies.
    pub max_substeps: u32,
    /// Treatment of soft bodies that require more than `max_substeps`; default [`StiffBodies::MassScaled`].
    pub stiff_bodies: StiffBodies,
    /// Tick length [s], 1/240 to 1/30, default 1/60. It sets how often targets, events and contact changes
    /// are exchanged with the program. Substeps, fracture and damping keep their rates per second; shorter
    /// ticks cost a little more. Worlds of different tick lengths behave alike but are not bit-identical.
    pub tick: f32,
    /// Whether bodies that are at rest fall asleep by themselves, default true. A sleeping body costs no time
    /// and moves only after it wakes. The [guide](crate::guide::acting) has the rule by which bodies fall
    /// asleep and wake. Even if this is false, [`World::put_to_sleep`](crate::World::put_to_sleep) works.
    pub sleep: bool,
}

hash_state! { [D: Dim] struct WorldConfig<D> { gravity, drag, max_substeps, stiff_bodies, tick, sleep } }

impl<D: Dim> Default for WorldConfig<D> {
    fn default() -> Self {
        Self {
            gravity: D::Vector::from_vec3(Vec3::new(0.0, -9.81, 0.0)),
            drag: 0.0,
            max_substeps: 64,
            stiff_bodies: StiffBodies::default(),
            tick: DEFAULT_TICK,
            sleep: true,
        }
    }
}

impl<D: Dim> WorldConfig<D> {
    /// Converts a rate [1/s] to a whole number of repetitions per tick, at least 1.
    pub(super) fn per_tick(&self, per_second: f64) -> u32 {
        ((f64::from(self.tick) * per_second + 0.5) as u32).max(1)
    }

    /// Returns how often per tick fracture is tested and damping is applied.
    pub(super) fn fracture_rounds_per_tick(&self) -> u32 {
        self.per_tick(ROUNDS)
    }

    /// Returns the time between two tests for fracture, which is also the time between two applications of
    /// damping [s].
    pub(super) fn fracture_interval(&self) -> f32 {
        self.tick / self.fracture_rounds_per_tick() as f32
    }

    /// Returns the number of substeps per tick that soft bodies can require at most.
    pub(super) fn max_substeps_per_tick(&self) -> u32 {
        let max = match self.stiff_bodies {
            StiffBodies::Exact => MAX_EXACT_SUBSTEPS,
            StiffBodies::MassScaled | StiffBodies::Softened => self.max_substeps,
        };
        self.per_tick(60.0 * f64::from(max))
    }

    /// Returns the minimum number of substeps per tick.
    pub(super) fn min_substeps_per_tick(&self) -> u32 {
        self.per_tick(60.0 * f64::from(DEFAULT_SUBSTEPS.min(self.max_substeps)))
    }

    /// Returns the shortest allowed substep [s]; bodies that require a shorter one are scaled.
    pub(crate) fn shortest_substep(&self) -> f64 {
        f64::from(self.tick) / f64::from(self.max_substeps_per_tick())
    }

    /// Returns the speeds at which objects count as at rest.
    pub(super) fn rest_speeds(&self) -> RestSpeeds {
        RestSpeeds {
            gravity: self.gravity.to_vec3().length(),
            drag: self.drag,
        }
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        let is_finite = self.gravity.is_finite();
        require(is_finite, "gravity", "finite", self.gravity)?;
        require(
            (0.0..=10.0).contains(&self.drag),
            "drag",
            "0 to 10",
            self.drag,
        )?;
        let substeps = self.max_substeps;
        let is_valid = (MIN_SUBSTEPS..=1024).contains(&substeps);
        require(is_valid, "max_substeps", "8 to 1024", substeps)?;
        let is_valid = (MIN_TICK..=MAX_TICK).contains(&self.tick);
        require(is_valid, "tick", "1/240 to 1/30 s", self.tick)
    }
}

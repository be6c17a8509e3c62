//! Predicted paths of contact spheres, and the test whether two of them come close.

use super::contact_sphere::SphereId;
use super::sphere_pair::MARGIN;
use crate::soft_body::element_forces::Row;

/// Slack: distance by which a sphere may deviate from its path before its pairs are searched again [voxels].
/// A larger value makes the list of pairs longer; a smaller one makes searches more frequent.
pub const SLACK: f32 = 0.35;

/// Weight of a sphere's mean velocity along its last path in the predicted velocity; the present velocity has
/// weight 1 − `AS_BEFORE`. The mean velocity predicts vibrating spheres better, because they return to where
/// they were.
const AS_BEFORE: f32 = 0.8;

/// Predicted straight path of a sphere, valid until its pairs are searched again.
#[derive(Copy, Clone, Debug, Default)]
pub struct Path {
    /// Position on the path, extrapolated to the time of the last full search [m].
    pub from: Row,
    /// Velocity [m/s].
    pub velocity: Row,
}

impl Path {
    /// Returns the position [m] at a time after the last full search [s].
    #[inline(always)]
    pub fn at(&self, time: f32) -> Row {
        self.from + self.velocity * time
    }
}

/// Start of a path.
#[derive(Copy, Clone, Debug)]
pub struct Start {
    /// Position [m].
    pub at: Row,
    /// Time relative to the last full search [s]; NaN if there was no path before.
    pub time: f32,
}

impl Start {
    pub const UNKNOWN: Self = Self {
        at: Row::ZERO,
        time: f32::NAN,
    };

    /// Returns the predicted velocity of a sphere [m/s]. `self` is the start of the sphere's last path,
    /// `here` the sphere's position [m] at the time `now` [s], and `velocity` its present velocity [m/s].
    pub fn expected(&self, here: Row, now: f32, velocity: Row) -> Row {
        let passed = now - self.time;
        if passed > 0.0 {
            let mean = (here - self.at) * (1.0 / passed);
            mean * AS_BEFORE + velocity * (1.0 - AS_BEFORE)
        } else {
            velocity
        }
    }
}

/// Time span after the last full search: its midpoint and half its length [s].
#[derive(Copy, Clone, Debug, Default)]
pub struct Span {
    pub middle: f32,
    pub half: f32,
}

/// Swept sphere: a sphere with its path, stored contiguously with everything that the pair test reads.
#[derive(Copy, Clone, Debug)]
pub struct SweptSphere {
    pub path: Path,
    /// Upper bound of half the length of the path [m], relative to the mean velocity of all spheres.
    pub sweep: f32,
    /// Radius of the sphere [m].
    pub radius: f32,
    pub sphere: SphereId,
    pub asleep: bool,
}

impl SweptSphere {
    /// Returns whether two swept spheres come close enough to make a pair within a time span. False if both
    /// sleep.
    #[inline(always)]
    pub fn meets(&self, other: &Self, span: Span) -> bool {
        let closing = self.path.velocity - other.path.velocity;
        let apart = self.path.from - other.path.from;
        let apart = apart + closing * span.middle;
        let reach = widened(self.radius + other.radius);
        // Rejects most pairs: those too far apart to meet in any direction of motion. The comparison is false
        // for NaN, which rejects the pair.
        let furthest = reach + self.sweep + other.sweep;
        let is_near = apart.dot(apart) <= furthest * furthest;
        if !is_near || self.asleep && other.asleep {
            return false;
        }
        // Time of the closest approach, relative to the midpoint of the span.
        let time = -apart.dot(closing) / closing.dot(closing).max(f32::MIN_POSITIVE);
        let time = time.clamp(-span.half, span.half);
        let apart = apart + closing * time;
        apart.dot(apart) <= reach * reach
    }
}

/// Returns the distance of the centres below which two swept spheres make a pair [m]. The spheres touch at
/// the distance `touching` [m] of their centres.
#[inline(always)]
pub fn widened(touching: f32) -> f32 {
    (1.0 + MARGIN + 2.0 * SLACK) * touching
}

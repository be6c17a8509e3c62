//! Errors of rigid-body parameters.

use crate::rigid_body::shape::{BadShape, Vector};
use std::fmt;

/// Largest absolute coordinate of rigid bodies and targets [m]; larger and non-finite ones are rejected.
/// Beyond it, single precision cannot resolve millimetres or the corresponding velocities.
pub const FARTHEST: f32 = 1e6;

/// Invalid rigid-body parameter.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct BadRigid {
    /// Name of the field.
    pub field: &'static str,
    /// Expected value.
    pub expected: &'static str,
}

impl fmt::Display for BadRigid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { field, expected } = self;
        write!(f, "invalid rigid body: {field} must be {expected}")
    }
}

impl std::error::Error for BadRigid {}

impl From<BadShape> for BadRigid {
    fn from(BadShape { field, expected }: BadShape) -> Self {
        Self { field, expected }
    }
}

pub fn require(good: bool, field: &'static str, expected: &'static str) -> Result<(), BadRigid> {
    good.then_some(()).ok_or(BadRigid { field, expected })
}

/// Returns whether a position is allowed for rigid bodies and targets.
pub fn is_within_reach(at: Vector) -> bool {
    at.to_array().iter().all(|k| k.abs() <= FARTHEST)
}

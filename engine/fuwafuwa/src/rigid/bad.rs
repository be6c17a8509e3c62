//! How something rigid cannot be.

use crate::shape::{BadShape, Vector};
use std::fmt;

/// Hands and goals further from the origin than this on an axis [m] are refused, like those that
/// are not finite: single precision has no millimetres out there, and no such speeds.
pub const FARTHEST: f32 = 1e6;

/// Something rigid that cannot be: which field, and what it must be.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct BadRigid {
    /// The field.
    pub field: &'static str,
    /// What was expected.
    pub expected: &'static str,
}

impl fmt::Display for BadRigid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { field, expected } = self;
        write!(f, "the {field} of what is rigid must be {expected}")
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

/// Whether something rigid or its goal may be there.
pub fn is_within_reach(at: Vector) -> bool {
    at.iter().all(|k| k.abs() <= FARTHEST)
}

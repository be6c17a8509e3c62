//! Range of positions.

use crate::rigid_body::shape::Vector;

/// Largest absolute coordinate of rigid bodies and targets [m]; larger and non-finite ones are rejected.
/// Beyond it, single precision cannot resolve millimetres or the corresponding velocities.
pub const FARTHEST: f32 = 1e6;

/// Returns whether a position is allowed for rigid bodies and targets.
pub fn is_within_reach(at: Vector) -> bool {
    at.abs().max_element() <= FARTHEST && at.is_finite()
}

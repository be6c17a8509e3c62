//! Limits of positions.

use glam::Vec3;

/// Largest allowed absolute coordinate of rigid bodies and targets [m]. At this distance, single precision
/// resolves only 6 cm.
pub const FARTHEST: f32 = 1e6;

/// Returns whether a position is finite and within `FARTHEST`, as required for rigid bodies and targets.
pub fn is_within_reach(at: Vec3) -> bool {
    at.abs().max_element() <= FARTHEST && at.is_finite()
}

//! Limits of positions.

use crate::error::Error;
use glam::Vec3;

/// Largest allowed absolute coordinate of rigid bodies and targets [m]. At this distance, single precision
/// resolves only 6 cm.
pub const FARTHEST: f32 = 1e6;

/// Returns whether a position is finite and within `FARTHEST`, as required for rigid bodies and targets.
pub fn is_within_reach(at: Vec3) -> bool {
    at.abs().max_element() <= FARTHEST && at.is_finite()
}

/// Largest absolute coordinate at which the shape and the rest of an object are right, in multiples of its
/// smallest detail: the voxel of a soft body, the smallest width of a dynamic rigid body.
///
/// A coordinate of n voxels is rounded by up to n / 2²⁴ voxels in single precision, so 8192 voxels are
/// rounded by at most 1/2048 voxel. `fuwafuwa check far` measures what the rounding does to the shape of a body at
/// rest: at 8192 voxels it is off by less than 1 % of a voxel, at 16384 by up to 2 %, at 131072 by up to
/// 28 %.
pub const RANGE: f32 = 8192.0;

/// Returns the largest allowed absolute coordinate of an object with the smallest detail `size` [m].
pub fn range_of(size: f32) -> f32 {
    (RANGE * size).min(FARTHEST)
}

/// Returns an error if the position [m] of an object with the smallest detail `size` [m] is not finite or
/// out of range; `detail` names the detail.
pub fn require_in_range(at: Vec3, size: f32, detail: &str) -> Result<(), Error> {
    let range = range_of(size);
    if at.abs().max_element() <= range && at.is_finite() {
        return Ok(());
    }
    let expected = format!(
        "within {range} m of the origin on each axis, where single precision resolves {detail} of {size} m"
    );
    Err(Error::parameter("position", expected, at))
}

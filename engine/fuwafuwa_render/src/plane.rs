//! 2D points.

use fuwafuwa::Vector;
use glam::{Vec2, Vec3};

/// Returns the 2D point of a vector [m].
pub fn flat(at: Vector) -> Vec2 {
    Vec3::from(at).truncate()
}

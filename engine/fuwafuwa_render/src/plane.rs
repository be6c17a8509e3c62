//! Places in the plane.

use fuwafuwa::Vector;
use glam::{Vec2, Vec3};

/// Where something is in the plane [m].
pub fn flat(at: Vector) -> Vec2 {
    Vec3::from(at).truncate()
}

//! Helpers for vectors.

use glam::Vec3;

/// Returns two unit vectors that are perpendicular to the unit vector `direction` and to each other.
pub fn perpendiculars(direction: Vec3) -> [Vec3; 2] {
    let least = (0..3).fold(0, |least, k| {
        match direction[k].abs() < direction[least].abs() {
            true => k,
            false => least,
        }
    });
    let first = direction.cross(Vec3::AXES[least]);
    let first = first * (1.0 / first.length());
    [first, direction.cross(first)]
}

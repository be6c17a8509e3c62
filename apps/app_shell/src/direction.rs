//! Conversion between directions as the user sees them and directions in the world. The user's directions are
//! right and away. In 2D, away is up; in 3D, it is along the floor, away from the camera.

use egui::Vec2;
use fuwafuwa::Vec3;

/// Converts a direction of the user (right, away) to a direction in the world. `turn` is the azimuth of the
/// camera, positive to the right [rad]; `None` in 2D.
pub fn to_world(turn: Option<f32>, lean: Vec2) -> Vec3 {
    let Some(turn) = turn else {
        return Vec3::new(lean.x, lean.y, 0.0);
    };
    let (sin, cos) = turn.sin_cos();
    Vec3::new(
        cos * lean.x - sin * lean.y,
        0.0,
        -sin * lean.x - cos * lean.y,
    )
}

/// Converts a vector in the world, such as a force [N], to a direction of the user (right, away). Inverse of
/// [`to_world`], except that in 3D the vertical component is dropped.
pub fn to_user(turn: Option<f32>, vector: Vec3) -> [f32; 2] {
    let [x, y, z] = vector.to_array();
    let Some(turn) = turn else {
        return [x, y];
    };
    let (sin, cos) = turn.sin_cos();
    [cos * x - sin * z, -sin * x - cos * z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::FRAC_PI_2;

    #[test]
    fn to_user_keeps_components_along_the_floor_as_seen_by_the_camera() {
        let force = Vec3::new(1.0, 2.0, 3.0);
        assert_eq!(to_user(None, force), [1.0, 2.0]);
        assert_eq!(to_user(Some(0.0), force), [1.0, -3.0]);
        let [right, away] = to_user(Some(FRAC_PI_2), force);
        assert!((right + 3.0).abs() < 1e-5 && (away + 1.0).abs() < 1e-5);
    }

    #[test]
    fn to_user_inverts_to_world() {
        for turn in [None, Some(0.7)] {
            let [right, away] = to_user(turn, to_world(turn, Vec2::new(0.3, -0.8)));
            assert!((right - 0.3).abs() < 1e-5 && (away + 0.8).abs() < 1e-5);
        }
    }
}

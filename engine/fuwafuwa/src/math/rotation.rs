//! Rotations in 2D and 3D.

use crate::foundation::dim::{Dim, DimVector};
use crate::foundation::hash::hash_state;
use glam::DVec3;
use glam::Vec3;

/// Rotation, stored as a unit quaternion. Results are identical on every machine, because no sine function of
/// a system library is used.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Rotation {
    /// Components x, y, z, w.
    quaternion: [f64; 4],
}

hash_state! { struct Rotation { quaternion } }

impl Default for Rotation {
    fn default() -> Self {
        Self::NONE
    }
}

impl Rotation {
    /// Identity rotation.
    pub const NONE: Self = Self {
        quaternion: [0.0, 0.0, 0.0, 1.0],
    };

    /// Creates a rotation by an angle [rad] about an axis of any length, counterclockwise as seen from the
    /// tip of the axis. Returns [`Rotation::NONE`] if the axis has length 0 or a value is not finite.
    ///
    /// ```
    /// use fuwafuwa::{Rotation, Vec3};
    /// use std::f32::consts::FRAC_PI_2;
    ///
    /// let quarter = Rotation::about(Vec3::Z, FRAC_PI_2);
    /// assert!(quarter.apply(Vec3::X).distance(Vec3::Y) < 1e-6);
    /// ```
    pub fn about(axis: Vec3, angle: f32) -> Self {
        let axis = axis.as_dvec3();
        let (sine, cosine) = libm::sincos(0.5 * f64::from(angle));
        let part = sine / axis.length();
        let [x, y, z] = (axis * part).to_array();
        Self::unit([x, y, z, cosine])
    }

    /// Creates a rotation in the plane by an angle [rad], counterclockwise.
    pub fn in_plane(angle: f32) -> Self {
        Self::about(Vec3::Z, angle)
    }

    /// Creates a rotation from a quaternion x, y, z, w of any length. Returns [`Rotation::NONE`] if the
    /// quaternion has length 0 or a component is not finite.
    pub fn from_quaternion(quaternion: [f32; 4]) -> Self {
        Self::unit(quaternion.map(f64::from))
    }

    /// Returns the unit quaternion x, y, z, w.
    pub fn quaternion(self) -> [f32; 4] {
        self.quaternion.map(|part| part as f32)
    }

    /// Rotates a vector. In 2D only the part of the rotation about the third axis is applied.
    pub fn apply<V: DimVector>(self, vector: V) -> V {
        let rotation = if V::N == 2 {
            self.in_third_axis()
        } else {
            self
        };
        let turned = rotation.turn(vector.to_vec3().as_dvec3());
        V::from_vec3(turned.as_vec3())
    }

    /// Returns the inverse rotation.
    #[must_use]
    pub fn inverse(self) -> Self {
        let [x, y, z, w] = self.quaternion;
        Self {
            quaternion: [-x, -y, -z, w],
        }
    }

    /// Returns the rotation that first applies `self` and then `next`.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        Self::unit(product(next.quaternion, self.quaternion))
    }

    /// Returns the rotation vector: the axis times the angle [rad], with an angle of at most π.
    pub fn scaled_axis(self) -> Vec3 {
        let [x, y, z, w] = self.quaternion;
        let (axis, sign) = (DVec3::new(x, y, z), if w < 0.0 { -1.0 } else { 1.0 });
        let sine = axis.length();
        let angle = 2.0 * libm::atan2(sine, sign * w);
        let stretch = if sine > 1e-12 { angle / sine } else { 2.0 };
        (axis * (sign * stretch)).as_vec3()
    }

    /// Returns the rotated unit vectors of the three axes: the columns of the rotation matrix.
    pub fn axes(self) -> [Vec3; 3] {
        Vec3::AXES.map(|axis| self.apply(axis))
    }

    /// Returns whether the quaternion has length 1. A quaternion that was read from a file may have another
    /// length.
    pub(crate) fn is_unit(self) -> bool {
        (squared(self.quaternion) - 1.0).abs() < 1e-9
    }

    /// Rotates a position [m] about a centre.
    pub(crate) fn apply_about(self, place: Vec3, centre: Vec3) -> Vec3 {
        let (place, centre) = (place.as_dvec3(), centre.as_dvec3());
        let turned = self.turn(place - centre);
        (centre + turned).as_vec3()
    }

    /// Returns the rotation as it acts in the dimension: unchanged in 3D, and only its part about the third
    /// axis in 2D.
    pub(crate) fn seen_in<D: Dim>(self) -> Self {
        match D::N {
            2 => self.in_third_axis(),
            _ => self,
        }
    }

    /// Returns the part of the rotation about the third axis.
    fn in_third_axis(self) -> Self {
        let [x, y, z, w] = self.quaternion;
        // Leaves a rotation that is already about the third axis as it is: normalising it again would change
        // its last bits.
        match (x, y) == (0.0, 0.0) {
            true => self,
            false => Self::unit([0.0, 0.0, z, w]),
        }
    }

    /// Returns the quaternion, not normalised, of the rotation that first applies `other` and then `self`.
    pub(crate) fn after(self, other: [f32; 4]) -> [f32; 4] {
        product(self.quaternion, other.map(f64::from)).map(|part| part as f32)
    }

    fn turn(self, vector: DVec3) -> DVec3 {
        let [x, y, z, w] = self.quaternion;
        let axis = DVec3::new(x, y, z);
        let across = axis.cross(vector) * 2.0;
        vector + across * w + axis.cross(across)
    }

    fn unit(quaternion: [f64; 4]) -> Self {
        let scale = 1.0 / squared(quaternion).sqrt();
        let quaternion = quaternion.map(|part| part * scale);
        match quaternion.iter().all(|part| part.is_finite()) {
            true => Self { quaternion },
            false => Self::NONE,
        }
    }
}

/// Returns the squared length of a quaternion.
fn squared([x, y, z, w]: [f64; 4]) -> f64 {
    x * x + y * y + z * z + w * w
}

/// Returns the quaternion product a b, which rotates first by b and then by a.
fn product([x, y, z, w]: [f64; 4], [bx, by, bz, bw]: [f64; 4]) -> [f64; 4] {
    [
        w * bx + x * bw + y * bz - z * by,
        w * by - x * bz + y * bw + z * bx,
        w * bz + x * by - y * bx + z * bw,
        w * bw - x * bx - y * by - z * bz,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::Dim2;
    use glam::Vec2;
    use std::f32::consts::PI;

    #[test]
    fn rotations_compose_in_order() {
        let first = Rotation::about(Vec3::new(1.0, 2.0, -1.0), 0.7);
        let second = Rotation::about(Vec3::new(0.0, -3.0, 1.0), -2.0);
        let both = Rotation::from_quaternion(second.after(first.quaternion()));
        let vector = Vec3::new(0.3, -0.8, 2.0);
        let one = both.apply(vector);
        assert!(one.abs_diff_eq(second.apply(first.apply(vector)), 1e-5));
        assert!(one.abs_diff_eq(first.then(second).apply(vector), 1e-5));
        assert_eq!(first.then(first.inverse()), Rotation::NONE);
    }

    #[test]
    fn apply_in_2d_uses_part_about_third_axis() {
        let tilted = Rotation::about(Vec3::new(0.3, -0.2, 1.0), 0.9);
        let turned = tilted.apply(Vec2::X);
        assert!((turned.length() - 1.0).abs() < 1e-6);
        assert_eq!(turned, tilted.seen_in::<Dim2>().apply(Vec2::X));
        let out_of_plane = Rotation::about(Vec3::X, 0.5 * PI);
        assert_eq!(out_of_plane.apply(Vec2::Y), Vec2::Y);
    }

    #[test]
    fn scaled_axis_returns_axis_times_shortest_angle() {
        for angle in [0.0, 1e-7, 0.5, 3.0] {
            let axis = Rotation::about(Vec3::new(0.0, -2.0, 0.0), angle).scaled_axis();
            assert!((axis[1] + angle).abs() < 1e-6 && axis[0] == 0.0, "{axis:?}");
        }
        let far = Rotation::in_plane(6.0).scaled_axis();
        assert!((far[2] - (6.0 - 2.0 * PI)).abs() < 1e-6);
    }

    #[test]
    fn invalid_rotations_become_identity() {
        let bad = [
            Rotation::about(Vec3::ZERO, 1.0),
            Rotation::about(Vec3::X, f32::NAN),
            Rotation::about(Vec3::new(f32::INFINITY, 0.0, 0.0), 1.0),
            Rotation::from_quaternion([0.0; 4]),
            Rotation::from_quaternion([f32::NAN, 0.0, 0.0, 1.0]),
            Rotation::about(Vec3::X, PI).seen_in::<Dim2>(),
        ];
        for (index, rotation) in bad.into_iter().enumerate() {
            let turned = rotation.apply(Vec3::new(1.0, 2.0, 3.0));
            assert_eq!(turned, Vec3::new(1.0, 2.0, 3.0), "{index}");
        }
    }
}

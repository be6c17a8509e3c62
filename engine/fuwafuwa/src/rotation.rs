//! Turning things.

use crate::dim::Dim;
use crate::vector::{Vector, cross, dot, minus, plus, scaled};

/// A rotation, kept as a unit quaternion. The same on every machine: no sine of a system's own library is in it.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Rotation {
    /// x, y, z, w.
    quaternion: [f64; 4],
}

impl Default for Rotation {
    fn default() -> Self {
        Self::NONE
    }
}

impl Rotation {
    /// No rotation.
    pub const NONE: Self = Self {
        quaternion: [0.0, 0.0, 0.0, 1.0],
    };

    /// By an angle [rad] about an axis of any length, counterclockwise as seen from its tip; none about an axis
    /// without a length or by an angle that is not finite.
    ///
    /// ```
    /// use fuwafuwa::Rotation;
    /// use std::f32::consts::FRAC_PI_2;
    ///
    /// let quarter = Rotation::about([0.0, 0.0, 1.0], FRAC_PI_2);
    /// let [x, y, z] = quarter.apply([1.0, 0.0, 0.0]);
    /// assert!(x.abs() < 1e-6 && (y - 1.0).abs() < 1e-6 && z == 0.0);
    /// ```
    pub fn about(axis: Vector, angle: f32) -> Self {
        let axis = axis.map(f64::from);
        let (sine, cosine) = libm::sincos(0.5 * f64::from(angle));
        let part = sine / dot(axis, axis).sqrt();
        let [x, y, z] = scaled(axis, part);
        Self::unit([x, y, z, cosine])
    }

    /// In the plane, by an angle [rad], counterclockwise.
    pub fn in_plane(angle: f32) -> Self {
        Self::about([0.0, 0.0, 1.0], angle)
    }

    /// From a quaternion x, y, z, w of any length; none from one without a length or with a number that is not finite.
    pub fn from_quaternion(quaternion: [f32; 4]) -> Self {
        Self::unit(quaternion.map(f64::from))
    }

    /// The unit quaternion x, y, z, w.
    pub fn quaternion(self) -> [f32; 4] {
        self.quaternion.map(|part| part as f32)
    }

    /// A vector, turned.
    pub fn apply(self, vector: Vector) -> Vector {
        self.turn(vector.map(f64::from)).map(|part| part as f32)
    }

    /// The rotation back.
    #[must_use]
    pub fn inverse(self) -> Self {
        let [x, y, z, w] = self.quaternion;
        Self {
            quaternion: [-x, -y, -z, w],
        }
    }

    /// This one, and then another.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        Self::unit(product(next.quaternion, self.quaternion))
    }

    /// Axis times angle [rad], the shorter way round.
    pub fn scaled_axis(self) -> Vector {
        let [x, y, z, w] = self.quaternion;
        let (axis, sign) = ([x, y, z], if w < 0.0 { -1.0 } else { 1.0 });
        let sine = dot(axis, axis).sqrt();
        let angle = 2.0 * libm::atan2(sine, sign * w);
        let stretch = if sine > 1e-12 { angle / sine } else { 2.0 };
        scaled(axis, sign * stretch).map(|part| part as f32)
    }

    /// What it makes of the three axes.
    pub fn axes(self) -> [Vector; 3] {
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| self.apply(axis))
    }

    /// Whether it is one: what is read from a file need not be.
    pub(crate) fn is_one(self) -> bool {
        (dot(self.quaternion, self.quaternion) - 1.0).abs() < 1e-9
    }

    /// A place [m], turned about another one.
    pub(crate) fn apply_about(self, place: Vector, centre: Vector) -> Vector {
        let (place, centre) = (place.map(f64::from), centre.map(f64::from));
        let turned = self.turn(minus(place, centre));
        plus(centre, turned).map(|part| part as f32)
    }

    /// The same as a world of `D` sees it: in the plane all turns are about the third axis.
    pub(crate) fn seen_in<D: Dim>(self) -> Self {
        let [x, y, z, w] = self.quaternion;
        // To make the length 1 once more would change the last bits.
        match D::N == 2 && (x, y) != (0.0, 0.0) {
            true => Self::unit([0.0, 0.0, z, w]),
            false => self,
        }
    }

    /// This one after another, as a quaternion that need not be of length 1.
    pub(crate) fn after(self, other: [f32; 4]) -> [f32; 4] {
        product(self.quaternion, other.map(f64::from)).map(|part| part as f32)
    }

    fn turn(self, vector: [f64; 3]) -> [f64; 3] {
        let [x, y, z, w] = self.quaternion;
        let axis = [x, y, z];
        let across = scaled(cross(axis, vector), 2.0);
        plus(plus(vector, scaled(across, w)), cross(axis, across))
    }

    fn unit(quaternion: [f64; 4]) -> Self {
        let length = dot(quaternion, quaternion).sqrt();
        let quaternion = scaled(quaternion, 1.0 / length);
        match quaternion.iter().all(|part| part.is_finite()) {
            true => Self { quaternion },
            false => Self::NONE,
        }
    }
}

/// a b: the second rotation, then the first.
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
    use crate::dim::Dim2;
    use std::f32::consts::PI;

    #[test]
    fn turns_follow_each_other() {
        let first = Rotation::about([1.0, 2.0, -1.0], 0.7);
        let second = Rotation::about([0.0, -3.0, 1.0], -2.0);
        let both = Rotation::from_quaternion(second.after(first.quaternion()));
        let vector = [0.3, -0.8, 2.0];
        let (one, two) = (both.apply(vector), second.apply(first.apply(vector)));
        assert!((0..3).all(|axis| (one[axis] - two[axis]).abs() < 1e-5));
        let three = first.then(second).apply(vector);
        assert!((0..3).all(|axis| (one[axis] - three[axis]).abs() < 1e-5));
        assert_eq!(first.then(first.inverse()), Rotation::NONE);
    }

    #[test]
    fn a_rotation_is_an_axis_times_an_angle() {
        for angle in [0.0, 1e-7, 0.5, 3.0] {
            let axis = Rotation::about([0.0, -2.0, 0.0], angle).scaled_axis();
            assert!((axis[1] + angle).abs() < 1e-6 && axis[0] == 0.0, "{axis:?}");
        }
        let far = Rotation::in_plane(6.0).scaled_axis();
        assert!((far[2] - (6.0 - 2.0 * PI)).abs() < 1e-6);
    }

    #[test]
    fn what_is_no_rotation_is_none() {
        let bad = [
            Rotation::about([0.0; 3], 1.0),
            Rotation::about([1.0, 0.0, 0.0], f32::NAN),
            Rotation::about([f32::INFINITY, 0.0, 0.0], 1.0),
            Rotation::from_quaternion([0.0; 4]),
            Rotation::from_quaternion([f32::NAN, 0.0, 0.0, 1.0]),
            Rotation::about([1.0, 0.0, 0.0], PI).seen_in::<Dim2>(),
        ];
        for (index, rotation) in bad.into_iter().enumerate() {
            let turned = rotation.apply([1.0, 2.0, 3.0]);
            assert_eq!(turned, [1.0, 2.0, 3.0], "{index}");
        }
    }
}

//! Principal moments of inertia of shapes with uniform density.

use crate::foundation::dim::{Dim, turning};
use crate::foundation::hash::hash_state;
use crate::math::rotation::Rotation;
use crate::math::vector::perpendiculars;
use crate::rigid_body::solid::Solid;
use glam::Vec3;
use std::f32::consts::PI;

/// Symmetric 3×3 matrix, by rows.
pub type Matrix = [Vec3; 3];

/// Principal axes and principal moments of inertia in local coordinates.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Inertia {
    axes: [Vec3; 3],
    /// Principal moments [kg m²]; in 2D only the third is not 0.
    moments: Vec3,
    /// Inverse principal moments [1/(kg m²)]; 0 for axes about which the body cannot rotate.
    inverse: Vec3,
}

hash_state! { struct Inertia { axes, moments, inverse } }

impl Inertia {
    /// Returns the inertia of a body with a mass [kg], uniform density and a shape centred on the origin.
    pub fn of<D: Dim>(local_shape: &Solid, mass: f32) -> Self {
        let (axes, shares) = match *local_shape {
            Solid::HalfSpace { .. } => (Rotation::NONE.axes(), Vec3::ZERO),
            Solid::Ball { radius, .. } => (Rotation::NONE.axes(), ball::<D>(radius)),
            Solid::Box { half, .. } => (Rotation::NONE.axes(), cuboid(half)),
            Solid::OrientedBox { half, rotation, .. } => (rotation.axes(), cuboid(half)),
            Solid::Capsule { from, to, radius } => (
                axes_along(to - from),
                capsule::<D>((to - from).length(), radius),
            ),
        };
        let moments = turning::<D>(shares * mass);
        let inverse = moments.map(|moment| if moment > 0.0 { 1.0 / moment } else { 0.0 });
        // In 2D all bodies rotate about the third axis, whatever the direction of a capsule.
        let axes = if D::N == 2 {
            Rotation::NONE.axes()
        } else {
            axes
        };
        Self {
            axes,
            moments,
            inverse,
        }
    }

    /// Returns whether all moments and inverse moments are finite, and the body can rotate about the third
    /// axis.
    pub fn is_sound(&self) -> bool {
        self.moments.is_finite() && self.inverse.is_finite() && self.inverse[2] > 0.0
    }

    /// Returns the inverse inertia matrix about the world axes [1/(kg m²)] of a body with the given rotation.
    pub fn inverse(&self, rotation: Rotation) -> Matrix {
        let mut matrix = [Vec3::ZERO; 3];
        for (axis, inverse) in self.axes.into_iter().zip(self.inverse.to_array()) {
            let axis = rotation.apply(axis);
            for row in 0..3 {
                matrix[row] += axis * (inverse * axis[row]);
            }
        }
        matrix
    }

    /// Returns the angular velocity [rad/s] after a body with `angular_velocity` has rotated from
    /// `before` to `after` without torque. The angular momentum is preserved.
    pub fn angular_velocity_after(
        &self,
        angular_velocity: Vec3,
        before: Rotation,
        after: Rotation,
    ) -> Vec3 {
        let axes = self.axes.into_iter().zip(self.moments.to_array());
        let momentum = axes.fold(Vec3::ZERO, |sum, (axis, moment)| {
            let axis = before.apply(axis);
            sum + axis * (moment * axis.dot(angular_velocity))
        });
        let axes = self.axes.into_iter().zip(self.inverse.to_array());
        axes.fold(Vec3::ZERO, |sum, (axis, inverse)| {
            let axis = after.apply(axis);
            sum + axis * (inverse * axis.dot(momentum))
        })
    }
}

/// Returns the product of a matrix and a vector.
#[inline(always)]
pub fn times(matrix: &Matrix, vector: Vec3) -> Vec3 {
    Vec3::from([0, 1, 2].map(|row: usize| matrix[row].dot(vector)))
}

// `cuboid`, `ball` and `capsule` return the principal moments of inertia per unit mass [m²].

fn cuboid(half: Vec3) -> Vec3 {
    let [x, y, z] = half.to_array();
    let about = |a: f32, b: f32| (a * a + b * b) / 3.0;
    // In 2D the third half extent is `f32::MAX`, so the first two moments overflow; only the third one is
    // used.
    Vec3::new(about(y, z), about(z, x), about(x, y))
}

/// Returns the principal moments of inertia of a ball, or in 2D of a disc, per unit mass [m²].
fn ball<D: Dim>(radius: f32) -> Vec3 {
    let share = if D::N == 2 { 0.5 } else { 0.4 };
    Vec3::splat(share * radius * radius)
}

/// Returns the principal moments of inertia of a capsule along the first axis, per unit mass [m²]. The
/// capsule consists of a cylinder of `length` [m] and two half balls, in 2D of a rectangle and two half
/// discs.
fn capsule<D: Dim>(length: f32, radius: f32) -> Vec3 {
    let squared = radius * radius;
    // `between` and `round` are the volumes of the cylinder and of both half balls. `middle` is the distance
    // of the centroid of a half ball from its flat side.
    let (between, round, middle) = match D::N {
        2 => (
            2.0 * radius * length,
            PI * squared,
            4.0 * radius / (3.0 * PI),
        ),
        _ => (
            PI * squared * length,
            4.0 / 3.0 * PI * squared * radius,
            3.0 / 8.0 * radius,
        ),
    };
    let whole = between + round;
    let (between, round) = (between / whole, round / whole);
    let own = ball::<D>(radius).x;
    let ends = own + 0.25 * length * length + length * middle;
    let side = match D::N {
        2 => (length * length + 4.0 * squared) / 12.0,
        _ => length * length / 12.0 + 0.25 * squared,
    };
    let aside = between * side + round * ends;
    Vec3::new(0.5 * between * squared + round * own, aside, aside)
}

/// Returns three orthonormal axes, the first of them parallel to `way`.
fn axes_along(way: Vec3) -> [Vec3; 3] {
    let length = way.length();
    if length <= 0.0 {
        return Rotation::NONE.axes();
    }
    let first = way * (1.0 / length);
    let [second, third] = perpendiculars(first);
    [first, second, third]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};
    use crate::rigid_body::solid::flat;

    /// Compares the moments of inertia of a shape with a numerical sum over small cubes.
    fn check<D: Dim>(local_shape: Solid) {
        let [low, high] = local_shape.bounds();
        let count = if D::N == 2 { 200 } else { 60 };
        let (mut mass, mut sums) = (0.0f64, [0.0f64; 3]);
        let depth = if D::N == 2 { 1 } else { count };
        for cell in 0..count * count * depth {
            let cell = [cell % count, cell / count % count, cell / count / count];
            let share = cell.map(|k| (k as f32 + 0.5) / count as f32);
            let at = flat::<D>(low + Vec3::from(share) * (high - low));
            if local_shape.distance(at).0 > 0.0 {
                continue;
            }
            mass += 1.0;
            for (axis, sum) in sums.iter_mut().enumerate() {
                let others = (0..3).filter(|&k| k != axis);
                *sum += others.map(|k| f64::from(at[k] * at[k])).sum::<f64>();
            }
        }
        let inertia = Inertia::of::<D>(&local_shape, 3.0);
        let inverse = inertia.inverse(Rotation::NONE);
        for axis in if D::N == 2 { 2..3 } else { 0..3 } {
            let expected = 3.0 * sums[axis] / mass;
            let found = 1.0 / f64::from(inverse[axis][axis]);
            assert!(
                (found / expected - 1.0).abs() < 0.01,
                "{local_shape:?} {found} {expected}"
            );
        }
    }

    #[test]
    fn moments_match_numeric_integration() {
        let [x, y, z] = [0.3, 0.5, 0.9];
        let capsule = Solid::Capsule {
            from: Vec3::new(-x, 0.0, 0.0),
            to: Vec3::new(x, 0.0, 0.0),
            radius: 0.2,
        };
        let ball = Solid::Ball {
            centre: Vec3::ZERO,
            radius: x,
        };
        let cuboid = |half| Solid::Box {
            centre: Vec3::ZERO,
            half,
        };
        check::<Dim3>(cuboid(Vec3::new(x, y, z)));
        check::<Dim2>(cuboid(Vec3::new(x, y, f32::MAX)));
        check::<Dim3>(capsule);
        check::<Dim2>(capsule);
        check::<Dim3>(ball);
        check::<Dim2>(ball);
    }

    #[test]
    fn tumbling_preserves_angular_momentum() {
        let local_shape = Solid::Box {
            centre: Vec3::ZERO,
            half: Vec3::new(0.3, 0.5, 0.9),
        };
        let inertia = Inertia::of::<Dim3>(&local_shape, 3.0);
        let momentum = |spin: Vec3, rotation: Rotation| {
            let axes = rotation.axes().into_iter().zip(inertia.moments.to_array());
            axes.fold(Vec3::ZERO, |sum, (axis, moment)| {
                sum + axis * (moment * axis.dot(spin))
            })
        };
        let (mut spin, mut rotation) = (Vec3::new(0.1, 5.0, 0.0), Rotation::NONE);
        let before = momentum(spin, rotation);
        let mut most = 0.0f32;
        for _ in 0..5000 {
            let next = rotation.then(Rotation::about(spin, spin.length() * 0.001));
            spin = inertia.angular_velocity_after(spin, rotation, next);
            rotation = next;
            most = most.max(spin[0].abs());
        }
        let off = momentum(spin, rotation) - before;
        assert!(off.length() < 1e-3 * before.length(), "{off:?}");
        // Rotation about the middle principal axis is unstable (tennis racket theorem), so the rotation axis
        // must have tumbled.
        assert!(most > 2.0, "{most}");
    }
}

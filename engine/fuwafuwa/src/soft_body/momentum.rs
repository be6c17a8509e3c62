//! Linear and angular momentum of a set of nodes, and the rigid motion with a given momentum.

use crate::foundation::dim::Dim;
use crate::math::vector::{cross, dot, minus, plus, scaled};
use crate::math::velocity::Velocity;
use crate::soft_body::element_forces::Row;

/// Momentum of mass points about a common centre, in double precision.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Momentum {
    /// Σ m v [kg m/s].
    pub linear: [f64; 3],
    /// Σ m x × v [kg m²/s].
    pub angular: [f64; 3],
}

impl Momentum {
    /// Computes the momentum of points (position, velocity, mass) about `centre`.
    pub fn of(points: impl Iterator<Item = (Row, Row, f32)>, centre: [f64; 3]) -> Self {
        let mut sum = Self::default();
        for (position, velocity, mass) in points {
            let x = from_centre(position, centre);
            let impulse = [0, 1, 2].map(|k: usize| f64::from(mass) * f64::from(velocity[k]));
            sum.linear = plus(sum.linear, impulse);
            sum.angular = plus(sum.angular, cross(x, impulse));
        }
        sum
    }

    /// Returns `self` − `other`.
    pub fn less(self, other: Self) -> Self {
        Self {
            linear: minus(self.linear, other.linear),
            angular: minus(self.angular, other.angular),
        }
    }
}

/// Rigid velocity field: v(x) = `velocity` + `spin` × (x − `centre`).
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct RigidMotion {
    velocity: [f64; 3],
    angular_velocity: [f64; 3],
    centre: [f64; 3],
}

/// [`RigidMotion`] in single precision, as an affine map.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub(crate) struct RigidMotionF32 {
    velocity: Row,
    centre: Row,
    /// Columns of the matrix of spin ×.
    spin: [Row; 3],
}

impl RigidMotionF32 {
    /// Velocity at a point.
    #[inline(always)]
    pub fn at<D: Dim>(&self, position: Row) -> Row {
        let from = minus(position, self.centre);
        let mut velocity = self.velocity;
        for axis in 0..D::N {
            velocity = plus(velocity, scaled(self.spin[axis], from[axis]));
        }
        velocity
    }
}

impl RigidMotion {
    /// Returns the motion that gives the points the momentum `wanted`. `centre` must be their centre of mass;
    /// `wanted` is relative to it.
    pub fn with_momentum(
        points: impl Iterator<Item = (Row, f32)>,
        centre: [f64; 3],
        wanted: Momentum,
    ) -> Self {
        let (mut inertia, mut total) = ([[0.0; 3]; 3], 0.0);
        for (position, mass) in points {
            let (x, mass) = (from_centre(position, centre), f64::from(mass));
            for i in 0..3 {
                inertia[i][i] += mass * dot(x, x);
                inertia[i] = minus(inertia[i], scaled(x, mass * x[i]));
            }
            total += mass;
        }
        let velocity = scaled(wanted.linear, 1.0 / total);
        Self::of_spin(velocity, centre, &wanted.angular, &inertia)
    }

    /// Returns the motion with a given velocity of the centre, and the spin that follows from the angular
    /// momentum and the inertia about it.
    pub(crate) fn of_spin(
        velocity: [f64; 3],
        centre: [f64; 3],
        angular: &[f64; 3],
        inertia: &[[f64; 3]; 3],
    ) -> Self {
        // Collinear points have no inertia about their line; the small addition keeps the matrix invertible.
        let mut inertia = *inertia;
        let little = 1e-9 * (inertia[0][0] + inertia[1][1] + inertia[2][2]) + f64::MIN_POSITIVE;
        (0..3).for_each(|k| inertia[k][k] += little);
        Self {
            velocity,
            angular_velocity: solved(&inertia, *angular),
            centre,
        }
    }

    /// Scales the velocity and the spin by one factor each.
    pub(crate) fn times(&self, velocity: f64, spin: f64) -> Self {
        Self {
            velocity: scaled(self.velocity, velocity),
            angular_velocity: scaled(self.angular_velocity, spin),
            centre: self.centre,
        }
    }

    /// Velocity of the centre, and angular velocity about it.
    pub(crate) fn velocity(&self) -> Velocity {
        Velocity {
            linear: self.velocity.map(|k| k as f32),
            angular: self.angular_velocity.map(|k| k as f32),
        }
    }

    /// Converts to single precision.
    pub(crate) fn roughly(&self) -> RigidMotionF32 {
        let row = |[x, y, z]: [f64; 3]| [x as f32, y as f32, z as f32, 0.0];
        let [x, y, z] = self.angular_velocity;
        RigidMotionF32 {
            velocity: row(self.velocity),
            centre: row(self.centre),
            spin: [row([0.0, z, -y]), row([-z, 0.0, x]), row([y, -x, 0.0])],
        }
    }

    /// Velocity at a point.
    pub fn at(&self, position: Row) -> [f64; 3] {
        plus(
            self.velocity,
            cross(self.angular_velocity, from_centre(position, self.centre)),
        )
    }
}

/// Centre of mass of points (position, mass).
pub fn centre_of(points: impl Iterator<Item = (Row, f32)>) -> [f64; 3] {
    let (mut sum, mut total) = ([0.0; 3], 0.0);
    for (position, mass) in points {
        let mass = f64::from(mass);
        sum = plus(sum, [0, 1, 2].map(|k: usize| mass * f64::from(position[k])));
        total += mass;
    }
    sum.map(|k| k / total)
}

/// Solves m x = b for a symmetric positive definite matrix by its adjugate.
fn solved(m: &[[f64; 3]; 3], b: [f64; 3]) -> [f64; 3] {
    let columns = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])];
    let determinant = dot(m[0], columns[0]);
    if determinant == 0.0 {
        return [0.0; 3];
    }
    columns.map(|column| dot(column, b) / determinant)
}

fn from_centre(position: Row, centre: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k: usize| f64::from(position[k]) - centre[k])
}

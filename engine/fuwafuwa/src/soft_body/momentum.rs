//! Linear and angular momentum of a set of nodes, and the rigid motion that has a given momentum.

use crate::foundation::dim::Dim;
use crate::math::twist::Twist;
use crate::soft_body::element_forces::Row;
use glam::DVec3;

/// Momentum of mass points about a centre, in double precision.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Momentum {
    /// Linear momentum Σ m v [kg m/s].
    pub linear: DVec3,
    /// Angular momentum Σ m x × v [kg m²/s]; x is the offset of a point from the centre.
    pub angular: DVec3,
}

impl Momentum {
    /// Computes the momentum of points (position [m], velocity [m/s], mass [kg]) about `centre` [m].
    pub fn of(points: impl Iterator<Item = (Row, Row, f32)>, centre: DVec3) -> Self {
        let mut sum = Self::default();
        for (position, velocity, mass) in points {
            let x = from_centre(position, centre);
            let impulse = velocity.xyz().as_dvec3() * f64::from(mass);
            sum.linear += impulse;
            sum.angular += x.cross(impulse);
        }
        sum
    }

    /// Returns `self` − `other`.
    pub fn less(self, other: Self) -> Self {
        Self {
            linear: self.linear - other.linear,
            angular: self.angular - other.angular,
        }
    }
}

/// Velocity field of a rigid body: v(x) = `velocity` + `angular_velocity` × (x − `centre`).
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct RigidMotion {
    velocity: DVec3,
    angular_velocity: DVec3,
    centre: DVec3,
}

/// [`RigidMotion`] in single precision, as an affine map.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub(crate) struct RigidMotionF32 {
    velocity: Row,
    centre: Row,
    /// Columns of the matrix that maps an offset from the centre to the cross product of the angular velocity
    /// with the offset.
    spin: [Row; 3],
}

impl RigidMotionF32 {
    /// Velocity [m/s] of the rigid motion at a position [m].
    #[inline(always)]
    pub fn at<D: Dim>(&self, position: Row) -> Row {
        let from = position - self.centre;
        let mut velocity = self.velocity;
        for axis in 0..D::N {
            velocity += self.spin[axis] * from[axis];
        }
        velocity
    }
}

impl RigidMotion {
    /// Returns the rigid motion that gives points (position, mass) the momentum `wanted` about `centre`,
    /// which must be their centre of mass.
    pub fn with_momentum(
        points: impl Iterator<Item = (Row, f32)>,
        centre: DVec3,
        wanted: Momentum,
    ) -> Self {
        let (mut inertia, mut total) = ([DVec3::ZERO; 3], 0.0);
        for (position, mass) in points {
            let (x, mass) = (from_centre(position, centre), f64::from(mass));
            for i in 0..3 {
                inertia[i][i] += mass * x.dot(x);
                inertia[i] -= x * (mass * x[i]);
            }
            total += mass;
        }
        let velocity = wanted.linear * (1.0 / total);
        Self::of_spin(velocity, centre, &wanted.angular, &inertia)
    }

    /// Returns the rigid motion with a given velocity of the centre. The angular velocity follows from the
    /// angular momentum and the inertia about the centre.
    pub(crate) fn of_spin(
        velocity: DVec3,
        centre: DVec3,
        angular: &DVec3,
        inertia: &[DVec3; 3],
    ) -> Self {
        // Adds a little to the inertia. The inertia of collinear points about their common line is 0, and
        // could not be inverted.
        let mut inertia = *inertia;
        let little = 1e-9 * (inertia[0][0] + inertia[1][1] + inertia[2][2]) + f64::MIN_POSITIVE;
        (0..3).for_each(|k| inertia[k][k] += little);
        Self {
            velocity,
            angular_velocity: solved(&inertia, *angular),
            centre,
        }
    }

    /// Returns the motion with its linear velocity multiplied by `velocity` and its angular velocity by
    /// `spin`.
    pub(crate) fn times(&self, velocity: f64, spin: f64) -> Self {
        Self {
            velocity: self.velocity * velocity,
            angular_velocity: self.angular_velocity * spin,
            centre: self.centre,
        }
    }

    /// Returns the velocity of the centre [m/s], and the angular velocity [rad/s].
    pub(crate) fn velocity(&self) -> Twist {
        Twist {
            linear: self.velocity.as_vec3(),
            angular: self.angular_velocity.as_vec3(),
        }
    }

    /// Converts the motion to single precision.
    pub(crate) fn roughly(&self) -> RigidMotionF32 {
        let row = |vector: DVec3| Row::from(vector.as_vec3());
        let [x, y, z] = self.angular_velocity.to_array();
        RigidMotionF32 {
            velocity: row(self.velocity),
            centre: row(self.centre),
            spin: [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]].map(|column| row(column.into())),
        }
    }

    /// Velocity [m/s] of the rigid motion at a position [m].
    pub fn at(&self, position: Row) -> DVec3 {
        self.velocity
            + self
                .angular_velocity
                .cross(from_centre(position, self.centre))
    }
}

/// Centre of mass [m] of points (position [m], mass [kg]).
pub fn centre_of(points: impl Iterator<Item = (Row, f32)>) -> DVec3 {
    let (mut sum, mut total) = (DVec3::ZERO, 0.0);
    for (position, mass) in points {
        let mass = f64::from(mass);
        sum += position.xyz().as_dvec3() * mass;
        total += mass;
    }
    sum / total
}

/// Returns the inverse of a symmetric positive definite matrix, by rows. Adds a little to the matrix, so that the
/// moments of collinear points can be inverted.
pub(super) fn inverse(mut m: [DVec3; 3]) -> [DVec3; 3] {
    let little = 1e-6 * (m[0][0] + m[1][1] + m[2][2]) + f64::MIN_POSITIVE;
    (0..3).for_each(|k| m[k][k] += little);
    DVec3::AXES.map(|axis| solved(&m, axis))
}

/// Solves m x = b for a symmetric positive definite matrix m by its adjugate; returns 0 if m is singular.
fn solved(m: &[DVec3; 3], b: DVec3) -> DVec3 {
    let columns = [m[1].cross(m[2]), m[2].cross(m[0]), m[0].cross(m[1])];
    let determinant = m[0].dot(columns[0]);
    if determinant == 0.0 {
        return DVec3::ZERO;
    }
    DVec3::from(columns.map(|column| column.dot(b))) / determinant
}

fn from_centre(position: Row, centre: DVec3) -> DVec3 {
    position.xyz().as_dvec3() - centre
}

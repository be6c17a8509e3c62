//! Linear and angular momentum of a set of nodes, and the rigid motion that makes up a difference.

use crate::solve::Row;

/// Sums over mass points, in double precision, about a common centre.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Momentum {
    /// Σ m v [kg m/s].
    pub linear: [f64; 3],
    /// Σ m x × v [kg m²/s].
    pub angular: [f64; 3],
}

impl Momentum {
    /// The momentum of the given (position, velocity, mass) about `centre`.
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

    /// `self` − `other`.
    pub fn less(self, other: Self) -> Self {
        let minus = |a: [f64; 3], b: [f64; 3]| plus(a, b.map(|k| -k));
        Self {
            linear: minus(self.linear, other.linear),
            angular: minus(self.angular, other.angular),
        }
    }
}

/// A rigid velocity field: v(x) = `velocity` + `spin` × (x − centre).
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RigidMotion {
    velocity: [f64; 3],
    spin: [f64; 3],
    centre: [f64; 3],
}

impl RigidMotion {
    /// The motion that gives the points just the momentum `wanted`, itself about `centre`, the
    /// centre of their mass.
    pub fn with_momentum(
        points: impl Iterator<Item = (Row, f32)>,
        centre: [f64; 3],
        wanted: Momentum,
    ) -> Self {
        let mut inertia = [[0.0; 3]; 3];
        let mut total = 0.0;
        for (position, mass) in points {
            let (x, mass) = (from_centre(position, centre), f64::from(mass));
            let squared: f64 = x.iter().map(|k| k * k).sum();
            for i in 0..3 {
                inertia[i][i] += mass * squared;
                for j in 0..3 {
                    inertia[i][j] -= mass * x[i] * x[j];
                }
            }
            total += mass;
        }
        // Points on one line have no inertia about it; the little that is added stands for it.
        let little = 1e-9 * (inertia[0][0] + inertia[1][1] + inertia[2][2]) + f64::MIN_POSITIVE;
        (0..3).for_each(|k| inertia[k][k] += little);
        Self {
            velocity: wanted.linear.map(|k| k / total),
            spin: solved(&inertia, wanted.angular),
            centre,
        }
    }

    /// The velocity at a point.
    pub fn at(&self, position: Row) -> [f64; 3] {
        plus(
            self.velocity,
            cross(self.spin, from_centre(position, self.centre)),
        )
    }
}

/// The centre of mass.
pub fn centre_of(points: impl Iterator<Item = (Row, f32)>) -> [f64; 3] {
    let (mut sum, mut total) = ([0.0; 3], 0.0);
    for (position, mass) in points {
        let mass = f64::from(mass);
        sum = plus(sum, [0, 1, 2].map(|k: usize| mass * f64::from(position[k])));
        total += mass;
    }
    sum.map(|k| k / total)
}

/// x of m x = b for a symmetric positive definite matrix, by its adjugate.
fn solved(m: &[[f64; 3]; 3], b: [f64; 3]) -> [f64; 3] {
    let columns = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])];
    let determinant = dot(m[0], columns[0]);
    columns.map(|column| dot(column, b) / determinant)
}

fn from_centre(position: Row, centre: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k: usize| f64::from(position[k]) - centre[k])
}

fn plus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

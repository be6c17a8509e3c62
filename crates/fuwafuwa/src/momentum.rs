//! Linear and angular momentum of a set of nodes, and the rigid motion that makes up a difference.

use crate::solve::Row;
use crate::vector::{cross, dot, minus, plus, scaled};

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
        Self {
            linear: minus(self.linear, other.linear),
            angular: minus(self.angular, other.angular),
        }
    }

    /// Adds a point at `x` from the centre to an angular momentum and an inertia.
    pub(crate) fn add_spin(
        angular: &mut [f64; 3],
        inertia: &mut [[f64; 3]; 3],
        x: [f64; 3],
        velocity: [f64; 3],
        mass: f64,
    ) {
        *angular = plus(*angular, scaled(cross(x, velocity), mass));
        let squared = dot(x, x);
        for i in 0..3 {
            inertia[i][i] += mass * squared;
            for j in 0..3 {
                inertia[i][j] -= mass * x[i] * x[j];
            }
        }
    }
}

/// A rigid velocity field: v(x) = `velocity` + `spin` × (x − centre).
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
        let (mut unused, mut inertia, mut total) = ([0.0; 3], [[0.0; 3]; 3], 0.0);
        for (position, mass) in points {
            let (x, mass) = (from_centre(position, centre), f64::from(mass));
            Momentum::add_spin(&mut unused, &mut inertia, x, [0.0; 3], mass);
            total += mass;
        }
        let velocity = scaled(wanted.linear, 1.0 / total);
        Self::of_spin(velocity, centre, &wanted.angular, &inertia)
    }

    /// The motion with a given velocity of the centre and angular momentum about it.
    pub(crate) fn of_spin(
        velocity: [f64; 3],
        centre: [f64; 3],
        angular: &[f64; 3],
        inertia: &[[f64; 3]; 3],
    ) -> Self {
        // Points on one line have no inertia about it; the little that is added stands for it.
        let mut inertia = *inertia;
        let little = 1e-9 * (inertia[0][0] + inertia[1][1] + inertia[2][2]) + f64::MIN_POSITIVE;
        (0..3).for_each(|k| inertia[k][k] += little);
        Self {
            velocity,
            spin: solved(&inertia, *angular),
            centre,
        }
    }

    /// The same in single precision.
    pub(crate) fn rounded(&self) -> RoughMotion {
        let single = |v: [f64; 3]| [v[0] as f32, v[1] as f32, v[2] as f32, 0.0];
        let [x, y, z, _] = single(self.spin);
        RoughMotion {
            velocity: single(self.velocity),
            spin: [[0.0, z, -y, 0.0], [-z, 0.0, x, 0.0], [y, -x, 0.0, 0.0]],
            centre: single(self.centre),
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

/// A [`RigidMotion`] in single precision.
#[derive(Copy, Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct RoughMotion {
    velocity: Row,
    /// What a step along each axis away from the centre adds.
    spin: [Row; 3],
    centre: Row,
}

impl RoughMotion {
    /// The velocity at a point.
    #[inline(always)]
    pub fn at(&self, position: Row) -> Row {
        let from = minus(position, self.centre);
        let [x, y, z] = &self.spin;
        let turn = plus(scaled(*x, from[0]), scaled(*y, from[1]));
        plus(self.velocity, plus(turn, scaled(*z, from[2])))
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
    if determinant == 0.0 {
        return [0.0; 3];
    }
    columns.map(|column| dot(column, b) / determinant)
}

fn from_centre(position: Row, centre: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k: usize| f64::from(position[k]) - centre[k])
}

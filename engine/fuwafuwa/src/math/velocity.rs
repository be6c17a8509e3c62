//! Velocities of bodies, and impulses.

use crate::math::vector::Vector;

/// Linear and angular velocity of a body.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Velocity {
    /// Linear velocity of the centre of mass [m/s].
    pub linear: Vector,
    /// Angular velocity about the centre of mass [rad/s]; in 2D only the third component counts.
    pub angular: Vector,
}

impl Velocity {
    /// Returns a velocity without rotation [m/s].
    pub fn linear(linear: Vector) -> Self {
        let angular = Vector::ZERO;
        Self { linear, angular }
    }

    /// Returns a rotation about the centre of mass [rad/s].
    pub fn angular(angular: Vector) -> Self {
        let linear = Vector::ZERO;
        Self { linear, angular }
    }
}

impl From<Vector> for Velocity {
    fn from(linear: Vector) -> Self {
        Self::linear(linear)
    }
}

/// Impulse at a point of a body.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Impulse {
    /// World-space point at which the impulse acts [m].
    pub point: Vector,
    /// Impulse [N s].
    pub impulse: Vector,
    /// Radius around the point [m], default 0. All nodes of a soft body within the radius gain the same velocity. If
    /// the radius contains no node, the nearest node receives the impulse. Rigid bodies ignore the radius.
    pub radius: f32,
}

impl Impulse {
    /// Returns an impulse [N s] at a world-space point [m].
    pub fn at(point: Vector, impulse: Vector) -> Self {
        let radius = 0.0;
        Self {
            point,
            impulse,
            radius,
        }
    }

    /// Returns the impulse with a radius [m].
    #[must_use]
    pub fn within(self, radius: f32) -> Self {
        Self { radius, ..self }
    }
}

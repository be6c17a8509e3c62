//! Velocities of bodies, and impulses.

use crate::foundation::dim::{Dim, Dim2, Dim3, DimAngular, DimVector};
use crate::math::twist::Twist;
use glam::{Vec2, Vec3};

/// Linear and angular velocity of a body.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub struct Velocity<D: Dim> {
    /// Linear velocity [m/s] of the centre of mass, or of the local origin of a kinematic or coupled body.
    pub linear: D::Vector,
    /// Angular velocity [rad/s]; in 2D positive is counterclockwise.
    pub angular: D::Angular,
}

impl<D: Dim> Velocity<D> {
    /// Returns a velocity with a linear part [m/s] and no rotation.
    pub fn linear(linear: D::Vector) -> Self {
        Self {
            linear,
            ..Self::default()
        }
    }

    /// Returns a velocity with an angular part [rad/s] and no linear part.
    pub fn angular(angular: D::Angular) -> Self {
        Self {
            angular,
            ..Self::default()
        }
    }

    pub(crate) fn twist(self) -> Twist {
        Twist {
            linear: self.linear.to_vec3(),
            angular: self.angular.to_vec3(),
        }
    }
}

impl<D: Dim> From<Twist> for Velocity<D> {
    fn from(twist: Twist) -> Self {
        Self {
            linear: D::Vector::from_vec3(twist.linear),
            angular: D::Angular::from_vec3(twist.angular),
        }
    }
}

impl From<Vec2> for Velocity<Dim2> {
    fn from(linear: Vec2) -> Self {
        Self::linear(linear)
    }
}

impl From<Vec3> for Velocity<Dim3> {
    fn from(linear: Vec3) -> Self {
        Self::linear(linear)
    }
}

/// Impulse at a point of a body.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Impulse<D: Dim> {
    /// World-space point at which the impulse acts [m].
    pub point: D::Vector,
    /// Impulse [N s].
    pub impulse: D::Vector,
    /// Radius around the point [m], default 0. All nodes of a soft body within the radius gain the same velocity. If
    /// the radius contains no node, the nearest node receives the impulse. Rigid bodies ignore the radius.
    pub radius: f32,
}

impl<D: Dim> Impulse<D> {
    /// Returns an impulse [N s] at a world-space point [m].
    pub fn at(point: D::Vector, impulse: D::Vector) -> Self {
        let radius = 0.0;
        Self {
            point,
            impulse,
            radius,
        }
    }

    /// Returns the impulse spread over the nodes within `radius` [m] of its point.
    #[must_use]
    pub fn within(self, radius: f32) -> Self {
        Self { radius, ..self }
    }
}

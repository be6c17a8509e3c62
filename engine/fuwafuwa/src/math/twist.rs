//! Linear and angular velocity in three coordinates.

use glam::Vec3;

/// Linear and angular velocity of a body, with three components in both 2D and 3D.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Twist {
    /// Linear velocity [m/s] of the centre of mass, or of the local origin of a kinematic or coupled body.
    pub linear: Vec3,
    /// Angular velocity [rad/s]; in 2D only the third component is not 0.
    pub angular: Vec3,
}

//! Conversions between the vectors of Bevy and those of the engine, which use different versions of `glam`.
//!
//! ```
//! use bevy_fuwafuwa::convert::{bevy_vector, engine_vector};
//! use bevy_fuwafuwa::prelude::*;
//! use bevy_math::Vec3;
//!
//! let half_extents = Vec3::new(0.5, 0.1, 0.5);
//! let table = RigidBody3d::fixed(Shape::cuboid(engine_vector(half_extents)));
//! let [low, high] = table.shape.bounds();
//! assert_eq!(bevy_vector(high - low), Vec3::new(1.0, 0.2, 1.0));
//! ```

use crate::component::Velocity;
use bevy_math::{Quat, Vec3};
use fuwafuwa::{Dim, DimAngular, DimVector, Rotation};

/// Returns a vector of Bevy as one of the engine; in 2D without z.
pub fn engine_vector<V: DimVector>(vector: Vec3) -> V {
    V::from_vec3(vector.to_array().into())
}

/// Returns a vector of the engine as one of Bevy; in 2D z is 0.
pub fn bevy_vector<V: DimVector>(vector: V) -> Vec3 {
    vector.to_vec3().to_array().into()
}

/// Returns a rotation of Bevy as one of the engine.
pub fn engine_rotation(rotation: Quat) -> Rotation {
    Rotation::from_quaternion(rotation.to_array())
}

/// Returns a rotation of the engine as one of Bevy.
pub fn bevy_rotation(rotation: Rotation) -> Quat {
    Quat::from_array(rotation.quaternion())
}

/// Returns a velocity component as a velocity of the engine.
pub fn engine_velocity<D: Dim>(velocity: Velocity) -> fuwafuwa::Velocity<D> {
    fuwafuwa::Velocity {
        linear: engine_vector(velocity.linear),
        angular: D::Angular::from_vec3(engine_vector(velocity.angular)),
    }
}

/// Returns a velocity of the engine as a velocity component.
pub fn bevy_velocity<D: Dim>(velocity: fuwafuwa::Velocity<D>) -> Velocity {
    Velocity {
        linear: bevy_vector(velocity.linear),
        angular: bevy_vector(velocity.angular.to_vec3()),
    }
}

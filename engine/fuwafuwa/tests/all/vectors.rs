//! Vectors in both dimensions, for tests that run in 2D and in 3D.

use fuwafuwa::{DimVector, Vec3};

/// Returns the vector (x, y, z) in the dimension of `V`; in 2D, z is dropped.
pub fn vector<V: DimVector>(x: f32, y: f32, z: f32) -> V {
    V::from_vec3(Vec3::new(x, y, z))
}

//! Vectors, rotations and SIMD lanes.

pub mod lanes;
pub mod rotation;
pub mod row;
pub mod twist;
pub mod vector;
pub mod velocity;

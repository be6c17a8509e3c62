//! Soft bodies whose elements are small at the surface, large inside, and re-graded as a crack runs in.
//!
//! The way through the library, each module using only those above it:
//! [`grid`] which voxels are solid → [`sharing`] what is connected → [`pyramid`] which cells exist
//! → [`stencil`] one class of element → [`mesh`] elements and nodes → [`law`] forces on them.
//! Two and three dimensions are one program: [`dim`] holds all that differs.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
// An axis indexes several vectors at once; zipping them would hide the formula.
#![allow(clippy::needless_range_loop)]

pub mod dim;
pub mod grid;
pub mod law;
pub mod mesh;
pub mod pyramid;
pub mod sharing;
pub mod stencil;

pub use dim::{Dim, Dim2, Dim3, Point};
pub use grid::{BuildError, VoxelGrid};
pub use mesh::Mesh;

//! Worlds in space: the same way through as in the plane.
//!
//! [`camera`] is what a caller says beside the rest of a [`crate::Frame`] → `rest` how a body is smooth
//! before it moves → `faces` what of it is bare → [`skin`] its smooth surface now, `stickers` what lies on
//! it; `cut` where it is opened → `boxes` its elements → `rounded` and `room` everything rigid → [`geometry`] all of them → `gpu`
//! draws them: first what the light and the sky see, then the picture.
//!
//! Up is the second axis: the sky, the lines below hands and the floor go by it.

mod boxes;
pub mod camera;
mod cut;
mod faces;
pub mod geometry;
#[cfg(feature = "gpu")]
mod gpu;
mod pool;
mod rest;
mod room;
mod rounded;
pub mod skin;
mod stickers;

pub use camera::{Camera, Cut};
pub use geometry::Geometry;
#[cfg(feature = "gpu")]
pub use gpu::Renderer;
pub use skin::Skin;

//! 3D worlds, with the same data flow as in 2D.
//!
//! The caller adds a [`camera`] to a [`crate::Frame`] → `rest` smooths the shape of a body at rest → `faces`
//! finds its bare faces → [`skin`] computes the current smooth surface, `stickers` the marks on it; `cut` the
//! cut planes → `boxes` the elements → `rounded` and `room` everything rigid → [`geometry`] collects them →
//! `gpu` draws the shadow map and the sky map, then the picture.
//!
//! Up is the second axis; the sky, the lines below hands and the floor depend on it.

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

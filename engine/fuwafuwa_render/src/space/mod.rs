//! 3D worlds, with the same data flow as in 2D:
//!
//! 1. The caller adds a [`camera`] to a [`crate::Frame`].
//! 2. `rest` has the smooth surface and the colours of a body at rest.
//! 3. `faces` finds its bare faces.
//! 4. [`skin`] computes the current smooth surface, and `stickers` the marks on it.
//! 5. For the element view, `cut` computes the cut planes, and `boxes` the elements.
//! 6. `rounded` and `room` turn rigid bodies into instances and polygons.
//! 7. [`geometry`] collects the vertices.
//! 8. `gpu` draws the shadow map and the sky map, then the picture.
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

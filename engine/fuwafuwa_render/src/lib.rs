//! Draws worlds of the soft-body engine fuwafuwa with wgpu: the skin of bodies or their elements, in 2D and
//! 3D.
//!
//! [`Frame`] describes as plain data how to show a world. [`Renderer::prepare`] computes the triangles and
//! draws intermediate images. [`Renderer::paint`] draws the picture into a render pass of a window.
//! [`Renderer::render_to_image`] draws into an image without a window.
//!
//! Data flow in 2D:
//!
//! 1. The caller provides a [`palette`] and a [`frame`].
//! 2. `rings` traces the outlines of the smooth surface, which the engine knows.
//! 3. `skin`, `elements` and `rigid` turn a world into vertices, without a GPU.
//! 4. [`geometry`] collects the vertices.
//! 5. `gpu` draws them.
//!
//! [`anchor`] and [`ages`] help callers that paint on top.
//!
//! [`space`] does the same for 3D worlds. It shares the palettes, frames, buffers and stages. It has its own
//! camera, skin and renderer, because a surface cannot be handled like an outline.
//!
//! To draw with another renderer, disable the default feature `gpu` and use the vertices, for example those
//! of [`space::Skin`].
//!
//! The limits of WebGL2, `wgpu::Limits::downlevel_webgl2_defaults`, are sufficient.
#![deny(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // brackets hold units, such as [m]
#![cfg_attr(not(feature = "gpu"), allow(dead_code))] // without `gpu`, most vertices are unused

pub mod ages;
pub mod anchor;
mod elements;
pub mod frame;
pub mod geometry;
#[cfg(feature = "gpu")]
mod gpu;
pub mod palette;
mod rigid;
mod rings;
mod skin;
pub mod space;

pub use ages::Ages;
pub use anchor::{Anchor, anchor, anchor_at};
pub use frame::{Basket, Camera, DimCamera, Frame, Look, Mark, Particle, Prop, Sticker, Tints};
pub use geometry::Geometry;
#[cfg(feature = "gpu")]
pub use gpu::Renderer;
#[cfg(feature = "gpu")]
pub use gpu::cost::Cost;
#[cfg(feature = "gpu")]
pub use gpu::image::{ImageError, ImageStage, image, image_async, pass_into};
#[cfg(feature = "gpu")]
pub use gpu::targets::new_image;
pub use palette::{Colour, Palette};
pub use rings::{OutlinePoint, Outlines, Span};

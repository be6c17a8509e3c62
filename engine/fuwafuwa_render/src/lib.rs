//! Draws a world of fuwafuwa with wgpu: the skin of its bodies, or their elements.
//!
//! [`Frame`] says as plain data how to look at a world. [`Renderer::prepare`] makes triangles of
//! it and draws what has to be drawn apart; [`Renderer::paint`] puts the picture into a pass of a
//! window, and [`Renderer::render_to_image`] into an image, without any window.
//!
//! The way through: [`palette`] and [`frame`] are what a caller says → `stairs` and `rest` how a body is smooth
//! before it moves → `rings` its smooth outlines now → `skin`, `elements`, `rigid` turn a world into vertices, without a GPU →
//! `geometry` all of them → `gpu` draws them. [`anchor`] and [`ages`] answer questions of those
//! who paint on top.
//!
//! [`space`] is the same for worlds in space; it shares the themes, frames, buffers and stages, and has
//! a camera, a skin and a renderer of its own, for a surface is no outline.
//!
//! Who draws another way leaves the feature `gpu` out, and takes the vertices: of [`space::Skin`], for one,
//! or what takes the stairs out of a shape in the plane, [`Rest`].
//!
//! It needs no more than WebGL2 has, `wgpu::Limits::downlevel_webgl2_defaults`.
#![deny(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units stand in brackets: [m]
#![cfg_attr(not(feature = "gpu"), allow(dead_code))] // nobody reads most vertices then

pub mod ages;
pub mod anchor;
mod elements;
pub mod frame;
pub mod geometry;
#[cfg(feature = "gpu")]
mod gpu;
pub mod palette;
mod plane;
mod rest;
mod rigid;
mod rings;
mod skin;
pub mod space;
mod stairs;

pub use ages::Ages;
pub use anchor::{Anchor, anchor, anchor_at};
pub use frame::{Basket, Camera, Frame, Look, Mark, Particle, Prop, Sticker};
pub use geometry::Geometry;
#[cfg(feature = "gpu")]
pub use gpu::Renderer;
#[cfg(feature = "gpu")]
pub use gpu::cost::Cost;
#[cfg(feature = "gpu")]
pub use gpu::image::{ImageError, Step, image, image_later, pass_into};
#[cfg(feature = "gpu")]
pub use gpu::targets::new_image;
pub use palette::{Colour, Palette};
pub use rest::Rest;

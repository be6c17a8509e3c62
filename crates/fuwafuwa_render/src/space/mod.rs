//! Worlds in space: the same way through as in the plane.
//!
//! `rest` how a body is smooth before it moves → [`skin`] its smooth surface now, kept up to date
//! face by face.

mod faces;
mod rest;
pub mod skin;
mod slots;

pub use skin::Skin;

//! Surface of a body as vertices and triangles, from which its mesh is written.

pub mod plane;
mod pool;
pub mod space;

use crate::colours::SoftColours;
use bevy_math::Vec3;
use fuwafuwa::{Dim, SoftBody};

/// Vertex of a triangle, in world space.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Vertex {
    /// Position [m].
    pub position: Vec3,
    /// Outward unit normal.
    pub normal: Vec3,
}

/// Triangulated surface that follows a body.
pub trait Surface<D: Dim>: Default + Send + Sync + 'static {
    /// Updates the surface to the current state of a body. Returns whether triangles or colours changed.
    fn follow(&mut self, body: &SoftBody<D>, colours: &SoftColours) -> bool;

    /// Returns the vertices; `None` for unused slots.
    fn vertices(&self) -> impl Iterator<Item = Option<Vertex>>;

    /// Returns the vertex colours, linear RGBA.
    fn colours(&self, colours: &SoftColours) -> impl Iterator<Item = [f32; 4]>;

    /// Returns the triangles, three vertex indices each. Unused triangles have three equal indices.
    fn indices(&self) -> impl Iterator<Item = u32>;
}

/// Returns the colour of a material, linear RGBA. If `is_fresh`, the colour is mixed with that of fresh crack
/// faces.
fn light_of(colours: &SoftColours, material: u8, is_fresh: bool) -> [f32; 4] {
    let count = colours.materials.len().max(1);
    let place = usize::from(material.max(1) - 1) % count;
    let own = colours.materials.get(place).copied().unwrap_or([0.5; 3]);
    let light = match is_fresh {
        false => own.map(linear),
        true => [0, 1, 2].map(|k| 0.5 * (linear(own[k]) + linear(colours.fresh[k]))),
    };
    [light[0], light[1], light[2], 1.0]
}

/// Converts an sRGB component to linear, 0 to 1 [IEC 61966-2-1].
fn linear(value: f32) -> f32 {
    match value <= 0.040_45 {
        true => value / 12.92,
        false => ((value + 0.055) / 1.055).powf(2.4),
    }
}

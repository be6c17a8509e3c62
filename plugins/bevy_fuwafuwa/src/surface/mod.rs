//! The surface of a body as vertices: what every mesh is written from.

pub mod plane;
mod pool;
pub mod space;

use crate::colours::SoftColours;
use bevy_math::Vec3;
use fuwafuwa::{Body, Dim};

/// A corner of a triangle, in the world.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Vertex {
    /// Where [m].
    pub at: Vec3,
    /// Outwards, of length 1.
    pub normal: Vec3,
}

/// What follows a body with triangles.
pub trait Surface<D: Dim>: Default + Send + Sync + 'static {
    /// Brings it up to date with a body. Returns whether triangles or colours are others than before.
    fn follow(&mut self, body: &Body<D>, colours: &SoftColours) -> bool;

    /// Its vertices; nothing at places that nobody has.
    fn vertices(&self) -> impl Iterator<Item = Option<Vertex>>;

    /// Their colours, as light (linear).
    fn colours(&self, colours: &SoftColours) -> impl Iterator<Item = [f32; 4]>;

    /// Its triangles, three vertices each. Some have no area.
    fn indices(&self) -> impl Iterator<Item = u32>;
}

/// The colour of a material, as light.
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

/// The share of light that a screen makes of a number, 0 to 1 [IEC 61966-2-1].
fn linear(value: f32) -> f32 {
    match value <= 0.040_45 {
        true => value / 12.92,
        false => ((value + 0.055) / 1.055).powf(2.4),
    }
}

//! Colours of soft bodies.

use bevy_ecs::component::Component;

/// Colours of a soft body: sRGB red, green and blue, 0 to 1. Read when the body enters the world.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct SoftColours {
    /// Colours by material, number 1 first. Material numbers beyond the end start again at the first colour.
    pub materials: Vec<[f32; 3]>,
    /// Colour of fresh crack faces, mixed half and half with the colour of the material.
    pub fresh: [f32; 3],
}

impl Default for SoftColours {
    fn default() -> Self {
        let palette = fuwafuwa_render::Palette::candy();
        Self {
            materials: palette.materials,
            fresh: palette.fresh,
        }
    }
}

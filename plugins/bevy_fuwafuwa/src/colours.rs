//! Which colour a soft body has.

use bevy_ecs::component::Component;

/// The colours of its materials, number 1 first, and of what was inside before it tore; red, green and blue as screens
/// take them (sRGB), 0 to 1. They start over after the last. Counts when the body enters.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct SoftColours {
    /// By material.
    pub materials: Vec<[f32; 3]>,
    /// Of what was inside, mixed half and half into that of its material.
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

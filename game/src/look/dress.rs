//! The letters of the game, and egui without its toolbox look.

use egui::{Context, FontData, FontDefinitions, FontFamily, vec2};
use std::sync::Arc;

/// The font that the game writes with.
const FONT: &[u8] = include_bytes!("../../fonts/MPLUSRounded1c-Bold.ttf");

/// Gives egui the game's font and takes its toolbox look away.
pub fn dress(context: &Context) {
    let mut fonts = FontDefinitions::empty();
    let name = "rounded".to_string();
    fonts
        .font_data
        .insert(name.clone(), Arc::new(FontData::from_static(FONT)));
    for family in [FontFamily::Proportional, FontFamily::Monospace] {
        fonts.families.entry(family).or_default().push(name.clone());
    }
    context.set_fonts(fonts);
    context.set_theme(egui::Theme::Light);
    // The text size is a setting.
    context.options_mut(|options| options.zoom_with_keyboard = false);
    context.all_styles_mut(|style| {
        style.interaction.selectable_labels = false;
        style.spacing.item_spacing = vec2(10.0, 6.0);
    });
}

//! The letters of the game, and egui without its toolbox look.

use egui::epaint::text::{FontInsert, FontPriority, InsertFontFamily};
use egui::{Context, FontData, FontDefinitions, FontFamily, vec2};
use std::sync::Arc;

/// Latin letters, signs, and what the title says. All families of letters are the same one.
const LATIN: &[u8] = include_bytes!("../../fonts/MPLUSRounded1c-Bold-latin.ttf");
/// Kana and kanji. A browser fetches them when they are wanted.
#[cfg(not(target_family = "wasm"))]
const JAPANESE: &[u8] = include_bytes!("../../fonts/MPLUSRounded1c-Bold-japanese.ttf");

const FAMILIES: [FontFamily; 2] = [FontFamily::Proportional, FontFamily::Monospace];

/// Gives egui the game's font and takes its toolbox look away.
pub fn dress(context: &Context) {
    let mut fonts = FontDefinitions::empty();
    let mut add = |name: &str, bytes| {
        let data = Arc::new(FontData::from_static(bytes));
        fonts.font_data.insert(name.into(), data);
        for family in FAMILIES {
            fonts.families.entry(family).or_default().push(name.into());
        }
    };
    add("latin", LATIN);
    #[cfg(not(target_family = "wasm"))]
    add("japanese", JAPANESE);
    context.set_fonts(fonts);
    context.set_theme(egui::Theme::Light);
    // The text size is a setting.
    context.options_mut(|options| {
        options.zoom_with_keyboard = false;
        // Who presses a button for long means it too, and so does one whose machine is slow.
        options.input_options.max_click_duration = f64::INFINITY;
    });
    context.all_styles_mut(|style| {
        style.interaction.selectable_labels = false;
        style.spacing.item_spacing = vec2(10.0, 6.0);
    });
}

/// Adds letters that came later.
pub fn add_letters(context: &Context, bytes: Vec<u8>) {
    let families = FAMILIES.map(|family| InsertFontFamily {
        family,
        priority: FontPriority::Lowest,
    });
    let data = FontData::from_owned(bytes);
    context.add_font(FontInsert::new("japanese", data, families.into()));
}

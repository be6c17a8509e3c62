//! Fonts and egui style.

use egui::epaint::text::{FontInsert, FontPriority, InsertFontFamily};
use egui::{Context, FontData, FontDefinitions, FontFamily, vec2};
use std::sync::Arc;

/// Font with Latin letters, symbols and the characters of the game's title; used for all font families.
const LATIN: &[u8] = include_bytes!("../fonts/MPLUSRounded1c-Bold-latin.ttf");
/// Font with kana and kanji. The browser version does not contain it, but downloads it on demand.
#[cfg(not(target_family = "wasm"))]
const JAPANESE: &[u8] = include_bytes!("../fonts/MPLUSRounded1c-Bold-japanese.ttf");

const FAMILIES: [FontFamily; 2] = [FontFamily::Proportional, FontFamily::Monospace];

/// Installs the fonts and the style in egui.
pub fn apply(context: &Context) {
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
    // Turns egui's keys for zooming off, because the game sets the text size itself.
    context.options_mut(|options| {
        options.zoom_with_keyboard = false;
        // A press counts as a click however long it lasts: players may hold a button for long, and frames of
        // a slow machine take long.
        options.input_options.max_click_duration = f64::INFINITY;
    });
    context.all_styles_mut(|style| {
        style.interaction.selectable_labels = false;
        style.spacing.item_spacing = vec2(10.0, 6.0);
    });
}

/// Adds the Japanese font after start-up, in the browser version.
pub fn add_japanese_font(context: &Context, bytes: Vec<u8>) {
    let families = FAMILIES.map(|family| InsertFontFamily {
        family,
        priority: FontPriority::Lowest,
    });
    let data = FontData::from_owned(bytes);
    context.add_font(FontInsert::new("japanese", data, families.into()));
}

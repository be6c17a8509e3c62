//! The button for the other language.

use super::super::hud::STAND;
use super::super::widgets::{Weight, button};
use crate::game::Game;
use crate::words::Language;
use egui::{Rect, Ui, vec2};
use tamaire_sound::Menu;

/// A button for the other language: its size, and how far it is from the corner [points].
const LANGUAGE: egui::Vec2 = vec2(168.0, STAND - 2.0 * EDGE);
const EDGE: f32 = 18.0;

/// The screen, but on an upright one without the edge where the button for the other language is.
pub(super) fn above(screen: Rect) -> Rect {
    let is_upright = screen.width() < screen.height();
    screen.with_max_y(screen.bottom() - if is_upright { STAND } else { 0.0 })
}

/// One big button, in the lower left corner, for whoever cannot read the rest.
pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    let corner = ui.max_rect().left_bottom() + vec2(EDGE, -EDGE - LANGUAGE.y);
    let rect = Rect::from_min_size(corner, LANGUAGE);
    let (theme, spoken) = (game.theme(), game.settings.language);
    for (language, name) in Language::ALL {
        let place = egui::UiBuilder::new().max_rect(rect);
        if language != spoken
            && ui
                .scope_builder(place, |ui| {
                    button(ui, &theme, name, LANGUAGE, Weight::Other).clicked()
                })
                .inner
        {
            game.settings.language = language;
            game.blip(Menu::Confirm);
        }
    }
}

//! Button that switches the language.

use super::super::hud::STAND;
use crate::game::Game;
use crate::words::Language;
use app_shell::widgets::{ButtonStyle, button};
use egui::{Rect, Ui, vec2};
use tamaire_sound::Menu;

/// Size of the button [points].
const LANGUAGE: egui::Vec2 = vec2(168.0, STAND - 2.0 * EDGE);
/// Distance of the button from the edges of the window [points].
const EDGE: f32 = 18.0;

/// Returns the area for other contents: the screen, in a portrait window without the bottom edge that holds
/// the language button.
pub(super) fn above(screen: Rect) -> Rect {
    let is_upright = screen.width() < screen.height();
    screen.with_max_y(screen.bottom() - if is_upright { STAND } else { 0.0 })
}

/// Shows a large button in the lower left corner with the other language's own name.
pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    let corner = ui.max_rect().left_bottom() + vec2(EDGE, -EDGE - LANGUAGE.y);
    let rect = Rect::from_min_size(corner, LANGUAGE);
    let (theme, spoken) = (game.theme(), game.settings.language);
    for (language, name) in Language::ALL {
        let place = egui::UiBuilder::new().max_rect(rect);
        if language != spoken
            && ui
                .scope_builder(place, |ui| {
                    button(ui, &theme, name, LANGUAGE, ButtonStyle::Other).clicked()
                })
                .inner
        {
            game.settings.language = language;
            game.blip(Menu::Confirm);
        }
    }
}

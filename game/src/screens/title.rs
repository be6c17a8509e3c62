//! The name of the game over a body that plays by itself.

use super::kit::{Weight, button, column};
use super::{veil, words};
use crate::game::{Game, Screen};
use egui::{Ui, pos2, vec2};
use tamaire_sound::Menu;

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    veil(ui, 110);
    let (theme, said) = (game.theme(), game.words());
    let screen = ui.max_rect();
    let bob = if game.settings.reduced_motion {
        0.0
    } else {
        6.0 * (1.6 * game.time).sin()
    };
    let top = pos2(
        screen.center().x,
        screen.top() + 0.2 * screen.height() + bob,
    );
    words(
        ui,
        top + vec2(0.0, 5.0),
        "玉入れ",
        104.0,
        egui::Color32::from_black_alpha(40),
    );
    words(ui, top, "玉入れ", 104.0, theme.accent);
    words(ui, top + vec2(0.0, 78.0), "tamaire", 34.0, theme.ink);
    let mut wanted = None;
    column(ui, 320.0, 320.0, |ui| {
        ui.add_space(110.0);
        let options = [
            (said.play, Screen::Levels),
            (said.replays, Screen::Replays),
            (said.settings, Screen::Settings(Box::new(Screen::Title))),
        ];
        for (place, (text, screen)) in options.into_iter().enumerate() {
            let weight = if place == 0 {
                Weight::Main
            } else {
                Weight::Other
            };
            let response = button(ui, &theme, text, vec2(280.0, 62.0), weight);
            if place == 0 {
                super::play::focus_first(ui, &response);
            }
            if response.clicked() {
                wanted = Some(screen);
            }
            ui.add_space(12.0);
        }
        if !cfg!(target_arch = "wasm32")
            && button(ui, &theme, said.quit, vec2(280.0, 52.0), Weight::Other).clicked()
        {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
    });
    if let Some(screen) = wanted {
        game.blip(Menu::Confirm);
        game.go(screen);
    }
}

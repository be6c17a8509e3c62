//! Pause menu.

use super::widgets::{Act, card, column, dim_background, title};
use crate::game::{Game, Screen};
use app_shell::widgets::{ButtonStyle, button};
use egui::{Ui, vec2};
use tamaire_sound::Menu;

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    dim_background(ui, 130);
    let (theme, said) = (game.theme(), game.words());
    let mut wanted: Option<Act> = None;
    column(ui, 380.0, 0.5, |ui| {
        card(ui, &theme, |ui| {
            title(ui, &theme, said.paused);
            ui.add_space(14.0);
            let options: [(&str, Act); 6] = [
                (said.go_on, |game| game.go(Screen::Play)),
                (said.again, Game::retry),
                (said.save, Game::keep_replay),
                (said.link_to_level, Game::copy_link_to_level),
                (said.settings, |game| game.go(Screen::Settings)),
                (said.levels, |game| game.go(Screen::Levels)),
            ];
            for (index, (text, act)) in options.into_iter().enumerate() {
                let weight = if index == 0 {
                    ButtonStyle::Main
                } else {
                    ButtonStyle::Other
                };
                let response = button(ui, &theme, text, vec2(300.0, 50.0), weight);
                if index == 0 {
                    super::play::focus_first(ui, &response);
                }
                if response.clicked() {
                    wanted = Some(act);
                }
                ui.add_space(10.0);
            }
        });
    });
    if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
        wanted = Some(|game| game.go(Screen::Play));
    }
    if let Some(act) = wanted {
        game.blip(Menu::Confirm);
        act(game);
    }
}

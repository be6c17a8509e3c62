//! PIN pad for the staff.

use super::super::icons;
use super::super::widgets::{card, column, dim_background, focus_first};
use crate::exhibit::{CORNER, Stand};
use crate::game::Game;
use app_shell::widgets::{ButtonStyle, button, fitted};
use egui::{Sense, Stroke, Ui, Vec2, vec2};
use tamaire_sound::Menu;

const KEY: Vec2 = vec2(96.0, 60.0);
const GAP: f32 = 10.0;
const DIGITS: [[char; 3]; 4] = [
    ['1', '2', '3'],
    ['4', '5', '6'],
    ['7', '8', '9'],
    [' ', '0', DELETE],
];
/// Key that deletes the last digit.
const DELETE: char = '⌫';

pub(super) fn show(stand: &mut Stand, game: &mut Game, ui: &mut Ui) {
    dim_background(ui, 255);
    let (theme, said) = (game.theme(), game.settings.language.at_stand());
    let pause = stand.pause();
    let entered = "●".repeat(stand.entrance.entered.len());
    let shown = match pause > 0.0 {
        true => (said.wait)(pause.ceil()),
        false if stand.entrance.was_wrong() => said.wrong.into(),
        false => entered,
    };
    let typed = typed_digit(ui);
    let mut leaves = ui.input(|input| input.key_pressed(egui::Key::Escape));
    let mut deletes = ui.input(|input| input.key_pressed(egui::Key::Backspace));
    let mut digit = typed;
    let width = 3.0 * KEY.x + 2.0 * GAP;
    column(ui, width + 60.0, 0.5, |ui| {
        card(ui, &theme, |ui| {
            ui.spacing_mut().item_spacing = vec2(GAP, GAP);
            for (text, size) in [(said.door, 34.0), (shown.as_str(), 28.0)] {
                let (rect, _) = ui.allocate_exact_size(vec2(width, 1.3 * size), Sense::hover());
                let galley = fitted(ui.painter(), text, size, width, theme.ink);
                ui.painter()
                    .galley(rect.center() - 0.5 * galley.size(), galley, theme.ink);
            }
            for row in DIGITS {
                ui.horizontal(|ui| {
                    for key in row {
                        if key == ' ' {
                            ui.allocate_exact_size(KEY, Sense::hover());
                            continue;
                        }
                        let text = match key {
                            DELETE => game.words().delete.to_string(),
                            digit => digit.to_string(),
                        };
                        let response = button(ui, &theme, &text, KEY, ButtonStyle::Other);
                        if key == '1' {
                            focus_first(ui, &response);
                        }
                        match response.clicked() {
                            true if key == DELETE => deletes = true,
                            true => digit = Some(key),
                            false => {}
                        }
                    }
                });
            }
            let back = button(
                ui,
                &theme,
                game.words().back,
                vec2(width, 52.0),
                ButtonStyle::Other,
            );
            leaves |= back.clicked();
        })
    });
    if leaves {
        game.blip(Menu::Back);
        stand.end_and_reset(game);
    } else if deletes {
        game.blip(Menu::Back);
        stand.entrance.entered.pop();
    } else if let Some(digit) = digit {
        game.blip(Menu::Confirm);
        stand.enter(game, digit);
    }
}

/// Draws a ring that closes while staff holds the hidden corner of the screen or the chord, a combination of
/// stick buttons.
pub(super) fn knocked(stand: &Stand, game: &Game, ui: &Ui) {
    if let Some(share) = stand.entrance.held() {
        let middle = ui.max_rect().right_top() + vec2(-0.5, 0.5) * CORNER;
        let stroke = Stroke::new(5.0, game.theme().faint);
        icons::arc(ui.painter(), middle, 0.3 * CORNER, share, stroke);
    }
}

/// Returns the digit that was typed on a keyboard.
fn typed_digit(ui: &Ui) -> Option<char> {
    ui.input(|input| {
        let mut typed = input.events.iter().filter_map(|event| match event {
            egui::Event::Text(text) => text.chars().next(),
            _ => None,
        });
        typed.find(char::is_ascii_digit)
    })
}

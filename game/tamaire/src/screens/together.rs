//! Screen that explains how two players play, and lets them begin.

use super::widgets::{Act, card, column, dim_background, menu, perform, title};
use crate::game::{Game, Screen};
use crate::input::{Action, InputSource, KeyboardPart};
use app_shell::widgets::{ButtonStyle, button};
use egui::{Align, Label, RichText, Ui, vec2};

/// Actions that move a hand, in the order in which their keys are listed.
const WAYS: [Action; 4] = [Action::Up, Action::Left, Action::Down, Action::Right];

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    dim_background(ui, 130);
    let (theme, said) = (game.theme(), game.words());
    let bindings = &game.settings.bindings;
    let parts = [KeyboardPart::Arrows, KeyboardPart::Letters];
    let names = parts.map(|part| bindings.names_in(&WAYS, part));
    let has_all = |part| WAYS.iter().all(|&way| bindings.has_key_in(way, part));
    let missing = [said.no_arrow_keys, said.no_letter_keys];
    let missing = { parts.into_iter().zip(missing) }.filter(|(part, _)| !has_all(*part));
    let missing: Vec<&str> = missing.map(|(_, text)| text).collect();
    // A second player who joined with another device needs no keys.
    let can_be_two = missing.is_empty() || game.controls.players.second().is_some();
    let wanted = column(ui, 520.0, 0.5, |ui| {
        card(ui, &theme, |ui| {
            title(ui, &theme, said.two_players);
            ui.add_space(10.0);
            ui.set_max_width(ui.available_width());
            let hands = [Some(0), Some(1), None, None];
            let lines = (said.who_plays)(&names);
            ui.with_layout(egui::Layout::top_down(Align::Min), |ui| {
                for (line, hand) in lines.into_iter().zip(hands) {
                    ui.horizontal_top(|ui| {
                        let (rect, _) =
                            ui.allocate_exact_size(vec2(30.0, 24.0), egui::Sense::hover());
                        let tone = hand.map_or(theme.faint, |hand| theme.hand(hand));
                        let radius = if hand.is_some() { 10.0 } else { 4.0 };
                        ui.painter().circle_filled(rect.center(), radius, tone);
                        ui.vertical(|ui| {
                            let text = RichText::new(line).size(19.0).color(theme.ink);
                            ui.add(Label::new(text).wrap());
                        });
                    });
                    ui.add_space(4.0);
                }
                for text in missing {
                    let warning = RichText::new(text).size(19.0);
                    ui.add(Label::new(warning.color(theme.accent)).wrap());
                }
            });
            ui.add_space(10.0);
            let options: [(&str, Act); 3] = [
                (said.play_as_two, |game| play(game, true)),
                (said.play_alone, |game| play(game, false)),
                (said.back, Game::go_back),
            ];
            let size = vec2(300.0, 50.0);
            if can_be_two {
                return menu(ui, &theme, size, &options);
            }
            ui.add_enabled_ui(false, |ui| {
                button(ui, &theme, said.play_as_two, size, ButtonStyle::Other);
            });
            ui.add_space(10.0);
            menu(ui, &theme, size, &options[1..])
        })
    });
    perform(game, ui, wanted, Game::go_back);
}

/// Leads to the levels, for two players or for one.
fn play(game: &mut Game, as_two: bool) {
    let players = &mut game.controls.players;
    let second = players.second();
    // A second player who joined with another device stays.
    if as_two && second.is_none() {
        players.join(InputSource::LetterKeys);
    }
    if let (false, Some(seat)) = (as_two, second) {
        players.join(seat);
    }
    game.go(Screen::Levels);
}

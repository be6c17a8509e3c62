//! How it went, and a dare to try the other way.

use super::kit::{Weight, button, card, column};
use super::{Act, veil};
use crate::game::{Game, Screen};
use egui::{RichText, Ui, vec2};
use tamaire_sound::Menu;

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    veil(ui, 90);
    let Some((outcome, is_best)) = game.won else {
        game.go(Screen::Play);
        return;
    };
    let (theme, said) = (game.theme(), game.words());
    let level = game.session.round().level().clone();
    let mut wanted: Option<Act> = None;
    let to_levels: Act = |game| {
        game.go(Screen::Title);
        game.go(Screen::Levels);
    };
    column(ui, 560.0, 560.0, |ui| {
        card(ui, &theme, |ui| {
            ui.label(
                RichText::new((said.route)(outcome.route))
                    .size(44.0)
                    .color(theme.accent)
                    .strong(),
            );
            if is_best {
                ui.label(
                    RichText::new(format!("★ {}", said.new_best))
                        .size(22.0)
                        .color(theme.ink),
                );
            }
            ui.add_space(10.0);
            ui.columns(4, |columns| {
                for (column, (name, value)) in columns.iter_mut().zip((said.summary)(&outcome)) {
                    column.vertical_centered(|ui| {
                        ui.label(RichText::new(value).size(26.0).color(theme.ink).strong());
                        ui.label(RichText::new(name).size(15.0).color(theme.faint));
                    });
                }
            });
            ui.add_space(10.0);
            for wish in &level.game().wish {
                let mark = if outcome.fulfils(wish) { "★" } else { "☆" };
                let text = format!("{mark} {}", (said.wish)(wish));
                ui.label(RichText::new(text).size(19.0).color(theme.ink));
            }
            ui.add_space(12.0);
            ui.label(
                RichText::new((said.other_way)(outcome.route))
                    .size(24.0)
                    .color(theme.accent),
            );
            ui.add_space(8.0);
            let again = button(ui, &theme, said.again, vec2(320.0, 60.0), Weight::Main);
            super::play::focus_first(ui, &again);
            if again.clicked() {
                wanted = Some(Game::retry);
            }
            ui.add_space(10.0);
            let small = vec2(154.0, 46.0);
            let rows: [[(&str, Act); 2]; 2] = [
                [
                    (said.next, |game| {
                        game.start((game.chosen + 1) % game.levels.len())
                    }),
                    (said.race, |game| {
                        if let Some(last) = game.last.clone()
                            && let Err(error) = game.race(last)
                        {
                            game.notify(error.to_string());
                        }
                    }),
                ],
                [(said.save, Game::keep_replay), (said.levels, to_levels)],
            ];
            for row in rows {
                ui.horizontal(|ui| {
                    ui.add_space(0.5 * (ui.available_width() - 2.0 * 200.0 - 10.0).max(0.0));
                    for (text, act) in row {
                        if button(ui, &theme, text, vec2(200.0, small.y), Weight::Other).clicked() {
                            wanted = Some(act);
                        }
                    }
                });
                ui.add_space(6.0);
            }
        });
    });
    if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
        wanted = Some(to_levels);
    }
    if let Some(act) = wanted {
        game.blip(Menu::Confirm);
        act(game);
    }
}

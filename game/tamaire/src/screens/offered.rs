//! Screen for a level or a round that was opened from a link, to play, watch, race or change it.

use super::icons;
use super::widgets::{Act, card, column, dim_background, menu, perform};
use crate::game::{Game, credits};
use crate::look::Stage;
use app_shell::widgets::fitted;
use egui::{Rect, Sense, Stroke, StrokeKind, Ui, vec2};
use std::sync::Arc;
use tamaire_play::{Replay, ReplayError};

/// Size of the level's thumbnail [points].
const PICTURE: egui::Vec2 = vec2(300.0, 200.0);
/// Size of a button [points].
const BUTTON: egui::Vec2 = vec2(300.0, 54.0);

pub(super) fn show(game: &mut Game, stage: &mut Stage, ui: &mut Ui) {
    dim_background(ui, 130);
    let (theme, said) = (game.theme(), game.words());
    let Some((replay, level)) = game.offered.clone() else {
        return game.go_back();
    };
    let maps = stage.maps(&game.pictured(), &theme);
    let wanted = column(ui, 400.0, 0.5, |ui| {
        card(ui, &theme, |ui| {
            let line = |ui: &mut Ui, text: &str, size: f32, ink| {
                let galley = fitted(ui.painter(), text, size, BUTTON.x, ink);
                ui.label(galley);
            };
            let headline = match replay.is_some() {
                true => said.offered,
                false => game.making().level_offered,
            };
            line(ui, headline, 26.0, theme.accent);
            ui.add_space(8.0);
            let (rect, _) = ui.allocate_exact_size(PICTURE, Sense::hover());
            ui.painter().rect_filled(rect, 18.0, theme.paper);
            maps.draw(ui.painter(), rect, &level);
            let frame = Stroke::new(5.0, theme.card);
            ui.painter()
                .rect_stroke(rect.expand(2.5), 20.0, frame, StrokeKind::Middle);
            let name = game.settings.language.of(&level.game().name);
            line(ui, name, 24.0, theme.ink);
            for text in credits(&level, game.making()) {
                line(ui, &text, 17.0, theme.faint);
            }
            if let Some(replay) = &replay {
                let seconds = (said.seconds)(replay.seconds());
                let how = match replay.outcome {
                    Some(outcome) => format!("{} {seconds}", (said.route)(outcome.route)),
                    None => seconds,
                };
                if let Some(outcome) = replay.outcome {
                    let at = Rect::from_min_size(rect.left_top(), vec2(44.0, 44.0)).center();
                    icons::route(ui.painter(), &theme, at, 14.0, outcome.route, true);
                }
                line(ui, &how, 19.0, theme.faint);
            }
            ui.add_space(12.0);
            let mut options: Vec<(&str, Act)> = Vec::new();
            options.push((said.play, Game::play_offered));
            if replay.is_some() {
                options.push((said.watch, |game| take(game, Game::watch)));
                options.push((said.race, |game| take(game, Game::race)));
            }
            options.push((game.making().change_this, change));
            options.push((said.back, Game::go_back));
            menu(ui, &theme, BUTTON, &options)
        })
    });
    perform(game, ui, wanted, Game::go_back);
}

/// Opens the editor with the level of the round.
fn change(game: &mut Game) {
    if let Some((_, level)) = game.offered.take() {
        game.edit_level(&level);
    }
}

fn take(game: &mut Game, act: fn(&mut Game, Arc<Replay>) -> Result<(), ReplayError>) {
    let Some((Some(replay), _)) = game.offered.take() else {
        return;
    };
    if let Err(error) = act(game, replay) {
        game.notify((game.words().replay_error)(&error));
    }
}

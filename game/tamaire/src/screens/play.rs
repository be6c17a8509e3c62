//! Screen of a running round.

use super::{hud, offers};
use crate::game::{Game, Screen};
use crate::look::{DrawOptions, Hint, Stage, view_of_level};
use egui::Ui;

/// Draws the world of the round as the background of the current screen.
pub(super) fn world(game: &mut Game, stage: &mut Stage, ui: &mut Ui) {
    let screen = ui.max_rect();
    let level = game.bout.round().level().clone();
    let mut view = view_of_level(&game.bout.camera, screen, &level);
    // In a portrait window the result covers the lower part, so the 2D view moves up.
    let is_below = game.screen() == Screen::Result && screen.width() < screen.height();
    let duration = if game.settings.reduced_motion {
        0.0
    } else {
        0.3
    };
    let share =
        ui.ctx()
            .animate_bool_with_time(ui.scope_id().with("room below"), is_below, duration);
    view.centre[1] -= 0.1 * share * view.height();
    game.bout.view = Some(view);
    let theme = game.theme();
    // Until the first level has been won, the hint shows how to push the body into the basket, and again if
    // the player is stuck.
    let is_first = game
        .levels
        .first()
        .is_some_and(|first| first.id == level.id);
    let hint = match game.screen() {
        Screen::Play | Screen::Paused if game.bout.session.is_played() => {
            let is_new = game.records.of(&level.id).is_none();
            match is_first && (is_new || game.bout.effects.is_reminding()) {
                true => Hint::Way,
                false => Hint::Hand,
            }
        }
        _ => Hint::None,
    };
    let look = DrawOptions {
        view,
        theme: &theme,
        elements: game.bout.elements,
        cut_share: game
            .bout
            .opening
            .share(game.time, game.settings.reduced_motion),
        effects: &game.bout.effects,
        time: game.time,
        ghost: game.bout.session.ghost(),
        hint,
        reduced_motion: game.settings.reduced_motion,
        resolution: game.quality().resolution(),
    };
    stage.draw(ui, game.bout.round(), &look);
}

/// Shows the overlay of a round.
pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    let is_on_button = hud::show(game, ui);
    offers::show(game, ui);
    if game.bout.session.is_played() && !is_on_button {
        // The pointer stays visible until it has picked up the hand.
        ui.ctx()
            .set_cursor_icon(match game.controls.players.is_picked_up(0) {
                true => egui::CursorIcon::None,
                false => egui::CursorIcon::Grab,
            });
    }
    let is_seen = game.bout.round().progress().outcome.is_none() || game.bout.has_cheered();
    if !game.bout.session.is_played() && game.bout.session.is_over() && is_seen {
        game.leave_round();
    }
}

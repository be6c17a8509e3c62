//! Screen of a running round.

use super::{hopeless, hud, offers, toys, watching};
use crate::game::{Game, Screen};
use crate::look::{DrawOptions, Hint, Stage, view_of_level};
use app_shell::View;
use egui::{Id, Rect, Ui, Vec2, vec2};
use fuwafuwa::Vec3;

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
    let view = beside_cards(game, ui, view, duration);
    let view = above_toys(game, ui, view);
    let view = match game.screen() {
        Screen::Editor | Screen::Properties => {
            let part = match game.screen() {
                Screen::Editor => super::editor::room(game, ui),
                _ => super::editor::beside_properties(screen),
            };
            let fitted = view_of_level(&game.bout.camera, part, &level);
            // In 3D the height alone decides about the scale of a view.
            let narrow = match view.space.is_some() {
                true => part.width() / screen.width(),
                false => 1.0,
            };
            view.shrunk((fitted.scale / view.scale).min(narrow))
                .displaced(part.center() - screen.center())
        }
        _ => view,
    };
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
            let is_new = game.records.of_level(&level).is_none();
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
        calm: game.settings.calm,
        reduced_motion: game.settings.reduced_motion,
        resolution: game.quality().resolution(),
    };
    stage.draw(ui, game.bout.round(), &look);
}

/// Width of the room that the winner needs beside the basket, on both sides together [m].
const AROUND_BASKET: f32 = 0.2;
/// Least scale of the view beside the cards of a result, relative to the usual one.
const LEAST_SCALE: f32 = 0.6;

/// Notes the part of the screen that the cards of a result leave free at a stand. From the next frame on, the
/// basket is shown in its middle, so that no card covers the winner.
#[cfg(not(target_family = "wasm"))] // Browsers have no stands.
pub(super) fn note_free_part(ui: &Ui, free: Rect) {
    ui.data_mut(|data| data.insert_temp(free_part(), free));
}

fn free_part() -> Id {
    Id::unique("free part of the screen")
}

/// Returns the view with the basket in the middle of the part of the screen that a result leaves free, if that
/// part is known. The view moves there within `duration` [s].
fn beside_cards(game: &Game, ui: &Ui, view: View, duration: f32) -> View {
    let free: Option<Rect> = ui.data(|data| data.get_temp(free_part()));
    let is_result = game.screen() == Screen::Result;
    let basket = game
        .bout
        .round()
        .level()
        .game()
        .all_baskets()
        .into_iter()
        .next();
    let shown = free.zip(basket).filter(|_| is_result);
    let shown = shown.as_ref();
    // The basket with the parts of the winner that stick out of it.
    let share = shown.map_or(1.0, |(free, basket)| {
        let wide = 2.0 * basket.half[0] + AROUND_BASKET;
        (free.width() / (wide * view.scale)).clamp(LEAST_SCALE, 1.0)
    });
    let id = |axis: &str| ui.scope_id().with(("beside cards", axis));
    let ctx = ui.ctx();
    let duration = if is_result { duration } else { 0.0 };
    let share = ctx.animate_value_with_time(id("share"), share, duration);
    let view = view.shrunk(share);
    let way = shown.map_or(Vec2::ZERO, |(free, basket)| {
        free.center() - view.to_screen(Vec3::from(basket.centre))
    });
    view.displaced(vec2(
        ctx.animate_value_with_time(id("x"), way.x, duration),
        ctx.animate_value_with_time(id("y"), way.y, duration),
    ))
}

/// Returns the view of a 2D playground with the whole room above the tools.
fn above_toys(game: &Game, ui: &Ui, view: View) -> View {
    let shares_screen = matches!(game.screen(), Screen::Play | Screen::Paused);
    if view.space.is_some() || !shares_screen {
        return view;
    }
    let (taken, screen) = (toys::height(game, ui), ui.max_rect());
    let share = 1.0 - taken / screen.height();
    view.shrunk(share).displaced(vec2(0.0, -0.5 * taken))
}

/// Covers the room with a pale veil while time runs back, with rings that close in on the hand.
fn veil(game: &Game, ui: &Ui) {
    let violet = egui::Color32::from_rgb(150, 120, 220);
    let (painter, screen) = (ui.painter(), ui.max_rect());
    painter.rect_filled(screen, 0.0, violet.gamma_multiply(0.16));
    let Some(view) = game.bout.view.filter(|_| !game.settings.reduced_motion) else {
        return;
    };
    let middle = view.to_screen(game.bout.round().hands()[0].position);
    let longest = 0.5 * screen.width();
    for ring in 0..4 {
        let share = 1.0 - (0.6 * game.time + 0.25 * f64::from(ring)).fract() as f32;
        let ink = violet.gamma_multiply(0.5 * (1.0 - share));
        painter.circle_stroke(middle, longest * share, egui::Stroke::new(4.0, ink));
    }
}

/// Shows the overlay of a round.
pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    if game.bout.session.is_rewinding() {
        veil(game, ui);
    }
    let mut is_on_button = hud::show(game, ui);
    is_on_button |= hopeless::show(game, ui);
    is_on_button |= toys::show(game, ui);
    offers::show(game, ui);
    watching::show(game, ui);
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

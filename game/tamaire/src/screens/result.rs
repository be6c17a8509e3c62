//! Result of a round, with a challenge to try the other route.

use super::icons;
use super::widgets::{Act, card, column_beside, column_part, dim_background, perform};
use crate::game::{Game, Screen};
use crate::words::Words;
use app_shell::Theme;
use app_shell::widgets::{ButtonStyle, button, fitted};
use egui::{Align, FontId, Layout, Rect, Role, Sense, Ui, Vec2, WidgetInfo, pos2, vec2};
use std::sync::Arc;
use tamaire_play::{Level, Outcome, Route, Wish};

/// Width of the card [points].
const WIDE: f32 = 490.0;
/// Height of the smaller buttons [points].
const SMALL: f32 = 46.0;
/// Font size of the labels of the figures [points]; smaller where a label would not fit.
const LABEL: f32 = 18.0;
/// Gap between buttons [points].
const GAP: f32 = 10.0;

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    dim_background(ui, 40);
    let Some((outcome, is_best)) = game.bout.won else {
        game.go(Screen::Play);
        return;
    };
    let (theme, said) = (game.theme(), game.words());
    let level = game.bout.round().level().clone();
    let across = across(&level);
    let wanted = column_beside(ui, WIDE, (across, false), |ui| {
        card(ui, &theme, |ui| {
            ui.spacing_mut().item_spacing = Vec2::ZERO;
            headline(ui, &theme, said, &outcome);
            if is_best && !outcome.is_by_itself() {
                let best = format!("★ {}", said.new_best);
                line(ui, &best, 21.0, theme.good);
            }
            if game.bout.round().rewinds() > 0 {
                line(ui, said.rewound, 18.0, theme.faint);
            }
            ui.add_space(8.0);
            numbers(ui, &theme, said, &outcome);
            ui.add_space(8.0);
            match help_of(&level, said) {
                // Stars of a level that wins by itself say nothing about a route.
                None if outcome.is_by_itself() => {}
                None => wishes(ui, &theme, said, &outcome, &level.game().wish),
                Some(help) => {
                    line(ui, &help, 20.0, theme.faint);
                    ui.add_space(GAP);
                }
            }
            ui.add_space(8.0);
            if let Some(route) = beaten_route(&level, &outcome) {
                line(ui, (said.other_way)(route), 23.0, theme.accent);
                ui.add_space(GAP);
            }
            let wishes = &level.game().wish;
            let is_reached = wishes.iter().all(|wish| outcome.fulfils(wish));
            let editor = game.is_test().then_some(game.making().to_editor);
            buttons(ui, &theme, said, (is_reached, editor), game.may_show_way())
        })
    });
    perform(game, ui, wanted, to_levels);
}

/// Returns the horizontal position of the card, which is on the side away from the basket, so that the happy
/// body stays visible.
fn across(level: &Level) -> f32 {
    let baskets = level.game().all_baskets();
    let is_right = baskets.first().is_some_and(|basket| basket.centre[0] > 0.0);
    if is_right { 0.05 } else { 0.95 }
}

/// Returns the part of the screen beside the card. In a portrait window, the whole screen: its upper part is free.
pub(super) fn free_part(game: &Game, screen: Rect) -> Rect {
    if screen.width() < screen.height() {
        return screen;
    }
    let card = column_part(screen, WIDE, across(game.bout.round().level()));
    match card.center().x < screen.center().x {
        true => screen.with_min_x(card.right()),
        false => screen.with_max_x(card.left()),
    }
}

/// Returns the assists of the level as text, if there are any.
fn help_of(level: &Level, said: &Words) -> Option<String> {
    let assists = level.game().assists.iter();
    let names: Vec<&str> = assists.map(|&assist| (said.assist)(assist)).collect();
    (!names.is_empty()).then(|| format!("{}: {}", said.assisted, names.join(", ")))
}

/// Returns the route of a win after which the other one is suggested. `None` if the level has only one, or wins by itself.
pub(super) fn beaten_route(level: &Level, outcome: &Outcome) -> Option<Route> {
    let has_other = level.routes().contains(&other(outcome.route));
    (has_other && !outcome.is_by_itself()).then_some(outcome.route)
}

/// Returns the route that is suggested after a win by `route`.
pub(super) fn other(route: Route) -> Route {
    match route {
        Route::Squeeze => Route::Shave,
        Route::Shave | Route::Mix => Route::Squeeze,
    }
}

/// Shows icon and name of the route, or that the level has won by itself.
pub(super) fn headline(ui: &mut Ui, theme: &Theme, said: &Words, outcome: &Outcome) {
    const SIGN: f32 = 64.0;
    if outcome.is_by_itself() {
        return line(ui, said.won_by_itself, 44.0, theme.accent);
    }
    let route = outcome.route;
    let room = vec2(ui.available_width(), 58.0);
    let (rect, response) = ui.allocate_exact_size(room, Sense::hover());
    let name = (said.route)(route);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, name));
    let galley = fitted(ui.painter(), name, 44.0, room.x - SIGN, theme.accent);
    let left = rect.center().x - 0.5 * (SIGN + galley.size().x);
    let middle = pos2(left + 0.4 * SIGN, rect.center().y);
    icons::route(ui.painter(), theme, middle, 22.0, route, true);
    let at = pos2(left + SIGN, middle.y - 0.5 * galley.size().y);
    ui.painter().galley(at, galley, theme.accent);
}

/// Shows a line of text, shrunk to the available width.
pub(super) fn line(ui: &mut Ui, text: &str, size: f32, ink: egui::Color32) {
    let galley = fitted(ui.painter(), text, size, ui.available_width(), ink);
    ui.label(galley);
}

/// Shows the figures of a round side by side.
pub(super) fn numbers(ui: &mut Ui, theme: &Theme, said: &Words, outcome: &Outcome) {
    let summary = (said.summary)(outcome);
    ui.spacing_mut().item_spacing.x = GAP;
    ui.columns(summary.len(), |columns| {
        // All labels have the size at which the longest one fits.
        let labels = { columns.iter().zip(&summary) }.map(|(column, (name, _))| {
            let font = FontId::proportional(LABEL);
            let galley = { column.painter() }.layout_no_wrap(name.to_string(), font, theme.faint);
            LABEL * (column.available_width() / galley.size().x).min(1.0)
        });
        let size = labels.fold(LABEL, f32::min);
        for (column, (name, value)) in columns.iter_mut().zip(summary) {
            column.spacing_mut().item_spacing = Vec2::ZERO;
            column.vertical_centered(|ui| {
                line(ui, &value, 29.0, theme.ink);
                line(ui, name, size, theme.faint);
            });
        }
    });
}

/// Shows the goals of the level, with a filled star for each one reached and the figure that missed one.
fn wishes(ui: &mut Ui, theme: &Theme, said: &Words, outcome: &Outcome, wishes: &[Wish]) {
    let most = ui.available_width();
    let lines = wishes.iter().map(|wish| {
        let (star, ink) = match outcome.fulfils(wish) {
            true => ("★", theme.ink),
            false => ("☆", theme.faint),
        };
        let missed = (said.near_miss)(wish, outcome);
        let found = missed.map_or(String::new(), |found| format!("  ({found})"));
        let text = format!("{star} {}{found}", (said.wish)(wish));
        (fitted(ui.painter(), &text, 20.0, most, ink), ink)
    });
    let lines: Vec<_> = lines.collect();
    let width = lines.iter().map(|(galley, _)| galley.size().x);
    let width = width.fold(0.0, f32::max);
    for (galley, ink) in lines {
        let (rect, response) = ui.allocate_exact_size(vec2(width, 28.0), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, galley.text()));
        let at = rect.left_center() - vec2(0.0, 0.5 * galley.size().y);
        ui.painter().galley(at, galley, ink);
    }
}

/// Shows the buttons of the result and returns the chosen action. The main button leads to the next level if
/// all goals of the current level are reached; otherwise it restarts the level. After a test of a level, it leads to the
/// editor, whose button has the text `editor`.
fn buttons(
    ui: &mut Ui,
    theme: &Theme,
    said: &Words,
    (is_reached, editor): (bool, Option<&str>),
    can_show: bool,
) -> Option<Act> {
    let mut wanted: Option<Act> = None;
    let width = (2.0 * 200.0 + GAP).min(ui.available_width());
    let again: (&str, Act) = (said.play_again, Game::retry);
    let next: (&str, Act) = match editor {
        Some(text) => (text, Game::end_test),
        None => (said.next, Game::start_next),
    };
    let is_reached = is_reached || editor.is_some();
    let (main, other) = if is_reached {
        (next, again)
    } else {
        (again, next)
    };
    let response = button(ui, theme, main.0, vec2(width, 60.0), ButtonStyle::Main);
    super::widgets::focus_first(ui, &response);
    if response.clicked() {
        wanted = Some(main.1);
    }
    let mut first = vec![other, (said.race, race)];
    if can_show {
        first.push((said.show_way, Game::show_way));
    }
    let rows: [&[(&str, Act)]; 3] = [
        &first,
        &[(said.save, Game::keep_replay), (said.link, Game::copy_link)],
        &[
            (said.photo, Game::keep_photo),
            (said.clip, Game::keep_clip),
            (said.levels, to_levels),
        ],
    ];
    for row in rows {
        ui.add_space(GAP + 2.0);
        let size = vec2(width, SMALL);
        ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Min), |ui| {
            ui.spacing_mut().item_spacing.x = GAP;
            let count = row.len() as f32;
            let size = vec2((width - (count - 1.0) * GAP) / count, SMALL);
            for &(text, act) in row {
                if button(ui, theme, text, size, ButtonStyle::Other).clicked() {
                    wanted = Some(act);
                }
            }
        });
    }
    wanted
}

fn race(game: &mut Game) {
    let last = Arc::new(game.bout.round().replay());
    if let Err(error) = game.race(last) {
        game.notify((game.words().replay_error)(&error));
    }
}

fn to_levels(game: &mut Game) {
    game.go(Screen::Levels);
}

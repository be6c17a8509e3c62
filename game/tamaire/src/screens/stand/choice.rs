//! Choice of a level at the stand.

use super::super::levels::{BELOW, LEGEND, grid, legend, tile};
use super::super::widgets::{dim_background, focus_first, page};
use super::language::above;
use crate::exhibit::Stand;
use crate::game::Game;
use crate::look::Stage;
use app_shell::widgets::fitted;
use egui::{Rect, Ui, pos2, vec2};
use tamaire_sound::Menu;

const GAP: f32 = 28.0;
/// Maximum width of a tile [points].
const WIDE: f32 = 360.0;
/// Approximate width of a tile in rows [points].
const NARROW: f32 = 260.0;

/// Maximum number of levels that are shown side by side. More are shown in rows.
const MOST_ACROSS: usize = 3;

pub(super) fn show(stand: &mut Stand, game: &mut Game, stage: &mut Stage, ui: &mut Ui) {
    dim_background(ui, 255);
    let chosen = match game.levels.len() <= MOST_ACROSS {
        true => side_by_side(game, stage, ui),
        false => in_rows(game, stage, ui),
    };
    if let Some(index) = chosen.filter(|_| stand.is_settled()) {
        game.blip(Menu::Confirm);
        stand.choose(game, index);
    }
}

/// Shows the levels in rows. Returns the chosen one.
fn in_rows(game: &Game, stage: &mut Stage, ui: &mut Ui) -> Option<usize> {
    let theme = game.theme();
    let maps = stage.maps(&game.pictured(), &theme);
    let mut chosen = None;
    let area = egui::UiBuilder::new().max_rect(above(ui.max_rect()).shrink(GAP));
    ui.scope_builder(area, |ui| {
        let text = game.settings.language.at_stand().which;
        let text = egui::RichText::new(text).size(44.0).color(theme.ink);
        ui.vertical_centered(|ui| ui.label(text));
        page(ui, "choice", f32::INFINITY, |ui| {
            ui.spacing_mut().item_spacing = vec2(GAP, GAP);
            let (columns, size) = grid(ui.available_width(), NARROW, GAP);
            let all: Vec<usize> = (0..game.levels.len()).collect();
            for row in all.chunks(columns) {
                ui.horizontal_top(|ui| {
                    for &index in row {
                        let response = tile(ui, game, maps, index, size);
                        if index == 0 {
                            focus_first(ui, &response);
                        }
                        if response.clicked() {
                            chosen = Some(index);
                        }
                    }
                });
            }
            legend(ui, game);
        });
    });
    chosen
}

/// Shows the levels side by side, and one below the other in a portrait window. Returns the chosen one.
fn side_by_side(game: &Game, stage: &mut Stage, ui: &mut Ui) -> Option<usize> {
    let (theme, screen) = (game.theme(), above(ui.max_rect()));
    let text = game.settings.language.at_stand().which;
    let headline = fitted(
        ui.painter(),
        text,
        52.0,
        screen.width() - 2.0 * GAP,
        theme.ink,
    );
    let count = game.levels.len() as f32;
    let is_tall = screen.width() < screen.height();
    let (across, down) = if is_tall { (1.0, count) } else { (count, 1.0) };
    let room = vec2(
        screen.width(),
        screen.height() - headline.size().y - LEGEND - 5.0 * GAP,
    );
    let wide = ((room.x - GAP) / across - GAP).min(WIDE);
    let high = (room.y / down - GAP - BELOW).max(40.0) / 0.62 + 20.0;
    let wide = wide.min(high);
    let size = vec2(wide, 0.62 * (wide - 20.0) + BELOW);
    let all = vec2(across * (size.x + GAP) - GAP, down * (size.y + GAP) - GAP);
    let middle = screen.center() + vec2(0.0, 0.5 * (headline.size().y - LEGEND - GAP));
    let top = middle.y - 0.5 * all.y - GAP - headline.size().y;
    let at = pos2(screen.center().x - 0.5 * headline.size().x, top);
    ui.painter().galley(at, headline, theme.ink);
    let corner = middle - 0.5 * all;
    let maps = stage.maps(&game.pictured(), &theme);
    let mut chosen = None;
    for index in 0..game.levels.len() {
        let step = index as f32 * (size + vec2(GAP, GAP));
        let step = if is_tall {
            vec2(0.0, step.y)
        } else {
            vec2(step.x, 0.0)
        };
        let place = egui::UiBuilder::new().max_rect(Rect::from_min_size(corner + step, size));
        let response = ui
            .scope_builder(place, |ui| tile(ui, game, maps, index, size))
            .inner;
        if index == 0 {
            focus_first(ui, &response);
        }
        if response.clicked() {
            chosen = Some(index);
        }
    }
    let below = Rect::from_min_max(
        pos2(screen.left() + GAP, corner.y + all.y + GAP),
        pos2(screen.right() - GAP, screen.bottom()),
    );
    ui.scope_builder(egui::UiBuilder::new().max_rect(below), |ui| {
        legend(ui, game);
    });
    chosen
}

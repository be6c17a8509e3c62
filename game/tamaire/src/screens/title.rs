//! Title screen over a round that plays by itself.

use super::widgets::{column_beside, column_part, dim_background, words};
use crate::game::{Game, Screen};
use crate::words::Language;
use app_shell::theme::DIMMED;
use app_shell::widgets::{ButtonStyle, button};
use egui::{Color32, Pos2, Rect, Sense, Stroke, Ui, vec2};
use fuwafuwa::{DimVector, Vec3};
use tamaire_play::AnyRound;
use tamaire_sound::Menu;

/// Horizontal position of the menu, 0 (left) to 1 (right). The menu is on the left, so that the basket stays
/// visible.
const ACROSS: f32 = 0.14;
/// Width of the menu [points].
const WIDE: f32 = 340.0;

/// Width of a portrait window in which the title leaves no room for the language button above it [points].
const NARROW: f32 = 480.0;

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    dim_background(ui, DIMMED);
    let (theme, said) = (game.theme(), game.words());
    let bob = if game.settings.reduced_motion {
        0.0
    } else {
        6.0 * (1.6 * game.time).sin() as f32
    };
    let mut wanted = None;
    column_beside(ui, WIDE, (ACROSS, true), |ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(WIDE, 190.0), Sense::hover());
        let top = rect.center_top() + vec2(0.0, 66.0 + bob);
        draw_name(game, ui, top, 104.0);
        let options = [
            (said.play, Screen::Levels),
            (game.making().draw, Screen::Paper),
            (said.two_players, Screen::Together),
            (said.replays, Screen::Replays),
            (said.settings, Screen::Settings),
        ];
        for (index, (text, screen)) in options.into_iter().enumerate() {
            let (weight, size) = match index {
                0 => (ButtonStyle::Main, vec2(280.0, 68.0)),
                _ => (ButtonStyle::Other, vec2(280.0, 56.0)),
            };
            ui.add_space(8.0);
            let response = button(ui, &theme, text, size, weight);
            if index == 0 {
                super::widgets::focus_first(ui, &response);
            }
            if response.clicked() {
                wanted = Some(screen);
            }
        }
        ui.add_space(8.0);
        if !cfg!(target_family = "wasm")
            && button(ui, &theme, said.quit, vec2(280.0, 48.0), ButtonStyle::Other).clicked()
        {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
        ui.add_space(10.0);
    });
    draw_hands(game, ui);
    switch_language(game, ui);
    if let Some(screen) = wanted {
        game.blip(Menu::Confirm);
        match screen {
            Screen::Paper => game.open_paper(),
            screen => game.go(screen),
        }
    }
}

/// Draws the name of the game, with the middle of its large letters at `middle`. `size` is their height [points].
/// Over the frame of a 2D room, which is darker than its floor, the name has a pale ground.
pub(super) fn draw_name(game: &Game, ui: &Ui, middle: Pos2, size: f32) {
    let theme = game.theme();
    let place = Rect::from_center_size(middle + vec2(0.0, 0.26 * size), size * vec2(3.4, 1.75));
    if !is_over_floor(game, place) {
        let pale = theme.card.gamma_multiply(0.8);
        ui.painter().rect_filled(place, 0.4 * size, pale);
    }
    for (by, colour) in [(5.0, Color32::from_black_alpha(40)), (0.0, theme.accent)] {
        words(ui, middle + vec2(0.0, by), "玉入れ", size, colour);
    }
    let below = middle + vec2(0.0, 0.74 * size);
    words(ui, below, "tamaire", 0.33 * size, theme.ink);
}

/// Whether a part of the screen shows the floor and the walls of the room only.
fn is_over_floor(game: &Game, place: Rect) -> bool {
    let Some(view) = game.bout.view.filter(|view| view.space.is_none()) else {
        return true;
    };
    let [low, high] = game.bout.round().level().arena();
    Rect::from_two_pos(view.to_screen(low), view.to_screen(high)).contains_rect(place)
}

/// Draws the hands of the recorded round over the menu, translucently, so that the menu does not hide them.
fn draw_hands(game: &Game, ui: &Ui) {
    let Some(view) = game.bout.view else {
        return;
    };
    let hands: Vec<(Vec3, f32)> = match game.bout.round() {
        AnyRound::Plane(round) => { round.hands() }
            .map(|hand| (hand.position().to_vec3(), hand.shape().inradius()))
            .collect(),
        AnyRound::Space(round) => { round.hands() }
            .map(|hand| (hand.position(), hand.shape().inradius()))
            .collect(),
    };
    let menu = column_part(ui.max_rect(), WIDE, ACROSS);
    let theme = game.theme();
    for (player, (at, radius)) in hands.into_iter().enumerate() {
        let middle = view.to_screen(at);
        if !menu.contains(middle) {
            continue;
        }
        let radius = radius * view.scale_at(at);
        let fill = theme.hand(player).gamma_multiply(0.7);
        let rim = Stroke::new(0.1 * radius, theme.card.gamma_multiply(0.8));
        ui.painter().circle(middle, radius, fill, rim);
    }
}

/// Shows a button in the upper right corner that switches to another language. Its text is that language's
/// own name.
fn switch_language(game: &mut Game, ui: &mut Ui) {
    let size = vec2(128.0, 40.0);
    let corner = ui.max_rect().right_top();
    // In a portrait window the title is below the language button, so the button is nearer to the corner.
    let is_upright = ui.max_rect().width() < ui.max_rect().height();
    let inwards = if is_upright {
        vec2(-16.0, 14.0)
    } else {
        vec2(-72.0, 52.0)
    };
    let mut at = corner + inwards - vec2(size.x, 0.0);
    if is_upright && ui.max_rect().width() < NARROW {
        // With large texts, the title reaches up to the corner.
        at.y = ui.max_rect().bottom() - 14.0 - size.y;
    }
    let rect = Rect::from_min_size(at, size);
    let theme = game.theme();
    let spoken = game.settings.language;
    let others = Language::ALL.into_iter();
    for (language, name) in others.filter(|&(language, _)| language != spoken) {
        ui.scope_builder(egui::UiBuilder::new().max_rect(rect), |ui| {
            if button(ui, &theme, name, size, ButtonStyle::Other).clicked() {
                game.settings.language = language;
                game.keep_settings();
                game.blip(Menu::Confirm);
            }
        });
    }
}

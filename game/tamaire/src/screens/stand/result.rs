//! Result of a round at the stand: play again, try the other route, and a code to take the round home.

use super::super::code;
use super::super::play;
use super::super::result::{beaten_route, headline, line, numbers, other};
use super::super::widgets::{card, column_beside, dim_background, focus_first};
use super::language::above;
use crate::exhibit::Stand;
use crate::game::{Game, Screen};
use crate::qr::Code;
use app_shell::widgets::{ButtonStyle, button, fitted};
use egui::{Rect, Ui, UiBuilder, Vec2, pos2, vec2};
use tamaire_play::Route;
use tamaire_sound::Menu;

/// Width of the card [points].
const WIDE: f32 = 410.0;
/// Gap between texts and buttons of the card [points].
const GAP: f32 = 12.0;
/// Distance of the QR code from the edge of the screen [points].
const EDGE: f32 = 12.0;
/// Maximum side length of the QR code [points].
const CODE: f32 = 360.0;

/// Action that a visitor has chosen.
#[derive(Copy, Clone)]
enum ResultAction {
    Again(Option<Route>),
    Another,
}

pub(super) fn show(stand: &mut Stand, game: &mut Game, ui: &mut Ui) {
    dim_background(ui, 40);
    let Some((outcome, _)) = game.bout.won else {
        game.go(Screen::Play);
        return;
    };
    let (theme, said) = (game.theme(), game.words());
    let level = game.bout.round().level().clone();
    let dared = beaten_route(&level, &outcome);
    let has_others = stand.config.levels.0.len() > 1;
    let area = UiBuilder::new().max_rect(above(ui.max_rect()));
    let show = |ui: &mut Ui| {
        column_beside(ui, WIDE, (0.0, false), |ui| {
            let wish = card(ui, &theme, |ui| {
                ui.spacing_mut().item_spacing = Vec2::ZERO;
                headline(ui, &theme, said, &outcome);
                ui.add_space(GAP);
                numbers(ui, &theme, said, &outcome);
                ui.add_space(2.0 * GAP);
                let size = vec2(ui.available_width(), 64.0);
                let mut wish = None;
                if let Some(route) = dared {
                    line(ui, (said.other_way)(route), 25.0, theme.accent);
                    ui.add_space(GAP);
                }
                let again = button(ui, &theme, said.play_again, size, ButtonStyle::Main);
                focus_first(ui, &again);
                if again.clicked() {
                    wish = Some(ResultAction::Again(dared.map(other)));
                }
                if has_others {
                    ui.add_space(GAP);
                    let text = game.settings.language.at_stand().another;
                    if button(ui, &theme, text, size - vec2(0.0, 12.0), ButtonStyle::Other)
                        .clicked()
                    {
                        wish = Some(ResultAction::Another);
                    }
                }
                wish
            });
            (wish, ui.min_rect())
        })
    };
    let (wish, card_rect) = ui.scope_builder(area, show).inner;
    let screen = ui.max_rect();
    let most = most_of_code(screen);
    let place = place_of_code(screen, most);
    let code = stand.coming_code().map(|_| place);
    play::note_free_part(ui, between(screen, code, card_rect));
    if let Some(home) = stand.to_take_home() {
        ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
            to_take_home(ui, game, home, most)
        });
    }
    if let Some(wish) = wish.filter(|_| stand.is_settled()) {
        game.blip(Menu::Confirm);
        match wish {
            ResultAction::Again(route) => stand.try_again(game, route),
            ResultAction::Another => stand.choose_again(game),
        }
    }
}

/// Minimum width of a module of a code [px]; phones cannot read smaller ones from a screen.
const LEAST: f32 = 3.0;

/// Shows a code on a card with its purpose. `most` is the maximum side length [points].
fn to_take_home(ui: &mut Ui, game: &Game, home: &Code, most: f32) {
    if code::pixels(ui, home, most) < LEAST {
        return;
    }
    let (theme, said) = (game.theme(), game.settings.language.at_stand());
    card(ui, &theme, |ui| {
        ui.spacing_mut().item_spacing.y = 6.0;
        ui.vertical_centered(|ui| {
            ui.set_max_width(most);
            let headline = fitted(ui.painter(), said.take_home, 27.0, most, theme.accent);
            ui.label(headline);
            code::draw(ui, home, most);
            let how = fitted(ui.painter(), said.scan, 20.0, most, theme.faint);
            ui.label(how);
        });
    });
}

/// Returns the maximum side length of the QR code [points].
fn most_of_code(screen: Rect) -> f32 {
    let is_upright = screen.width() < screen.height();
    CODE.min(if is_upright { 0.6 } else { 0.3 } * screen.width())
}

/// Returns the part of the screen between the card of the result and the QR code, if there is one.
fn between(screen: Rect, code: Option<Rect>, card: Rect) -> Rect {
    match screen.width() < screen.height() {
        true => screen
            .with_min_y(code.map_or(screen.top(), |code| code.bottom()))
            .with_max_y(card.top()),
        false => screen
            .with_min_x(card.right())
            .with_max_x(code.map_or(screen.right(), |code| code.left())),
    }
}

/// Returns the area of the QR code: on the right, or at the top of a portrait window.
fn place_of_code(screen: Rect, side: f32) -> Rect {
    // The card adds a margin and two lines of text.
    let size = vec2(side + 40.0, side + 130.0);
    let at = match screen.width() < screen.height() {
        true => pos2(screen.center().x - 0.5 * size.x, screen.top() + 20.0),
        false => pos2(
            screen.right() - size.x - EDGE,
            screen.center().y - 0.5 * size.y,
        ),
    };
    Rect::from_min_size(at, size)
}

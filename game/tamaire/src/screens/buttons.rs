//! Circular on-screen buttons during play. All players get pause and restart; touch screens also get the
//! actions that keys and pads have buttons for.

use super::icons;
use super::toys;
use crate::game::{Game, ScreenButton};
use crate::input::{Action, InputMethod};
use app_shell::Theme;
use app_shell::widgets::note_hovered;
use egui::{Color32, Painter, Pos2, Rect, Role, Sense, Ui, WidgetInfo, pos2, vec2};
use tamaire_play::AnyRound;

/// Function that draws an icon at a position, with a scale and a colour.
type Icon = fn(&Painter, Pos2, f32, Color32);

/// Height of the upper row [points].
pub(super) const HIGH: f32 = 44.0;
/// Gap between buttons and labels of a row [points].
pub(super) const GAP: f32 = 8.0;
/// Distance of buttons from the edge of the window [points].
pub(super) const EDGE: f32 = 15.0;
/// Side length of a thumb button, a large button in the lower right corner [points].
const THUMB: f32 = 68.0;

/// Shows a row of buttons from `corner` to the right, and the thumb buttons in the lower right corner.
/// Returns the right end of the row and whether the mouse is over a button.
pub(super) fn show(game: &mut Game, ui: &Ui, corner: Pos2, scale: f32) -> (f32, bool) {
    let said = game.words();
    let mut row: Vec<(Action, &str, Icon)> = Vec::new();
    if game.public.is_none() {
        row.push((Action::Pause, said.paused, icons::pause));
    }
    row.push((Action::Retry, said.again, icons::again));
    let is_on = game.bout.session.is_played() && game.bout.round().progress().outcome.is_none();
    if is_on && game.may_rewind() {
        let name = (said.action)(Action::Rewind);
        row.push((Action::Rewind, name, icons::rewind));
    }
    if game.is_test() || game.is_with_drawing() {
        row.push((Action::Make, (said.action)(Action::Make), icons::pencil));
    }
    let mut thumb: Vec<(Action, &str, Icon)> = Vec::new();
    if game.controls.means == InputMethod::Fingers && game.bout.session.is_played() {
        let name = |action| (said.action)(action);
        row.push((Action::Elements, name(Action::Elements), icons::elements));
        if game.public.is_none() {
            row.push((Action::Slow, name(Action::Slow), icons::slow));
        }
        match game.bout.round() {
            // Not in 3D: there, a second finger raises the first player's hand.
            AnyRound::Plane(_) if game.takes_two() => {
                row.push((Action::Join, name(Action::Join), icons::two));
            }
            AnyRound::Plane(_) => {}
            AnyRound::Space(_) => {
                let ways = match game.bout.elements {
                    None => [Action::Raise, Action::Lower],
                    Some(_) => [Action::Deeper, Action::Shallower],
                };
                thumb.push((ways[0], name(ways[0]), icons::up));
                thumb.push((ways[1], name(ways[1]), icons::down));
            }
        }
    }
    let side = scale * HIGH;
    let step = vec2(side + scale * GAP, 0.0);
    let in_row = |index: usize| Rect::from_min_size(corner + index as f32 * step, vec2(side, side));
    let end = in_row(row.len()).left();
    let above = vec2(0.0, toys::height(game, ui));
    let last = ui.max_rect().right_bottom() - scale * vec2(EDGE + THUMB, EDGE + THUMB) - above;
    let count = thumb.len();
    let in_corner = |index: usize| {
        let up = scale * (THUMB + 2.0 * GAP) * (count - 1 - index) as f32;
        Rect::from_min_size(pos2(last.x, last.y - up), scale * vec2(THUMB, THUMB))
    };
    let row = row.into_iter().enumerate();
    let thumb = thumb.into_iter().enumerate();
    let all: Vec<_> = row
        .map(|(index, button)| (in_row(index), button))
        .chain(thumb.map(|(index, button)| (in_corner(index), button)))
        .collect();
    let mut is_on_button = false;
    game.controls.buttons.clear();
    game.bout.is_rewind_pressed = false;
    for (rect, (action, name, icon)) in all {
        let button = ScreenButton { action, rect };
        game.controls.buttons.push(button);
        is_on_button |= one(game, ui, button, name, icon);
    }
    (end, is_on_button)
}

/// Shows a button; returns whether the mouse is over it.
fn one(game: &mut Game, ui: &Ui, button: ScreenButton, name: &str, icon: Icon) -> bool {
    let (theme, rect) = (game.theme(), button.rect);
    // The button cannot get the keyboard focus, since its action has a key.
    let response = ui.interact(rect, egui::Id::unique(name), Sense::CLICK);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    note_hovered(ui, &response);
    let is_held = game.controls.devices.pressed.contains(&button.action);
    let fill = match is_held || response.hovered() {
        true => theme.card,
        false => pale(&theme),
    };
    let (middle, radius) = (rect.center(), 0.5 * rect.width());
    ui.painter().circle_filled(middle, radius, fill);
    icon(ui.painter(), middle, rect.width() / HIGH, theme.ink);
    if button.action == Action::Rewind {
        game.bout.is_rewind_pressed = response.is_pointer_button_down_on();
    } else if response.clicked() {
        game.act(button.action, button.seat());
    }
    response.hovered()
}

/// Colour of the translucent background of buttons and labels over a round.
pub(super) fn pale(theme: &Theme) -> Color32 {
    theme.card.gamma_multiply(0.72)
}

//! Screen on which players make and change levels.

mod canvas;
mod finish;
mod properties;
mod shelf;
mod signs;

pub(super) use finish::{focus_name, show as finish};
pub(super) use properties::{beside_properties, show as properties};

use super::hud;
use super::making::{step_button, step_keys};
use crate::game::{Game, Screen};
use app_shell::widgets::{ButtonStyle, button, fitted};
use egui::{Key, Modifiers, Rect, Ui, UiBuilder, Vec2, pos2, vec2};
use tamaire_sound::Menu;

/// Margin around the parts of the screen [points].
const EDGE: f32 = 10.0;
/// Height of the row of buttons at the top [points].
const TOP: f32 = 46.0;
/// Gap between buttons [points].
const GAP: f32 = 8.0;

/// Returns the part of the screen in which the room is shown.
pub(super) fn room(game: &Game, ui: &Ui) -> Rect {
    let (screen, scale) = (ui.max_rect(), hud::full_scale(game, ui));
    screen
        .with_min_y(screen.top() + scale * TOP + 2.0 * EDGE)
        .with_max_y(screen.bottom() - shelf::height(screen, scale))
}

pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    let (screen, room) = (ui.max_rect(), room(game, ui));
    // While keys hold a thing, Escape lets it go.
    let has_focus = ui.memory(|memory| memory.focused().is_some());
    let had_keys = game.maker.editor.moves_by_keys && has_focus;
    keys(game, ui);
    canvas::show(game, ui, room);
    let leaves = top(game, ui, screen.shrink(EDGE).with_max_y(room.top() - EDGE));
    shelf::show(game, ui, screen.with_min_y(room.bottom()));
    let is_escape = ui.input(|input| input.key_pressed(Key::Escape));
    let is_free = game.maker.editor.selection.is_empty();
    if is_escape && !is_free && !had_keys {
        let item = game.main_item();
        game.select_nothing();
        // The mark stays at the thing, so that keys go on from there.
        if let Some(item) = item {
            canvas::focus(ui, item);
        }
    }
    if leaves || is_escape && is_free && !had_keys {
        game.blip(Menu::Back);
        game.leave_editor();
    }
}

/// Shows the row at the top. Returns whether the player leaves the editor.
fn top(game: &mut Game, ui: &mut Ui, rect: Rect) -> bool {
    let (theme, said, words) = (game.theme(), game.words(), game.making());
    let high = rect.height();
    let is_narrow = rect.width() < 620.0;
    let wide = if is_narrow {
        0.21 * rect.width()
    } else {
        130.0
    };
    let mut left = rect.left();
    let mut right = rect.right();
    let press = |ui: &mut Ui, text: &str, at: f32, style: ButtonStyle| {
        let place = Rect::from_min_size(pos2(at, rect.top()), vec2(wide, high));
        let builder = UiBuilder::new().max_rect(place);
        let shown = ui.scope_builder(builder, |ui| button(ui, &theme, text, place.size(), style));
        shown.inner.clicked()
    };
    let leaves = press(ui, said.back, left, ButtonStyle::Other);
    left += wide + GAP;
    right -= wide;
    let plays = press(ui, words.test, right, ButtonStyle::Main);
    right -= wide + GAP;
    let keeps = press(ui, words.finish, right, ButtonStyle::Other);
    let draft = &game.maker.draft;
    let steps = [
        (-1.0, words.undo, draft.can_undo()),
        (1.0, words.redo, draft.can_redo()),
    ];
    let side = high.min(0.5 * (right - left) - GAP);
    for (way, name, is_able) in steps {
        let place = Rect::from_min_size(pos2(left, rect.top()), Vec2::splat(side));
        if step_button(ui, &theme, place, name, way, is_able) {
            game.blip(Menu::Confirm);
            game.undo_edit(way > 0.0);
        }
        left += side + GAP;
    }
    if !is_narrow {
        let name = game.draft_name();
        let room = right - left - GAP;
        let galley = fitted(ui.painter(), name, 24.0, room, theme.ink);
        let at = pos2(
            left + 0.5 * (room - galley.size().x),
            rect.center().y - 0.5 * galley.size().y,
        );
        ui.painter().galley(at, galley, theme.ink);
    }
    if plays {
        game.blip(Menu::Confirm);
        game.test_level();
    }
    if keeps {
        game.blip(Menu::Confirm);
        game.end_drag();
        game.go(Screen::Finish);
    }
    leaves
}

/// Reads the keys of drawing programs.
fn keys(game: &mut Game, ui: &Ui) {
    if game.maker.editor.drag.is_some() {
        // Numbers of things may be others at the end of the drag.
        return;
    }
    let pressed = |key, modifiers| ui.input_mut(|input| input.consume_key(modifiers, key));
    let command = Modifiers::COMMAND;
    let [undoes, redoes] = step_keys(ui);
    if redoes {
        game.undo_edit(true);
    } else if undoes {
        game.undo_edit(false);
    } else if pressed(Key::D, command) {
        game.copy_selection();
        game.paste();
    } else if pressed(Key::Delete, Modifiers::NONE) || pressed(Key::Backspace, Modifiers::NONE) {
        if !game.maker.editor.selection.is_empty() {
            game.remove_selection();
        }
    } else if pressed(Key::A, command) {
        game.select_all();
    }
    let (copies, cuts, pastes) = ui.input(|input| {
        use egui::Event::{Copy, Cut, Paste};
        let has = |which: fn(&egui::Event) -> bool| input.events.iter().any(which);
        (
            has(|event| matches!(event, Copy)),
            has(|event| matches!(event, Cut)),
            has(|event| matches!(event, Paste(_))),
        )
    });
    let has_selection = !game.maker.editor.selection.is_empty();
    if has_selection && (copies || cuts) {
        game.copy_selection();
        // With an empty clipboard, the system does not tell the game that the keys for pasting are pressed.
        ui.ctx().copy_text(game.draft_name().to_string());
    }
    if has_selection && cuts {
        game.remove_selection();
    }
    if pastes {
        game.paste();
    }
}

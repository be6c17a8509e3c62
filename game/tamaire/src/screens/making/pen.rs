//! Pen on a sheet: pointer, finger, keys, pads and one switch.

use crate::game::{Cursor, Game};
use egui::{
    Event, EventFilter, Key, PointerButton, Pos2, Rect, Response, Stroke, Ui, Vec2, pos2, vec2,
};

/// Movement of the cursor by an arrow key, as a share of the sheet.
const STEP: f32 = 1.0 / 64.0;
/// Speed of the cursor with a fully deflected stick [shares of the sheet/s].
const SPEED: f32 = 0.6;
/// Deflection of a stick below which the cursor rests, and above which it is fully deflected.
const DEAD: [f32; 2] = [0.15, 0.95];
/// Time in which the cursor sweeps across the sheet for a player with one switch, in scanning steps.
const SWEEP: f32 = 5.0;
/// Factor on the width of a stroke of a pen without pressure, and what full pressure adds to it.
const PRESSURE: [f32; 2] = [0.5, 1.0];

/// Movement of the pen in this frame.
#[derive(Default)]
pub(super) struct Moves {
    /// Points through which the pen is drawn, each with the factor on the width of the stroke that its pressure gives.
    pub(super) points: Vec<(Pos2, f32)>,
    /// Whether the pen is up after the last point.
    pub(super) is_up: bool,
}

/// Returns the movement of the pen on a sheet.
pub(super) fn moves(game: &mut Game, ui: &Ui, rect: Rect, sheet: &Response) -> Moves {
    let is_primary = ui.input(|input| input.pointer.primary_down());
    if sheet.is_pointer_button_down_on() && is_primary {
        game.maker.cursor = None;
        return of_pointer(ui, sheet);
    }
    if let Some(at) = sheet.interact_pointer_pos()
        && (sheet.clicked() || sheet.drag_stopped())
    {
        // The last movement, or a whole tap, happened within this frame.
        let mut moves = of_pointer(ui, sheet);
        if moves.points.is_empty() && sheet.clicked() && !game.maker.is_drawing() {
            moves.points.push((at, 1.0));
        }
        moves.is_up = true;
        return moves;
    }
    if !sheet.has_focus() {
        // The cursor belongs to the focus.
        game.maker.cursor = None;
    }
    if sheet.has_focus()
        && let Some(moves) = by_keys(game, ui, rect, sheet)
    {
        return moves;
    }
    Moves {
        points: Vec::new(),
        is_up: true,
    }
}

/// Returns the points over which the pointer moved while it is down.
fn of_pointer(ui: &Ui, sheet: &Response) -> Moves {
    let mut moves = Moves::default();
    let mut pressure = ui.data(|data| data.get_temp(sheet.id)).unwrap_or(1.0);
    ui.input(|input| {
        let is_touch = |event: &Event| matches!(event, Event::Touch { .. });
        if !input.events.is_empty() && !input.events.iter().any(is_touch) {
            // A mouse has no pressure.
            pressure = 1.0;
        }
        for event in &input.events {
            match *event {
                Event::Touch { force, .. } => {
                    let [least, more] = PRESSURE;
                    pressure = force.map_or(1.0, |force| least + more * force.clamp(0.0, 1.0));
                }
                Event::PointerMoved(at) => moves.points.push((at, pressure)),
                Event::PointerButton {
                    pos,
                    button: PointerButton::Primary,
                    pressed: true,
                    ..
                } => {
                    moves.points.clear();
                    moves.points.push((pos, pressure));
                }
                _ => {}
            }
        }
    });
    ui.data_mut(|data| data.insert_temp(sheet.id, pressure));
    moves
}

/// Moves the cursor of a player without a pointer. Returns `None` while there is no cursor.
fn by_keys(game: &mut Game, ui: &Ui, rect: Rect, sheet: &Response) -> Option<Moves> {
    let scans = game.settings.scanning.is_on();
    let count = |key| ui.input(|input| input.num_presses(key)) as f32;
    let is_pressed = count(Key::Enter) + count(Key::Space) > 0.0;
    let Some(mut cursor) = game.maker.cursor else {
        // The arrows move the focus again.
        let filter = EventFilter::default();
        ui.memory_mut(|memory| memory.set_focus_lock_filter(sheet.id, filter));
        if is_pressed {
            game.maker.cursor = Some(Cursor {
                at: Vec2::splat(0.5),
                is_down: false,
                sweep: scans.then_some(0),
            });
        }
        return None;
    };
    let filter = EventFilter {
        tab: scans,
        horizontal_arrows: true,
        vertical_arrows: true,
        escape: true,
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(sheet.id, filter));
    ui.ctx().request_repaint();
    let seconds = ui.input(|input| input.stable_dt.min(0.1));
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        game.maker.cursor = None;
        return Some(Moves {
            points: Vec::new(),
            is_up: true,
        });
    }
    let mut moves = Moves::default();
    let place = |at: Vec2| rect.min + at * rect.size();
    if let (Some(axis), Some(step)) = (cursor.sweep, game.settings.scanning.step()) {
        let next = (cursor.at[axis] + seconds / (SWEEP * step)).fract();
        cursor.at[axis] = next;
        game.maker.cursor = Some(cursor);
        if is_pressed && axis == 0 {
            cursor.sweep = Some(1);
            game.maker.cursor = Some(cursor);
        } else if is_pressed {
            moves.points.push((place(cursor.at), 1.0));
            game.maker.cursor = None;
        }
        moves.is_up = true;
        return Some(moves);
    }
    let keys = vec2(
        count(Key::ArrowRight) - count(Key::ArrowLeft),
        count(Key::ArrowDown) - count(Key::ArrowUp),
    );
    let sticks = &game.controls.devices.sticks.devices;
    let [x, y] = sticks.iter().fold([0.0; 2], |sum: [f32; 2], device| {
        let [x, y] = sticks::radial_dead_zone(device.aim(), DEAD[0], DEAD[1]);
        [sum[0] + x, sum[1] + y]
    });
    let before = cursor.at;
    let by = STEP * keys + SPEED * seconds * vec2(x, -y);
    cursor.at = (cursor.at + by).clamp(Vec2::ZERO, Vec2::splat(1.0));
    let toggles = is_pressed;
    if cursor.is_down || toggles {
        moves.points.push((place(before), 1.0));
        moves.points.push((place(cursor.at), 1.0));
    }
    cursor.is_down ^= toggles;
    moves.is_up = !cursor.is_down;
    game.maker.cursor = Some(cursor);
    Some(moves)
}

/// Draws the cursor of a player without a pointer.
pub(super) fn draw_cursor(game: &Game, ui: &Ui, rect: Rect) {
    let Some(cursor) = game.maker.cursor else {
        return;
    };
    let (painter, theme) = (ui.painter(), game.theme());
    let at = rect.min + cursor.at * rect.size();
    let line = Stroke::new(2.0, theme.accent);
    match cursor.sweep {
        Some(axis) => {
            painter.line_segment([pos2(at.x, rect.top()), pos2(at.x, rect.bottom())], line);
            if axis == 1 {
                painter.line_segment([pos2(rect.left(), at.y), pos2(rect.right(), at.y)], line);
            }
        }
        None => {
            let radius = if cursor.is_down { 7.0 } else { 12.0 };
            painter.circle_stroke(at, radius, Stroke::new(3.0, theme.accent));
            painter.circle_filled(at, 2.5, theme.accent);
        }
    }
}

//! Bar under a replay: position and speed.

use super::buttons::pale;
use super::widgets::track;
use crate::game::{Game, SPEEDS};
use app_shell::widgets::{ButtonStyle, fitted, plain_button};
use egui::{Align, Layout, Rect, Role, Sense, Ui, UiBuilder, WidgetInfo, pos2, vec2};
use fuwafuwa::DEFAULT_TICK;

/// Maximum width of the bar [points].
const WIDE: f32 = 760.0;
/// Height of a row of the bar [points].
const HIGH: f32 = 60.0;
/// Distance of the bar from the edges of the window [points].
const EDGE: f32 = 15.0;
/// Width of the bar below which the speeds are in a second row [points].
const NARROW: f32 = 560.0;
/// Gap between the parts of the bar [points].
const GAP: f32 = 12.0;
/// Size of the button of a speed [points].
const SPEED: egui::Vec2 = vec2(58.0, 40.0);
/// Width of the text that tells the position [points].
const CLOCK: f32 = 112.0;

/// Shows the bar while a replay is on the screen.
pub(super) fn show(game: &mut Game, ui: &mut Ui) {
    let Some([tick, length]) = game.bout.session.position() else {
        return;
    };
    let (theme, screen) = (game.theme(), ui.max_rect());
    let width = WIDE.min(screen.width() - 2.0 * EDGE);
    let is_narrow = width < NARROW;
    let high = if is_narrow { 2.0 * HIGH } else { HIGH };
    let middle = pos2(screen.center().x, screen.bottom() - EDGE - 0.5 * high);
    let bar = Rect::from_center_size(middle, vec2(width, high));
    ui.painter().rect_filled(bar, 0.5 * HIGH, pale(&theme));
    let inside = bar.shrink2(vec2(24.0, 0.0));
    let speeds = SPEEDS.len() as f32 * (SPEED.x + GAP) - GAP;
    let parts = match is_narrow {
        true => inside.split_top_bottom_at_fraction(0.5),
        false => inside.split_left_right_at_x(inside.right() - speeds),
    };
    let layout = Layout::left_to_right(Align::Center);
    let builder = |rect| UiBuilder::new().max_rect(rect).layout(layout);
    ui.scope_builder(builder(parts.0), |ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        draw_clock(ui, game, [tick, length]);
        let wide = (ui.available_width() - GAP).max(60.0);
        let all = length.max(1) as f32 * DEFAULT_TICK;
        let here = tick as f32 * DEFAULT_TICK;
        let name = game.words().position;
        let (_, asked) = track(ui, &theme, name, here, [0.0, all], 1.0, wide);
        if let Some(seconds) = asked {
            // At the very end the replay would close.
            let last = length.saturating_sub(1);
            game.wind_to(((seconds / DEFAULT_TICK).round() as usize).min(last));
        }
    });
    ui.scope_builder(builder(parts.1), |ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        for (speed, text) in SPEEDS {
            let is_chosen = game.bout.watch_speed == speed;
            let response = plain_button(ui, &theme, text, SPEED, ButtonStyle::of(is_chosen));
            let told = format!("{}: {text}", game.words().speed);
            let role = Role::RadioButton;
            response.widget_info(|| WidgetInfo::selected(role, true, is_chosen, &told));
            if response.clicked() {
                game.bout.watch_speed = speed;
            }
        }
    });
}

/// Draws the position and the length of the replay.
fn draw_clock(ui: &mut Ui, game: &Game, ticks: [usize; 2]) {
    let theme = game.theme();
    // The round goes on for a moment after the end of its replay.
    let ticks = [ticks[0].min(ticks[1]), ticks[1]];
    let [here, all] = ticks.map(|tick| tick as f32 * DEFAULT_TICK);
    let text = (game.words().seconds_of)(here, all);
    let (rect, _) = ui.allocate_exact_size(vec2(CLOCK, HIGH), Sense::hover());
    let galley = fitted(ui.painter(), &text, 19.0, CLOCK, theme.ink);
    let at = rect.left_center() - vec2(0.0, 0.5 * galley.size().y);
    ui.painter().galley(at, galley, theme.ink);
}

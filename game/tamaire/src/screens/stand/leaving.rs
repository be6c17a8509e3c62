//! Countdown ring that is shown before a visit without input ends.

use super::super::icons;
use crate::exhibit::{Stand, presence::Attention};
use crate::game::Game;
use app_shell::widgets::fitted;
use egui::{Color32, Stroke, Ui, vec2};

const RADIUS: f32 = 92.0;
const WIDE: f32 = 16.0;

/// Shows the ring over everything else.
pub(super) fn show(stand: &Stand, game: &Game, ui: &Ui) {
    let Attention::Leaving(left) = stand.attention else {
        return;
    };
    let (theme, screen) = (game.theme(), ui.max_rect());
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("leaving"));
    let painter = ui.ctx().layer_painter(layer);
    painter.rect_filled(screen, 0.0, Color32::from_black_alpha(90));
    let middle = screen.center();
    painter.circle_filled(middle, RADIUS + WIDE, theme.card);
    painter.circle_stroke(middle, RADIUS, Stroke::new(WIDE, theme.button));
    icons::arc(
        &painter,
        middle,
        RADIUS,
        left,
        Stroke::new(WIDE, theme.accent),
    );
    let seconds = (left * stand.config.times.countdown.0).ceil();
    let number = fitted(
        &painter,
        &format!("{seconds:.0}"),
        76.0,
        2.0 * RADIUS,
        theme.ink,
    );
    painter.galley(middle - 0.5 * number.size(), number, theme.ink);
    let text = game.settings.language.at_stand().still_there;
    let galley = fitted(&painter, text, 40.0, screen.width() - 60.0, Color32::WHITE);
    let below = middle + vec2(0.0, RADIUS + WIDE + 40.0);
    painter.galley(below - 0.5 * galley.size(), galley, Color32::WHITE);
}

//! Countdown ring that is shown before a visit without input ends.

use super::super::icons;
use crate::exhibit::{Stand, presence::Attention};
use crate::game::Game;
use app_shell::widgets::fitted;
use egui::{Color32, Rect, Stroke, Ui, vec2};

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
    // A visitor may still be about to scan the code, so it is not dimmed.
    if stand.to_take_home().is_none() {
        painter.rect_filled(screen, 0.0, Color32::from_black_alpha(90));
    }
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
    let seconds = (left * stand.countdown()).ceil();
    let number = fitted(
        &painter,
        &format!("{seconds:.0}"),
        76.0,
        2.0 * RADIUS,
        theme.ink,
    );
    painter.galley(middle - 0.5 * number.size(), number, theme.ink);
    let text = game.settings.language.at_stand().still_there;
    let galley = fitted(&painter, text, 40.0, screen.width() - 108.0, theme.ink);
    let below = middle + vec2(0.0, RADIUS + WIDE + 48.0);
    let label = Rect::from_center_size(below, galley.size() + vec2(48.0, 16.0));
    painter.rect_filled(label, 0.5 * label.height(), theme.card);
    painter.galley(below - 0.5 * galley.size(), galley, theme.ink);
}

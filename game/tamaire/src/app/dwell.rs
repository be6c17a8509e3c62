//! Dwell clicking: a mouse that stays on a button clicks it. For players who point with their eyes or head.

use app_shell::Theme;
use egui::{Color32, Context, Id, LayerId, Order, Pos2, Shape, Stroke, vec2};
use std::f32::consts::TAU;

/// Time on a widget after which the mouse clicks it [s].
const REST: f32 = 1.0;
/// Radius of the progress ring around the mouse [points].
const RADIUS: f32 = 20.0;

/// Widget under the mouse, and the time for which the mouse has been on it.
#[derive(Debug, Default)]
pub(super) struct Dwell {
    on: Option<Id>,
    /// Time for which the mouse has stayed on the widget [s].
    seconds: f32,
    /// Whether the mouse has moved since the screen appeared. A widget that appears under an unmoved mouse is
    /// not clicked.
    has_moved: bool,
}

impl Dwell {
    /// Adds `seconds` [s] to the time for which the mouse has stayed on the widget `on`. Another widget
    /// restarts this time. Returns true once, when the widget is to be clicked.
    pub(super) fn pass(&mut self, on: Option<Id>, has_moved: bool, seconds: f32) -> bool {
        self.has_moved |= has_moved;
        let on = on.filter(|_| self.has_moved);
        if self.on != on {
            (self.on, self.seconds) = (on, 0.0);
        }
        let before = self.seconds;
        self.seconds += if on.is_some() { seconds } else { 0.0 };
        before < REST && self.seconds >= REST
    }

    /// Draws the progress ring around the mouse.
    pub(super) fn draw(&self, ctx: &Context, at: Pos2, theme: &Theme) {
        let share = self.seconds / REST;
        if self.on.is_none() || share >= 1.0 {
            return;
        }
        let layer = LayerId::new(Order::Tooltip, Id::unique("dwell"));
        let painter = ctx.layer_painter(layer);
        let point = |step: usize| {
            let (sin, cos) = (TAU * share * step as f32 / 32.0).sin_cos();
            at + RADIUS * vec2(sin, -cos)
        };
        let ring: Vec<Pos2> = (0..=32).map(point).collect();
        painter.circle_stroke(at, RADIUS, Stroke::new(7.0, Color32::from_white_alpha(160)));
        painter.add(Shape::line(ring, Stroke::new(5.0, theme.accent)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dwell_clicks_each_widget_once() {
        let [one, other] = ["one", "other"].map(|name| Some(Id::unique(name)));
        let mut dwell = Dwell::default();
        assert!(!dwell.pass(one, false, 9.0), "the mouse has not moved");
        let mut pass = |on, seconds| dwell.pass(on, true, seconds);
        assert!(!pass(None, 9.0) && !pass(one, 0.6) && !pass(other, 0.6));
        assert!(pass(other, 0.6) && !pass(other, 9.0));
        assert!(!pass(None, 0.1) && !pass(other, 0.9) && pass(other, 0.2));
    }
}

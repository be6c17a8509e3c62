//! A mouse that rests on a button presses it: for whoever points with eyes or head.

use crate::look::Theme;
use egui::{Color32, Context, Id, LayerId, Order, Pos2, Shape, Stroke, vec2};
use std::f32::consts::TAU;

/// For how long it rests [s].
const REST: f32 = 1.0;
/// The ring around it [points].
const RADIUS: f32 = 20.0;

/// On what the mouse rests.
#[derive(Debug, Default)]
pub(super) struct Dwell {
    on: Option<Id>,
    /// For how long [s].
    seconds: f32,
    /// Whether it came there by itself: what comes up under it is not meant.
    has_moved: bool,
}

impl Dwell {
    /// Lets time pass with the mouse on something; says whether that is pressed now, which happens once.
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

    /// Shows around the mouse how long it still has to rest.
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
    fn what_the_mouse_rests_on_is_pressed_once() {
        let [one, other] = ["one", "other"].map(|name| Some(Id::unique(name)));
        let mut dwell = Dwell::default();
        assert!(!dwell.pass(one, false, 9.0), "it came up under the mouse");
        let mut pass = |on, seconds| dwell.pass(on, true, seconds);
        assert!(!pass(None, 9.0) && !pass(one, 0.6) && !pass(other, 0.6));
        assert!(pass(other, 0.6) && !pass(other, 9.0));
        assert!(!pass(None, 0.1) && !pass(other, 0.9) && pass(other, 0.2));
    }
}

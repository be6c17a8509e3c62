//! Switches and fields of a room.

use super::DrawOptions;
use egui::{Color32, Painter, Pos2, Shape as Drawn, Stroke};
use fuwafuwa::{Dim, DimVector, Shape, Vec3};
use tamaire_play::Round;

/// Distance between the streaks that show a field [m].
const SPACING: f32 = 0.22;
/// Length of a streak per acceleration [m / (m/s²)], and its maximum [m].
const LENGTH: [f32; 2] = [0.02, 0.14];
/// Acceleration below which no streak is drawn [m/s²].
const WEAK: f32 = 0.3;
/// Time in which a streak moves along its length and fades [s].
const PERIOD: f64 = 1.2;

/// Draws the switches and fields of a round.
pub(super) fn draw<D: Dim>(painter: &Painter, round: &Round<D>, look: &DrawOptions) {
    for (region, is_on) in round.machinery().switches() {
        switch(painter, region, is_on, look);
    }
    if round.machinery().has_fields() {
        field(painter, round, look);
    }
}

/// Draws a switch as a pad that lights up when it is on. In 3D its lowest face is drawn.
fn switch<D: Dim>(painter: &Painter, region: &Shape<D>, is_on: bool, look: &DrawOptions) {
    let strength = if is_on { 0.75 } else { 0.25 };
    let fill = look.theme.accent.gamma_multiply(strength);
    let rim = Stroke::new(2.5, look.theme.accent);
    let [low, high] = region.bounds().map(DimVector::to_vec3);
    let second = if D::N == 2 { 1 } else { 2 };
    let corner = |[first, next]: [bool; 2]| {
        let mut at = low;
        at.x = if first { high.x } else { low.x };
        at[second] = if next { high[second] } else { low[second] };
        look.view.to_screen(at)
    };
    let corners = [[false, false], [true, false], [true, true], [false, true]].map(corner);
    match *region {
        Shape::Ball { centre, radius } if D::N == 2 => {
            let middle = centre.to_vec3();
            let radius = radius * look.view.scale_at(middle);
            painter.circle(look.view.to_screen(middle), radius, fill, rim);
        }
        _ => {
            painter.add(Drawn::convex_polygon(corners.to_vec(), fill, rim));
        }
    }
}

/// Draws a field as streaks that move with it.
fn field<D: Dim>(painter: &Painter, round: &Round<D>, look: &DrawOptions) {
    let [low, high] = round.level().arena();
    let time = if look.reduced_motion {
        0.5 * PERIOD
    } else {
        look.time
    };
    let counts = [0, 1, 2].map(|axis| match axis < D::N {
        true => ((high[axis] - low[axis]) / SPACING) as usize,
        false => 1,
    });
    let ink = Color32::WHITE;
    for number in 0..counts.iter().product() {
        let steps = [
            number % counts[0],
            number / counts[0] % counts[1],
            number / (counts[0] * counts[1]),
        ];
        let mut at = Vec3::ZERO;
        for axis in 0..D::N {
            at[axis] = low[axis] + SPACING * (steps[axis] as f32 + 0.5);
        }
        let pull = round
            .machinery()
            .field_at(D::Vector::from_vec3(at))
            .to_vec3();
        let strength = pull.length();
        if strength < WEAK {
            continue;
        }
        // Neighbours begin at different times.
        let phase = (time / PERIOD + 0.37 * number as f64).fract() as f32;
        let streak = pull * ((LENGTH[0] * strength).min(LENGTH[1]) / strength);
        let from = at + streak * (2.0 * phase - 1.0);
        let ends: [Pos2; 2] = [from, from + streak].map(|at| look.view.to_screen(at));
        let fade = 1.0 - (2.0 * phase - 1.0).abs();
        let width = 0.012 * look.view.scale_at(at);
        let [rim, inner] = [(1.8, look.theme.faint), (1.0, ink)];
        for (wider, colour) in [rim, inner] {
            let stroke = Stroke::new(wider * width, colour.gamma_multiply(0.8 * fade));
            painter.line_segment(ends, stroke);
        }
    }
}

//! Switches, fields and knives of a room, and bubbles where nothing falls.

use super::DrawOptions;
use egui::{Color32, Painter, Pos2, Shape as Drawn, Stroke};
use fuwafuwa::{Dim, DimVector, Knife, Shape, Vec3, World};
use tamaire_play::Round;

/// Distance between the streaks that show a field [m].
const SPACING: f32 = 0.22;
/// Length of a streak per acceleration [m / (m/s²)], and its maximum [m].
const LENGTH: [f32; 2] = [0.02, 0.14];
/// Acceleration below which no streak is drawn [m/s²].
const WEAK: f32 = 0.3;
/// Time in which a streak moves along its length and fades [s].
const PERIOD: f64 = 1.2;
/// Number of bubbles in a room without gravity, radius of the largest [m], and how far each drifts [m].
const BUBBLES: usize = 24;
const BUBBLE: f32 = 0.028;
const DRIFT: f32 = 0.08;

/// Colours of the blade of a knife, of its rim and of its handle.
const STEEL: Color32 = Color32::from_rgb(214, 221, 228);
const STEEL_RIM: Color32 = Color32::from_rgb(104, 116, 130);
const HANDLE: Color32 = Color32::from_rgb(120, 84, 52);
/// Minimum height of a drawn blade, and half the width of its back in 2D and of a handle [m].
const BLADE: f32 = 0.05;
const BACK: f32 = 0.018;

/// Draws the switches, fields and knives of a round, or bubbles where nothing falls.
pub(super) fn draw<D: Dim>(painter: &Painter, round: &Round<D>, look: &DrawOptions) {
    for (region, is_on) in round.machinery().switches() {
        switch(painter, region, is_on, look);
    }
    for (_, knife) in round.world().knives() {
        blade(painter, round.world(), &knife.definition(), look);
    }
    if round.machinery().has_fields() {
        field(painter, round, look);
    }
    if round.is_weightless() {
        bubbles(painter, round, look);
    }
}

/// Draws bubbles that drift through a room without gravity.
fn bubbles<D: Dim>(painter: &Painter, round: &Round<D>, look: &DrawOptions) {
    let [low, high] = round.level().arena();
    let time = if look.reduced_motion { 0.0 } else { look.time };
    // Multiples of these irrational numbers, modulo 1, spread evenly (additive recurrence in three dimensions).
    let share = |number: usize, axis: usize| {
        let ratio = [0.819_172_5, 0.671_043_6, 0.549_700_5][axis];
        (0.5 + ratio * number as f32).fract()
    };
    for number in 0..BUBBLES {
        let mut at = Vec3::ZERO;
        for axis in 0..D::N {
            let turn = time * (0.3 + 0.1 * axis as f64) + 2.4 * number as f64;
            let rest = low[axis] + (high[axis] - low[axis]) * share(number, axis);
            at[axis] = rest + DRIFT * turn.sin() as f32;
        }
        let middle = look.view.to_screen(at);
        let radius = BUBBLE * (0.4 + 0.6 * share(number, 2)) * look.view.scale_at(at);
        let rim = look.theme.faint.gamma_multiply(0.45);
        let fill = Color32::WHITE.gamma_multiply(0.25);
        painter.circle(middle, radius, fill, Stroke::new(0.18 * radius, rim));
        let glint = middle - 0.35 * radius * egui::Vec2::splat(1.0);
        painter.circle_filled(glint, 0.25 * radius, Color32::WHITE.gamma_multiply(0.8));
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

/// Draws a knife: its blade, and a handle from the blade to the rigid body that holds it.
fn blade<D: Dim>(painter: &Painter, world: &World<D>, knife: &Knife<D>, look: &DrawOptions) {
    let Ok(holder) = world.rigid_body(knife.holder) else {
        return;
    };
    let (place, turn) = (holder.position(), holder.rotation());
    let [from, to] = { knife.edge }.map(|end| (place + turn.apply(end)).to_vec3());
    let toward = turn.apply(knife.toward).to_vec3().normalize_or_zero();
    let height = knife.height.max(BLADE) * toward;
    let scale = look.view.scale_at(from);
    let corners = match D::N {
        2 => {
            let aside = BACK.max(0.12 * knife.height) * Vec3::new(-toward.y, toward.x, 0.0);
            let (tip, back) = (0.5 * (from + to), 0.5 * (from + to) - height);
            vec![tip, back + aside, back - aside]
        }
        _ => vec![from, to, to - height, from - height],
    };
    let back = 0.5 * (from + to) - height;
    let handle = [back, place.to_vec3()].map(|at| look.view.to_screen(at));
    painter.line_segment(handle, Stroke::new(2.0 * BACK * scale, HANDLE));
    let corners = corners.into_iter().map(|at| look.view.to_screen(at));
    let rim = Stroke::new(1.5, STEEL_RIM);
    painter.add(Drawn::convex_polygon(corners.collect(), STEEL, rim));
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

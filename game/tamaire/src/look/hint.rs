//! Wordless hint that is shown until the hand moves: a ring marks the player's hand, and a pale hand pushes a
//! pale body into the basket in a loop.

use super::{DrawOptions, Hint};
use app_shell::View;
use egui::{Color32, Painter, Pos2, Shape, Stroke, Vec2, vec2};
use fuwafuwa::{Dim, Dim2, Dim3, DimVector, RigidBodyRef, SoftBody, Vec3};
use tamaire_play::Round;

/// Duration of one loop of the animation [s].
const ROUND_TRIP: f64 = 3.2;

/// Draws the hint of a 2D round.
pub(super) fn draw(painter: &Painter, round: &Round<Dim2>, look: &DrawOptions) {
    let Some(hand) = hand_to_show(round, look) else {
        return;
    };
    draw_ring(painter, hand, look);
    if look.hint == Hint::Way {
        draw_way(painter, round, hand, look);
    }
}

/// Draws the hint of a 3D round: only the ring around the hand, because texts explain the controls.
pub(super) fn draw_ring_of_space(painter: &Painter, round: &Round<Dim3>, look: &DrawOptions) {
    if let Some(hand) = hand_to_show(round, look) {
        draw_ring(painter, hand, look);
    }
}

/// Returns the first hand while the hint is shown.
fn hand_to_show<'a, D: Dim>(
    round: &'a Round<D>,
    look: &DrawOptions,
) -> Option<RigidBodyRef<'a, D>> {
    let is_shown = look.hint != Hint::None && look.effects.hint != 0.0;
    round.hands().next().filter(|_| is_shown)
}

/// Draws rings that spread from the hand.
fn draw_ring<D: Dim>(painter: &Painter, hand: RigidBodyRef<'_, D>, look: &DrawOptions) {
    let position = hand.position().to_vec3();
    let at = look.view.to_screen(position);
    let radius = hand.shape().inradius() * look.view.scale_at(position);
    let tone = look.theme.hand(0).gamma_multiply(look.effects.hint);
    let wave = if look.reduced_motion {
        0.4
    } else {
        (0.8 * look.time).rem_euclid(1.0) as f32
    };
    for late in [0.0, 0.5] {
        let wave = (wave + late).rem_euclid(1.0);
        let stroke = Stroke::new(4.0, tone.gamma_multiply(1.0 - wave));
        painter.circle_stroke(at, radius * (1.15 + 1.1 * wave), stroke);
    }
}

/// Draws the pale hand and the body that it pushes.
fn draw_way(
    painter: &Painter,
    round: &Round<Dim2>,
    hand: RigidBodyRef<'_, Dim2>,
    look: &DrawOptions,
) {
    let (view, strength) = (&look.view, look.effects.hint);
    let (Some(goal), Some(body)) = (basket_centre(round), round.counted_bodies().next()) else {
        return;
    };
    let Some(piece) = body.piece_views().into_iter().next() else {
        return;
    };
    let width = 0.5 * (piece.high.x - piece.low.x);
    let body_at = vec2(piece.centre.x, piece.centre.y);
    let from = vec2(hand.position().x, hand.position().y);
    let hand = hand.shape().inradius();
    let way = (goal - body_at).normalized();
    let touch = body_at - (width + hand) * way;
    let end = goal - (width + hand) * way;
    let time = if look.reduced_motion {
        0.62
    } else {
        (look.time / ROUND_TRIP).rem_euclid(1.0) as f32
    };
    let part = |low: f32, high: f32| smooth(((time - low) / (high - low)).clamp(0.0, 1.0));
    let reach = part(0.06, 0.34);
    let push = part(0.38, 0.84);
    let pale = strength * part(0.0, 0.06) * (1.0 - part(0.90, 1.0));
    let hand_at = from + reach * (touch - from) + push * (end - touch);
    if push > 0.0 {
        let by = push * (goal - body_at);
        let edge = Color32::from_rgb(120, 60, 60).gamma_multiply(0.6 * pale);
        let fill = look.theme.material(1).gamma_multiply(0.22 * pale);
        draw_pale_body(painter, view, body, by, edge, fill);
    }
    draw_arrows(
        painter,
        view,
        body_at + (width + hand) * way,
        goal,
        strength,
        look,
    );
    let screen = view.to_screen(Vec3::new(hand_at.x, hand_at.y, 0.0));
    let radius = hand * view.scale;
    let tone = look.theme.hand(0).gamma_multiply(0.55 * pale);
    painter.circle_filled(screen, radius, tone);
    let rim = Stroke::new(3.0, Color32::WHITE.gamma_multiply(pale));
    painter.circle_stroke(screen, radius, rim);
    painter.circle_stroke(screen, 0.55 * radius, rim);
}

fn draw_pale_body(
    painter: &Painter,
    view: &View,
    body: &SoftBody<Dim2>,
    by: Vec2,
    edge: Color32,
    fill: Color32,
) {
    for outline in body.outlines() {
        let points = outline.points.iter();
        let points: Vec<Pos2> = points
            .map(|&at| view.to_screen(at + Vec3::new(by.x, by.y, 0.0)))
            .collect();
        let mut points = smoothed(points);
        points.extend(points.first().copied());
        let middle = points.iter().fold(Vec2::ZERO, |sum, at| sum + at.to_vec2());
        let middle = (middle / points.len().max(1) as f32).to_pos2();
        let reach = points.iter().map(|at| at.distance(middle));
        painter.circle_filled(middle, reach.fold(f32::MAX, f32::min), fill);
        painter.extend(Shape::dashed_line(
            &points,
            Stroke::new(3.0, edge),
            14.0,
            10.0,
        ));
    }
}

/// Smooths the voxel steps of a closed line.
fn smoothed(mut points: Vec<Pos2>) -> Vec<Pos2> {
    for _ in 0..6 {
        let before = points.clone();
        let count = before.len();
        for (index, point) in points.iter_mut().enumerate() {
            let (last, next) = (
                before[(index + count - 1) % count],
                before[(index + 1) % count],
            );
            *point = *point + 0.25 * ((last - *point) + (next - *point));
        }
    }
    points
}

/// Draws chevrons that move towards the basket.
fn draw_arrows(
    painter: &Painter,
    view: &View,
    from: Vec2,
    to: Vec2,
    strength: f32,
    look: &DrawOptions,
) {
    let on_screen = |at: Vec2| view.to_screen(Vec3::new(at.x, at.y, 0.0));
    let (from, to) = (on_screen(from), on_screen(to));
    let way = (to - from).normalized();
    let side = way.rot90();
    let size = 0.045 * view.scale;
    let march = if look.reduced_motion {
        0.0
    } else {
        (1.2 * look.time).rem_euclid(1.0) as f32
    };
    let count = (from.distance(to) / (3.2 * size)).floor().max(1.0);
    for step in 0..count as usize {
        let share = (step as f32 + march) / count;
        let tip = from + share * (to - from);
        let fade = (4.0 * share.min(1.0 - share)).min(1.0);
        let line = [
            tip - size * way + size * side,
            tip,
            tip - size * way - size * side,
        ];
        let white = Color32::WHITE.gamma_multiply(0.9 * fade * strength);
        let ink = look.theme.ink.gamma_multiply(0.35 * fade * strength);
        painter.add(Shape::line(line.to_vec(), Stroke::new(0.62 * size, ink)));
        painter.add(Shape::line(line.to_vec(), Stroke::new(0.40 * size, white)));
    }
}

fn basket_centre(round: &Round<Dim2>) -> Option<Vec2> {
    match round.baskets().first()?.region {
        fuwafuwa::Shape::Box { centre, .. } => Some(vec2(centre.x, centre.y)),
        _ => None,
    }
}

fn smooth(share: f32) -> f32 {
    share * share * (3.0 - 2.0 * share)
}

//! Icons of buttons, badges and routes.

use super::widgets::words;
use app_shell::Theme;
use app_shell::widgets::least_letters;
use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Ui, Vec2, pos2, vec2};
use std::f32::consts::TAU;
use tamaire_play::Route;

/// Draws an arc, clockwise from the top; `share` 1 is a full circle.
pub(super) fn arc(painter: &Painter, middle: Pos2, radius: f32, share: f32, stroke: Stroke) {
    let count = (64.0 * share).ceil() as usize;
    let point = |step: usize| {
        let angle = std::f32::consts::TAU * share * step as f32 / count as f32;
        pos2(
            middle.x + radius * angle.sin(),
            middle.y - radius * angle.cos(),
        )
    };
    if count > 0 {
        painter.add(Shape::line((0..=count).map(point).collect(), stroke));
    }
}

/// Draws a check mark.
pub(super) fn tick(painter: &Painter, middle: Pos2, size: f32, stroke: Stroke) {
    let points = [[-0.8, 0.05], [-0.25, 0.6], [0.8, -0.6]];
    let points = points.map(|[x, y]| middle + size * vec2(x, y));
    painter.add(Shape::line(points.to_vec(), stroke));
    for end in [points[0], points[1], points[2]] {
        painter.circle_filled(end, 0.5 * stroke.width, stroke.color);
    }
}

/// Draws the 3D badge; `corner` is its upper left corner.
pub(super) fn space(ui: &Ui, corner: Pos2, theme: &Theme) {
    let letters = least_letters(ui.ctx()).max(16.0);
    let ground = Rect::from_min_size(corner, letters * vec2(2.4, 1.5));
    ui.painter().rect_filled(ground, 0.75 * letters, theme.ink);
    words(ui, ground.center(), "3D", letters, theme.card);
}

/// Draws the icon of a route: a body pressed into a square, a body with bits torn off, or both. It is pale
/// until the route was won.
pub(super) fn route(
    painter: &Painter,
    theme: &Theme,
    middle: Pos2,
    size: f32,
    route: Route,
    is_done: bool,
) {
    let (fill, line) = match is_done {
        true => (theme.material(1), theme.ink),
        false => (Color32::TRANSPARENT, theme.faint),
    };
    let stroke = Stroke::new((0.16 * size).max(1.5), line);
    let square = Rect::from_center_size(middle, vec2(1.7, 1.7) * size);
    if route != Route::Shave {
        painter.rect(square, 0.55 * size, fill, stroke, StrokeKind::Middle);
    } else {
        painter.circle(middle, 0.8 * size, fill, stroke);
    }
    if route != Route::Squeeze {
        let hole = if is_done {
            theme.card
        } else {
            Color32::TRANSPARENT
        };
        for [x, y, radius] in [[-0.72, -0.55, 0.42], [-0.85, 0.35, 0.34]] {
            let at = middle + size * vec2(x, y);
            painter.circle_filled(at, radius * size, hole);
        }
        for [x, y] in [[-1.15, -0.75], [-1.3, 0.0], [-1.1, 0.75]] {
            let dot = if is_done { fill } else { line };
            painter.circle_filled(middle + size * vec2(x, y), 0.16 * size, dot);
        }
    }
}

/// Draws a pause sign.
pub(super) fn pause(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    for x in [-5.0, 5.0] {
        let bar = Rect::from_center_size(at + scale * vec2(x, 0.0), scale * vec2(5.0, 17.0));
        painter.rect_filled(bar, 2.0 * scale, ink);
    }
}

/// Draws a restart arrow.
pub(super) fn again(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    let stroke = Stroke::new(3.5 * scale, ink);
    arc(painter, at, 9.0 * scale, 0.8, stroke);
    polygon(
        painter,
        at - scale * vec2(0.0, 9.0),
        scale,
        ink,
        &[[-7.0, 0.0], [2.0, -6.0], [2.0, 6.0]],
    );
}

/// Draws the icon of the element view: a large element beside small ones.
pub(super) fn elements(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    for (x, y, side) in [(-4.5, 0.0, 9.0), (5.0, -4.75, 7.0), (5.0, 4.75, 7.0)] {
        let square = Rect::from_center_size(
            at + scale * vec2(x, y),
            scale * vec2(side, if x < 0.0 { 17.0 } else { side }),
        );
        painter.rect_stroke(
            square,
            1.0,
            Stroke::new(2.0 * scale, ink),
            StrokeKind::Inside,
        );
    }
}

/// Draws a slow-motion sign.
pub(super) fn slow(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    polygon(
        painter,
        at - scale * vec2(4.0, 0.0),
        scale,
        ink,
        &[[-6.0, -7.0], [6.0, 0.0], [-6.0, 7.0]],
    );
    for x in [5.0, 11.0] {
        painter.circle_filled(at + scale * vec2(x, 5.5), 1.8 * scale, ink);
    }
}

/// Draws two dots for two players.
pub(super) fn two(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    for x in [-6.0, 6.0] {
        painter.circle_filled(at + scale * vec2(x, 0.0), 5.0 * scale, ink);
    }
}

/// Draws a basket that is open at the top.
pub(super) fn basket(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    let points = [[-10.0, -7.0], [-7.0, 8.0], [7.0, 8.0], [10.0, -7.0]];
    let points = points.map(|[x, y]| at + scale * vec2(x, y));
    let stroke = Stroke::new(2.5 * scale, ink);
    painter.add(Shape::line(points.to_vec(), stroke));
    for share in [0.33, 0.67] {
        let side = points[0] + share * (points[1] - points[0]);
        let other = points[3] + share * (points[2] - points[3]);
        painter.line_segment([side, other], Stroke::new(1.5 * scale, ink));
    }
}

/// Draws a clock face.
pub(super) fn clock(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    let stroke = Stroke::new(2.5 * scale, ink);
    painter.circle_stroke(at, 9.5 * scale, stroke);
    for [x, y] in [[0.0, -6.0], [4.5, 2.0]] {
        painter.line_segment([at, at + scale * vec2(x, y)], stroke);
    }
}

/// Draws two arrows to the left.
pub(super) fn rewind(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    for x in [-9.0, 1.0] {
        let corners = [[x, 0.0], [x + 9.0, -8.0], [x + 9.0, 8.0]];
        let corners = corners.map(|corner| at + scale * vec2(corner[0], corner[1]));
        painter.add(egui::Shape::convex_polygon(
            corners.to_vec(),
            ink,
            Stroke::NONE,
        ));
    }
}

/// Draws a padlock.
pub(super) fn lock(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    let stroke = Stroke::new(3.0 * scale, ink);
    arc(
        painter,
        at - scale * vec2(0.0, 5.0),
        6.5 * scale,
        1.0,
        stroke,
    );
    let body = Rect::from_center_size(at + scale * vec2(0.0, 4.0), scale * vec2(21.0, 15.0));
    painter.rect_filled(body, 3.5 * scale, ink);
}

/// Draws a body of which a small part is missing.
pub(super) fn kept(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    let stroke = Stroke::new(2.5 * scale, ink);
    painter.circle_stroke(at, 9.0 * scale, Stroke::new(1.0 * scale, ink));
    arc(painter, at, 9.0 * scale, 0.85, stroke);
    painter.circle_filled(at, 5.5 * scale, ink);
}

/// Draws some pieces.
pub(super) fn pieces(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    for [x, y, radius] in [
        [-5.5, -4.0, 4.5],
        [5.0, -6.0, 3.0],
        [4.0, 4.5, 5.0],
        [-6.0, 6.5, 2.5],
    ] {
        painter.circle_filled(at + scale * vec2(x, y), radius * scale, ink);
    }
}

/// Draws two links of a chain.
pub(super) fn joints(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    let stroke = Stroke::new(2.5 * scale, ink);
    for x in [-4.5, 4.5] {
        let link = Rect::from_center_size(at + scale * vec2(x, 0.0), scale * vec2(13.0, 8.0));
        painter.rect_stroke(link, 4.0 * scale, stroke, StrokeKind::Middle);
    }
}

/// Draws an egg.
pub(super) fn egg(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    let point = |step: usize| {
        let way = Vec2::angled(TAU * step as f32 / 32.0);
        // Narrower at the top.
        let narrow = 7.5 + 1.5 * way.y;
        at + scale * vec2(narrow * way.x, 10.0 * way.y)
    };
    let outline = (0..32).map(point).collect();
    painter.add(Shape::closed_line(outline, Stroke::new(2.5 * scale, ink)));
}

/// Draws an upward arrow.
pub(super) fn up(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    polygon(
        painter,
        at,
        scale,
        ink,
        &[[-8.0, 5.0], [0.0, -8.0], [8.0, 5.0]],
    );
}

/// Draws a downward arrow.
pub(super) fn down(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    polygon(
        painter,
        at,
        scale,
        ink,
        &[[-8.0, -5.0], [0.0, 8.0], [8.0, -5.0]],
    );
}

fn polygon(painter: &Painter, at: Pos2, scale: f32, ink: Color32, corners: &[[f32; 2]]) {
    let corners = corners.iter().map(|&[x, y]| at + scale * vec2(x, y));
    painter.add(Shape::convex_polygon(corners.collect(), ink, Stroke::NONE));
}

/// Draws a round hand that pushes: a ball with an arrow.
pub(super) fn hand(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    painter.circle_filled(at - scale * vec2(4.0, 0.0), 7.0 * scale, ink);
    let tip = at + scale * vec2(6.0, 0.0);
    polygon(
        painter,
        tip,
        scale,
        ink,
        &[[0.0, -5.0], [6.0, 0.0], [0.0, 5.0]],
    );
}

/// Draws two jaws that hold something.
pub(super) fn grab(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    let stroke = Stroke::new(3.0 * scale, ink);
    for side in [-1.0, 1.0] {
        let jaw = [[3.0, -9.0], [9.0, -4.0], [9.0, 4.0], [3.0, 9.0]];
        let jaw = jaw.map(|[x, y]| at + scale * vec2(side * x, y));
        painter.add(Shape::line(jaw.to_vec(), stroke));
    }
    painter.circle_filled(at, 4.0 * scale, ink);
}

/// Draws a knife.
pub(super) fn knife(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    polygon(
        painter,
        at,
        scale,
        ink,
        &[
            [-10.0, 8.0],
            [6.0, -10.0],
            [9.0, -7.0],
            [4.0, 2.0],
            [-6.0, 10.0],
        ],
    );
    let handle = [at + scale * vec2(4.0, 2.0), at + scale * vec2(10.0, 9.0)];
    painter.line_segment(handle, Stroke::new(4.0 * scale, ink));
}

/// Draws a pin.
pub(super) fn pin(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    painter.circle_filled(at - scale * vec2(0.0, 5.0), 6.0 * scale, ink);
    let needle = [at, at + scale * vec2(0.0, 11.0)];
    painter.line_segment(needle, Stroke::new(2.5 * scale, ink));
}

/// Draws three sliders.
pub(super) fn sliders(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    for (y, knob) in [(-6.0, 4.0), (0.0, -4.0), (6.0, 2.0)] {
        let line = [-9.0, 9.0].map(|x| at + scale * vec2(x, y));
        painter.line_segment(line, Stroke::new(2.0 * scale, ink));
        painter.circle_filled(at + scale * vec2(knob, y), 3.2 * scale, ink);
    }
}

/// Draws a broom.
pub(super) fn broom(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    let stick = [at + scale * vec2(8.0, -10.0), at];
    painter.line_segment(stick, Stroke::new(3.0 * scale, ink));
    polygon(
        painter,
        at,
        scale,
        ink,
        &[[-2.0, -3.0], [3.0, 2.0], [-3.0, 10.0], [-10.0, 3.0]],
    );
}

/// Draws a pencil.
pub(super) fn pencil(painter: &Painter, at: Pos2, scale: f32, ink: Color32) {
    polygon(
        painter,
        at,
        scale,
        ink,
        &[[-5.0, 1.0], [5.0, -9.0], [9.0, -5.0], [-1.0, 5.0]],
    );
    polygon(
        painter,
        at,
        scale,
        ink,
        &[[-6.5, 3.0], [-3.0, 6.5], [-9.0, 9.0]],
    );
}

//! The face of a body.

use egui::epaint::{CubicBezierShape, EllipseShape};
use egui::{Color32, Painter, Pos2, Stroke, Vec2, vec2};

/// How a body feels.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Mood {
    /// Looks about.
    Calm,
    /// Is squeezed.
    Wince,
    /// Was just torn.
    Shock,
    /// Is in.
    Beam,
}

/// Where a face is.
#[derive(Copy, Clone, Debug)]
pub struct Place {
    /// Its middle on the screen.
    pub at: Pos2,
    /// To its left eye's outside, in points: its size and how it is turned.
    pub right: Vec2,
    /// Upwards, of the same length.
    pub up: Vec2,
    /// What it looks at, on the screen.
    pub look_at: Pos2,
}

/// Draws a face; `blink` from 0 = open to 1 = shut.
pub fn draw_face(painter: &Painter, place: &Place, mood: Mood, blink: f32) {
    let ink = Color32::from_rgb(74, 44, 42);
    let point = |x: f32, y: f32| place.at + x * place.right + y * place.up;
    let unit = place.right.length();
    if unit < 5.0 {
        return;
    }
    let line = Stroke::new((0.07 * unit).max(1.5), ink);
    let turn = place.right.angle();
    for side in [-1.0, 1.0] {
        let eye = point(0.42 * side, 0.18);
        match mood {
            Mood::Wince => {
                // > <
                let (outer, inner) = (0.60 * side, 0.28 * side);
                let bend = point(inner, 0.18);
                painter.line_segment([point(outer, 0.32), bend], line);
                painter.line_segment([bend, point(outer, 0.04)], line);
                painter.circle_filled(bend, 0.5 * line.width, ink);
            }
            // ^ ^
            Mood::Beam => arch(painter, line, &point, [0.42 * side, 0.10], 0.28),
            Mood::Calm if blink > 0.6 => arch(painter, line, &point, [0.42 * side, 0.20], -0.12),
            Mood::Calm | Mood::Shock => {
                let is_shocked = mood == Mood::Shock;
                let size = if is_shocked { 0.25 } else { 0.20 };
                let open = if is_shocked { 1.0 } else { 1.0 - blink };
                painter.add(EllipseShape {
                    center: eye,
                    radius: vec2(size, 1.15 * size * open) * unit,
                    fill: Color32::WHITE,
                    stroke: line,
                    angle: turn,
                });
                let pupil = if is_shocked { 0.07 } else { 0.125 };
                let way = place.look_at - eye;
                let gaze = way / (way.length() + 0.8 * unit);
                let at = eye + (size - pupil) * unit * vec2(gaze.x, gaze.y * open);
                let pupil = pupil * open.max(0.6);
                painter.circle_filled(at, pupil * unit, ink);
                let glint = at + vec2(-0.35, -0.4) * pupil * unit;
                painter.circle_filled(glint, 0.35 * pupil * unit, Color32::WHITE);
            }
        }
        let rosy = if mood == Mood::Beam { 110 } else { 70 };
        let blush = Color32::from_rgba_unmultiplied(240, 90, 90, rosy);
        painter.add(EllipseShape {
            angle: turn,
            ..EllipseShape::filled(point(0.68 * side, -0.12), vec2(0.14, 0.09) * unit, blush)
        });
    }
    if mood == Mood::Wince {
        draw_sweat(painter, &point, unit);
    }
    match mood {
        Mood::Calm => curve(
            painter,
            line,
            [
                point(-0.14, -0.16),
                point(-0.08, -0.28),
                point(0.08, -0.28),
                point(0.14, -0.16),
            ],
        ),
        Mood::Wince => curve(
            painter,
            line,
            [
                point(-0.20, -0.22),
                point(-0.08, -0.08),
                point(0.08, -0.38),
                point(0.20, -0.22),
            ],
        ),
        Mood::Shock => {
            let mouth = vec2(0.11, 0.16) * unit;
            painter.add(EllipseShape {
                angle: turn,
                ..EllipseShape::filled(point(0.0, -0.28), mouth, ink)
            });
        }
        Mood::Beam => {
            let mut outline: Vec<Pos2> = vec![point(-0.26, -0.10)];
            for step in 0..=12 {
                let angle = std::f32::consts::PI * step as f32 / 12.0;
                outline.push(point(-0.26 * angle.cos(), -0.10 - 0.30 * angle.sin()));
            }
            let shape = egui::Shape::convex_polygon(outline, ink, Stroke::NONE);
            painter.add(shape);
            let tongue = Color32::from_rgb(240, 110, 110);
            painter.add(EllipseShape {
                angle: turn,
                ..EllipseShape::filled(point(0.0, -0.31), vec2(0.12, 0.07) * unit, tongue)
            });
        }
    }
}

/// An arch over a place, as an eye that is shut; `rise` < 0 hangs down.
fn arch(
    painter: &Painter,
    stroke: Stroke,
    point: &impl Fn(f32, f32) -> Pos2,
    [x, y]: [f32; 2],
    rise: f32,
) {
    let points = [[-0.17, 0.0], [-0.12, rise], [0.12, rise], [0.17, 0.0]];
    let points = points.map(|[across, up]| point(x + across, y + up));
    curve(painter, stroke, points);
}

/// A drop at the temple.
fn draw_sweat(painter: &Painter, point: &impl Fn(f32, f32) -> Pos2, unit: f32) {
    let water = Color32::from_rgb(150, 210, 240);
    let outline = [
        [0.0, 0.20],
        [0.08, 0.02],
        [0.05, -0.06],
        [-0.05, -0.06],
        [-0.08, 0.02],
    ];
    let corners = outline.map(|[x, y]| point(0.80 + x, 0.42 + y));
    let rim = Stroke::new((0.025 * unit).max(1.0), Color32::from_rgb(74, 120, 160));
    painter.add(egui::Shape::convex_polygon(corners.to_vec(), water, rim));
}

fn curve(painter: &Painter, stroke: Stroke, points: [Pos2; 4]) {
    let fill = Color32::TRANSPARENT;
    painter.add(CubicBezierShape::from_points_stroke(
        points, false, fill, stroke,
    ));
    for end in [points[0], points[3]] {
        painter.circle_filled(end, 0.5 * stroke.width, stroke.color);
    }
}

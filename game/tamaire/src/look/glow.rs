//! Progress shown at the basket. While a body rests inside, a line grows around the basket until it closes.
//! After a win the bars of the basket glow.

use super::DrawOptions;
use app_shell::View;
use egui::{Color32, Painter, Pos2, Rect, Shape as Drawn, Stroke, pos2, vec2};
use fuwafuwa::{Dim2, MotionType, Rotation, Shape, Vec2};
use tamaire_play::Round;

/// Colour of the glowing bars of a basket.
const GOLD: Color32 = Color32::from_rgb(255, 205, 70);

/// Draws the progress line around the basket and, after a win, the glow of its bars.
pub(super) fn draw(painter: &Painter, round: &Round<Dim2>, look: &DrawOptions) {
    let (progress, view) = (round.progress(), &look.view);
    let held = round.share_held();
    if held == 0.0 {
        return;
    }
    if progress.outcome.is_some() {
        let breath = if look.reduced_motion {
            0.5
        } else {
            0.5 + 0.5 * (5.0 * look.time).sin() as f32
        };
        for (_, obstacle) in round.world().rigid_bodies() {
            if obstacle.motion_type() == MotionType::Fixed {
                shine(painter, view, obstacle.shape(), 0.55 + 0.45 * breath);
            }
        }
    }
    for basket in round.baskets() {
        let Shape::Box { centre, half } = basket.region else {
            continue;
        };
        let width = 0.035 * view.scale;
        let line = along_box(view, centre, half, held);
        painter.add(Drawn::line(
            line.clone(),
            Stroke::new(width, Color32::WHITE),
        ));
        painter.add(Drawn::line(line, Stroke::new(0.6 * width, look.theme.good)));
    }
}

/// Returns the first `share` of the outline of a box, clockwise from the middle of its top.
fn along_box(view: &View, centre: Vec2, half: Vec2, share: f32) -> Vec<Pos2> {
    let size = 2.0 * view.scale * vec2(half.x, half.y);
    let rect = Rect::from_center_size(view.to_screen(centre.extend(0.0)), size);
    let corners = [
        rect.center_top(),
        rect.right_top(),
        rect.right_bottom(),
        rect.left_bottom(),
        rect.left_top(),
        rect.center_top(),
    ];
    let mut left = share * 2.0 * (rect.width() + rect.height());
    let mut line = vec![corners[0]];
    for pair in corners.windows(2) {
        let length = pair[0].distance(pair[1]);
        let part = (left / length.max(1e-3)).min(1.0);
        line.push(pair[0] + part * (pair[1] - pair[0]));
        left -= length;
        if left <= 0.0 {
            break;
        }
    }
    line
}

/// Draws a glow around a shape; the glow fades with the distance from the shape.
fn shine(painter: &Painter, view: &View, shape: Shape<Dim2>, strength: f32) {
    let on_screen = |at: Vec2| view.to_screen(at.extend(0.0));
    let layers = [(0.02, 60), (0.05, 36), (0.09, 22), (0.14, 12)];
    for (reach, alpha) in layers {
        let [red, green, blue, _] = GOLD.to_array();
        let light =
            Color32::from_rgba_unmultiplied(red, green, blue, alpha).gamma_multiply(strength);
        match shape {
            Shape::HalfSpace { .. } => {}
            Shape::Capsule { from, to, radius } => {
                let (from, to) = (on_screen(from), on_screen(to));
                let radius = (radius + reach) * view.scale;
                painter.add(Drawn::convex_polygon(
                    bar(from, to, radius),
                    light,
                    Stroke::NONE,
                ));
            }
            Shape::Box { centre, half } => {
                let half = view.scale * (vec2(half.x, half.y) + vec2(reach, reach));
                let rect = Rect::from_center_size(on_screen(centre), 2.0 * half);
                painter.rect_filled(rect, reach * view.scale, light);
            }
            Shape::OrientedBox {
                centre,
                half,
                rotation,
            } => {
                let corners = corners(view, centre, half + Vec2::splat(reach), rotation);
                painter.add(Drawn::convex_polygon(corners, light, Stroke::NONE));
            }
            Shape::Ball { centre, radius } => {
                let radius = (radius + reach) * view.scale;
                painter.circle_filled(on_screen(centre), radius, light);
            }
        }
    }
}

/// Returns the corners of a rotated box.
pub(super) fn corners(view: &View, centre: Vec2, half: Vec2, rotation: Rotation) -> Vec<Pos2> {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let corners = corners.map(|[x, y]| {
        let own = Vec2::new(x * half.x, y * half.y);
        view.to_screen((centre + rotation.apply(own)).extend(0.0))
    });
    corners.into()
}

/// Returns the outline of a capsule.
pub(super) fn bar(from: Pos2, to: Pos2, radius: f32) -> Vec<Pos2> {
    let turn = (to - from).angle();
    let end = |middle: Pos2, first: f32| {
        (0..=12).map(move |step| {
            let angle = first + std::f32::consts::PI * step as f32 / 12.0;
            pos2(
                middle.x + radius * angle.cos(),
                middle.y + radius * angle.sin(),
            )
        })
    };
    let quarter = std::f32::consts::FRAC_PI_2;
    end(to, turn - quarter)
        .chain(end(from, turn + quarter))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_closes_at_full_share() {
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(200.0, 100.0));
        let view = View {
            rect,
            centre: [0.0; 2],
            scale: 50.0,
            space: None,
        };
        let line = |share| along_box(&view, Vec2::ZERO, Vec2::new(1.0, 0.5), share);
        assert_eq!(line(1.0).first(), line(1.0).last());
        assert_eq!(line(0.5).last(), Some(&pos2(100.0, 75.0)));
    }
}

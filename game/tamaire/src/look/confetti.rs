//! Confetti after a win.

use app_shell::View;
use egui::{Color32, Painter, Pos2, Shape, Stroke, Vec2, vec2};
use fuwafuwa::Vec3;

/// Number of confetti pieces.
const COUNT: usize = 140;
/// Terminal falling speed [m/s].
const FALL: f32 = 0.55;
/// Colours of confetti. Each colour is drawn with a different shape.
const PAPER: [Color32; 5] = [
    Color32::from_rgb(240, 108, 98),
    Color32::from_rgb(255, 190, 61),
    Color32::from_rgb(87, 168, 200),
    Color32::from_rgb(143, 196, 106),
    Color32::from_rgb(190, 130, 200),
];

/// Confetti after a win.
#[derive(Clone, Debug, Default)]
pub struct Confetti {
    pieces: Vec<ConfettiPiece>,
}

/// One piece of confetti.
#[derive(Copy, Clone, Debug)]
struct ConfettiPiece {
    at: Vec3,
    velocity: Vec2,
    /// Rotation angle of the piece [rad].
    angle: f32,
    /// Angular velocity of the piece [rad/s].
    angular_velocity: f32,
    kind: usize,
    left: f32,
}

impl Confetti {
    /// Throws confetti up from the two lower corners of `room` [m].
    pub fn rain(&mut self, room: [Vec3; 2], random: &mut fastrand::Rng) {
        let mut any = |low: f32, high: f32| low + (high - low) * random.f32();
        let [low, high] = room;
        let height = high.y - low.y;
        self.pieces = (0..COUNT)
            .map(|index| {
                let side = if index % 2 == 0 { 1.0 } else { -1.0 };
                let from = if side > 0.0 { low.x } else { high.x };
                ConfettiPiece {
                    at: Vec3::new(from, low.y + 0.2 * height, 0.0),
                    velocity: vec2(side * any(0.6, 6.4), any(1.6, 4.6)) * 0.5 * height,
                    angle: any(0.0, 6.0),
                    angular_velocity: any(-9.0, 9.0),
                    kind: index / 2 % PAPER.len(),
                    left: any(2.5, 4.5),
                }
            })
            .collect();
    }

    /// Advances the confetti by `seconds`.
    pub fn pass(&mut self, seconds: f32) {
        for paper in &mut self.pieces {
            let slower = (1.0 - 2.4 * seconds).max(0.0);
            paper.velocity = (paper.velocity + vec2(0.0, FALL)) * slower - vec2(0.0, FALL);
            // Sideways sway of falling paper.
            let sway = 0.25 * (1.5 * paper.angle).sin();
            paper.at.x += (paper.velocity.x + sway) * seconds;
            paper.at.y += paper.velocity.y * seconds;
            paper.angle += paper.angular_velocity * seconds;
            paper.left -= seconds;
        }
        self.pieces.retain(|paper| paper.left > 0.0);
    }

    /// Draws the confetti.
    pub fn draw(&self, painter: &Painter, view: &View) {
        for paper in &self.pieces {
            let colour = PAPER[paper.kind].gamma_multiply(paper.left.min(1.0));
            let size = 0.022 * view.scale;
            let middle = view.to_screen(paper.at);
            // Paper that tumbles is seen face-on and edge-on in turn.
            let thin = 0.25 + 0.75 * (1.3 * paper.angle).cos().abs();
            let (sin, cos) = paper.angle.sin_cos();
            let point = |x: f32, y: f32| -> Pos2 {
                let (x, y) = (size * x, size * y * thin);
                middle + vec2(cos * x - sin * y, sin * x + cos * y)
            };
            let corners: Vec<Pos2> = match paper.kind {
                0 => vec![
                    point(-1.0, -0.6),
                    point(1.0, -0.6),
                    point(1.0, 0.6),
                    point(-1.0, 0.6),
                ],
                1 => vec![point(0.0, -1.0), point(0.9, 0.7), point(-0.9, 0.7)],
                2 => vec![
                    point(0.0, -1.1),
                    point(0.8, 0.0),
                    point(0.0, 1.1),
                    point(-0.8, 0.0),
                ],
                3 => vec![
                    point(-1.5, -0.25),
                    point(1.5, -0.25),
                    point(1.5, 0.25),
                    point(-1.5, 0.25),
                ],
                _ => (0..8)
                    .map(|step| {
                        let (y, x) = (std::f32::consts::TAU * step as f32 / 8.0).sin_cos();
                        point(0.7 * x, 0.7 * y)
                    })
                    .collect(),
            };
            painter.add(Shape::convex_polygon(corners, colour, Stroke::NONE));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn confetti_rises_falls_and_disappears() {
        let mut confetti = Confetti::default();
        let room = [Vec3::new(-1.6, -1.0, 0.0), Vec3::new(1.6, 1.0, 0.0)];
        confetti.rain(room, &mut fastrand::Rng::with_seed(1));
        let height = |confetti: &Confetti| {
            let sum: f32 = confetti.pieces.iter().map(|paper| paper.at.y).sum();
            sum / confetti.pieces.len() as f32
        };
        let start = height(&confetti);
        (0..40).for_each(|_| confetti.pass(0.02));
        let top = height(&confetti);
        (0..60).for_each(|_| confetti.pass(0.02));
        assert!(top > start + 0.4 && height(&confetti) < top - 0.3);
        (0..200).for_each(|_| confetti.pass(0.02));
        assert!(confetti.pieces.is_empty());
    }
}

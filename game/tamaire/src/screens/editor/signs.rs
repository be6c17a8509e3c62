//! Signs of the things that can be added to a level.

use super::super::icons;
use app_shell::Theme;
use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Vec2, vec2};
use tamaire_maker::items::Kind;

/// Colours of the signs.
struct Ink {
    line: Stroke,
    wood: Color32,
    glass: Color32,
    soft: Color32,
    hand: Color32,
}

/// Draws the sign of a kind of thing, about 20 points wide at scale 1.
pub(super) fn draw(painter: &Painter, theme: &Theme, at: Pos2, scale: f32, kind: Kind) {
    let ink = Ink {
        line: Stroke::new(1.6 * scale, theme.ink),
        wood: Color32::from_rgb(222, 178, 110),
        glass: Color32::from_rgba_unmultiplied(150, 205, 225, 120),
        soft: theme.material(1),
        hand: theme.hand(0),
    };
    let pen = Pen {
        painter,
        at,
        scale,
        ink,
    };
    pen.draw(theme, kind);
}

struct Pen<'a> {
    painter: &'a Painter,
    at: Pos2,
    scale: f32,
    ink: Ink,
}

impl Pen<'_> {
    fn point(&self, [x, y]: [f32; 2]) -> Pos2 {
        self.at + self.scale * vec2(x, y)
    }

    fn line(&self, from: [f32; 2], to: [f32; 2]) {
        let ends = [self.point(from), self.point(to)];
        self.painter.line_segment(ends, self.ink.line);
    }

    fn path(&self, points: &[[f32; 2]]) {
        let points = points.iter().map(|&point| self.point(point)).collect();
        self.painter.line(points, self.ink.line);
    }

    fn disc(&self, middle: [f32; 2], radius: f32, fill: Color32) {
        let middle = self.point(middle);
        self.painter
            .circle(middle, self.scale * radius, fill, self.ink.line);
    }

    fn board(&self, middle: [f32; 2], size: [f32; 2], fill: Color32) {
        let place = Rect::from_center_size(self.point(middle), self.scale * Vec2::from(size));
        self.painter
            .rect(place, 2.0, fill, self.ink.line, StrokeKind::Middle);
    }

    fn shape(&self, corners: &[[f32; 2]], fill: Color32) {
        let corners = corners.iter().map(|&corner| self.point(corner)).collect();
        let shape = Shape::convex_polygon(corners, fill, self.ink.line);
        self.painter.add(shape);
    }

    /// Draws a head of an arrow that points to `tip`, seen from `from`.
    fn arrow(&self, from: [f32; 2], tip: [f32; 2]) {
        let way = (Vec2::from(tip) - Vec2::from(from)).normalized();
        let (back, across) = (Vec2::from(tip) - 4.0 * way, 3.0 * way.rot90());
        self.line(from, tip);
        self.path(&[(back + across).into(), tip, (back - across).into()]);
    }

    fn draw(&self, theme: &Theme, kind: Kind) {
        let Ink {
            wood,
            glass,
            soft,
            hand,
            ..
        } = self.ink;
        match kind {
            Kind::Body(..) => {
                self.disc([0.0, 0.0], 8.5, soft);
                for x in [-3.0, 3.0] {
                    let eye = self.point([x, -1.0]);
                    self.painter.circle_filled(eye, 1.4 * self.scale, theme.ink);
                }
            }
            Kind::Wall => self.board([0.0, 0.0], [19.0, 8.0], wood),
            Kind::Ball => self.disc([0.0, 0.0], 8.0, wood),
            Kind::Bar => {
                let ends = [[-8.0, 5.0], [8.0, -5.0]].map(|end| self.point(end));
                self.painter
                    .line_segment(ends, Stroke::new(7.0 * self.scale, wood));
            }
            Kind::Glass => self.board([0.0, 0.0], [9.0, 19.0], glass),
            Kind::Curtain => {
                for x in [-6.0, -2.0, 2.0, 6.0] {
                    self.path(&[[x, -9.0], [x + 1.5, -3.0], [x - 1.5, 3.0], [x, 9.0]]);
                }
            }
            Kind::Basket => icons::basket(self.painter, self.at, self.scale, theme.ink),
            Kind::Plank => self.board([0.0, 0.0], [20.0, 4.0], wood),
            Kind::SeeSaw => {
                self.shape(&[[0.0, 0.0], [5.0, 9.0], [-5.0, 9.0]], wood);
                self.shape(
                    &[[-10.0, 3.0], [10.0, -5.0], [10.0, -2.0], [-10.0, 6.0]],
                    wood,
                );
            }
            Kind::Rope => self.path(&[[-9.0, -8.0], [-3.0, 1.0], [3.0, -1.0], [9.0, 8.0]]),
            Kind::Spring => self.path(&[
                [-10.0, 0.0],
                [-6.0, -6.0],
                [-2.0, 6.0],
                [2.0, -6.0],
                [6.0, 6.0],
                [10.0, 0.0],
            ]),
            Kind::Pin => icons::pin(self.painter, self.at, self.scale, theme.ink),
            Kind::Door => {
                self.board([-3.0, 2.0], [5.0, 15.0], wood);
                self.arrow([6.0, 7.0], [6.0, -8.0]);
            }
            Kind::Lift => {
                self.board([0.0, 5.0], [18.0, 4.0], wood);
                self.arrow([-4.0, 0.0], [-4.0, -9.0]);
                self.arrow([4.0, -9.0], [4.0, 0.0]);
            }
            Kind::Paddle => {
                self.shape(
                    &[[-10.0, -1.5], [10.0, -1.5], [10.0, 1.5], [-10.0, 1.5]],
                    wood,
                );
                self.shape(
                    &[[-1.5, -10.0], [1.5, -10.0], [1.5, 10.0], [-1.5, 10.0]],
                    wood,
                );
            }
            Kind::Wind => {
                for (y, long) in [(-6.0, 8.0), (0.0, 10.0), (6.0, 7.0)] {
                    self.arrow([-9.0, y], [long, y]);
                }
            }
            Kind::Planet => {
                self.disc([0.0, 0.0], 5.0, soft);
                self.path(&[[-10.0, 3.0], [-4.0, 5.0], [4.0, 1.0], [10.0, -4.0]]);
            }
            Kind::Button => {
                self.board([0.0, 6.0], [18.0, 4.0], wood);
                self.board([0.0, 1.0], [10.0, 5.0], theme.accent);
            }
            Kind::Knife => icons::knife(self.painter, self.at, self.scale, theme.ink),
            Kind::Saw => {
                self.disc([0.0, 0.0], 6.0, wood);
                for k in 0..8 {
                    let way = Vec2::angled(std::f32::consts::TAU * k as f32 / 8.0);
                    self.line((6.0 * way).into(), (10.0 * way).into());
                }
            }
            Kind::SecondHand => {
                self.disc([-4.0, 2.0], 5.5, hand);
                self.disc([5.0, -2.0], 5.5, theme.hand(1));
            }
            Kind::Fork => {
                for x in [-6.0, 0.0, 6.0] {
                    self.disc([x, 0.0], 3.0, hand);
                }
            }
            Kind::Tongs => {
                self.disc([0.0, -6.0], 3.5, hand);
                self.disc([0.0, 6.0], 3.5, hand);
                self.arrow([7.0, -8.0], [7.0, -2.0]);
                self.arrow([7.0, 8.0], [7.0, 2.0]);
            }
        }
    }
}

//! Drawn face of a body, made of coloured polygons. In 2D the polygons are painted directly, in 3D they are
//! projected onto the skin.

use app_shell::View;
use egui::{Color32, Painter, Pos2, Shape, Stroke};
use fuwafuwa::glam::vec2;
use fuwafuwa::{PieceId, Vec2, Vec3};
use fuwafuwa_render::{Mark, Sticker};
use std::f32::consts::{PI, TAU};

/// Line width of a drawn face, in units of the face's size.
const LINE: f32 = 0.07;
/// Minimum line width of a drawn face on the screen [points].
const THIN: f32 = 1.5;
/// Minimum size of a drawn face on the screen [points]. Smaller faces are not drawn.
const LEAST: f32 = 5.0;

/// Expression of a body's drawn face.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Mood {
    /// Expression of a relaxed body that looks around.
    Calm,
    /// Expression of a body that is squeezed or in pain.
    Wince,
    /// Expression of a body that was just torn.
    Shock,
    /// Expression of a body that was torn near its drawn face, or that has lost a large part.
    Sad,
    /// Expression of a body in the basket.
    Beam,
}

impl Mood {
    /// Returns the happy expression nearest to this one.
    pub(super) fn happy(self) -> Self {
        match self {
            Self::Calm | Self::Wince | Self::Shock | Self::Sad => Self::Calm,
            Self::Beam => Self::Beam,
        }
    }
}

/// Current drawn face of a body.
#[derive(Copy, Clone, Debug)]
pub struct Face {
    /// Index of the body in the world.
    pub body: usize,
    /// Piece that carries the drawn face.
    pub piece: PieceId,
    /// Centre of the drawn face [m]. In 3D the centre is inside the body.
    pub at: Vec3,
    /// Axes of the drawn face: to the right as seen, up, and outwards. The length of each axis is the size of
    /// the face [m].
    pub axes: [Vec3; 3],
    /// Expression of the drawn face.
    pub mood: Mood,
    /// Closing of the eyelids, from 0 (open) to 1 (shut).
    pub blink: f32,
    /// Point that the eyes look at [m].
    pub look_at: Vec3,
}

impl Face {
    /// Paints the drawn face in a 2D view.
    pub fn paint(&self, painter: &Painter, view: &View) {
        let [right, up, _] = self
            .axes
            .map(|axis| view.scale * egui::vec2(axis.x, -axis.y));
        let unit = right.length();
        if unit < LEAST {
            return;
        }
        let at = view.to_screen(self.at);
        for mark in self.marks(LINE.max(THIN / unit)) {
            let corners = mark.outline.iter().map(|[x, y]| at + *x * right + *y * up);
            let corners: Vec<Pos2> = corners.collect();
            let [red, green, blue, alpha] = mark.colour.map(|k| (255.0 * k + 0.5) as u8);
            let colour = Color32::from_rgba_unmultiplied(red, green, blue, alpha);
            painter.add(Shape::convex_polygon(corners, colour, Stroke::NONE));
        }
    }

    /// Returns the drawn face as a [`Sticker`], which the renderer projects onto the skin of a 3D body.
    pub fn sticker(&self) -> Sticker {
        Sticker {
            body: self.body,
            piece: self.piece,
            origin: self.at,
            axes: self.axes,
            marks: self.marks(LINE),
        }
    }

    /// Returns the polygons of the drawn face. `line` is the line width in units of the face's size.
    fn marks(&self, line: f32) -> Vec<Mark> {
        let mut pen = Pen {
            line,
            marks: Vec::new(),
        };
        for side in [-1.0, 1.0] {
            self.draw_eye(&mut pen, side);
            let rosy = if self.mood == Mood::Beam { 0.43 } else { 0.27 };
            let blush = with_alpha(rgb(240, 90, 90), rosy);
            pen.area(
                ellipse(vec2(0.68 * side, -0.12), vec2(0.14, 0.09)),
                blush,
                0.0,
            );
        }
        self.draw_mouth(&mut pen);
        match self.mood {
            Mood::Wince => draw_sweat(&mut pen),
            Mood::Sad => draw_tear(&mut pen),
            Mood::Calm | Mood::Shock | Mood::Beam => {}
        }
        pen.marks
    }

    fn draw_eye(&self, pen: &mut Pen, side: f32) {
        let eye = vec2(0.42 * side, 0.18);
        match self.mood {
            Mood::Wince => {
                // Eyes squeezed shut, like > <.
                let (outer, inner) = (0.60 * side, 0.28 * side);
                pen.stroke(&[vec2(outer, 0.32), vec2(inner, 0.18), vec2(outer, 0.04)]);
            }
            // Smiling eyes, like ^ ^.
            Mood::Beam => pen.arch(eye.with_y(0.10), 0.28),
            Mood::Calm | Mood::Sad if self.blink > 0.6 => pen.arch(eye.with_y(0.20), -0.12),
            Mood::Calm | Mood::Sad | Mood::Shock => {
                if self.mood == Mood::Sad {
                    // Eyebrows, raised in the middle.
                    pen.stroke(&[vec2(0.64 * side, 0.44), vec2(0.30 * side, 0.58)]);
                }
                let is_shocked = self.mood == Mood::Shock;
                let (size, pupil) = if is_shocked {
                    (0.25, 0.07)
                } else {
                    (0.20, 0.125)
                };
                let open = if is_shocked { 1.0 } else { 1.0 - self.blink };
                let oval = |by: f32| ellipse(eye, vec2(size + by, 1.15 * size * open + by));
                pen.area(oval(0.5 * pen.line), INK, 0.04);
                pen.area(oval(-0.5 * pen.line), WHITE, EYEBALL);
                let gaze = self.gaze(eye);
                let reach = size - pupil;
                let at = eye + vec2(reach * gaze.x, reach * gaze.y * open);
                let pupil = pupil * open.max(0.6);
                pen.on_eyeball(ellipse(at, Vec2::splat(pupil)), INK);
                let glint = at + vec2(-0.35 * pupil, 0.4 * pupil);
                pen.on_eyeball(ellipse(glint, Vec2::splat(0.35 * pupil)), WHITE);
            }
        }
    }

    /// Gaze direction of the eye at `eye`: x to the right and y up, each from −1 to 1.
    fn gaze(&self, eye: Vec2) -> Vec2 {
        let by = self.look_at - self.at;
        let way = self
            .axes
            .map(|axis| by.dot(axis) / axis.dot(axis).max(1e-12));
        let way = Vec3::from(way) - eye.extend(0.0);
        let share = 1.0 / (way.length() + 0.8);
        way.truncate() * share
    }

    fn draw_mouth(&self, pen: &mut Pen) {
        match self.mood {
            Mood::Calm => {
                pen.curve([[-0.14, -0.16], [-0.08, -0.28], [0.08, -0.28], [0.14, -0.16]]);
            }
            Mood::Sad => {
                pen.curve([[-0.15, -0.32], [-0.08, -0.18], [0.08, -0.18], [0.15, -0.32]]);
            }
            Mood::Wince => {
                pen.curve([[-0.20, -0.22], [-0.08, -0.08], [0.08, -0.38], [0.20, -0.22]]);
            }
            Mood::Shock => pen.area(ellipse(vec2(0.0, -0.28), vec2(0.11, 0.16)), INK, 0.0),
            Mood::Beam => {
                let corners = (0..=12).map(|step| {
                    let (sin, cos) = (PI * step as f32 / 12.0).sin_cos();
                    [-0.26 * cos, -0.10 - 0.30 * sin]
                });
                pen.area(corners.collect(), INK, 0.0);
                let tongue = ellipse(vec2(0.0, -0.31), vec2(0.12, 0.07));
                pen.area(tongue, rgb(240, 110, 110), 0.03);
            }
        }
    }
}

/// Colour of outlines, pupils and mouths in drawn faces.
const INK: [f32; 4] = rgb(74, 44, 42);
/// Colour of eyeballs and glints in drawn faces.
const WHITE: [f32; 4] = [1.0; 4];
/// Height of an eyeball above the surface of the drawn face, in units of the face's size.
const EYEBALL: f32 = 0.13;

struct Pen {
    /// Line width in units of the size of the drawn face.
    line: f32,
    marks: Vec<Mark>,
}

impl Pen {
    /// Fills an outline.
    fn area(&mut self, outline: Vec<[f32; 2]>, colour: [f32; 4], bulge: f32) {
        self.marks.push(Mark {
            outline,
            colour,
            bulge,
            lift: 0.0,
        });
    }

    /// Fills an outline that lies on an eyeball.
    fn on_eyeball(&mut self, outline: Vec<[f32; 2]>, colour: [f32; 4]) {
        self.area(outline, colour, 0.02);
        if let Some(mark) = self.marks.last_mut() {
            mark.lift = 0.85 * EYEBALL;
        }
    }

    /// Draws a polyline with round ends.
    fn stroke(&mut self, points: &[Vec2]) {
        for pair in points.windows(2) {
            let along = pair[1] - pair[0];
            let turn = along.y.atan2(along.x);
            let corners = (0..16).map(|step| {
                // The first eight corners form half a circle around the end of the line, the last eight
                // around its beginning.
                let end = pair[1 - step / 8];
                let angle = turn - 0.5 * PI + PI * (step - step / 8) as f32 / 7.0;
                (end + vec2(angle.cos(), angle.sin()) * (0.5 * self.line)).to_array()
            });
            self.area(corners.collect(), INK, 0.0);
        }
    }

    /// Draws a cubic Bézier curve.
    fn curve(&mut self, points: [[f32; 2]; 4]) {
        let [a, b, c, d] = points.map(Vec2::from);
        let points = (0..=10).map(|step| {
            let (t, s) = (step as f32 / 10.0, 1.0 - step as f32 / 10.0);
            let ends = a * (s * s * s) + d * (t * t * t);
            let between = b * (3.0 * s * s * t) + c * (3.0 * s * t * t);
            ends + between
        });
        self.stroke(&points.collect::<Vec<_>>());
    }

    /// Draws an arch at `at`, for example a shut eye; negative `rise` bends it downwards.
    fn arch(&mut self, at: Vec2, rise: f32) {
        let points = [[-0.17, 0.0], [-0.12, rise], [0.12, rise], [0.17, 0.0]];
        self.curve(points.map(|by| (at + Vec2::from(by)).into()));
    }
}

/// Draws a drop of sweat at the temple.
fn draw_sweat(pen: &mut Pen) {
    draw_drop(pen, vec2(0.80, 0.42), 1.0);
}

/// Draws a tear below an eye.
fn draw_tear(pen: &mut Pen) {
    draw_drop(pen, vec2(0.52, -0.22), 0.8);
}

/// Draws a drop of water at `at`.
fn draw_drop(pen: &mut Pen, at: Vec2, scale: f32) {
    let drop = |size: f32| {
        // Corners of the drop, counterclockwise from its tip.
        let outline = [
            [0.0, 0.20],
            [-0.08, 0.02],
            [-0.05, -0.06],
            [0.05, -0.06],
            [0.08, 0.02],
        ];
        outline
            .map(|by| (at + Vec2::from(by) * (scale * size)).to_array())
            .to_vec()
    };
    pen.area(drop(1.2), rgb(74, 120, 160), 0.02);
    pen.area(drop(1.0), rgb(150, 210, 240), 0.05);
}

fn ellipse(at: Vec2, size: Vec2) -> Vec<[f32; 2]> {
    let corners = (0..28).map(|step| {
        let (sin, cos) = (TAU * step as f32 / 28.0).sin_cos();
        (at + size * vec2(cos, sin)).to_array()
    });
    corners.collect()
}

const fn rgb(red: u8, green: u8, blue: u8) -> [f32; 4] {
    [
        red as f32 / 255.0,
        green as f32 / 255.0,
        blue as f32 / 255.0,
        1.0,
    ]
}

fn with_alpha([red, green, blue, _]: [f32; 4], alpha: f32) -> [f32; 4] {
    [red, green, blue, alpha]
}

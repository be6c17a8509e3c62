//! A face on a body, from ellipses and curves.

use crate::paper::ellipse;
use crate::{Frame, Painter, Role, Spot};
use fuwafuwa::shape::Vector;
use fuwafuwa::vector::{dot, length, minus, plus, scaled};
use fuwafuwa::{Body, Dim2};

/// What a face feels.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum Mood {
    /// Nothing much: it looks and smiles a little.
    #[default]
    Calm,
    /// It is squeezed: eyes shut tight.
    Wince,
    /// It tears: eyes and mouth wide open.
    Shock,
    /// It is in: it laughs.
    Beam,
}

/// A face, which stretches and turns with what it is on.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Face {
    /// Its middle [m].
    pub at: Vector,
    /// From the middle to its right side, as we see it [m].
    pub right: Vector,
    /// From the middle to its top [m].
    pub up: Vector,
    /// What it feels.
    pub mood: Mood,
    /// What it looks at [m].
    pub look_at: Vector,
}

impl Face {
    /// A face in the middle of the largest piece of a body, half as wide as that.
    ///
    /// Nothing when the nodes of that piece lie on one another, so that it has no sides.
    pub fn on(body: &Body<Dim2>, mood: Mood, look_at: Vector) -> Option<Self> {
        let views = body.piece_views().into_iter();
        let piece = views.max_by(|a, b| a.mass.total_cmp(&b.mass))?;
        let voxel = body.grid().voxel_size();
        let nodes = body.mesh().nodes();
        let nodes = nodes.filter(|&(id, _)| body.pieces().of_node(id) == piece.number);
        let nodes: Vec<Place> = nodes
            .map(|(id, node)| {
                let (now, _, mass) = body.node_state(id);
                let rest = node.at.map(|k| k as f32 * voxel);
                Place { rest, now, mass }
            })
            .collect();
        let mut middle = mean(&nodes, |place| place.rest, |place| place.mass);
        let inside = body.mesh().owner(middle.map(|k| (k / voxel) as i32));
        if inside.is_none_or(|element| body.pieces().of_element(element) != piece.number) {
            let far = |place: &Place| length(minus(place.rest, middle));
            middle = nodes.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?.rest;
        }
        let share = piece.mass / body.total_mass() as f32;
        let area = share * body.grid().solid_count() as f32 * voxel * voxel;
        let half = 0.5 * (area / std::f32::consts::PI).sqrt();
        let motion = Motion::near(&nodes, middle, half)?;
        let at = motion.moved(middle);
        let side = |way: Vector| minus(motion.moved(plus(middle, scaled(way, half))), at);
        Some(Self {
            at,
            right: side([1.0, 0.0, 0.0]),
            up: side([0.0, 1.0, 0.0]),
            mood,
            look_at,
        })
    }

    /// Paints it.
    pub fn paint(&self, painter: &mut Painter, frame: Frame) {
        let pen = Pen {
            face: self,
            frame,
            gaze: self.gaze(),
        };
        for side in [-1.0, 1.0] {
            pen.area(painter, [0.74 * side, -0.16], [0.2, 0.13], Role::Cheek);
        }
        match self.mood {
            Mood::Calm => {
                pen.open_eyes(painter, [0.21, 0.27], 0.135);
                pen.curve(painter, [-0.2, -0.26], [0.0, -0.46], [0.2, -0.26], 1.0);
            }
            Mood::Wince => {
                for side in [-1.0, 1.0] {
                    let corners = [[0.62, 0.4], [0.3, 0.2], [0.62, 0.0]];
                    pen.line(painter, &corners.map(|[u, v]| [side * u, v]), 1.2);
                }
                let wave = [
                    [-0.3, -0.4],
                    [-0.15, -0.28],
                    [0.0, -0.4],
                    [0.15, -0.28],
                    [0.3, -0.4],
                ];
                pen.line(painter, &wave, 1.0);
            }
            Mood::Shock => {
                pen.open_eyes(painter, [0.26, 0.33], 0.085);
                pen.area(painter, [0.0, -0.46], [0.17, 0.23], Role::Mouth);
                pen.area(painter, [0.0, -0.57], [0.1, 0.09], Role::Tongue);
                for side in [-1.0, 1.0] {
                    pen.curve(
                        painter,
                        [0.26 * side, 0.66],
                        [0.46 * side, 0.78],
                        [0.66 * side, 0.6],
                        0.9,
                    );
                }
            }
            Mood::Beam => {
                for side in [-1.0, 1.0] {
                    let [from, to] = [0.24, 0.66].map(|u| [u * side, 0.1]);
                    pen.curve(painter, from, [0.45 * side, 0.56], to, 1.3);
                }
                let mouth = ellipse([0.0, -0.22], [0.32, 0.4]).filter(|at| at[1] < -0.2);
                painter.area(mouth.map(|at| pen.spot(at)).collect(), Role::Mouth);
                pen.area(painter, [0.0, -0.5], [0.17, 0.1], Role::Tongue);
            }
        }
    }

    /// How far its eyes turn towards what it looks at, 1 = as far as they can.
    fn gaze(&self) -> Spot {
        let way = minus(self.look_at, self.at);
        let share = |axis: Vector| dot(way, axis) / dot(axis, axis).max(1e-12);
        let [u, v] = [share(self.right), share(self.up)];
        let far = 1.0 + (u * u + v * v).sqrt();
        [1.2 * u / far, 1.2 * v / far]
    }
}

/// Where a node was at rest [m] and where it is now [m].
struct Place {
    rest: Vector,
    now: Vector,
    mass: f32,
}

/// The affine motion that comes closest to that of the nodes near a place.
struct Motion {
    /// A place at rest, and where it is now [m].
    rest: Vector,
    now: Vector,
    /// Where the two axes went.
    axes: [Vector; 2],
}

impl Motion {
    /// By least squares, a node at a distance of `reach` [m] counting a quarter of one at the place.
    fn near(nodes: &[Place], place: Vector, reach: f32) -> Option<Self> {
        let weight = |node: &Place| {
            let far = length(minus(node.rest, place)) / reach;
            node.mass / ((1.0 + far * far) * (1.0 + far * far))
        };
        let rest = mean(nodes, |node| node.rest, weight);
        let now = mean(nodes, |node| node.now, weight);
        let (mut spread, mut moved) = ([0.0; 3], [[0.0; 3]; 2]);
        for node in nodes {
            let [x, y, _] = minus(node.rest, rest);
            let way = scaled(minus(node.now, now), weight(node));
            spread = plus(spread, scaled([x * x, x * y, y * y], weight(node)));
            moved = [
                plus(moved[0], scaled(way, x)),
                plus(moved[1], scaled(way, y)),
            ];
        }
        let [xx, xy, yy] = spread;
        let size = xx * yy - xy * xy;
        (size > 0.0).then(|| Self {
            rest,
            now,
            axes: [
                scaled(
                    minus(scaled(moved[0], yy), scaled(moved[1], xy)),
                    1.0 / size,
                ),
                scaled(
                    minus(scaled(moved[1], xx), scaled(moved[0], xy)),
                    1.0 / size,
                ),
            ],
        })
    }

    fn moved(&self, place: Vector) -> Vector {
        let [x, y, _] = minus(place, self.rest);
        plus(
            self.now,
            plus(scaled(self.axes[0], x), scaled(self.axes[1], y)),
        )
    }
}

fn mean(nodes: &[Place], of: impl Fn(&Place) -> Vector, weight: impl Fn(&Place) -> f32) -> Vector {
    let (mut sum, mut whole) = ([0.0; 3], 0.0);
    for node in nodes {
        sum = plus(sum, scaled(of(node), weight(node)));
        whole += weight(node);
    }
    scaled(sum, 1.0 / whole)
}

/// Draws in the coordinates of a face: from −1 to 1 to the right and upwards.
struct Pen<'a> {
    face: &'a Face,
    frame: Frame,
    gaze: Spot,
}

impl Pen<'_> {
    fn spot(&self, [u, v]: Spot) -> Spot {
        let Face { at, right, up, .. } = *self.face;
        let aside = plus(scaled(right, u), scaled(up, v));
        self.frame.spot(plus(at, aside))
    }

    fn area(&self, painter: &mut Painter, middle: Spot, size: Spot, role: Role) {
        let corners = ellipse(middle, size).map(|at| self.spot(at));
        painter.area(corners.collect(), role);
    }

    fn open_eyes(&self, painter: &mut Painter, size: Spot, pupil: f32) {
        for side in [-1.0, 1.0] {
            let middle = [0.44 * side, 0.18];
            let reach = [size[0] - pupil, size[1] - pupil].map(|room| 0.85 * room);
            let seen = [0, 1].map(|k: usize| middle[k] + reach[k] * self.gaze[k]);
            let rim = size.map(|k| k + 0.035);
            self.area(painter, middle, rim, Role::Ink);
            self.area(painter, middle, size, Role::Paper);
            self.area(painter, seen, [pupil, 1.1 * pupil], Role::Ink);
            let gleam = [seen[0] - 0.35 * pupil, seen[1] + 0.4 * pupil];
            self.area(painter, gleam, [0.33 * pupil; 2], Role::Paper);
        }
    }

    fn curve(&self, painter: &mut Painter, from: Spot, by: Spot, to: Spot, width: f32) {
        let spots: Vec<Spot> = bow(from, by, to).collect();
        self.line(painter, &spots, width);
    }

    fn line(&self, painter: &mut Painter, spots: &[Spot], width: f32) {
        let [right, up] = [self.face.right, self.face.up].map(|axis| dot(axis, axis).sqrt());
        let width = (0.05 * width * (right + up) * self.frame.unit).max(1.0);
        let spots = spots.iter().map(|&at| self.spot(at));
        painter.line(spots.collect(), width, Role::Ink);
    }
}

/// A parabola from one place to another, drawn towards a third.
fn bow(from: Spot, by: Spot, to: Spot) -> impl Iterator<Item = Spot> {
    const STEPS: usize = 12;
    (0..=STEPS).map(move |step| {
        let t = step as f32 / STEPS as f32;
        let s = 1.0 - t;
        [0, 1].map(|k: usize| s * s * from[k] + 2.0 * s * t * by[k] + t * t * to[k])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::{Material, VoxelGrid};

    fn disc() -> Body<Dim2> {
        Body::new(VoxelGrid::ball(24, 1.0).unwrap(), &[Material::default()]).unwrap()
    }

    fn close(a: Vector, b: Vector) -> bool {
        length(minus(a, b)) < 1e-3
    }

    #[test]
    fn a_face_stretches_and_turns_with_its_body() {
        let mut body = disc();
        let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
        for id in nodes {
            // Turned to the left by a quarter, and twice as tall as before.
            let ([x, y, _], velocity, _) = body.node_state(id);
            body.set_node_state(id, [-2.0 * y, x, 0.0], velocity);
        }
        let face = Face::on(&body, Mood::Calm, [0.0; 3]).unwrap();
        let half = face.right[1];
        assert!(close(face.at, [-1.0, 0.5, 0.0]) && half > 0.2 && half < 0.25);
        assert!(close(face.right, [0.0, half, 0.0]) && close(face.up, [-2.0 * half, 0.0, 0.0]));
    }

    #[test]
    fn eyes_follow_what_they_look_at() {
        let face = |look_at| Face::on(&disc(), Mood::Calm, look_at).unwrap();
        assert!(face([9.0, 0.5, 0.0]).gaze()[0] > 0.9);
        assert!(face([0.5, -9.0, 0.0]).gaze()[1] < -0.9);
        assert!(face([0.5, 0.5, 0.0]).gaze()[0].abs() < 0.01);
    }
}

//! Ropes, springs and pins between bodies.

use super::DrawOptions;
use app_shell::View;
use egui::{Color32, Painter, Pos2, Shape, Stroke};
use fuwafuwa::inspect::obstacles;
use fuwafuwa::{Dim, DimVector, JointKind, Layers, Vec3, World};

/// Colours of the rim and of the inside of a rope.
const ROPE: [Color32; 2] = [
    Color32::from_rgb(120, 84, 52),
    Color32::from_rgb(214, 178, 120),
];
/// Width of a rope [m].
const WIDTH: f32 = 0.03;
/// Number of segments of a hanging rope.
const SEGMENTS: usize = 16;
/// Number of turns of a spring.
const TURNS: usize = 9;

/// Shape of a joint on the screen.
enum Figure {
    /// Points along a rope [m].
    Rope(Vec<Vec3>),
    Spring,
    Pin,
}

/// A joint to draw.
pub(super) struct JointFigure {
    /// Positions of the anchors [m].
    ends: [Vec3; 2],
    figure: Figure,
}

/// Draws the joints of a world.
pub(super) fn draw<D: Dim>(painter: &Painter, world: &World<D>, look: &DrawOptions) {
    for joint in figures(world) {
        joint.draw(painter, &look.view);
    }
}

/// Returns the joints of a world. A slack rope hangs down.
pub(super) fn figures<D: Dim>(world: &World<D>) -> impl Iterator<Item = JointFigure> {
    world.joints().filter_map(|(handle, joint)| {
        let anchors = world.joint_anchor_positions(handle).ok()??;
        let ends = anchors.map(DimVector::to_vec3);
        let figure = match joint.definition().kind {
            JointKind::Rope { length } => {
                // A parabola with this sag is about as long as the rope.
                let slack = (length * length - (ends[1] - ends[0]).length_squared()).max(0.0);
                let points = hanging(anchors, (0.375 * slack).sqrt());
                let points = points.enumerate().map(|(step, at)| {
                    // A taut rope passes through obstacles, and its ends may lie in them.
                    let hangs = slack > 0.0 && (1..SEGMENTS).contains(&step);
                    match hangs {
                        true => outside_obstacles(world, at).to_vec3(),
                        false => at.to_vec3(),
                    }
                });
                Figure::Rope(points.collect())
            }
            JointKind::Spring { .. } => Figure::Spring,
            _ => Figure::Pin,
        };
        Some(JointFigure { ends, figure })
    })
}

impl JointFigure {
    /// Draws the joint.
    pub(super) fn draw(&self, painter: &Painter, view: &View) {
        let [from, to] = self.ends;
        let width = view.scale_at(0.5 * (from + to)) * WIDTH;
        let ends = self.ends.map(|at| view.to_screen(at));
        let line = match &self.figure {
            Figure::Rope(points) => points.iter().map(|&at| view.to_screen(at)).collect(),
            Figure::Spring => zigzag(ends, 2.0 * width),
            Figure::Pin => {
                painter.circle(ends[0], width, ROPE[1], Stroke::new(0.4 * width, ROPE[0]));
                return;
            }
        };
        painter.add(Shape::line(line.clone(), Stroke::new(width, ROPE[0])));
        painter.add(Shape::line(line, Stroke::new(0.5 * width, ROPE[1])));
        for end in ends {
            painter.circle_filled(end, 0.9 * width, ROPE[0]);
        }
    }
}

/// Returns points of a parabola between two positions whose middle hangs down by `sag` [m].
fn hanging<V: DimVector>([from, to]: [V; 2], sag: f32) -> impl Iterator<Item = V> {
    (0..=SEGMENTS).map(move |step| {
        let share = step as f32 / SEGMENTS as f32;
        from + (to - from) * share - V::Y * (4.0 * sag * share * (1.0 - share))
    })
}

/// Returns the position, or the nearest one outside of the obstacles: a slack rope lies on the floor.
fn outside_obstacles<D: Dim>(world: &World<D>, at: D::Vector) -> D::Vector {
    let solid = obstacles(world).filter(|body| body.layers().meet(Layers::default()));
    solid.fold(at, |at, body| {
        let (distance, normal) = body.shape().distance(at);
        at - normal * distance.min(0.0)
    })
}

/// Returns a zigzag line between two points that deviates by `width` to both sides [points].
fn zigzag([from, to]: [Pos2; 2], width: f32) -> Vec<Pos2> {
    let across = (to - from).normalized().rot90();
    let steps = 2 * TURNS;
    let place = |step: usize| {
        let side = match step {
            0 => 0.0,
            step if step == steps => 0.0,
            step if step.is_multiple_of(2) => -width,
            _ => width,
        };
        from.lerp(to, step as f32 / steps as f32) + side * across
    };
    (0..=steps).map(place).collect()
}

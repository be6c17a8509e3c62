//! How the devices of a player are taken: what is meant by right and away, and where hands may be.

use egui::Vec2;
use fuwafuwa::Vector;

/// How the devices of a player are taken.
#[derive(Copy, Clone, Debug)]
pub struct Manner {
    /// 1 = usual.
    pub sensitivity: f32,
    /// Whether a stick points at a position in the arena, instead of saying how fast to go.
    pub stick_places: bool,
    /// Low and high corner of where goals may be [m].
    pub arena: [Vector; 2],
    /// In space by how much the camera went around to the right [rad]: what is away from the player goes along the floor,
    /// away from the camera.
    pub turn: Option<f32>,
}

impl Manner {
    /// Which way in the world it is when somebody leans to the right and away; in space, where the camera went around to the
    /// right by `turn` [rad].
    pub fn along(turn: Option<f32>, lean: Vec2) -> Vector {
        let Some(turn) = turn else {
            return [lean.x, lean.y, 0.0];
        };
        let (sin, cos) = turn.sin_cos();
        [
            cos * lean.x - sin * lean.y,
            0.0,
            -sin * lean.x - cos * lean.y,
        ]
    }

    /// The nearest position in the arena. A level in the plane says nothing about the third axis.
    pub(super) fn within(&self, mut position: Vector) -> Vector {
        let [low, high] = self.arena;
        let axes = if self.turn.is_some() { 3 } else { 2 };
        for axis in 0..axes {
            position[axis] = position[axis].clamp(low[axis], high[axis]);
        }
        position
    }

    /// The position in the arena at which a stick points, in space at a height [m].
    pub(super) fn position_of(&self, stick: [f32; 2], height: f32) -> Vector {
        let [low, high] = self.arena;
        let way = Self::along(self.turn, Vec2::from(stick));
        let mut position = [0, 1, 2].map(|axis: usize| {
            0.5 * (low[axis] + high[axis]) + 0.5 * way[axis] * (high[axis] - low[axis])
        });
        if self.turn.is_some() {
            position[1] = height;
        }
        position
    }
}

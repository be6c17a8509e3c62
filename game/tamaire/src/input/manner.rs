//! Interpretation of a player's input: sensitivity, directions, and limits of the hands.

use app_shell::direction::to_world;
use egui::Vec2;
use fuwafuwa::Vec3;
use fuwafuwa::glam::Quat;

/// Interpretation of a player's input.
#[derive(Copy, Clone, Debug)]
pub struct InputMapping {
    /// Sensitivity, 1 = default.
    pub sensitivity: f32,
    /// Whether the position of a stick sets the position of the hand, instead of its speed.
    pub stick_sets_position: bool,
    /// Low and high corner of the box to which goals are limited [m].
    pub arena: [Vec3; 2],
    /// In 3D: rotation of the camera to the right [rad]. "Away from the player" then means along the floor,
    /// away from the camera. `None` in 2D.
    pub turn: Option<f32>,
}

impl InputMapping {
    /// Clamps a position to the arena. In 2D the third axis is ignored.
    pub(super) fn clamp_to_arena(&self, mut position: Vec3) -> Vec3 {
        let [low, high] = self.arena;
        let axes = if self.turn.is_some() { 3 } else { 2 };
        for axis in 0..axes {
            // Not `Vec3::clamp`, which turns NaN into a position.
            position[axis] = position[axis].clamp(low[axis], high[axis]);
        }
        position
    }

    /// Rotates a vector in the plane in which hands move: in 3D along the floor.
    pub(super) fn turned(&self, vector: Vec3, angle: f32) -> Vec3 {
        match self.turn {
            Some(_) => Quat::from_rotation_y(angle) * vector,
            None => Quat::from_rotation_z(angle) * vector,
        }
    }

    /// Converts a stick position to a position in the arena [m]. In 3D the height of the result is `height`
    /// [m].
    pub(super) fn position_of(&self, stick: [f32; 2], height: f32) -> Vec3 {
        let [low, high] = self.arena;
        let way = to_world(self.turn, Vec2::from(stick));
        let position = 0.5 * (low + high) + 0.5 * way * (high - low);
        match self.turn {
            Some(_) => position.with_y(height),
            None => position,
        }
    }
}

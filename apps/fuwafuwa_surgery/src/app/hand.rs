//! Converts input of mouse, keys and sticks into the input of the procedure.

use crate::procedure::{BLUNTEST, Input};
use crate::tools::Tool;
use app_shell::direction::to_world;
use egui::Vec2;
use fuwafuwa::inspect::vector::{plus, scaled};
use fuwafuwa::{Rotation, Vector};
use std::f32::consts::PI;

/// Speed of the hand at full deflection of a key or stick [m/s]: horizontally and vertically.
const PACE: f32 = 0.06;
const RISE: f32 = 0.04;
/// Turning speed of the tool at full deflection [rad/s].
const TURN: f32 = 1.5;

/// Motion that the user requests for a frame.
#[derive(Clone, Debug, Default)]
pub struct HandInput {
    /// Target position for the hand [m]; its height is ignored. `None` keeps the position.
    pub place: Option<Vector>,
    /// Horizontal velocity to the right and away from the camera; length 1 is full speed.
    pub lean: Vec2,
    /// Upward speed; 1 is full speed.
    pub lift: f32,
    /// Immediate change of height [m].
    pub wheel: f32,
    /// Turning speed about three axes: yaw to the left, pitch up, roll to the left; 1 is full speed.
    pub turn: Vector,
    /// Whether the forceps close.
    pub grips: bool,
}

/// Target pose of the hand, and its tool.
#[derive(Clone, Debug)]
pub struct Hand {
    /// Tool in the hand.
    pub tool: Tool,
    /// Edge radius of the knife [µm].
    pub dull: u16,
    /// Target position [m].
    pub goal: Vector,
    /// Yaw, pitch and roll [rad].
    pub turned: Vector,
    grips: bool,
}

impl Hand {
    /// Creates a hand at a position [m] with a tool.
    pub fn at(goal: Vector, tool: Tool) -> Self {
        Self {
            tool,
            dull: Input::default().dull,
            goal,
            turned: [0.0; 3],
            grips: false,
        }
    }

    /// Creates a hand at a position [m] with the tool and rotation of the last input.
    pub fn holding(goal: Vector, last: &Input) -> Self {
        let rotation = last.rotation();
        let [x, y, z] =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| rotation.apply(axis));
        let up = (-z[1]).clamp(-1.0, 1.0).asin();
        let turned = [z[0].atan2(z[2]), up, x[1].atan2(y[1])];
        Self {
            dull: last.dull,
            turned,
            grips: last.grips,
            ..Self::at(goal, last.tool)
        }
    }

    /// Takes up a tool. If it is another one, it enters at `height` [m].
    pub fn take(&mut self, tool: Tool, height: f32) {
        if tool != self.tool {
            self.tool = tool;
            self.goal[1] = height;
        }
    }

    /// Moves the hand for `seconds` within a room, given by two opposite corners [m]. `turn` is the azimuth
    /// of the camera [rad].
    pub fn pass(&mut self, wishes: &HandInput, [low, high]: [Vector; 2], turn: f32, seconds: f32) {
        if let Some([x, _, z]) = wishes.place {
            self.goal = [x, self.goal[1], z];
        }
        let lean = wishes.lean * (1.0 / wishes.lean.length().max(1.0));
        self.goal = plus(self.goal, to_world(Some(turn), lean * PACE * seconds));
        self.goal[1] += wishes.wheel + RISE * wishes.lift.clamp(-1.0, 1.0) * seconds;
        for axis in 0..3 {
            self.goal[axis] = self.goal[axis].clamp(low[axis], high[axis]);
        }
        let by = scaled(wishes.turn, TURN * seconds);
        let [around, up, over] = plus(self.turned, by);
        // Yaw is unlimited; pitch and roll stop at half a turn, upside down.
        self.turned = [wrapped(around), up.clamp(-PI, PI), over.clamp(-PI, PI)];
        self.grips = wishes.grips;
    }

    /// Returns the rotation of the tool.
    pub fn rotation(&self) -> Rotation {
        let [around, up, over] = self.turned;
        let over = Rotation::about([0.0, 0.0, 1.0], over);
        let up = Rotation::about([1.0, 0.0, 0.0], up);
        over.then(up).then(Rotation::about([0.0, 1.0, 0.0], around))
    }

    /// Returns the input for a tick.
    pub fn input(&self) -> Input {
        let input = Input {
            grips: self.grips,
            dull: self.dull.min(BLUNTEST),
            ..Input::default()
        };
        input.at(self.tool, self.goal, self.rotation())
    }
}

/// Returns the equivalent angle between −π and π.
fn wrapped(angle: f32) -> f32 {
    angle - 2.0 * PI * (angle / (2.0 * PI)).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOM: [Vector; 2] = [[-0.1, 0.0, -0.1], [0.1, 0.2, 0.1]];

    fn hand() -> Hand {
        Hand::at([0.0, 0.1, 0.0], Tool::Hook)
    }

    #[test]
    fn hand_moves_in_camera_directions_and_stays_in_the_room() {
        let mut hand = hand();
        let wishes = HandInput {
            lean: egui::vec2(0.0, 9.0),
            wheel: -1.0,
            ..HandInput::default()
        };
        // Seen from the patient's right (+x), away from the camera means to the patient's left (−x).
        hand.pass(&wishes, ROOM, 0.5 * PI, 0.5);
        assert!((hand.goal[0] + 0.03).abs() < 1e-6 && hand.goal[2].abs() < 1e-6);
        assert_eq!(hand.goal[1], 0.0);
        let place = Some([9.0, 9.0, 0.05]);
        let wishes = HandInput {
            place,
            ..HandInput::default()
        };
        hand.pass(&wishes, ROOM, 0.0, 0.0);
        assert_eq!(hand.goal, [0.1, 0.0, 0.05]);
    }

    #[test]
    fn take_raises_the_hand_to_the_entry_height() {
        let mut hand = hand();
        hand.take(Tool::Hook, 0.2);
        assert_eq!(hand.goal[1], 0.1);
        hand.take(Tool::Forceps, 0.2);
        assert_eq!((hand.goal[1], hand.input().tool), (0.2, Tool::Forceps));
    }

    #[test]
    fn yaw_rotates_about_the_vertical_axis() {
        let mut hand = hand();
        let wishes = HandInput {
            turn: [1.0, 0.0, 0.0],
            ..HandInput::default()
        };
        hand.pass(&wishes, ROOM, 0.0, 0.5 * PI / TURN);
        let [x, y, z] = hand.input().rotation().apply([1.0, 0.0, 0.0]);
        assert!(x.abs() < 1e-3 && y.abs() < 1e-3 && (z + 1.0).abs() < 1e-3);
    }

    #[test]
    fn holding_restores_rotation_and_sharpness() {
        let turned = [[0.3, -0.8, 0.5], [-2.9, 1.2, 3.0], [0.0; 3]];
        for turned in turned {
            let before = Hand {
                turned,
                dull: 7,
                ..Hand::at([0.0; 3], Tool::default())
            };
            let after = Hand::holding(before.goal, &before.input());
            for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
                let [was, is] = [&before, &after].map(|hand| hand.rotation().apply(axis));
                let apart = was.iter().zip(is).map(|(a, b)| (a - b).abs());
                assert!(apart.fold(0.0, f32::max) < 1e-3, "{was:?} {is:?}");
            }
            assert_eq!(after.dull, 7);
        }
    }
}

//! Converts input of mouse, keys and sticks into the input of the procedure.

use crate::procedure::{BLUNTEST, Input};
use crate::tools::Tool;
use app_shell::direction::to_world;
use egui::Vec2;
use fuwafuwa::{Rotation, Vec3};
use std::f32::consts::PI;

/// Horizontal speed of the hand at full deflection of a key or stick [m/s].
const PACE: f32 = 0.06;
/// Vertical speed of the hand at full deflection of a key or stick [m/s].
const RISE: f32 = 0.04;
/// Turning speed of the tool at full deflection [rad/s].
const TURN: f32 = 1.5;

/// Motion of the hand that the user requests in a frame.
#[derive(Clone, Debug, Default)]
pub struct HandInput {
    /// Target position for the hand [m]; its height is ignored. `None` keeps the position.
    pub place: Option<Vec3>,
    /// Horizontal velocity to the right and away from the camera; length 1 is full speed.
    pub lean: Vec2,
    /// Upward speed; 1 is full speed.
    pub lift: f32,
    /// Immediate change of height [m].
    pub wheel: f32,
    /// Turning speed about three axes: yaw to the left, pitch up, roll to the left; 1 is full speed.
    pub turn: Vec3,
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
    pub goal: Vec3,
    /// Yaw, pitch and roll [rad].
    pub turned: Vec3,
    grips: bool,
}

impl Hand {
    /// Creates a hand at a position [m] with a tool.
    pub fn at(goal: Vec3, tool: Tool) -> Self {
        Self {
            tool,
            dull: Input::default().dull,
            goal,
            turned: Vec3::ZERO,
            grips: false,
        }
    }

    /// Creates a hand at a position [m] with the tool and rotation of the last input.
    pub fn holding(goal: Vec3, last: &Input) -> Self {
        let [x, y, z] = last.rotation().axes();
        let up = (-z.y).clamp(-1.0, 1.0).asin();
        Self {
            dull: last.dull,
            turned: Vec3::new(z.x.atan2(z.z), up, x.y.atan2(y.y)),
            grips: last.grips,
            ..Self::at(goal, last.tool)
        }
    }

    /// Takes up a tool. A tool other than the current one starts at the height `height` [m].
    pub fn take(&mut self, tool: Tool, height: f32) {
        if tool != self.tool {
            self.tool = tool;
            self.goal.y = height;
        }
    }

    /// Moves the hand for `seconds` according to `wishes`. The hand stays within a room, given by two
    /// opposite corners [m]. `turn` is the azimuth of the camera [rad].
    pub fn pass(&mut self, wishes: &HandInput, [low, high]: [Vec3; 2], turn: f32, seconds: f32) {
        if let Some(place) = wishes.place {
            self.goal = place.with_y(self.goal.y);
        }
        let lean = wishes.lean * (1.0 / wishes.lean.length().max(1.0));
        self.goal += to_world(Some(turn), lean * PACE * seconds);
        self.goal.y += wishes.wheel + RISE * wishes.lift.clamp(-1.0, 1.0) * seconds;
        self.goal = self.goal.clamp(low, high);
        let [around, up, over] = (self.turned + wishes.turn * (TURN * seconds)).to_array();
        // Leaves yaw unlimited; limits pitch and roll to half a turn, which is upside down.
        self.turned = Vec3::new(wrapped(around), up.clamp(-PI, PI), over.clamp(-PI, PI));
        self.grips = wishes.grips;
    }

    /// Returns the rotation of the tool.
    pub fn rotation(&self) -> Rotation {
        let [around, up, over] = self.turned.to_array();
        let over = Rotation::about(Vec3::Z, over);
        let up = Rotation::about(Vec3::X, up);
        over.then(up).then(Rotation::about(Vec3::Y, around))
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

    const ROOM: [Vec3; 2] = [Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.2, 0.1)];

    fn hand() -> Hand {
        Hand::at(Vec3::new(0.0, 0.1, 0.0), Tool::Hook)
    }

    #[test]
    fn hand_moves_in_camera_directions_and_stays_in_the_room() {
        let mut hand = hand();
        let wishes = HandInput {
            lean: egui::vec2(0.0, 9.0),
            wheel: -1.0,
            ..HandInput::default()
        };
        // The camera looks from the patient's right (+x), so moving away from the camera must decrease x.
        hand.pass(&wishes, ROOM, 0.5 * PI, 0.5);
        assert!((hand.goal.x + 0.03).abs() < 1e-6 && hand.goal.z.abs() < 1e-6);
        assert_eq!(hand.goal.y, 0.0);
        let place = Some(Vec3::new(9.0, 9.0, 0.05));
        let wishes = HandInput {
            place,
            ..HandInput::default()
        };
        hand.pass(&wishes, ROOM, 0.0, 0.0);
        assert_eq!(hand.goal, Vec3::new(0.1, 0.0, 0.05));
    }

    #[test]
    fn take_raises_the_hand_to_the_entry_height() {
        let mut hand = hand();
        hand.take(Tool::Hook, 0.2);
        assert_eq!(hand.goal.y, 0.1);
        hand.take(Tool::Forceps, 0.2);
        assert_eq!((hand.goal.y, hand.input().tool), (0.2, Tool::Forceps));
    }

    #[test]
    fn yaw_rotates_about_the_vertical_axis() {
        let mut hand = hand();
        let wishes = HandInput {
            turn: Vec3::X,
            ..HandInput::default()
        };
        hand.pass(&wishes, ROOM, 0.0, 0.5 * PI / TURN);
        let turned = hand.input().rotation().apply(Vec3::X);
        assert!(turned.abs_diff_eq(Vec3::NEG_Z, 1e-3), "{turned}");
    }

    #[test]
    fn holding_restores_rotation_and_sharpness() {
        let turned = [
            Vec3::new(0.3, -0.8, 0.5),
            Vec3::new(-2.9, 1.2, 3.0),
            Vec3::ZERO,
        ];
        for turned in turned {
            let before = Hand {
                turned,
                dull: 7,
                ..Hand::at(Vec3::ZERO, Tool::default())
            };
            let after = Hand::holding(before.goal, &before.input());
            for axis in [Vec3::X, Vec3::Y] {
                let [was, is] = [&before, &after].map(|hand| hand.rotation().apply(axis));
                assert!(was.abs_diff_eq(is, 1e-3), "{was} {is}");
            }
            assert_eq!(after.dull, 7);
        }
    }
}

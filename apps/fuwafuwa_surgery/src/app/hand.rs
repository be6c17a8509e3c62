//! What mouse, keys and sticks ask for becomes what the hand wants.

use crate::procedure::{BLUNTEST, Input};
use crate::tools::Tool;
use egui::Vec2;
use fuwafuwa::vector::{plus, scaled};
use fuwafuwa::{Rotation, Vector};
use std::f32::consts::PI;
use tamaire::input::Manner;

/// How fast a key or a stick that leans fully moves the hand [m/s], and how fast it rises.
const PACE: f32 = 0.06;
const RISE: f32 = 0.04;
/// How fast it turns [rad/s].
const TURN: f32 = 1.5;

/// What is asked for in a tick.
#[derive(Clone, Debug, Default)]
pub struct Wishes {
    /// To be at a place; its height does not count [m].
    pub place: Option<Vector>,
    /// To go to the right and away, at full pace where this is 1 long.
    pub lean: Vec2,
    /// To rise, at full pace where this is 1.
    pub lift: f32,
    /// To be higher at once [m].
    pub wheel: f32,
    /// To turn, at full pace where a part is 1: around to the left, up, over to the left.
    pub turn: Vector,
    /// To close the forceps.
    pub grips: bool,
}

/// Where the hand wants to be, and what it holds.
#[derive(Clone, Debug)]
pub struct Hand {
    /// What it holds.
    pub tool: Tool,
    /// Radius of the knife's edge [µm].
    pub dull: u16,
    /// Where it wants to be [m].
    pub goal: Vector,
    /// By how much it is turned around, up and over [rad].
    pub turned: Vector,
    grips: bool,
}

impl Hand {
    /// One that is somewhere [m] with a tool.
    pub fn at(goal: Vector, tool: Tool) -> Self {
        Self {
            tool,
            dull: Input::default().dull,
            goal,
            turned: [0.0; 3],
            grips: false,
        }
    }

    /// One that is somewhere [m] and holds a tool as it was held last.
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

    /// Takes up a tool, which comes in from a height [m].
    pub fn take(&mut self, tool: Tool, height: f32) {
        if tool != self.tool {
            self.tool = tool;
            self.goal[1] = height;
        }
    }

    /// Does what is asked for, for `seconds`, within a room from corner to corner [m]; the camera went around by `turn`.
    pub fn pass(&mut self, wishes: &Wishes, [low, high]: [Vector; 2], turn: f32, seconds: f32) {
        if let Some([x, _, z]) = wishes.place {
            self.goal = [x, self.goal[1], z];
        }
        let lean = wishes.lean * (1.0 / wishes.lean.length().max(1.0));
        self.goal = plus(self.goal, Manner::along(Some(turn), lean * PACE * seconds));
        self.goal[1] += wishes.wheel + RISE * wishes.lift.clamp(-1.0, 1.0) * seconds;
        for axis in 0..3 {
            self.goal[axis] = self.goal[axis].clamp(low[axis], high[axis]);
        }
        let by = scaled(wishes.turn, TURN * seconds);
        let [around, up, over] = plus(self.turned, by);
        // Around as often as one likes, up and over no further than upside down.
        self.turned = [wrapped(around), up.clamp(-PI, PI), over.clamp(-PI, PI)];
        self.grips = wishes.grips;
    }

    /// How it is turned.
    pub fn rotation(&self) -> Rotation {
        let [around, up, over] = self.turned;
        let over = Rotation::about([0.0, 0.0, 1.0], over);
        let up = Rotation::about([1.0, 0.0, 0.0], up);
        over.then(up).then(Rotation::about([0.0, 1.0, 0.0], around))
    }

    /// What it wants in a tick.
    pub fn input(&self) -> Input {
        let input = Input {
            grips: self.grips,
            dull: self.dull.min(BLUNTEST),
            ..Input::default()
        };
        input.at(self.tool, self.goal, self.rotation())
    }
}

/// The same angle between −π and π.
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
    fn it_stays_in_the_room_and_goes_as_the_camera_sees_it() {
        let mut hand = hand();
        let wishes = Wishes {
            lean: egui::vec2(0.0, 9.0),
            wheel: -1.0,
            ..Wishes::default()
        };
        // From the right side away leads to the left.
        hand.pass(&wishes, ROOM, 0.5 * PI, 0.5);
        assert!((hand.goal[0] + 0.03).abs() < 1e-6 && hand.goal[2].abs() < 1e-6);
        assert_eq!(hand.goal[1], 0.0);
        let place = Some([9.0, 9.0, 0.05]);
        let wishes = Wishes {
            place,
            ..Wishes::default()
        };
        hand.pass(&wishes, ROOM, 0.0, 0.0);
        assert_eq!(hand.goal, [0.1, 0.0, 0.05]);
    }

    #[test]
    fn a_tool_that_is_taken_up_comes_from_above() {
        let mut hand = hand();
        hand.take(Tool::Hook, 0.2);
        assert_eq!(hand.goal[1], 0.1);
        hand.take(Tool::Forceps, 0.2);
        assert_eq!((hand.goal[1], hand.input().tool), (0.2, Tool::Forceps));
    }

    #[test]
    fn what_is_turned_around_is_turned_about_what_is_up() {
        let mut hand = hand();
        let wishes = Wishes {
            turn: [1.0, 0.0, 0.0],
            ..Wishes::default()
        };
        hand.pass(&wishes, ROOM, 0.0, 0.5 * PI / TURN);
        let [x, y, z] = hand.input().rotation().apply([1.0, 0.0, 0.0]);
        assert!(x.abs() < 1e-3 && y.abs() < 1e-3 && (z + 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_hand_that_takes_over_holds_the_tool_as_it_was_held() {
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

//! Input of the players in a tick. It comes from mouse, touch, stick, keys, a program or a recording.

use fuwafuwa::Vec3;
use serde::{Deserialize, Serialize};

/// Maximum number of players in a round.
pub const PLAYERS: usize = 2;

/// Number of units of a target position per metre. Targets are integers, so that a recording holds exactly
/// the input that was played. Coordinates range over ±4 m, which contains the arena.
pub const UNITS_PER_METRE: f32 = 8192.0;

/// Distance of a target from the start of its hand up to which the hand counts as not moved [m].
const STILL: f32 = 0.002;

/// Coordinates that mark a player without a target in a recorded row. No target has these coordinates.
const ABSENT: [i16; 3] = [i16::MIN; 3];

/// Target positions of the players' hands at the end of a tick.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputFrame {
    /// Target of each player in units of 1/8192 m. `None` if the player gives no input: the hand then keeps
    /// its last target. The second player's hand enters the room with its first target.
    pub goals: [Option<[i16; 3]>; PLAYERS],
}

impl InputFrame {
    /// Returns a frame with a target for the first player [m].
    pub fn towards(position: Vec3) -> Self {
        Self::default().with(0, position)
    }

    /// Returns the frame with a target for a player, counted from 0 [m]. Coordinates beyond ±4 m are clamped,
    /// and NaN becomes 0.
    pub fn with(mut self, player: usize, position: Vec3) -> Self {
        self.goals[player] = Some(units_of(position));
        self
    }

    /// Encodes the frame as a row of numbers, for a recording. The row has three numbers for each player, up
    /// to the last player with a target.
    pub(crate) fn row(&self) -> Vec<i16> {
        let hands = self.goals.iter().rposition(Option::is_some);
        let goals = &self.goals[..hands.map_or(0, |last| last + 1)];
        goals
            .iter()
            .flat_map(|goal| goal.unwrap_or(ABSENT))
            .collect()
    }

    /// Decodes a row from [`InputFrame::row`].
    pub(crate) fn of_row(row: &[i16]) -> Self {
        let mut frame = Self::default();
        for (goal, given) in frame.goals.iter_mut().zip(row.chunks_exact(3)) {
            *goal = Some([given[0], given[1], given[2]]).filter(|goal| *goal != ABSENT);
        }
        frame
    }

    /// Returns whether a target of the frame moves a hand away from `targets`, the targets of the hands at the
    /// start [m].
    pub(crate) fn moves_a_hand(&self, targets: &[Vec3]) -> bool {
        targets.iter().enumerate().any(|(player, &target)| {
            let goal = self.goals.get(player).and_then(|_| self.goal(player));
            goal.is_some_and(|goal| (goal - target).length() > STILL)
        })
    }

    /// Returns the target of a player [m].
    pub fn goal(&self, player: usize) -> Option<Vec3> {
        self.goals[player].map(position_of)
    }
}

/// Returns a position [m] in units of 1/8192 m. Coordinates beyond ±4 m are clamped, and NaN becomes 0.
pub(crate) fn units_of(position: Vec3) -> [i16; 3] {
    let unit = |k: f32| ((k * UNITS_PER_METRE).round() as i16).max(-i16::MAX);
    position.to_array().map(unit)
}

/// Returns the position [m] for [`units_of`].
pub(crate) fn position_of(units: [i16; 3]) -> Vec3 {
    Vec3::from(units.map(f32::from)) / UNITS_PER_METRE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn target_is_rounded_to_1_8192_m_and_clamped() {
        let frame = InputFrame::towards(Vec3::new(1.25, -3.999, 0.0));
        let frame = frame.with(1, Vec3::new(f32::NAN, 1e9, -1e9));
        let goal = frame.goal(0).unwrap();
        assert!((goal.x - 1.25).abs() < 1e-4 && (goal.y + 3.999).abs() < 1e-4);
        let nonsense = frame.goal(1).unwrap();
        assert!(nonsense.abs().max_element() <= 4.0, "{nonsense:?}");
        assert_eq!(InputFrame::default().goal(0), None);
    }

    #[test]
    fn row_round_trips_absent_hands() {
        let far = InputFrame::towards(Vec3::splat(-1e9));
        let second = InputFrame::default().with(1, Vec3::new(0.5, 0.0, 0.0));
        for (frame, length) in [
            (InputFrame::default(), 0),
            (far, 3),
            (second, 6),
            (far.with(1, Vec3::ZERO), 6),
        ] {
            let row = frame.row();
            assert_eq!(row.len(), length);
            assert_eq!(InputFrame::of_row(&row), frame);
        }
    }
}

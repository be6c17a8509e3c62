//! What players do in a tick, however they do it: mouse, touch, stick, keys, program or recording.

use fuwafuwa::Vector;
use serde::{Deserialize, Serialize};

/// Most hands in a round.
pub const PLAYERS: usize = 2;

/// Goals are whole numbers of 1/8192 m, so that a recording holds exactly what was played. The
/// arena lies within ±4 m of the origin.
pub const UNITS_PER_METRE: f32 = 8192.0;

/// What a row has in place of a hand that nobody plays: no goal is there.
const ABSENT: [i16; 3] = [i16::MIN; 3];

/// Where the players want their hands to be at the end of a tick.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputFrame {
    /// For each player a place in 1/8192 m, or nothing while nobody plays that hand: it stays out
    /// until its player joins, and where it is when its player lets go.
    pub goals: [Option<[i16; 3]>; PLAYERS],
}

impl InputFrame {
    /// The frame in which the first player wants to be at a place [m].
    pub fn towards(place: Vector) -> Self {
        Self::default().with(0, place)
    }

    /// The same with the place [m] where another player wants to be.
    pub fn with(mut self, player: usize, place: Vector) -> Self {
        let unit = |k: f32| ((k * UNITS_PER_METRE).round() as i16).max(-i16::MAX);
        self.goals[player] = Some(place.map(unit));
        self
    }

    /// The frame as a row of numbers: three for each hand up to the last that is played.
    pub(crate) fn row(&self) -> Vec<i16> {
        let hands = self.goals.iter().rposition(Option::is_some);
        let goals = &self.goals[..hands.map_or(0, |last| last + 1)];
        goals
            .iter()
            .flat_map(|goal| goal.unwrap_or(ABSENT))
            .collect()
    }

    /// The frame of a row.
    pub(crate) fn of_row(row: &[i16]) -> Self {
        let mut frame = Self::default();
        for (goal, given) in frame.goals.iter_mut().zip(row.chunks_exact(3)) {
            *goal = Some([given[0], given[1], given[2]]).filter(|goal| *goal != ABSENT);
        }
        frame
    }

    /// Where a player wants to be [m].
    pub fn goal(&self, player: usize) -> Option<Vector> {
        self.goals[player].map(|goal| goal.map(|k| f32::from(k) / UNITS_PER_METRE))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_kept_to_a_sixteenth_of_a_millimetre_and_nonsense_stays_in_range() {
        let frame = InputFrame::towards([1.25, -3.999, 0.0]).with(1, [f32::NAN, 1e9, -1e9]);
        let goal = frame.goal(0).unwrap();
        assert!((goal[0] - 1.25).abs() < 1e-4 && (goal[1] + 3.999).abs() < 1e-4);
        let nonsense = frame.goal(1).unwrap();
        assert!(nonsense.iter().all(|k| k.abs() <= 4.0), "{nonsense:?}");
        assert_eq!(InputFrame::default().goal(0), None);
    }

    #[test]
    fn a_row_tells_which_hands_are_played() {
        let far = InputFrame::towards([-1e9; 3]);
        let second = InputFrame::default().with(1, [0.5, 0.0, 0.0]);
        for (frame, length) in [
            (InputFrame::default(), 0),
            (far, 3),
            (second, 6),
            (far.with(1, [0.0; 3]), 6),
        ] {
            let row = frame.row();
            assert_eq!(row.len(), length);
            assert_eq!(InputFrame::of_row(&row), frame);
        }
    }
}

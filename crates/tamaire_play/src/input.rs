//! What players do in a tick, however they do it: mouse, touch, stick, keys, program or recording.

use fuwafuwa::Vector;
use serde::{Deserialize, Serialize};

/// Most hands in a round.
pub const PLAYERS: usize = 2;

/// Goals are whole numbers of 1/8192 m, so that a recording holds exactly what was played. The
/// arena lies within ±4 m of the origin.
pub const UNITS_PER_METRE: f32 = 8192.0;

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
        self.goals[player] = Some(place.map(|k| (k * UNITS_PER_METRE).round() as i16));
        self
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
}

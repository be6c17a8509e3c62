//! What somebody who is new to space has not tried yet.

use super::{Game, Screen};
use crate::input::{Action, Means};
use fuwafuwa::Vector;
use fuwafuwa::vector::minus;

/// Who has gone this far along the floor has moved, who this far up or down has risen [m], and who has gone this far
/// around has looked around [rad].
const MOVED: f32 = 0.2;
const RAISED: f32 = 0.12;
const TURNED: f32 = 0.2;
/// In a round it is told for so long [s].
const LONG: f32 = 45.0;

/// What somebody who is new to space has not tried yet.
#[derive(Clone, Debug, Default)]
pub struct Lesson {
    /// Whether the hand was moved, was raised, and the camera went around; from then on it is known.
    tried: [bool; 3],
    /// For how long it has been told in this round [s].
    seconds: f32,
}

impl Lesson {
    /// A new round.
    pub(super) fn begin(&mut self) {
        self.seconds = 0.0;
    }

    /// Which of the three are to be told of: how to move, to rise, to look around.
    fn missing(&self) -> [bool; 3] {
        self.tried.map(|tried| !tried && self.seconds < LONG)
    }

    /// A player wants to be so far from where the hand began [m], and the camera is so far from where it began [rad].
    fn see(&mut self, gone: Vector, turned: f32, seconds: f32) {
        let along = (gone[0] * gone[0] + gone[2] * gone[2]).sqrt();
        let now = [along > MOVED, gone[1].abs() > RAISED, turned > TURNED];
        for (tried, now) in self.tried.iter_mut().zip(now) {
            *tried |= now;
        }
        self.seconds += seconds;
    }
}

impl Game {
    /// How the hand moves and rises and the camera turns, with what was used last; each with whether it is still to be
    /// told. Nothing in the plane, where nobody plays, and to those who have won in space.
    pub fn lesson(&self) -> Vec<(String, bool)> {
        // Where elements are seen, the wheel looks deeper.
        if !self.is_played_in_space() || self.has_won_in_space() || self.elements.is_some() {
            return Vec::new();
        }
        let on_stick = self.means == Means::Stick;
        let names = [
            &[Action::Up, Action::Left, Action::Down, Action::Right][..],
            &[Action::Raise, Action::Lower],
            &[Action::TurnLeft, Action::TurnRight],
        ];
        let bindings = &self.settings.bindings;
        let names = names.map(|actions| bindings.first_names(actions, on_stick));
        let lines = (self.words().how_in_space)(self.means, &names);
        lines.into_iter().zip(self.lesson.missing()).collect()
    }

    /// Notes what was tried.
    pub(super) fn learn(&mut self, seconds: f32) {
        if !self.is_played_in_space() {
            return;
        }
        let round = self.session.round();
        let gone = match self.players.wanted(0) {
            Some(wanted) => minus(wanted, round.start(0)),
            None => [0.0; 3],
        };
        let [right, up] = self.camera.gone_around();
        self.lesson.see(gone, right.abs().max(up.abs()), seconds);
    }

    fn has_won_in_space(&self) -> bool {
        let mut levels = self.levels.iter();
        levels.any(|level| level.scene().dim == 3 && self.records.of(&level.id).is_some())
    }

    fn is_played_in_space(&self) -> bool {
        self.screen == Screen::Play && self.session.is_played() && self.turn().is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_thing_is_told_until_it_was_tried_and_none_for_ever() {
        let mut lesson = Lesson::default();
        lesson.see([0.1, 0.05, 0.1], 0.1, 1.0);
        assert_eq!(lesson.missing(), [true; 3]);
        lesson.see([0.0, -0.2, 0.0], 0.0, 1.0);
        assert_eq!(lesson.missing(), [true, false, true]);
        lesson.see([0.2, 0.0, 0.2], 0.0, LONG);
        assert_eq!(lesson.missing(), [false; 3], "it was told for long enough");
        lesson.begin();
        assert_eq!(lesson.missing(), [false, false, true]);
        lesson.see([0.0; 3], 0.3, 1.0);
        assert_eq!(lesson.missing(), [false; 3]);
    }
}

//! What somebody who is new to space has not tried yet.

use fuwafuwa::Vector;

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
    pub(super) fn missing(&self) -> [bool; 3] {
        self.tried.map(|tried| !tried && self.seconds < LONG)
    }

    /// A player wants to be so far from where the hand began [m], and the camera is so far from where it began [rad].
    pub(super) fn see(&mut self, gone: Vector, turned: f32, seconds: f32) {
        let along = (gone[0] * gone[0] + gone[2] * gone[2]).sqrt();
        let now = [along > MOVED, gone[1].abs() > RAISED, turned > TURNED];
        for (tried, now) in self.tried.iter_mut().zip(now) {
            *tried |= now;
        }
        self.seconds += seconds;
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

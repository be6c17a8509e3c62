//! Tutorial: hints for players who are new to 3D levels.

use fuwafuwa::Vec3;

/// Movement of the hand along the floor after which the hint about moving counts as followed [m].
const MOVED: f32 = 0.2;
/// Movement of the hand up or down after which the hint about raising counts as followed [m].
const RAISED: f32 = 0.12;
/// Rotation of the camera after which the hint about turning counts as followed [rad].
const TURNED: f32 = 0.2;
/// Time for which hints are shown in a round [s].
const LONG: f32 = 45.0;

/// Progress of the tutorial.
#[derive(Clone, Debug, Default)]
pub struct Tutorial {
    /// Whether the player has tried to move the hand, to raise it, and to turn the camera. The values are
    /// kept across rounds.
    tried: [bool; 3],
    /// Time for which hints have been shown in this round [s].
    seconds: f32,
}

impl Tutorial {
    /// Restarts the hint time for a new round.
    pub(super) fn begin(&mut self) {
        self.seconds = 0.0;
    }

    /// Returns whether to show each of the three hints: move the hand, raise the hand, turn the camera.
    pub(super) fn missing(&self) -> [bool; 3] {
        self.tried.map(|tried| !tried && self.seconds < LONG)
    }

    /// Updates the progress after a frame of `seconds` [s]. `gone` is the offset of the player's goal from
    /// the start of the hand [m], `turned` the rotation of the camera from its start [rad].
    pub(super) fn see(&mut self, gone: Vec3, turned: f32, seconds: f32) {
        let along = gone.with_y(0.0).length();
        let now = [along > MOVED, gone.y.abs() > RAISED, turned > TURNED];
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
    fn hint_disappears_when_tried_or_after_its_time() {
        let mut lesson = Tutorial::default();
        lesson.see(Vec3::new(0.1, 0.05, 0.1), 0.1, 1.0);
        assert_eq!(lesson.missing(), [true; 3]);
        lesson.see(Vec3::new(0.0, -0.2, 0.0), 0.0, 1.0);
        assert_eq!(lesson.missing(), [true, false, true]);
        lesson.see(Vec3::new(0.2, 0.0, 0.2), 0.0, LONG);
        assert_eq!(lesson.missing(), [false; 3], "the hint time is over");
        lesson.begin();
        assert_eq!(lesson.missing(), [false, false, true]);
        lesson.see(Vec3::ZERO, 0.3, 1.0);
        assert_eq!(lesson.missing(), [false; 3]);
    }
}

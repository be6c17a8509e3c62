//! Tutorial: hints that disappear when their action was done and return when the player is stuck.

use fuwafuwa::Vec3;

/// Movement of the hand along the floor after which the hint about moving counts as followed [m].
const MOVED: f32 = 0.2;
/// Movement of the hand up or down after which the hint about raising counts as followed [m].
const RAISED: f32 = 0.12;
/// Rotation of the camera after which the hint about turning counts as followed [rad].
const TURNED: f32 = 0.2;
/// Time for which hints are shown in a round, and again each time the player is stuck [s].
const LONG: f32 = 45.0;
/// Time without progress after which a player counts as stuck [s].
const PATIENCE: f32 = 20.0;
/// Growth of the share of the mass in the basket that counts as progress.
const PROGRESS: f32 = 0.02;
/// Number of rounds of the same level given up one after the other, from which on a player counts as stuck.
const FAILURES: usize = 2;
/// Consecutive failures in a level after which a way to win may be shown.
const TRIES: usize = 4;
/// Playing time after which a ghost shows the first move, and again each time [s].
const UNTIL_FIRST_MOVE: f32 = 60.0;

/// Progress of the tutorial.
#[derive(Clone, Debug, Default)]
pub struct Tutorial {
    /// Whether the player has moved the hand, raised it, and turned the camera since the hints were last
    /// needed. The values are kept across rounds.
    done: [bool; 3],
    /// Time for which hints have been shown [s].
    seconds: f32,
    /// Offset of the goal and rotation of the camera from which movements are measured [m, rad].
    from: (Vec3, f32),
    /// Largest share of the mass in the basket in this round.
    best: f32,
    /// Time since the last progress [s].
    waiting: f32,
    /// Number of rounds of the same level that the player has given up.
    failures: usize,
    /// Playing time since the round began or the first move was last shown [s].
    unshown: f32,
}

/// Observation of a frame.
#[derive(Copy, Clone, Debug, Default)]
pub(super) struct Seen {
    /// Offset of the player's goal from the start of the hand [m].
    pub gone: Vec3,
    /// Rotation of the camera from its start [rad].
    pub turned: f32,
    /// Share of the mass in the basket. `None` in a level without a basket.
    pub within: Option<f32>,
    /// Whether the player has begun to push.
    pub has_begun: bool,
    /// Duration of the frame [s].
    pub seconds: f32,
}

impl Tutorial {
    /// Goes on in the same level after a way to win was shown: the failures count on.
    pub(super) fn begin_after_way(&mut self) {
        let failures = self.failures;
        self.begin(false);
        self.failures = failures;
    }

    /// Prepares for a new round. `has_failed` tells whether the player has given the same level up. Returns
    /// whether the player counts as stuck.
    pub(super) fn begin(&mut self, has_failed: bool) -> bool {
        self.failures = if has_failed { self.failures + 1 } else { 0 };
        (self.seconds, self.best, self.waiting) = (0.0, 0.0, 0.0);
        self.from = Default::default();
        let is_stuck = self.failures >= FAILURES;
        self.unshown = if is_stuck { UNTIL_FIRST_MOVE } else { 0.0 };
        if is_stuck {
            self.done = [false; 3];
        }
        is_stuck
    }

    /// Returns whether it is time to show the first move of the level; then the time begins again from 0.
    pub(super) fn wants_first_move(&mut self) -> bool {
        let wants = self.unshown >= UNTIL_FIRST_MOVE;
        if wants {
            self.unshown = 0.0;
        }
        wants
    }

    /// Returns whether the player has given the same level up so often that a way to win may be shown.
    pub(super) fn may_see_way(&self) -> bool {
        self.failures >= TRIES
    }

    /// Returns whether to show each of the three hints: move the hand, raise the hand, turn the camera.
    pub(super) fn missing(&self) -> [bool; 3] {
        self.done.map(|done| !done && self.seconds < LONG)
    }

    /// Updates the progress after a frame. Returns whether the player has just been found stuck, so that all
    /// hints are shown again.
    pub(super) fn see(&mut self, seen: Seen) -> bool {
        let gone = seen.gone - self.from.0;
        let along = gone.with_y(0.0).length();
        let turned = (seen.turned - self.from.1).abs();
        let now = [along > MOVED, gone.y.abs() > RAISED, turned > TURNED];
        for (done, now) in self.done.iter_mut().zip(now) {
            *done |= now;
        }
        self.seconds += seen.seconds;
        let Some(within) = seen.within.filter(|_| seen.has_begun) else {
            return false;
        };
        self.waiting += seen.seconds;
        self.unshown += seen.seconds;
        if within > self.best + PROGRESS {
            (self.best, self.waiting) = (within, 0.0);
        }
        let is_stuck = self.waiting >= PATIENCE;
        if is_stuck {
            (self.done, self.seconds, self.waiting) = ([false; 3], 0.0, 0.0);
            self.from = (seen.gone, seen.turned);
        }
        is_stuck
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn see(lesson: &mut Tutorial, gone: [f32; 3], turned: f32, seconds: f32) {
        let gone = Vec3::from(gone);
        let is_stuck = lesson.see(Seen {
            gone,
            turned,
            seconds,
            ..Seen::default()
        });
        assert!(!is_stuck, "the player has not begun");
    }

    #[test]
    fn hint_disappears_when_done_or_after_its_time() {
        let mut lesson = Tutorial::default();
        see(&mut lesson, [0.1, 0.05, 0.1], 0.1, 1.0);
        assert_eq!(lesson.missing(), [true; 3]);
        see(&mut lesson, [0.0, -0.2, 0.0], 0.0, 1.0);
        assert_eq!(lesson.missing(), [true, false, true]);
        see(&mut lesson, [0.2, 0.0, 0.2], 0.0, LONG);
        assert_eq!(lesson.missing(), [false; 3], "the hint time is over");
        lesson.begin(false);
        assert_eq!(lesson.missing(), [false, false, true]);
        see(&mut lesson, [0.0; 3], 0.3, 1.0);
        assert_eq!(lesson.missing(), [false; 3]);
    }

    #[test]
    fn hints_return_after_twenty_seconds_without_progress() {
        let mut lesson = Tutorial::default();
        let mut pass = |seconds: usize, within| {
            let seen = Seen {
                gone: Vec3::splat(0.5),
                turned: 1.0,
                within,
                has_begun: true,
                seconds: 1.0,
            };
            let found = (0..seconds).filter(|_| lesson.see(seen)).count();
            (found, lesson.missing())
        };
        assert_eq!(pass(15, Some(0.0)), (0, [false; 3]));
        assert_eq!(pass(15, Some(0.3)), (0, [false; 3]), "progress");
        assert_eq!(pass(15, Some(0.31)), (1, [true; 3]), "hardly any progress");
        assert_eq!(pass(30, None), (0, [true; 3]), "there is no basket");
        // Movements are measured from here, so each hint stays until its action is done again.
        see(&mut lesson, [0.5, 0.3, 0.5], 1.0, 1.0);
        assert_eq!(lesson.missing(), [true, false, true]);
    }

    #[test]
    fn hints_return_after_same_failure() {
        let mut lesson = Tutorial::default();
        see(&mut lesson, [0.5; 3], 1.0, 1.0);
        assert!(!lesson.begin(true));
        assert_eq!(lesson.missing(), [false; 3]);
        assert!(!lesson.wants_first_move());
        assert!(lesson.begin(true));
        assert_eq!(lesson.missing(), [true; 3]);
        assert!(lesson.wants_first_move());
        assert!(!lesson.wants_first_move(), "once");
        assert!(!lesson.begin(false), "another level");
        assert!(!lesson.wants_first_move());
    }

    #[test]
    fn first_move_is_due_after_each_minute() {
        let mut lesson = Tutorial::default();
        lesson.begin(false);
        let mut wanted = Vec::new();
        for second in 0..150 {
            let seen = Seen {
                within: Some(0.01 * second as f32),
                has_begun: second >= 20,
                seconds: 1.0,
                ..Seen::default()
            };
            lesson.see(seen);
            wanted.extend(lesson.wants_first_move().then_some(second));
        }
        assert_eq!(wanted, [79, 139]);
    }
}

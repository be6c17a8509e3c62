//! The ghost that shows the first move of a level.

use fuwafuwa::{DEFAULT_TICK, Vec3};
use fuwafuwa_scenes::scene::point_at;
use std::sync::Arc;
use tamaire_play::{AnyRound, InputFrame, Level};

/// Time for which the ghost stays at the end of the move [s].
const REST: f32 = 1.0;
/// Number of times that the ghost shows the move.
const TIMES: u32 = 2;

/// Round in which a ghost plays the first move of a level, [`TIMES`] times.
pub(super) struct Guide {
    round: AnyRound,
    /// Number of times that the move has been shown.
    shown: u32,
}

impl Guide {
    /// Creates the ghost of a level. `None` if the level has no hint.
    pub(super) fn new(level: &Arc<Level>) -> Option<Self> {
        let has_hint = !level.game().hint.is_empty();
        has_hint.then(|| Self {
            round: AnyRound::new(level.clone()),
            shown: 0,
        })
    }

    /// Returns the ghost's round.
    pub(super) fn round(&self) -> &AnyRound {
        &self.round
    }

    /// Plays the next tick. Returns whether the ghost stays.
    pub(super) fn step(&mut self) -> bool {
        let seconds = |round: &AnyRound| (round.ticks() + 1) as f32 * DEFAULT_TICK;
        let level = self.round.level().clone();
        let path = &level.game().hint;
        let end = path.last().map_or(0.0, |end| end[0]);
        if seconds(&self.round) > end + REST {
            self.shown += 1;
            if self.shown == TIMES {
                return false;
            }
            self.round = AnyRound::new(level.clone());
        }
        let target = point_at(path, seconds(&self.round));
        self.round.step(InputFrame::towards(Vec3::from(target)));
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ghost_shows_the_first_move_twice() {
        let mut scene = Level::open("classic").unwrap().scene().clone();
        let start = tamaire_play::AnyRound::new(Arc::new(Level::open("classic").unwrap()));
        let from = start.start(0);
        let game = scene.game.as_mut().unwrap();
        game.hint = vec![[0.0, from.x, from.y, 0.0], [0.5, from.x, from.y + 0.4, 0.0]];
        let level = Arc::new(Level::from_scene("hinted", scene).unwrap());
        let mut guide = Guide::new(&level).unwrap();
        let mut heights = Vec::new();
        while guide.step() {
            heights.push(guide.round().hands()[0].position.y);
        }
        let once = (1.5 / DEFAULT_TICK) as usize;
        assert!(heights.len().abs_diff(2 * once) <= 2, "{}", heights.len());
        assert!((heights[once - 2] - from.y - 0.4).abs() < 0.05, "the end");
        assert!((heights[once + 2] - from.y).abs() < 0.1, "the start again");
        assert!(Guide::new(&Arc::new(Level::open("classic").unwrap())).is_none());
    }
}

//! The ghost that shows the first move of a level.

use fuwafuwa::{DEFAULT_TICK, Vec3};
use fuwafuwa_scenes::scene::point_at;
use tamaire_play::{AnyRound, InputFrame};

/// Time for which the ghost stays at the end of the move [s].
const REST: f32 = 1.0;
/// Number of times that the ghost shows the move.
const TIMES: u32 = 2;
/// Movement of the player's hand while the ghost shows the move that prevents a second showing [m].
const TAKEN_UP: f32 = 0.1;

/// Round in which a ghost plays the first move of a level, [`TIMES`] times, or once if the player goes on meanwhile.
pub(super) struct Guide {
    round: AnyRound,
    /// Target of the player's hand when the ghost came [m].
    from: Vec3,
    /// Whether the player has moved the hand since.
    has_moved: bool,
    /// Number of times that the move has been shown.
    shown: u32,
}

impl Guide {
    /// Creates the ghost of the level of a round that people play. `None` if the level has no hint.
    pub(super) fn new(played: &AnyRound) -> Option<Self> {
        let has_hint = !played.level().game().hint.is_empty();
        has_hint.then(|| Self {
            round: AnyRound::new(played.level().clone()),
            from: played.hands()[0].target,
            has_moved: false,
            shown: 0,
        })
    }

    /// Returns the ghost's round.
    pub(super) fn round(&self) -> &AnyRound {
        &self.round
    }

    /// Plays the next tick, while people play another round. Returns whether the ghost stays.
    pub(super) fn step(&mut self, played: &AnyRound) -> bool {
        self.has_moved |= (played.hands()[0].target - self.from).length() > TAKEN_UP;
        let seconds = |round: &AnyRound| (round.ticks() + 1) as f32 * DEFAULT_TICK;
        let level = self.round.level().clone();
        let path = &level.game().hint;
        let end = path.last().map_or(0.0, |end| end[0]);
        if seconds(&self.round) > end + REST {
            self.shown += 1;
            if self.shown == TIMES || self.has_moved {
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
    use std::sync::Arc;
    use tamaire_play::Level;

    #[test]
    fn ghost_shows_the_first_move_twice() {
        let mut scene = Level::open("classic").unwrap().scene().clone();
        let start = AnyRound::new(Arc::new(Level::open("classic").unwrap()));
        let from = start.start(0);
        let game = scene.game.as_mut().unwrap();
        game.hint = vec![[0.0, from.x, from.y, 0.0], [0.5, from.x, from.y + 0.4, 0.0]];
        let level = Arc::new(Level::from_scene("hinted", scene).unwrap());
        let played = AnyRound::new(level);
        let mut guide = Guide::new(&played).unwrap();
        let mut heights = Vec::new();
        while guide.step(&played) {
            heights.push(guide.round().hands()[0].position.y);
        }
        let once = (1.5 / DEFAULT_TICK) as usize;
        assert!(heights.len().abs_diff(2 * once) <= 2, "{}", heights.len());
        assert!((heights[once - 2] - from.y - 0.4).abs() < 0.05, "the end");
        assert!((heights[once + 2] - from.y).abs() < 0.1, "the start again");
        assert!(Guide::new(&start).is_none());
        // Once, if the player goes on.
        let mut guide = Guide::new(&played).unwrap();
        let mut goes_on = played;
        for _ in 0..5 {
            goes_on.step(InputFrame::towards(from + Vec3::splat(0.2)));
        }
        let shown = std::iter::repeat_with(|| guide.step(&goes_on));
        let shown = shown.take_while(|stays| *stays).count();
        assert!(shown.abs_diff(once) <= 2, "{shown}");
    }
}

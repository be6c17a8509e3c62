//! A replay that can be wound to any tick.

use app_shell::Clock;
use tamaire_play::{AnyRound, Playback, ReplayError};

/// Maximum number of marks. A mark holds a whole world, some megabytes for a large level.
const MOST_MARKS: usize = 12;
/// Distance between marks [ticks]. It doubles each time that there are too many marks.
const FIRST_STEP: usize = 300;
/// Time per frame in which ticks are computed while winding [s].
const BUDGET: f64 = 0.03;

/// Replay with marks: copies of earlier states. Winding computes the ticks from the nearest mark before the goal.
pub(super) struct Reel {
    playback: Playback,
    /// Earlier states, in the order of their ticks. The first one is the start.
    marks: Vec<Playback>,
    /// Distance between marks [ticks].
    step: usize,
    /// Tick to wind to, if it has not been reached yet.
    goal: Option<usize>,
}

impl Reel {
    /// Creates a reel at the start of a replay.
    pub fn new(playback: Playback) -> Self {
        Self {
            marks: vec![playback.clone()],
            playback,
            step: FIRST_STEP,
            goal: None,
        }
    }

    /// Returns the playback in its current state.
    pub fn playback(&self) -> &Playback {
        &self.playback
    }

    /// Returns the round at the start of the replay.
    pub fn start(&self) -> &AnyRound {
        // The first mark is never removed: tick 0 is a multiple of every distance between marks.
        self.marks[0].round()
    }

    /// Tick that is shown, or that is being wound to.
    pub fn tick(&self) -> usize {
        self.goal.unwrap_or(self.playback.tick())
    }

    /// Whether the reel is being wound.
    pub fn is_winding(&self) -> bool {
        self.goal.is_some()
    }

    /// Begins to wind to `tick`, limited to the length of the replay. [`Self::wind`] continues.
    pub fn wind_to(&mut self, tick: usize) {
        let goal = tick.min(self.playback.ticks());
        let here = self.playback.tick();
        let before = self.marks.iter().rfind(|mark| mark.tick() <= goal);
        if let Some(mark) = before.filter(|mark| goal < here || mark.tick() > here) {
            self.playback = mark.clone();
        }
        self.goal = Some(goal);
    }

    /// Computes ticks towards the goal, for at most [`BUDGET`] as measured with `clock`.
    ///
    /// # Errors
    /// [`ReplayError`] if the world diverges from the replay.
    pub fn wind(&mut self, clock: &Clock) -> Result<(), ReplayError> {
        let began = clock.now();
        while self.goal.is_some_and(|goal| self.playback.tick() < goal) {
            self.step()?;
            if clock.now() - began > BUDGET {
                return Ok(());
            }
        }
        self.goal = None;
        Ok(())
    }

    /// Plays the next tick.
    ///
    /// # Errors
    /// [`ReplayError`] if the world diverges from the replay.
    pub fn step(&mut self) -> Result<(), ReplayError> {
        self.playback.step()?;
        let tick = self.playback.tick();
        let is_new = self.marks.last().is_none_or(|last| last.tick() < tick);
        if is_new && tick.is_multiple_of(self.step) {
            self.marks.push(self.playback.clone());
        }
        if self.marks.len() > MOST_MARKS {
            self.step *= 2;
            self.marks
                .retain(|mark| mark.tick().is_multiple_of(self.step));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use tamaire_play::{Bot, BotKind, Level, Replay};

    fn replay(ticks: usize) -> Arc<Replay> {
        let mut round = AnyRound::new(Arc::new(Level::open("classic").unwrap()));
        round.play(&mut Bot::new(BotKind::Shave, 3), ticks);
        Arc::new(round.replay())
    }

    #[test]
    fn wound_world_equals_played_world() {
        let clock = Clock::of(|| 0.0);
        let recorded = replay(420);
        let mut reel = Reel::new(Playback::new(recorded.clone()).unwrap());
        let length = reel.playback().ticks();
        assert!(length > 2 * FIRST_STEP / 3, "{length}");
        for tick in [length, 10, length - 5, 0] {
            reel.wind_to(tick);
            assert!(reel.is_winding());
            assert_eq!(reel.tick(), tick);
            reel.wind(&clock).unwrap();
            assert!(!reel.is_winding());
            let mut played = Playback::new(recorded.clone()).unwrap();
            (0..tick).for_each(|_| played.step().unwrap());
            let found = reel.playback();
            assert_eq!(
                (found.tick(), found.round().hash()),
                (tick, played.round().hash())
            );
        }
        reel.wind_to(usize::MAX);
        assert_eq!(reel.tick(), length);
    }

    #[test]
    fn winding_is_spread_over_frames_and_marks_are_few() {
        let mut reel = Reel::new(Playback::new(replay(400)).unwrap());
        reel.step = 2;
        let time = std::cell::Cell::new(0.0);
        // Each look at the clock takes 11 ms, so three ticks exceed the budget.
        let clock = Clock::of(move || {
            time.set(time.get() + 0.011);
            time.get()
        });
        reel.wind_to(100);
        reel.wind(&clock).unwrap();
        assert_eq!((reel.playback().tick(), reel.tick()), (3, 100));
        while reel.is_winding() {
            reel.wind(&clock).unwrap();
        }
        assert!(reel.marks.len() <= MOST_MARKS, "{}", reel.marks.len());
        assert_eq!(reel.marks[0].tick(), 0);
        let before = reel
            .marks
            .iter()
            .rfind(|mark| mark.tick() <= 60)
            .unwrap()
            .tick();
        reel.wind_to(60);
        assert_eq!(reel.playback().tick(), before);
    }
}

//! Real-time control of a round that is played by people or replayed.

mod reel;

use app_shell::{Clock, Pace};
use fuwafuwa::DEFAULT_TICK;
use reel::Reel;
use std::sync::Arc;
use tamaire_play::{AnyRound, InputFrame, Level, Playback, Replay, ReplayError};

/// Round that advances in real time, played by people or replayed.
pub struct Session {
    player: Player,
    /// Earlier round of the same level, to race against.
    ghost: Option<Playback>,
    pace: Pace,
    /// Error that stopped a replay or a ghost.
    complaint: Option<ReplayError>,
}

/// Source of the input of a round.
enum Player {
    /// The people at the input devices.
    People(AnyRound),
    Replay(Reel),
}

impl Session {
    /// Creates a session for a new round that people play.
    pub fn of_people(level: Arc<Level>) -> Self {
        Self::of(Player::People(AnyRound::new(level)))
    }

    /// Creates a session that plays a recorded round.
    ///
    /// # Errors
    /// [`ReplayError`] if the recorded level is invalid or was changed.
    pub fn of_replay(replay: Arc<Replay>) -> Result<Self, ReplayError> {
        Ok(Self::of(Player::Replay(Reel::new(Playback::new(replay)?))))
    }

    fn of(player: Player) -> Self {
        Self {
            player,
            ghost: None,
            pace: Pace::default(),
            complaint: None,
        }
    }

    /// Adds a ghost: a recorded round of the level to race against.
    pub fn against(mut self, ghost: Playback) -> Self {
        self.ghost = Some(ghost);
        self
    }

    /// Creates a session that starts over, with the same level or replay, and the same ghost if there is one.
    pub fn again(&self) -> Self {
        let again = match &self.player {
            Player::People(round) => Self::of_people(round.level().clone()),
            Player::Replay(reel) => Self::of(Player::Replay(Reel::new(reel.playback().again()))),
        };
        let ghost = self.ghost.as_ref().map(Playback::again);
        Self { ghost, ..again }
    }

    /// Returns the current state of the round.
    pub fn round(&self) -> &AnyRound {
        match &self.player {
            Player::People(round) => round,
            Player::Replay(reel) => reel.playback().round(),
        }
    }

    /// Returns the round of the ghost, if any.
    pub fn ghost(&self) -> Option<&AnyRound> {
        self.ghost.as_ref().map(Playback::round)
    }

    /// Whether people play the round.
    pub fn is_played(&self) -> bool {
        matches!(self.player, Player::People(_))
    }

    /// Whether the replay or the round has ended.
    pub fn is_over(&self) -> bool {
        match &self.player {
            Player::Replay(reel) => !reel.is_winding() && reel.playback().is_over(),
            _ => self.round().progress().outcome.is_some(),
        }
    }

    /// Returns the position in a replay and its length [ticks]. `None` if people play the round.
    pub fn position(&self) -> Option<[usize; 2]> {
        match &self.player {
            Player::People(_) => None,
            Player::Replay(reel) => Some([reel.tick(), reel.playback().ticks()]),
        }
    }

    /// Winds a replay to `tick`. The ticks in between are computed in the next frames, without sounds. Does nothing
    /// if people play the round.
    pub fn wind_to(&mut self, tick: usize) {
        if let Player::Replay(reel) = &mut self.player {
            reel.wind_to(tick);
        }
    }

    /// Returns the error that stopped a replay or a ghost, once.
    pub fn take_complaint(&mut self) -> Option<ReplayError> {
        self.complaint.take()
    }

    /// Estimated speed that this machine can reach, as a share of real time, at most 1. The value is 1 if
    /// computing a tick takes no longer than the tick lasts.
    pub fn bearable(&self) -> f64 {
        (f64::from(DEFAULT_TICK) / self.pace.cost()).min(1.0)
    }

    /// Discards elapsed time that was not simulated yet, so that the round does not catch up.
    pub fn forget_time(&mut self) {
        self.pace.forget();
    }

    /// Advances the round by `seconds` [s] in whole ticks, or by fewer ticks if computing them takes too
    /// long, as measured with `clock`. If people play the round, `wish` returns the input for each tick.
    /// `seen` is called with the round after each tick.
    pub fn advance(
        &mut self,
        seconds: f32,
        clock: &Clock,
        mut wish: impl FnMut(&AnyRound) -> InputFrame,
        mut seen: impl FnMut(&AnyRound),
    ) {
        if let Player::Replay(reel) = &mut self.player
            && reel.is_winding()
            && self.complaint.is_none()
        {
            self.complaint = reel.wind(clock).err();
            return self.pace.forget();
        }
        self.pace.begin(seconds.into());
        while self.pace.is_due() {
            let began = clock.now();
            self.tick(&mut wish);
            seen(self.round());
            self.pace.note(clock.now() - began);
        }
    }

    fn tick(&mut self, wish: &mut impl FnMut(&AnyRound) -> InputFrame) {
        match &mut self.player {
            Player::People(round) => {
                let frame = wish(round);
                round.step(frame);
            }
            Player::Replay(reel) if self.complaint.is_none() => {
                self.complaint = reel.step().err();
            }
            Player::Replay(_) => {}
        }
        if let Some(ghost) = &mut self.ghost
            && let Err(error) = ghost.step()
        {
            // Removes a ghost that no longer follows its recording.
            self.ghost = None;
            self.complaint = Some(error);
        }
    }
}

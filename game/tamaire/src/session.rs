//! A round in time: played by people, tried by a bot, or watched again.

use app_shell::{Clock, Pace};
use fuwafuwa::TICK;
use std::sync::Arc;
use tamaire_play::{AnyRound, InputFrame, Level, Playback, Replay, ReplayError};

/// A round in time.
pub struct Session {
    player: Player,
    /// The same level as somebody played it before, to race against.
    ghost: Option<Playback>,
    pace: Pace,
    /// Why a replay or a ghost was stopped.
    complaint: Option<ReplayError>,
}

/// Who plays.
enum Player {
    /// Whoever holds the devices.
    People(AnyRound),
    Replay(Playback),
}

impl Session {
    /// A new round for people.
    pub fn of_people(level: Arc<Level>) -> Self {
        Self::of(Player::People(AnyRound::new(level)))
    }

    /// A round as it was played.
    ///
    /// # Errors
    /// [`ReplayError`] when its level is broken or was changed.
    pub fn of_replay(replay: Arc<Replay>) -> Result<Self, ReplayError> {
        Ok(Self::of(Player::Replay(Playback::new(replay)?)))
    }

    fn of(player: Player) -> Self {
        Self {
            player,
            ghost: None,
            pace: Pace::default(),
            complaint: None,
        }
    }

    /// The same against somebody who played the level before.
    pub fn against(mut self, ghost: Playback) -> Self {
        self.ghost = Some(ghost);
        self
    }

    /// The same from its start: a replay is watched again, and people race the same ghost again.
    pub fn again(&self) -> Self {
        let again = match &self.player {
            Player::People(round) => Self::of_people(round.level().clone()),
            Player::Replay(playback) => Self::of(Player::Replay(playback.again())),
        };
        let ghost = self.ghost.as_ref().map(Playback::again);
        Self { ghost, ..again }
    }

    /// The round as it is now.
    pub fn round(&self) -> &AnyRound {
        match &self.player {
            Player::People(round) => round,
            Player::Replay(playback) => playback.round(),
        }
    }

    /// The round that is raced against.
    pub fn ghost(&self) -> Option<&AnyRound> {
        self.ghost.as_ref().map(Playback::round)
    }

    /// Whether people play.
    pub fn is_played(&self) -> bool {
        matches!(self.player, Player::People(_))
    }

    /// Whether there is nothing more to watch.
    pub fn is_over(&self) -> bool {
        match &self.player {
            Player::Replay(playback) => playback.is_over(),
            _ => self.round().progress().outcome.is_some(),
        }
    }

    /// Why a replay or a ghost was stopped, once.
    pub fn take_complaint(&mut self) -> Option<ReplayError> {
        self.complaint.take()
    }

    /// What share of its speed the round can reach on this machine, as far as is known: 1 where ticks cost less than they last.
    pub fn bearable(&self) -> f64 {
        (f64::from(TICK) / self.pace.cost()).min(1.0)
    }

    /// What has passed and was not played yet is not made up for.
    pub fn forget_time(&mut self) {
        self.pace.forget();
    }

    /// Advances by `seconds` in whole ticks; by fewer ticks if they take too long by `clock`. In a round that
    /// people play, `wish` returns the input for each tick. `seen` is called with the round after each tick.
    pub fn advance(
        &mut self,
        seconds: f32,
        clock: &Clock,
        mut wish: impl FnMut(&AnyRound) -> InputFrame,
        mut seen: impl FnMut(&AnyRound),
    ) {
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
            Player::Replay(playback) if self.complaint.is_none() => {
                self.complaint = playback.step().err();
            }
            Player::Replay(_) => {}
        }
        if let Some(ghost) = &mut self.ghost
            && let Err(error) = ghost.step()
        {
            // A ghost that goes astray is no ghost.
            self.ghost = None;
            self.complaint = Some(error);
        }
    }
}

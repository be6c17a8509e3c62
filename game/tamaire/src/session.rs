//! Real-time control of a round that is played by people or replayed.

mod guide;
mod reel;

use app_shell::{Clock, Pace};
use fuwafuwa::DEFAULT_TICK;
use guide::Guide;
use reel::Reel;
use std::sync::Arc;
use tamaire_play::playground::{Change, ChangeError};
use tamaire_play::{AnyRound, InputFrame, Level, Playback, Replay, ReplayError, Rewind, Way};

/// Round that advances in real time, played by people or replayed.
pub struct Session {
    player: Player,
    /// Earlier states of a round that people play.
    rewind: Option<Rewind>,
    /// Time that is to run back but was not shown yet [s]; `None` while time runs forward.
    back: Option<f32>,
    /// Earlier round of the same level, to race against.
    ghost: Option<Playback>,
    /// Ghost that shows the first move.
    guide: Option<Guide>,
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
        let round = AnyRound::new(level);
        let rewind = Some(Rewind::new(&round));
        let player = Player::People(round);
        Self {
            rewind,
            ..Self::of(player)
        }
    }

    /// Creates a session that plays a recorded round.
    ///
    /// # Errors
    /// [`ReplayError`] if the recorded level is invalid or was changed.
    pub fn of_replay(replay: Arc<Replay>) -> Result<Self, ReplayError> {
        Ok(Self::of(Player::Replay(Reel::new(Playback::new(replay)?))))
    }

    /// Creates a session that shows a way to win a level.
    pub fn of_way(level: Arc<Level>, way: &Way) -> Self {
        Self::of(Player::Replay(Reel::new(Playback::of_way(level, way))))
    }

    fn of(player: Player) -> Self {
        Self {
            player,
            rewind: None,
            back: None,
            ghost: None,
            guide: None,
            pace: Pace::default(),
            complaint: None,
        }
    }

    /// Adds a ghost: a recorded round of the level to race against.
    pub fn against(mut self, ghost: Playback) -> Self {
        self.ghost = Some(ghost);
        self
    }

    /// Removes the earlier states, so that time cannot run back.
    pub fn without_rewind(mut self) -> Self {
        self.rewind = None;
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

    /// Makes a change of a playground that people play.
    ///
    /// # Errors
    /// [`ChangeError`] if the level has a basket, the round is a replay, or there are too many bodies.
    pub fn change(&mut self, change: Change) -> Result<(), ChangeError> {
        match &mut self.player {
            Player::People(round) => round.change(change),
            Player::Replay(_) => Err(ChangeError::NoPlayground),
        }
    }

    /// Returns the current state of the round.
    pub fn round(&self) -> &AnyRound {
        match &self.player {
            Player::People(round) => round,
            Player::Replay(reel) => reel.playback().round(),
        }
    }

    /// Returns the round of the ghost, if any: one to race against, or one that shows the first move.
    pub fn ghost(&self) -> Option<&AnyRound> {
        let raced = self.ghost.as_ref().map(Playback::round);
        raced.or_else(|| self.guide.as_ref().map(Guide::round))
    }

    /// Lets a ghost show the first move of the level. Returns whether it does: the level has a hint, people play
    /// the round, and there is no other ghost.
    pub fn show_first_move(&mut self) -> bool {
        if self.is_played() && self.ghost().is_none() {
            self.guide = Guide::new(self.round());
            return self.guide.is_some();
        }
        false
    }

    /// Whether a way to win the level is shown.
    pub fn shows_way(&self) -> bool {
        matches!(&self.player, Player::Replay(reel) if reel.playback().is_way())
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

    /// Whether a replay is being wound.
    pub fn is_winding(&self) -> bool {
        matches!(&self.player, Player::Replay(reel) if reel.is_winding())
    }

    /// Returns the start of the round that is replayed. `None` if people play the round.
    pub fn start(&self) -> Option<&AnyRound> {
        match &self.player {
            Player::People(_) => None,
            Player::Replay(reel) => Some(reel.start()),
        }
    }

    /// Computing time of all ticks of the last frame [s].
    pub fn time_in_ticks(&self) -> f64 {
        self.pace.spent()
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

    /// Returns the time that can still run back [s]; 0 in a replay and after a win.
    pub fn seconds_to_rewind(&self) -> f32 {
        let left = self
            .rewind
            .as_ref()
            .map_or(0, |rewind| rewind.left(self.round()));
        left as f32 * DEFAULT_TICK
    }

    /// Whether time runs back.
    pub fn is_rewinding(&self) -> bool {
        self.back.is_some()
    }

    /// Lets time run back by `seconds` [s], as far as the earlier states are computed. `clock` measures the time for
    /// that. A ghost waits. Returns whether the round has changed.
    pub fn run_back(&mut self, seconds: f32, clock: &Clock) -> bool {
        let (Player::People(round), Some(rewind)) = (&mut self.player, &mut self.rewind) else {
            return false;
        };
        if self.back.is_none() {
            rewind.begin(round);
            round.count_rewind();
        }
        let step = rewind.stride() as f32 * DEFAULT_TICK;
        let mut back = self.back.unwrap_or(step) + seconds;
        let (began, before) = (clock.now(), round.ticks());
        while !rewind.prepare(round) && clock.now() - began < BUDGET {}
        while back >= step && rewind.left(round) > 0 {
            if !rewind.is_ready() {
                // The states are still being computed: time stands.
                back = step;
                break;
            }
            rewind.back(round);
            rewind.prepare(round);
            back -= step;
        }
        self.back = Some(back);
        round.ticks() != before
    }

    /// Lets time run forward again after [`Self::run_back`].
    pub fn run_forward(&mut self) {
        if self.back.take().is_some()
            && let Some(rewind) = &mut self.rewind
        {
            rewind.end();
            self.pace.forget();
        }
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
        let first = clock.now();
        let mut ticks = 0;
        while self.pace.is_due() {
            let began = clock.now();
            self.tick(&mut wish);
            seen(self.round());
            self.pace.note(clock.now() - began);
            ticks += 1;
        }
        self.guide(ticks, || clock.now() - first < BUDGET);
    }

    /// Lets the ghost that shows the first move play `ticks` ticks. After the first one, it waits for the next
    /// frame when there is no `time` left.
    fn guide(&mut self, ticks: usize, time: impl Fn() -> bool) {
        for tick in 0..ticks {
            if self.guide.is_none() || tick > 0 && !time() {
                return;
            }
            let guide = self.guide.take();
            self.guide = guide.and_then(|mut guide| guide.step(self.round()).then_some(guide));
        }
    }

    /// Plays the next tick of the round, and lets the ghost follow.
    fn tick(&mut self, wish: &mut impl FnMut(&AnyRound) -> InputFrame) {
        match &mut self.player {
            Player::People(round) => {
                let frame = wish(round);
                round.step(frame);
                if let Some(rewind) = &mut self.rewind {
                    rewind.note(round);
                }
            }
            Player::Replay(reel) if self.complaint.is_none() => {
                self.complaint = reel.step().err();
            }
            Player::Replay(_) => {}
        }
        let clock = self.round().clock_ticks();
        if let Some(ghost) = &mut self.ghost
            && let Err(error) = race(ghost, clock)
        {
            // Removes a ghost that no longer follows its recording.
            self.ghost = None;
            self.complaint = Some(error);
        }
    }
}

/// Time per frame in which earlier states are computed while time runs back, and after which the ghost that shows the
/// first move waits [s].
const BUDGET: f64 = 0.012;

/// Maximum number of ticks that a ghost plays during a tick of the player [ticks]. A ghost that waited for its
/// first push when the player began catches up at this rate.
const CATCH_UP: usize = 4;

/// Lets a ghost play until its clock shows `clock` ticks, at most [`CATCH_UP`] ticks at a time. Until the
/// player's first push, the ghost plays up to, but not including, its own.
fn race(ghost: &mut Playback, clock: u64) -> Result<(), ReplayError> {
    if clock == 0 && !ghost.starts_clock_next() {
        return ghost.step();
    }
    for _ in 0..CATCH_UP {
        if ghost.round().clock_ticks() >= clock {
            break;
        }
        ghost.step()?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use fuwafuwa::Vec3;

    /// Returns a replay of a round in which the hand moves from tick `idle` on.
    fn recorded(idle: usize) -> Arc<Replay> {
        let level = Arc::new(Level::open("classic").expect("the level is built in"));
        let mut round = AnyRound::new(level);
        for tick in 0..120 {
            round.step(match tick < idle {
                true => InputFrame::default(),
                false => InputFrame::towards(Vec3::new(-1.4, 0.6, 0.0)),
            });
        }
        Arc::new(round.replay())
    }

    /// Returns the clock of the player and of the ghost [ticks].
    fn clocks(session: &Session) -> [u64; 2] {
        let ghost = session.ghost().expect("the ghost follows its recording");
        [session.round().clock_ticks(), ghost.clock_ticks()]
    }

    #[test]
    fn ghost_waits_for_the_first_push_of_the_player() {
        for idle in [0, 40, 90] {
            let replay = recorded(idle);
            let level = Arc::new(replay.level().unwrap());
            let ghost = Playback::new(replay).unwrap();
            let mut session = Session::of_people(level).against(ghost);
            let play = |session: &mut Session, ticks: usize, frame: InputFrame| {
                (0..ticks).for_each(|_| session.tick(&mut |_| frame));
                assert!(session.take_complaint().is_none());
            };
            play(&mut session, 60, InputFrame::default());
            assert_eq!(clocks(&session), [0, 0], "{idle}");
            // The ghost begins with the player. If it had to wait longer in its own round, it catches up.
            play(
                &mut session,
                20,
                InputFrame::towards(Vec3::new(-1.3, 0.0, 0.0)),
            );
            assert_eq!(clocks(&session), [20, 20], "{idle}");
            assert_eq!(clocks(&session.again()), [0, 0], "{idle}");
        }
    }
}

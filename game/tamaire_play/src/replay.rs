//! Recorded rounds, to be stored, watched, raced and shared.

use crate::level::{LevelError, has_line, stem, without_names};
use crate::playground::{MOST_AT_ONCE, MOST_CHANGES, TimedChange};
use crate::round::{MAX_TICKS, start_targets};
use crate::rules::is_zero;
use crate::{AnyRound, InputFrame, Level, Outcome, Round, Way};
use fuwafuwa::{DEFAULT_TICK, Dim};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{BodyText, shortened};
use serde::{Deserialize, Serialize};
use std::str::Utf8Error;
use std::sync::Arc;

/// Version of the replay format and of the rules. A change of either that makes an older round run
/// differently requires a new version.
pub const VERSION: u32 = 9;

/// Maximum size of a replay [bytes]. Larger replays are rejected.
pub const MAX_BYTES: usize = 1 << 25;
/// Maximum length of the level name in a replay [characters].
pub(crate) const MAX_NAME: usize = 200;
/// Minimum number of hexadecimal digits of a hash in a replay. Replays from links have this number.
const FEW_DIGITS: usize = 4;

/// A recorded round: its level, its input and its outcome.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Replay {
    /// Version of the replay format and of the rules; only [`VERSION`] can be played.
    pub version: u32,
    /// Version of the game.
    pub game: String,
    /// Name of the level.
    pub level: String,
    /// Hash of the level in hexadecimal.
    pub level_hash: String,
    /// Outcome, if the round was won. Its ticks count from the first push here, and from the start of the
    /// recording in files and links.
    pub outcome: Option<Outcome>,
    /// Number of times that time ran back in the round. The replay contains only what was played on.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub rewinds: u32,
    /// Changes of a playground, in the order of their ticks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<TimedChange>,
    /// Hexadecimal digits of the world's hash after every sixtieth tick and after the last tick. All sixteen
    /// digits, or the last four if the replay came from a link.
    pub hashes: Vec<String>,
    /// Input of the players: a row of target positions for each tick.
    pub(crate) frames: Vec<Vec<i16>>,
    /// Scene of the level.
    pub(crate) scene: Scene,
}

/// Reason why a replay cannot be played.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// The file cannot be read.
    #[error("cannot read the replay: {0}")]
    Unreadable(String),
    /// The text is no replay.
    #[error("this is no replay: {0}")]
    Text(String),
    /// The replay has another version of the rules.
    #[error("this replay has version {found}, but this game plays version {VERSION}")]
    Version {
        /// Version of the replay.
        found: u32,
    },
    /// The level of the replay is invalid.
    #[error(transparent)]
    Level(#[from] LevelError),
    /// The level does not match its hash.
    #[error("the level in this replay was changed")]
    LevelChanged,
    /// The playback diverges from the recorded round: a hash differs.
    #[error("this replay was changed: it goes another way at second {second}")]
    Differs {
        /// Time of the first hash that differs, in seconds from the start.
        second: usize,
    },
    /// The outcome of the playback differs from the recorded outcome.
    #[error("this replay was changed: its result differs from the recorded one")]
    OutcomeDiffers,
}

impl Replay {
    /// Records a round. Of a round longer than [`MAX_TICKS`], only the beginning is recorded, without an
    /// outcome.
    pub fn of<D: Dim>(round: &Round<D>) -> Self {
        let (level, outcome) = (round.level(), round.progress().outcome);
        let mut hashes = round.hashes().to_vec();
        if hashes.len() < marks(round.frames().len()) {
            hashes.push(round.world().hash());
        }
        Self {
            version: VERSION,
            game: env!("CARGO_PKG_VERSION").into(),
            // Leaves out the folders of the level's file, because they are private.
            level: stem(&level.id).chars().take(MAX_NAME).collect(),
            level_hash: format!("{:016x}", level.hash()),
            // Leaves out a win after the last recorded tick.
            outcome: outcome.filter(|outcome| {
                outcome.ticks + round.idle_ticks() == round.frames().len() as u64
            }),
            rewinds: round.rewinds(),
            changes: round.played_changes().to_vec(),
            hashes: hashes.iter().map(|hash| format!("{hash:016x}")).collect(),
            frames: round.frames().iter().map(InputFrame::row).collect(),
            scene: level.scene().clone(),
        }
    }

    /// Returns whether the content of a file is that of a replay, perhaps damaged.
    pub fn is_in(bytes: &[u8]) -> bool {
        has_line(bytes, "level_hash")
    }

    /// Reads a replay from the bytes of a file.
    ///
    /// # Errors
    /// As [`Replay::read`].
    pub fn of_bytes(bytes: &[u8]) -> Result<Self, ReplayError> {
        check_length(bytes.len())?;
        let no_text = |error: Utf8Error| ReplayError::Text(error.to_string());
        Self::read(std::str::from_utf8(bytes).map_err(no_text)?)
    }

    /// Reads a replay from a text.
    ///
    /// # Errors
    /// [`ReplayError`] if the text is not a replay, or is a replay of another version.
    pub fn read(text: &str) -> Result<Self, ReplayError> {
        check_length(text.len())?;
        #[derive(Deserialize)]
        struct Header {
            version: u32,
        }
        let wrong = |error: toml::de::Error| ReplayError::Text(shortened(error.message(), 400));
        // Checks the version before reading the fields, because other versions may have other fields.
        let Header { version } = toml::from_str(text).map_err(wrong)?;
        if version != VERSION {
            return Err(ReplayError::Version { found: version });
        }
        let replay: Self = toml::from_str(text).map_err(wrong)?;
        replay.check()?;
        Ok(replay.timed_from_first_push())
    }

    /// Returns the replay with the ticks of its outcome counted from the first input that moves a hand. Files
    /// and links count all ticks of the recording, see [`Replay::stored_outcome`].
    pub(crate) fn timed_from_first_push(mut self) -> Self {
        let (all, clock) = (self.ticks() as u64, self.clock_ticks() as u64);
        if let Some(outcome) = &mut self.outcome
            && outcome.ticks == all
        {
            outcome.ticks = clock;
        }
        self
    }

    /// Returns the outcome for files and links, with all ticks of the recording, as every game of this
    /// [`VERSION`] expects. The time on the clock follows from the recorded input.
    pub(crate) fn stored_outcome(&self) -> Option<Outcome> {
        let (all, clock) = (self.ticks() as u64, self.clock_ticks() as u64);
        let mut outcome = self.outcome;
        if let Some(outcome) = &mut outcome
            && outcome.ticks == clock
        {
            outcome.ticks = all;
        }
        outcome
    }

    /// Checks that the parts of the replay match each other, and that none is too long.
    pub(crate) fn check(&self) -> Result<(), ReplayError> {
        let letters = self.level.chars().count();
        if letters > MAX_NAME {
            let reason = format!("level: expected at most {MAX_NAME} characters, found {letters}");
            return Err(ReplayError::Text(reason));
        }
        let ticks = self.frames.len();
        if ticks > MAX_TICKS {
            let reason = format!("expected at most {MAX_TICKS} ticks, found {ticks}");
            return Err(ReplayError::Text(reason));
        }
        if let Some(tick) = self
            .frames
            .iter()
            .position(|row| ![0, 3, 6].contains(&row.len()))
        {
            let reason = format!("frame {tick}: expected 0, 3 or 6 numbers");
            return Err(ReplayError::Text(reason));
        }
        let (found, expected) = (self.hashes.len(), marks(ticks));
        if found != expected {
            let reason = format!("expected {expected} hashes for {ticks} ticks, found {found}");
            return Err(ReplayError::Text(reason));
        }
        let found = self.changes.len();
        if found > MOST_CHANGES {
            let reason = format!("expected at most {MOST_CHANGES} changes, found {found}");
            return Err(ReplayError::Text(reason));
        }
        let game = self.scene.game.as_ref();
        if found > 0 && game.is_some_and(|game| !game.all_baskets().is_empty()) {
            let reason = "changes: expected none in a level with a basket".into();
            return Err(ReplayError::Text(reason));
        }
        let mut at_once = self.changes.chunk_by(|a, b| a.tick == b.tick);
        if at_once.any(|changes| changes.len() > MOST_AT_ONCE) {
            let reason = format!("changes: expected at most {MOST_AT_ONCE} between two ticks");
            return Err(ReplayError::Text(reason));
        }
        if !self.changes.is_sorted_by_key(|change| change.tick) {
            let reason = "changes: expected them in the order of their ticks".into();
            return Err(ReplayError::Text(reason));
        }
        let is_digit = |digit: u8| matches!(digit, b'0'..=b'9' | b'a'..=b'f');
        let is_hash =
            |hash: &String| (FEW_DIGITS..=16).contains(&hash.len()) && hash.bytes().all(is_digit);
        if let Some(place) = self.hashes.iter().position(|hash| !is_hash(hash)) {
            let reason = format!("hash {place}: expected {FEW_DIGITS} to 16 hexadecimal digits");
            return Err(ReplayError::Text(reason));
        }
        let mut bodies = self.scene.body.iter();
        if bodies.any(BodyText::lacks_content) {
            // Rejects file names, because the files would be opened.
            let reason = "expected embedded content for every body with a file".into();
            return Err(ReplayError::Text(reason));
        }
        Ok(())
    }

    /// Returns the replay as a text.
    pub fn text(&self) -> String {
        let outcome = self.stored_outcome();
        let stored = Self {
            outcome,
            ..self.clone()
        };
        toml::to_string(&stored).expect("every field of a replay can be serialized")
    }

    /// Returns the replay as a text for storing. Checks that the text can be read and watched.
    ///
    /// # Errors
    /// [`ReplayError`] if the text could not be read or watched.
    pub fn text_to_keep(&self) -> Result<String, ReplayError> {
        let text = self.text();
        Self::read(&text)?.level()?;
        Ok(text)
    }

    /// Returns the number of ticks.
    pub fn ticks(&self) -> usize {
        self.frames.len()
    }

    /// Returns the number of ticks before the first input that moves a hand away from its start.
    pub fn idle_ticks(&self) -> usize {
        let targets = start_targets(&self.scene);
        let moves = |tick: &usize| self.frame(*tick).moves_a_hand(&targets);
        (0..self.ticks()).find(moves).unwrap_or(self.ticks())
    }

    /// Returns the number of ticks on the clock of the round, which starts with the first input that moves a
    /// hand.
    pub fn clock_ticks(&self) -> usize {
        self.ticks() - self.idle_ticks()
    }

    /// Returns the time on the clock of the round at the end of the replay [s].
    pub fn seconds(&self) -> f32 {
        self.clock_ticks() as f32 * DEFAULT_TICK
    }

    /// Returns the input of a tick. After the last recorded tick, returns an empty frame.
    pub fn frame(&self, tick: usize) -> InputFrame {
        let row = self.frames.get(tick);
        row.map_or_else(InputFrame::default, |row| InputFrame::of_row(row))
    }

    /// Returns the level of the replay.
    ///
    /// # Errors
    /// [`ReplayError`] if the level is invalid, or does not match its hash.
    pub fn level(&self) -> Result<Level, ReplayError> {
        let level = Level::from_scene(&self.level, self.scene.clone())?;
        let is_same = self.is_of(&level);
        is_same.then_some(level).ok_or(ReplayError::LevelChanged)
    }

    /// Returns whether the replay was played in `level`. The names may differ.
    pub fn is_of(&self, level: &Level) -> bool {
        self.level_hash == format!("{:016x}", level.hash())
    }

    /// Returns the replay as one of `level`. `None` if the level differs in more than its names.
    pub fn renamed(&self, level: &Level) -> Option<Self> {
        let is_same = without_names(&self.scene) == without_names(level.scene());
        is_same.then(|| Self {
            level: level.id.clone(),
            level_hash: format!("{:016x}", level.hash()),
            scene: level.scene().clone(),
            ..self.clone()
        })
    }
}

impl AnyRound {
    /// Records the round up to now.
    pub fn replay(&self) -> Replay {
        match self {
            Self::Plane(round) => Replay::of(round),
            Self::Space(round) => Replay::of(round),
        }
    }
}

/// Returns the number of hashes that a replay of `ticks` ticks has.
fn marks(ticks: usize) -> usize {
    ticks.div_ceil(60)
}

fn check_length(found: usize) -> Result<(), ReplayError> {
    let reason = format!("expected at most {MAX_BYTES} bytes, found {found}");
    let good = found <= MAX_BYTES;
    good.then_some(()).ok_or(ReplayError::Text(reason))
}

/// Playback of a replay.
#[derive(Clone, Debug)]
pub struct Playback {
    replay: Arc<Replay>,
    round: AnyRound,
    tick: usize,
    /// Number of recorded ticks before the first input that moves a hand.
    idle_ticks: usize,
    /// Whether the playback shows a way, which has no recorded hashes and ends with the win.
    is_way: bool,
}

impl Playback {
    /// Starts the playback of a replay.
    ///
    /// # Errors
    /// [`ReplayError`] if the level is invalid, or does not match its hash.
    pub fn new(replay: Arc<Replay>) -> Result<Self, ReplayError> {
        let round = AnyRound::new(Arc::new(replay.level()?));
        Ok(Self {
            idle_ticks: replay.idle_ticks(),
            replay,
            round,
            tick: 0,
            is_way: false,
        })
    }

    /// Starts the playback of a way to win a level.
    pub fn of_way(level: Arc<Level>, way: &Way) -> Self {
        let round = AnyRound::new(level);
        let replay = Replay {
            frames: way.frames().iter().map(InputFrame::row).collect(),
            ..round.replay()
        };
        Self {
            idle_ticks: replay.idle_ticks(),
            replay: Arc::new(replay),
            round,
            tick: 0,
            is_way: true,
        }
    }

    /// Returns a new playback of the same replay, at its start.
    pub fn again(&self) -> Self {
        Self {
            replay: self.replay.clone(),
            round: AnyRound::new(self.round.level().clone()),
            tick: 0,
            idle_ticks: self.idle_ticks,
            is_way: self.is_way,
        }
    }

    /// Returns the round that is played back, in its current state.
    pub fn round(&self) -> &AnyRound {
        &self.round
    }

    /// Returns whether this shows a way; see [`Self::of_way`].
    pub fn is_way(&self) -> bool {
        self.is_way
    }

    /// Number of ticks that were played.
    pub fn tick(&self) -> usize {
        self.tick
    }

    /// Number of recorded ticks.
    pub fn ticks(&self) -> usize {
        self.replay.ticks()
    }

    /// Returns whether all recorded ticks were played, or whether a way has won.
    pub fn is_over(&self) -> bool {
        let has_won = self.is_way && self.round.progress().outcome.is_some();
        has_won || self.tick >= self.replay.ticks()
    }

    /// Returns whether the next tick is the first one that moves a hand, which starts the clock.
    pub fn starts_clock_next(&self) -> bool {
        self.tick == self.idle_ticks
    }

    /// Plays the next tick. After the last recorded tick, the world continues without input.
    ///
    /// # Errors
    /// [`ReplayError`] if the world diverges from the replay.
    pub fn step(&mut self) -> Result<(), ReplayError> {
        let was_over = self.is_over();
        if !was_over {
            self.round.change_again(&self.replay.changes);
        }
        self.round.step(self.replay.frame(self.tick));
        self.tick += 1;
        if was_over || self.is_way {
            return Ok(());
        }
        if self.tick.is_multiple_of(60) || self.is_over() {
            let found = format!("{:016x}", self.round.hash());
            let expected = self.replay.hashes.get(marks(self.tick) - 1);
            if !expected.is_some_and(|digits| found.ends_with(digits)) {
                let second = self.tick / 60;
                return Err(ReplayError::Differs { second });
            }
        }
        let ends_alike = self.round.progress().outcome == self.replay.outcome;
        if self.is_over() && !ends_alike {
            return Err(ReplayError::OutcomeDiffers);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::Link;
    use crate::{Bot, BotKind};
    use fuwafuwa::Dim2;

    #[test]
    fn invalid_replay_gives_a_short_error() {
        let long = "z".repeat(1 << 20);
        let level = Arc::new(Level::open("classic").unwrap());
        let text = Replay::of(&Round::<Dim2>::new(level)).text();
        let texts = [
            format!("version = \"{long}\""),
            format!("version = {VERSION}\n{long} = 1"),
            text.replacen("hashes = []", &format!("hashes = \"{long}\""), 1),
            text.replacen("dim = 2", &format!("dim = \"{long}\""), 1),
        ];
        for text in texts {
            let error = Replay::read(&text).unwrap_err().to_string();
            assert!(error.len() < 1000, "{} bytes", error.len());
        }
    }

    #[test]
    fn text_to_keep_rejects_an_unreadable_replay() {
        let level = Arc::new(Level::open("classic").unwrap());
        let mut replay = Replay::of(&Round::<Dim2>::new(level));
        assert_eq!(replay.text_to_keep().unwrap(), replay.text());
        replay.game = "z".repeat(MAX_BYTES);
        let error = replay.text_to_keep().unwrap_err().to_string();
        assert!(error.contains("expected at most"), "{error}");
        replay.game = String::new();
        replay.level = "z".repeat(MAX_NAME + 1);
        let error = replay.text_to_keep().unwrap_err().to_string();
        assert!(error.contains("characters, found"), "{error}");
    }

    /// Plays a round whose player waits for 90 ticks and then wins.
    fn won_after_waiting() -> Round<Dim2> {
        let mut round = Round::<Dim2>::new(Arc::new(Level::open("classic").unwrap()));
        for _ in 0..90 {
            round.step(InputFrame::default());
            assert_eq!(round.clock_ticks(), 0);
        }
        // A target at the hand moves nothing.
        let start = start_targets(round.level().scene())[0];
        round.step(InputFrame::towards(start));
        assert_eq!(round.clock_ticks(), 0);
        let mut bot = Bot::new(BotKind::Squeeze, 1);
        while round.progress().outcome.is_none() {
            assert!(round.frames().len() < 1800, "the bot does not win");
            let frame = bot.frame(&round);
            round.step(frame);
        }
        round
    }

    #[test]
    fn clock_starts_with_the_first_push() {
        let round = won_after_waiting();
        let outcome = round.progress().outcome.unwrap();
        let idle = round.idle_ticks();
        assert!((91..120).contains(&idle), "{idle}");
        assert_eq!(outcome.ticks + idle, round.frames().len() as u64);
        let replay = Replay::of(&round);
        assert_eq!(replay.outcome, Some(outcome));
        assert_eq!(replay.seconds(), outcome.seconds());
        let all = format!("ticks = {}\n", replay.ticks());
        assert!(replay.text().contains(&all), "files count all ticks");
        assert_eq!(
            replay.stored_outcome().unwrap().ticks,
            replay.ticks() as u64
        );
        assert_eq!(Replay::read(&replay.text()).unwrap(), replay);
        let Ok(Link::Round(sent)) = Link::read(&replay.link().unwrap()) else {
            panic!("no round");
        };
        assert_eq!(sent.outcome, Some(outcome));
    }

    #[test]
    fn replay_with_all_ticks_in_its_outcome_is_genuine() {
        let round = won_after_waiting();
        let mut old = Replay::of(&round);
        let clock = old.outcome.unwrap().ticks;
        old.outcome.as_mut().unwrap().ticks = old.ticks() as u64;
        let read = Replay::read(&old.text()).unwrap();
        assert_eq!(read.outcome.unwrap().ticks, clock);
        let mut playback = Playback::new(Arc::new(read)).unwrap();
        while !playback.is_over() {
            playback.step().unwrap();
        }
        // Another number of ticks is a changed result.
        old.outcome.as_mut().unwrap().ticks = clock + 1;
        let read = Replay::read(&old.text()).unwrap();
        let mut playback = Playback::new(Arc::new(read)).unwrap();
        let mut steps = (0..old.ticks()).map(|_| playback.step());
        assert!(steps.any(|step| matches!(step, Err(ReplayError::OutcomeDiffers))));
    }

    #[test]
    fn renamed_replay_plays_in_the_renamed_level_only() {
        let replay = Replay::of(&won_after_waiting());
        let mut scene = replay.scene.clone();
        scene.game.as_mut().unwrap().name.en = "other".into();
        scene.game.as_mut().unwrap().made_by = Some("Mika".into());
        let level = Level::from_scene("other", scene.clone()).unwrap();
        assert!(!replay.is_of(&level));
        let renamed = replay.renamed(&level).unwrap();
        assert!(renamed.is_of(&level));
        let mut playback = Playback::new(Arc::new(renamed)).unwrap();
        while !playback.is_over() {
            playback.step().unwrap();
        }
        assert!(playback.round().progress().outcome.is_some());
        scene.gravity[1] -= 1.0;
        let harder = Level::from_scene("other", scene).unwrap();
        assert!(replay.renamed(&harder).is_none());
    }

    #[test]
    fn replay_embeds_its_files() {
        let level = Arc::new(Level::open("cat").unwrap());
        let text = Replay::of(&Round::<Dim2>::new(level)).text();
        assert!(Replay::read(&text).is_ok());
        let lines = text.lines().filter(|line| !line.starts_with("content = "));
        let bare: Vec<&str> = lines.collect();
        assert!(bare.len() < text.lines().count());
        let error = Replay::read(&bare.join("\n")).unwrap_err().to_string();
        assert!(error.contains("content"), "{error}");
    }
}

//! A round on file, to be watched, raced and shared.

use crate::level::{LevelError, stem};
use crate::round::MAX_TICKS;
use crate::{AnyRound, InputFrame, Level, Outcome, Round};
use fuwafuwa::Dim;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{BodyText, shortened};
use serde::{Deserialize, Serialize};
use std::str::Utf8Error;
use std::sync::Arc;

/// Number of the format and of the rules; it changes when an older round would run differently.
pub const VERSION: u32 = 6;

/// Most bytes of a replay: what is longer is not read.
pub const MAX_BYTES: usize = 1 << 25;
/// Most letters of the name of a level in one.
pub(crate) const MAX_NAME: usize = 200;
/// Fewest digits of a hash in one: so many are left of it in a link.
const FEW_DIGITS: usize = 4;

/// A round: the level itself, what was played in it, and what came of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Replay {
    /// Number of the format.
    pub version: u32,
    /// Version of the game.
    pub game: String,
    /// The level's name.
    pub level: String,
    /// The level's hash, in hexadecimal.
    pub level_hash: String,
    /// How it was won, if it was.
    pub outcome: Option<Outcome>,
    /// The world's hash after every sixtieth tick and after the last, in hexadecimal: its last digits, four or more. All
    /// sixteen are there unless it came as a link.
    pub hashes: Vec<String>,
    /// What was played: for each tick the goals of the hands.
    pub(crate) frames: Vec<Vec<i16>>,
    /// The level.
    pub(crate) scene: Scene,
}

/// Why a replay is not played.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// It cannot be read.
    #[error("it cannot be read: {0}")]
    Unreadable(String),
    /// It is no replay.
    #[error("this is no replay: {0}")]
    Text(String),
    /// It was made by another version.
    #[error("this replay is of version {found}, and this game plays version {VERSION}")]
    Version {
        /// Its version.
        found: u32,
    },
    /// Its level is broken.
    #[error(transparent)]
    Level(#[from] LevelError),
    /// Its level is not the one that was played.
    #[error("the level in this replay was changed")]
    LevelChanged,
    /// It does not lead to what it says.
    #[error("this replay was changed: it goes another way at second {second}")]
    Differs {
        /// Where.
        second: usize,
    },
    /// It does not end as it says.
    #[error("this replay was changed: it does not end as it says")]
    OutcomeDiffers,
}

impl Replay {
    /// What was played in a round so far. Of one that is longer than [`MAX_TICKS`] it is the beginning,
    /// which was not won.
    pub fn of<D: Dim>(round: &Round<D>) -> Self {
        let (level, outcome) = (round.level(), round.progress().outcome);
        let mut hashes = round.hashes().to_vec();
        if hashes.len() < marks(round.frames().len()) {
            hashes.push(round.world().hash());
        }
        Self {
            version: VERSION,
            game: env!("CARGO_PKG_VERSION").into(),
            // Of a file not its folders, which are nobody else's business.
            level: stem(&level.id).chars().take(MAX_NAME).collect(),
            level_hash: format!("{:016x}", level.hash()),
            outcome: outcome.filter(|outcome| outcome.ticks == round.frames().len() as u64),
            hashes: hashes.iter().map(|hash| format!("{hash:016x}")).collect(),
            frames: round.frames().iter().map(InputFrame::row).collect(),
            scene: level.scene().clone(),
        }
    }

    /// The replay in the bytes of a file.
    ///
    /// # Errors
    /// As [`Replay::read`].
    pub fn of_bytes(bytes: &[u8]) -> Result<Self, ReplayError> {
        check_length(bytes.len())?;
        let no_text = |error: Utf8Error| ReplayError::Text(error.to_string());
        Self::read(std::str::from_utf8(bytes).map_err(no_text)?)
    }

    /// The replay in a text.
    ///
    /// # Errors
    /// [`ReplayError`] when it is none, or one of another version.
    pub fn read(text: &str) -> Result<Self, ReplayError> {
        check_length(text.len())?;
        #[derive(Deserialize)]
        struct Header {
            version: u32,
        }
        let wrong = |error: toml::de::Error| ReplayError::Text(shortened(error.message(), 400));
        // Another version may have other fields: that it is one must be seen before them.
        let Header { version } = toml::from_str(text).map_err(wrong)?;
        if version != VERSION {
            return Err(ReplayError::Version { found: version });
        }
        let replay: Self = toml::from_str(text).map_err(wrong)?;
        replay.check()?;
        Ok(replay)
    }

    /// Whether all that depends on each other fits, and nothing is too long.
    pub(crate) fn check(&self) -> Result<(), ReplayError> {
        let letters = self.level.chars().count();
        if letters > MAX_NAME {
            let reason = format!("level: expected {MAX_NAME} letters at most, found {letters}");
            return Err(ReplayError::Text(reason));
        }
        let ticks = self.frames.len();
        if ticks > MAX_TICKS {
            let reason = format!("expected {MAX_TICKS} ticks at most, found {ticks}");
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
        let is_digit = |digit: u8| matches!(digit, b'0'..=b'9' | b'a'..=b'f');
        let is_hash =
            |hash: &String| (FEW_DIGITS..=16).contains(&hash.len()) && hash.bytes().all(is_digit);
        if let Some(place) = self.hashes.iter().position(|hash| !is_hash(hash)) {
            let reason = format!("hash {place}: expected {FEW_DIGITS} to 16 hexadecimal digits");
            return Err(ReplayError::Text(reason));
        }
        let mut bodies = self.scene.body.iter();
        if bodies.any(BodyText::lacks_content) {
            // Whose replay it is does not say which files are opened.
            let reason = "expected the content of every body that has a file".into();
            return Err(ReplayError::Text(reason));
        }
        Ok(())
    }

    /// It as a text.
    pub fn text(&self) -> String {
        toml::to_string(self).expect("a replay has nothing that cannot be written")
    }

    /// The same, if it can be read and watched again.
    ///
    /// # Errors
    /// [`ReplayError`] says why not.
    pub fn text_to_keep(&self) -> Result<String, ReplayError> {
        let text = self.text();
        Self::read(&text)?.level()?;
        Ok(text)
    }

    /// Number of ticks.
    pub fn ticks(&self) -> usize {
        self.frames.len()
    }

    /// What was played in a tick; nothing after the last.
    pub fn frame(&self, tick: usize) -> InputFrame {
        let row = self.frames.get(tick);
        row.map_or_else(InputFrame::default, |row| InputFrame::of_row(row))
    }

    /// The level it was played in.
    ///
    /// # Errors
    /// [`ReplayError`] when it is broken, or not the one that was played.
    pub fn level(&self) -> Result<Level, ReplayError> {
        let level = Level::of(&self.level, self.scene.clone())?;
        let is_same = self.is_of(&level);
        is_same.then_some(level).ok_or(ReplayError::LevelChanged)
    }

    /// Whether it was played in this level, by whatever name.
    pub fn is_of(&self, level: &Level) -> bool {
        self.level_hash == format!("{:016x}", level.hash())
    }
}

impl AnyRound {
    /// What was played in it so far.
    pub fn replay(&self) -> Replay {
        match self {
            Self::Plane(round) => Replay::of(round),
            Self::Space(round) => Replay::of(round),
        }
    }
}

/// How many hashes there are of so many ticks.
fn marks(ticks: usize) -> usize {
    ticks.div_ceil(60)
}

fn check_length(found: usize) -> Result<(), ReplayError> {
    let reason = format!("expected {MAX_BYTES} bytes at most, found {found}");
    let good = found <= MAX_BYTES;
    good.then_some(()).ok_or(ReplayError::Text(reason))
}

/// A replay that is being played.
#[derive(Clone, Debug)]
pub struct Playback {
    replay: Arc<Replay>,
    round: AnyRound,
    tick: usize,
}

impl Playback {
    /// A replay from its start.
    ///
    /// # Errors
    /// [`ReplayError`] when its level is broken or another one.
    pub fn new(replay: Arc<Replay>) -> Result<Self, ReplayError> {
        let round = AnyRound::new(Arc::new(replay.level()?));
        let tick = 0;
        Ok(Self {
            replay,
            round,
            tick,
        })
    }

    /// The same from its start.
    pub fn again(&self) -> Self {
        Self {
            replay: self.replay.clone(),
            round: AnyRound::new(self.round.level().clone()),
            tick: 0,
        }
    }

    /// The round as it is now.
    pub fn round(&self) -> &AnyRound {
        &self.round
    }

    /// Whether all of it was played.
    pub fn is_over(&self) -> bool {
        self.tick >= self.replay.ticks()
    }

    /// Plays a tick. Past the end the world goes on by itself.
    ///
    /// # Errors
    /// [`ReplayError`] when it turns out that the replay was tampered with.
    pub fn step(&mut self) -> Result<(), ReplayError> {
        let was_over = self.is_over();
        self.round.step(self.replay.frame(self.tick));
        self.tick += 1;
        if was_over {
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
    use fuwafuwa::Dim2;

    #[test]
    fn what_is_no_replay_is_refused_briefly() {
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
    fn what_could_not_be_read_again_is_not_kept() {
        let level = Arc::new(Level::open("classic").unwrap());
        let mut replay = Replay::of(&Round::<Dim2>::new(level));
        assert_eq!(replay.text_to_keep().unwrap(), replay.text());
        replay.game = "z".repeat(MAX_BYTES);
        let error = replay.text_to_keep().unwrap_err().to_string();
        assert!(error.contains("bytes at most"), "{error}");
        replay.game = String::new();
        replay.level = "z".repeat(MAX_NAME + 1);
        let error = replay.text_to_keep().unwrap_err().to_string();
        assert!(error.contains("letters at most"), "{error}");
    }

    #[test]
    fn a_replay_brings_its_files_along() {
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

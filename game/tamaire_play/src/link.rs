//! Rounds and levels as links. The part of an address behind its `#` never leaves the browser, so that a
//! round can be shared without a server that stores it.
//!
//! ```
//! use fuwafuwa::Vec3;
//! use std::sync::Arc;
//! use tamaire_play::link::{Link, address};
//! use tamaire_play::{AnyRound, InputFrame, Level, Playback};
//!
//! let mut round = AnyRound::new(Arc::new(Level::open("classic")?));
//! for _ in 0..30 {
//!     round.step(InputFrame::towards(Vec3::new(0.5, 0.2, 0.0)));
//! }
//! let sent = address("https://example.org/play/", &round.replay().link()?);
//! assert!(sent.starts_with("https://example.org/play/#r1") && sent.len() < 200);
//!
//! let Link::Round(replay) = Link::read(&sent)? else {
//!     panic!("expected a round");
//! };
//! let mut playback = Playback::new(Arc::from(replay))?;
//! while !playback.is_over() {
//!     playback.step()?;
//! }
//! assert_eq!(playback.round().hash(), round.hash());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A fragment consists of a letter for its kind (`r` or `l`), a digit for its format, bytes in base64url [RFC
//! 4648, §5], and a final `z`. Many programs that detect addresses in a text stop before a `-` or `_` at the
//! end; the `z` prevents this. The bytes are a checksum and a postcard encoding of `SentRound` or
//! `SentLevel`. For a QR code, the bytes are written in decimal digits, with the format `0`. A built-in level
//! is sent as its name, its assists and a hash only.

mod coder;
mod digits;
mod error;
mod frames;
mod level;
mod pasted;

pub use error::{LinkError, MAX_LENGTH};
pub use pasted::is_link;

use crate::level::{hash_of, stem};
use crate::playground::TimedChange;
use crate::replay::{MAX_BYTES, MAX_NAME, VERSION};
use crate::round::MAX_TICKS;
use crate::{Level, Outcome, Replay, ReplayError, Route};
use base64::Engine;
use base64::prelude::BASE64_URL_SAFE_NO_PAD as BASE64;
use error::{all, taken};
use fuwafuwa::inspect::Hash;
use level::SentLevel;
use serde::{Deserialize, Serialize, Serializer};

/// Digit in a fragment that stands for bytes in base64url.
const FORMAT: char = '1';
/// Digit in a fragment that stands for bytes in decimal digits.
const DIGITS: char = '0';
const ROUND: char = 'r';
const LEVEL: char = 'l';
const END: char = 'z';

/// Content of a link.
#[derive(Clone, Debug, PartialEq)]
pub enum Link {
    /// A round to watch or to race.
    Round(Box<Replay>),
    /// A level to play.
    Level(Box<Level>),
}

impl Link {
    /// Reads an address or its fragment, also as mail and chat programs leave them: percent-encoded or in
    /// quoted-printable, in brackets or quotation marks, with punctuation behind, or with spaces and line
    /// breaks inside. The world of a level is built to check it; a round is checked against its hashes during
    /// playback.
    ///
    /// # Errors
    /// [`LinkError`] if the text is no link, is damaged, or has content that cannot be played.
    pub fn read(text: &str) -> Result<Self, LinkError> {
        let mut problem = LinkError::Other;
        for fragment in pasted::candidates(text).fragments() {
            match unsealed(fragment) {
                Ok((kind, bytes)) => return Self::of(kind, &bytes),
                Err(error) => problem = error,
            }
        }
        Err(problem)
    }

    /// Decodes the content of a fragment.
    fn of(kind: char, bytes: &[u8]) -> Result<Self, LinkError> {
        match kind {
            ROUND => SentRound::read(bytes).map(Box::new).map(Self::Round),
            _ => SentLevel::read(bytes).map(Box::new).map(Self::Level),
        }
    }
}

/// Returns the kind and the verified bytes of a fragment.
fn unsealed(fragment: &str) -> Result<(char, Vec<u8>), LinkError> {
    let (kind, body) = parts(fragment)?;
    check_length(fragment.len())?;
    Ok((kind, unpacked(kind, body)?))
}

impl Replay {
    /// Returns the replay as the fragment of a link. Each hash is shortened to four digits, which suffice to
    /// detect a playback that differs from the round.
    ///
    /// # Errors
    /// [`LinkError`] if the fragment is too long, or if reading it would fail.
    pub fn link(&self) -> Result<String, LinkError> {
        let fragment = self.fragment()?;
        check_length(fragment.len())?;
        Ok(fragment)
    }

    /// Returns the replay as a fragment of any length, for storing rounds.
    ///
    /// # Errors
    /// [`LinkError`] if reading the fragment would fail.
    pub fn fragment(&self) -> Result<String, LinkError> {
        Ok(packed(ROUND, &self.sent()?))
    }

    /// Returns the replay as a fragment in decimal digits. Digits take less space than base64 in a QR code,
    /// and more elsewhere.
    ///
    /// # Errors
    /// As [`Replay::link`].
    pub fn code(&self) -> Result<String, LinkError> {
        in_digits(ROUND, &self.sent()?)
    }

    fn sent(&self) -> Result<(u32, SentRound, Extras), LinkError> {
        self.check()?;
        if self.version != VERSION {
            let found = self.version;
            return Err(ReplayError::Version { found }.into());
        }
        if self.level_hash != format!("{:016x}", hash_of(&self.scene)) {
            return Err(ReplayError::LevelChanged.into());
        }
        let played: Vec<_> = (0..self.ticks()).map(|tick| self.frame(tick)).collect();
        let outcome = self.stored_outcome();
        let extras = Extras {
            broken: outcome.map_or(0, |outcome| outcome.broken),
            torn: outcome.map_or(0, |outcome| outcome.torn),
            rewinds: self.rewinds,
            changes: self.changes.clone(),
        };
        let sent = SentRound {
            game: self.game.clone(),
            level: SentLevel::of(&self.level, &self.scene)?,
            outcome: outcome.map(|won| {
                (
                    won.ticks, won.route, won.kept, won.inside, won.pieces, won.lost,
                )
            }),
            hashes: self.hashes.iter().map(|hash| last_digits(hash)).collect(),
            ticks: self.ticks() as u32,
            frames: frames::write(&played),
        };
        Ok((VERSION, sent, extras))
    }

    /// Reads a round from a fragment made by [`Replay::fragment`].
    ///
    /// # Errors
    /// As [`Link::read`], except that the fragment may be as long as a stored replay.
    pub fn of_fragment(fragment: &str) -> Result<Self, LinkError> {
        if fragment.len() > MAX_BYTES {
            return Err(LinkError::TooLong {
                found: fragment.len(),
            });
        }
        let (kind, body) = parts(fragment)?;
        match kind {
            ROUND => SentRound::read(&unpacked(kind, body)?),
            _ => Err(LinkError::Other),
        }
    }
}

impl Level {
    /// Returns the level as the fragment of a link.
    ///
    /// # Errors
    /// [`LinkError`] if the fragment is too long.
    pub fn link(&self) -> Result<String, LinkError> {
        let fragment = packed(LEVEL, &self.sent()?);
        check_length(fragment.len())?;
        Ok(fragment)
    }

    /// Returns the level as a fragment in decimal digits, for a QR code; see [`Replay::code`].
    ///
    /// # Errors
    /// As [`Level::link`].
    pub fn code(&self) -> Result<String, LinkError> {
        in_digits(LEVEL, &self.sent()?)
    }

    fn sent(&self) -> Result<SentLevel, LinkError> {
        let id: String = stem(&self.id).chars().take(MAX_NAME).collect();
        SentLevel::of(&id, self.scene())
    }
}

/// Returns the address of a page with a fragment. If `page` already has a fragment, it is replaced.
pub fn address(page: &str, fragment: &str) -> String {
    let page = page.split_once('#').map_or(page, |(page, _)| page);
    format!("{page}#{fragment}")
}

/// Content of a link to a round. In the encoded bytes, the version of the rules stands before it, and
/// [`Extras`] after it.
#[derive(Debug, Serialize, Deserialize)]
struct SentRound {
    game: String,
    level: SentLevel,
    /// As [`Replay::stored_outcome`].
    outcome: Option<SentOutcome>,
    /// The last four hexadecimal digits of each hash.
    hashes: Vec<[u8; 2]>,
    ticks: u32,
    frames: Vec<u8>,
}

/// Fields of an [`Outcome`] in their order, without those of [`Extras`].
type SentOutcome = (u64, Route, f32, f32, usize, usize);

/// Numbers of a round that are usually 0. Zeros at the end take no space, so that links to usual rounds stay as they
/// were.
#[derive(Clone, Default)]
struct Extras {
    /// [`Outcome::broken`]
    broken: usize,
    /// [`Outcome::torn`]
    torn: u32,
    /// [`Replay::rewinds`]
    rewinds: u32,
    /// [`Replay::changes`]
    changes: Vec<TimedChange>,
}

impl Serialize for Extras {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if !self.changes.is_empty() {
            return (self.broken, self.torn, self.rewinds, &self.changes).serialize(serializer);
        }
        match (self.broken, self.torn, self.rewinds) {
            (0, 0, 0) => serializer.serialize_unit(),
            (broken, 0, 0) => serializer.serialize_u64(broken as u64),
            (broken, torn, 0) => (broken, torn).serialize(serializer),
            all => all.serialize(serializer),
        }
    }
}

impl Extras {
    /// Reads the numbers from all of the bytes.
    fn read(bytes: &[u8]) -> Result<Self, LinkError> {
        if bytes.is_empty() {
            return Ok(Self::default());
        }
        let (broken, rest) = taken::<usize>(bytes)?;
        let (torn, rest) = match rest {
            [] => (0, rest),
            rest => taken::<u32>(rest)?,
        };
        let (rewinds, rest) = match rest {
            [] => (0, rest),
            rest => taken::<u32>(rest)?,
        };
        let changes = match rest {
            [] => Vec::new(),
            rest => all::<Vec<TimedChange>>(rest)?,
        };
        let read = Self {
            broken,
            torn,
            rewinds,
            changes,
        };
        // Another length than the written one is an error.
        let written = postcard::to_allocvec(&read).map_err(|_| LinkError::Damaged)?;
        (written == bytes).then_some(read).ok_or(LinkError::Damaged)
    }
}

impl SentRound {
    fn read(bytes: &[u8]) -> Result<Replay, LinkError> {
        let (version, bytes) = taken::<u32>(bytes)?;
        if version > VERSION {
            return Err(LinkError::Newer);
        }
        if version < VERSION {
            return Err(ReplayError::Version { found: version }.into());
        }
        let (sent, rest): (Self, &[u8]) = taken(bytes)?;
        let extras = Extras::read(rest)?;
        if sent.outcome.is_none() && (extras.broken, extras.torn) != (0, 0) {
            return Err(LinkError::Damaged);
        }
        let ticks = sent.ticks as usize;
        if ticks > MAX_TICKS {
            return Err(LinkError::Damaged);
        }
        let scene = sent.level.scene()?;
        let played = frames::read(&sent.frames, ticks).ok_or(LinkError::Damaged)?;
        let digits = |hash: &[u8; 2]| format!("{:04x}", u16::from_be_bytes(*hash));
        let replay = Replay {
            version,
            game: sent.game,
            level: sent.level.id,
            level_hash: format!("{:016x}", hash_of(&scene)),
            outcome: { sent.outcome }.map(|(ticks, route, kept, inside, pieces, lost)| Outcome {
                ticks,
                route,
                kept,
                inside,
                pieces,
                lost,
                broken: extras.broken,
                torn: extras.torn,
            }),
            rewinds: extras.rewinds,
            changes: extras.changes,
            hashes: sent.hashes.iter().map(digits).collect(),
            frames: played.iter().map(|frame| frame.row()).collect(),
            scene,
        };
        replay.check()?;
        Ok(replay.timed_from_first_push())
    }
}

/// Returns the last four hexadecimal digits of a hash.
fn last_digits(hash: &str) -> [u8; 2] {
    let number = u64::from_str_radix(hash, 16);
    (number.expect("check() verified the hexadecimal digits") as u16).to_be_bytes()
}

/// Splits a fragment into the letter of its kind and the text after it.
fn parts(fragment: &str) -> Result<(char, &str), LinkError> {
    let mut letters = fragment.chars();
    let kind = letters.next().filter(|kind| [ROUND, LEVEL].contains(kind));
    let kind = kind.ok_or(LinkError::Other)?;
    let rest = letters.as_str();
    match letters.next() {
        Some(FORMAT | DIGITS) => Ok((kind, rest)),
        Some('2'..='9') => Err(LinkError::Newer),
        _ => Err(LinkError::Other),
    }
}

fn packed(kind: char, sent: &impl Serialize) -> String {
    format!("{kind}{FORMAT}{}{END}", BASE64.encode(sealed(kind, sent)))
}

/// Encodes a value as a fragment in decimal digits.
fn in_digits(kind: char, sent: &impl Serialize) -> Result<String, LinkError> {
    let code = format!("{kind}{DIGITS}{}{END}", digits::write(&sealed(kind, sent)));
    check_length(code.len())?;
    Ok(code)
}

/// Encodes a value as bytes, with the checksum in front.
fn sealed(kind: char, sent: &impl Serialize) -> Vec<u8> {
    let payload = postcard::to_stdvec(sent).expect("serialization into a vector cannot fail");
    [&checksum(kind, &payload)[..], &payload].concat()
}

/// Decodes the text after the letter of a fragment and verifies its checksum.
fn unpacked(kind: char, rest: &str) -> Result<Vec<u8>, LinkError> {
    let (format, body) = rest.split_at(1);
    let body = body.strip_suffix(END).ok_or(LinkError::CutShort)?;
    let bytes = match format.starts_with(DIGITS) {
        true => digits::read(body),
        false => BASE64.decode(body).ok(),
    };
    let mut bytes = bytes.ok_or(LinkError::Damaged)?;
    let payload = bytes.split_off(bytes.len().min(4));
    let is_whole = bytes == checksum(kind, &payload);
    is_whole.then_some(payload).ok_or(LinkError::Damaged)
}

/// Returns the checksum of a fragment's kind and payload. It detects accidental changes, not forgery.
fn checksum(kind: char, payload: &[u8]) -> [u8; 4] {
    let bytes = [&[kind as u8], payload].concat();
    (Hash::of(&bytes) as u32).to_le_bytes()
}

fn check_length(found: usize) -> Result<(), LinkError> {
    let is_short = found <= MAX_LENGTH;
    is_short.then_some(()).ok_or(LinkError::TooLong { found })
}

#[cfg(test)]
mod tests {
    use super::level::{Content, EFFORT, MAX_SCENE_BYTES, WholeScene};
    use super::*;
    use miniz_oxide::deflate;
    use std::time::Instant;

    fn round(level: SentLevel, ticks: u32, frames: Vec<u8>) -> SentRound {
        SentRound {
            game: String::new(),
            level,
            outcome: None,
            hashes: vec![[0; 2]; ticks.div_ceil(60) as usize],
            ticks,
            frames,
        }
    }

    fn classic() -> SentLevel {
        SentLevel::of("classic", Level::open("classic").unwrap().scene()).unwrap()
    }

    fn whole(text: &str) -> SentLevel {
        let whole: WholeScene = (text.into(), Vec::new());
        let bytes = postcard::to_stdvec(&whole).unwrap();
        let content = Content::Whole(deflate::compress_to_vec(&bytes, EFFORT));
        let id = "mine".into();
        SentLevel { id, content }
    }

    fn refusal(kind: char, sent: &impl Serialize) -> String {
        let start = Instant::now();
        let read = Link::read(&packed(kind, sent));
        let seconds = start.elapsed().as_secs_f32();
        assert!(seconds < 2.0, "{seconds} s");
        read.unwrap_err().to_string()
    }

    #[test]
    fn links_with_a_valid_checksum_are_still_checked() {
        let damaged = LinkError::Damaged.to_string();
        // A text of eight megabytes that compresses to few bytes. Reading the link must fail quickly.
        let bomb = whole(&" ".repeat(8 << 20));
        assert_eq!(refusal(LEVEL, &bomb), damaged);
        assert_eq!(refusal(ROUND, &(VERSION, round(bomb, 1, vec![0]))), damaged);
        let mut noise = whole("");
        noise.content = Content::Whole(vec![0xff; 9]);
        assert_eq!(refusal(LEVEL, &noise), damaged);
        assert_eq!(
            refusal(LEVEL, &(classic(), 1_u8)),
            damaged,
            "trailing bytes must be rejected"
        );
        assert_eq!(
            refusal(ROUND, &(VERSION, round(classic(), 1, vec![]))),
            damaged
        );
        assert_eq!(
            refusal(ROUND, &(VERSION, round(classic(), 1, vec![32]))),
            damaged
        );
        let mut endless = round(classic(), 1, vec![0]);
        endless.ticks = u32::MAX;
        assert_eq!(refusal(ROUND, &(VERSION, endless)), damaged);
        let mut long = classic();
        long.id = "z".repeat(MAX_NAME + 1);
        assert_eq!(refusal(LEVEL, &long), damaged);

        let text = refusal(LEVEL, &whole("dim = 2\nbody = 1"));
        assert!(text.contains("line 2"), "{text}");
        let mut few = round(classic(), 61, vec![0]);
        few.hashes.pop();
        let few = refusal(ROUND, &(VERSION, few));
        assert!(few.contains("expected 2 hashes for 61 ticks"), "{few}");
        let mut unknown = classic();
        unknown.id = "clasic".into();
        let unknown = refusal(LEVEL, &unknown);
        assert!(
            unknown.contains("no built-in level \"clasic\""),
            "{unknown}"
        );
    }

    #[test]
    fn scene_too_large_for_a_link_is_rejected() {
        let mut scene = Level::open("cat").unwrap().scene().clone();
        scene.body[0].content = Some("AAAA".repeat(MAX_SCENE_BYTES / 3));
        let error = SentLevel::of("mine", &scene).unwrap_err().to_string();
        let expected = "mine: for a link, expected at most 131072 bytes, found 13";
        assert!(error.starts_with(expected), "{error}");
    }

    #[test]
    fn links_of_other_rules_or_levels_are_rejected() {
        let later = refusal(ROUND, &(VERSION + 1, "a later format"));
        assert_eq!(later, LinkError::Newer.to_string());
        let earlier = refusal(ROUND, &(VERSION - 1, "an earlier format"));
        assert!(earlier.contains("this replay has version"), "{earlier}");
        let mut level = classic();
        if let Content::Known { hash, .. } = &mut level.content {
            *hash ^= 1;
        }
        let other = refusal(LEVEL, &level);
        assert!(other.contains("\"classic\" has changed"), "{other}");
    }

    #[test]
    fn longest_round_in_few_bytes_is_read_quickly() {
        let mut random = fastrand::Rng::with_seed(1);
        for way in [0, 1, 30, 31] {
            let told = (0..100).map(|_| random.u8(..));
            let frames = [way].into_iter().chain(told).collect();
            let sent = round(classic(), MAX_TICKS as u32, frames);
            let start = Instant::now();
            let link = Link::read(&packed(ROUND, &(VERSION, sent)));
            let seconds = start.elapsed().as_secs_f32();
            assert!(seconds < 2.0, "{seconds} s");
            let Ok(Link::Round(replay)) = link else {
                panic!("{link:?}");
            };
            assert_eq!(replay.ticks(), MAX_TICKS);
        }
    }

    #[test]
    fn largest_level_in_a_link_is_read_quickly() {
        let (_, classic) = crate::level::NAMED[0];
        let ball = "[[obstacle]]\nball = { centre = [9.0, 9.0, 9.0], radius = 0.1 }\n";
        let room = MAX_SCENE_BYTES - classic.len() - 9;
        let text = [classic, &ball.repeat(room / ball.len())].concat();
        let refused = refusal(LEVEL, &whole(&text));
        assert!(refused.contains("expected 256 at most"), "{refused}");
    }
}

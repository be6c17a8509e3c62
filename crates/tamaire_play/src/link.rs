//! Rounds and levels as links: what stands behind the `#` of an address never leaves the browser, so a round travels without
//! anybody keeping it.
//!
//! ```
//! use std::sync::Arc;
//! use tamaire_play::link::{Link, address};
//! use tamaire_play::{AnyRound, InputFrame, Level, Playback};
//!
//! let mut round = AnyRound::new(Arc::new(Level::open("classic")?));
//! for _ in 0..30 {
//!     round.step(InputFrame::towards([0.5, 0.2, 0.0]));
//! }
//! let sent = address("https://example.org/play/", &round.replay().link()?);
//! assert!(sent.starts_with("https://example.org/play/#r1") && sent.len() < 200);
//!
//! let Link::Round(replay) = Link::read(&sent)? else {
//!     panic!("it was a round");
//! };
//! let mut playback = Playback::new(Arc::new(replay))?;
//! while !playback.is_over() {
//!     playback.step()?;
//! }
//! assert_eq!(playback.round().hash(), round.hash());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A fragment is a letter for what it is, a digit for the format, bytes in base64url [RFC 4648, §5] and a `z`: after a `-` or a
//! `_` at its end many programs that find addresses in a text would stop too early. The bytes are a checksum and what postcard
//! makes of `SentRound` or `SentLevel`. Of a level that comes along only the name and a hash travel.

mod coder;
mod frames;

use crate::assists::assisted;
use crate::level::{LevelError, hash_of, plain, stem, text_of};
use crate::replay::{MAX_NAME, VERSION};
use crate::round::MAX_TICKS;
use crate::{Assist, Level, Outcome, Replay, ReplayError};
use base64::Engine;
use base64::prelude::{BASE64_STANDARD, BASE64_URL_SAFE_NO_PAD as BASE64};
use fuwafuwa::hash::Hash;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::BodyText;
use miniz_oxide::{deflate, inflate};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Most characters of a fragment, the `#` aside: browsers and chat programs bear as many.
pub const MAX_LENGTH: usize = 16_000;

/// Most bytes of a scene in one before they are deflated: an honest one that fits is smaller.
const MAX_SCENE_BYTES: usize = 1 << 17;
/// The format of a fragment.
const FORMAT: char = '1';
const ROUND: char = 'r';
const LEVEL: char = 'l';
const END: char = 'z';
/// How hard deflate looks for repetitions, 0 to 10.
const EFFORT: u8 = 9;

/// What a link brings.
#[derive(Clone, Debug, PartialEq)]
pub enum Link {
    /// A round to watch or to race.
    Round(Replay),
    /// A level to play.
    Level(Level),
}

/// Why there is no such link.
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// It is the address of something else.
    #[error("this is no link to a round or a level of tamaire")]
    Other,
    /// Its format is a later one, or its round was played by later rules.
    #[error("this link was made by a newer tamaire")]
    Newer,
    /// Not all of it arrived.
    #[error("the end of this link is missing")]
    CutShort,
    /// It is not what was sent.
    #[error("this link was changed on its way, or is not all of it")]
    Damaged,
    /// There is too much in it.
    #[error("a link has {MAX_LENGTH} characters at most, and this one has {found}")]
    TooLong {
        /// How many characters it has, or would have.
        found: usize,
    },
    /// It was played in a level that is another one here.
    #[error("the level {0:?} is not what it was when this link was made")]
    LevelDiffers(
        /// The level.
        String,
    ),
    /// The round is broken.
    #[error(transparent)]
    Round(#[from] ReplayError),
    /// The level is broken.
    #[error(transparent)]
    Level(#[from] LevelError),
}

impl Link {
    /// What an address, or what stands behind its `#`, brings. A level is built to see whether it can be; a round shows when
    /// it is played whether it goes as it says.
    ///
    /// # Errors
    /// [`LinkError`] when it is no link, did not arrive as it was sent, or brings nothing that can be played.
    pub fn read(text: &str) -> Result<Self, LinkError> {
        let fragment = text.split_once('#').map_or(text, |(_, fragment)| fragment);
        let fragment = fragment.trim();
        let mut letters = fragment.chars();
        let kind = letters.next().filter(|kind| [ROUND, LEVEL].contains(kind));
        let kind = kind.ok_or(LinkError::Other)?;
        match letters.next() {
            Some(FORMAT) => {}
            Some('2'..='9') => return Err(LinkError::Newer),
            _ => return Err(LinkError::Other),
        }
        check_length(fragment.len())?;
        let body = letters.as_str().strip_suffix(END);
        let bytes = unpacked(kind, body.ok_or(LinkError::CutShort)?)?;
        match kind {
            ROUND => SentRound::read(&bytes).map(Self::Round),
            _ => SentLevel::read(&bytes).map(Self::Level),
        }
    }
}

impl Replay {
    /// It as what stands behind the `#` of an address. Of the hashes four digits each travel: by them it is still seen
    /// when it goes another way.
    ///
    /// # Errors
    /// [`LinkError`] when it is too long, or could not be read again.
    pub fn link(&self) -> Result<String, LinkError> {
        self.check()?;
        if self.version != VERSION {
            let found = self.version;
            return Err(ReplayError::Version { found }.into());
        }
        if self.level_hash != format!("{:016x}", hash_of(&self.scene)) {
            return Err(ReplayError::LevelChanged.into());
        }
        let played: Vec<_> = (0..self.ticks()).map(|tick| self.frame(tick)).collect();
        let sent = SentRound {
            game: self.game.clone(),
            level: SentLevel::of(&self.level, &self.scene)?,
            outcome: self.outcome,
            hashes: self.hashes.iter().map(|hash| last_digits(hash)).collect(),
            ticks: self.ticks() as u32,
            frames: frames::write(&played),
        };
        packed(ROUND, &(VERSION, sent))
    }
}

impl Level {
    /// It as what stands behind the `#` of an address.
    ///
    /// # Errors
    /// [`LinkError`] when it is too long.
    pub fn link(&self) -> Result<String, LinkError> {
        let id: String = stem(&self.id).chars().take(MAX_NAME).collect();
        packed(LEVEL, &SentLevel::of(&id, self.scene())?)
    }
}

/// An address that brings what a fragment holds: that of the page, whatever it brought itself, and the fragment.
pub fn address(page: &str, fragment: &str) -> String {
    let page = page.split_once('#').map_or(page, |(page, _)| page);
    format!("{page}#{fragment}")
}

/// A round on its way, behind the number of its rules.
#[derive(Debug, Serialize, Deserialize)]
struct SentRound {
    game: String,
    level: SentLevel,
    outcome: Option<Outcome>,
    /// The last four digits of each.
    hashes: Vec<[u8; 2]>,
    ticks: u32,
    frames: Vec<u8>,
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
        let sent: Self = all(bytes)?;
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
            outcome: sent.outcome,
            hashes: sent.hashes.iter().map(digits).collect(),
            frames: played.iter().map(|frame| frame.row()).collect(),
            scene,
        };
        replay.check()?;
        Ok(replay)
    }
}

/// A level on its way.
#[derive(Debug, Serialize, Deserialize)]
struct SentLevel {
    id: String,
    content: Content,
}

#[derive(Debug, Serialize, Deserialize)]
enum Content {
    /// It comes along, with some things made easier.
    Known {
        assists: BTreeSet<Assist>,
        /// Half of its hash.
        hash: u32,
    },
    /// A [`WholeScene`], deflated.
    Whole(Vec<u8>),
}

impl SentLevel {
    fn of(id: &str, scene: &Scene) -> Result<Self, LinkError> {
        let assists = scene.game.iter().flat_map(|game| &game.assists);
        let assists: BTreeSet<Assist> = assists.copied().collect();
        let known = Level::open(id).map(|level| assisted(level.scene(), &assists));
        let content = match known {
            Ok(known) if known == *scene => Content::Known {
                assists,
                hash: hash_of(scene) as u32,
            },
            _ => Content::Whole(deflated(id, scene)?),
        };
        let id = id.into();
        Ok(Self { id, content })
    }

    fn read(bytes: &[u8]) -> Result<Level, LinkError> {
        let sent: Self = all(bytes)?;
        if sent.id.chars().count() > MAX_NAME {
            return Err(LinkError::Damaged);
        }
        // One that somebody made never takes the place of one that comes along.
        let is_made = matches!(sent.content, Content::Whole(_)) && !sent.id.contains('.');
        let id = sent.id.clone() + if is_made { ".toml" } else { "" };
        Ok(Level::of(&id, plain(sent.scene()?))?)
    }

    fn scene(&self) -> Result<Scene, LinkError> {
        match &self.content {
            Content::Known { assists, hash } => {
                let scene = assisted(Level::open(&self.id)?.scene(), assists);
                let is_same = hash_of(&scene) as u32 == *hash;
                let differs = || LinkError::LevelDiffers(self.id.clone());
                is_same.then_some(scene).ok_or_else(differs)
            }
            Content::Whole(deflated) => inflated(&self.id, deflated),
        }
    }
}

/// The text of a scene without the files that its bodies are made from, and those: their bytes are told in less room than
/// their letters.
type WholeScene = (String, Vec<Option<Vec<u8>>>);

fn deflated(id: &str, scene: &Scene) -> Result<Vec<u8>, LinkError> {
    let mut scene = scene.clone();
    let files = scene.body.iter_mut().map(take_file).collect();
    let whole: WholeScene = (text_of(&scene), files);
    let bytes = postcard::to_stdvec(&whole).expect("a vector takes all");
    let found = bytes.len();
    if found > MAX_SCENE_BYTES {
        let reason = format!("for a link, expected {MAX_SCENE_BYTES} bytes at most, found {found}");
        return Err(LevelError::Unreadable(id.into(), reason).into());
    }
    Ok(deflate::compress_to_vec(&bytes, EFFORT))
}

fn inflated(id: &str, deflated: &[u8]) -> Result<Scene, LinkError> {
    let bytes = inflate::decompress_to_vec_with_limit(deflated, MAX_SCENE_BYTES);
    let (text, files): WholeScene = all(&bytes.map_err(|_| LinkError::Damaged)?)?;
    let mut scene = Scene::read(id, &text, &[]).map_err(LevelError::Scene)?;
    for (body, file) in scene.body.iter_mut().zip(files) {
        body.content = file
            .map(|bytes| BASE64_STANDARD.encode(bytes))
            .or(body.content.take());
    }
    Ok(scene)
}

/// Takes out the bytes of the file that a body is made from; what is no base64 stays.
fn take_file(body: &mut BodyText) -> Option<Vec<u8>> {
    let bytes = BASE64_STANDARD.decode(body.content.as_ref()?).ok()?;
    body.content = None;
    Some(bytes)
}

/// The last four hexadecimal digits of a hash.
fn last_digits(hash: &str) -> [u8; 2] {
    let number = u64::from_str_radix(hash, 16);
    (number.expect("that it is one was checked") as u16).to_be_bytes()
}

fn packed(kind: char, sent: &impl Serialize) -> Result<String, LinkError> {
    let payload = postcard::to_stdvec(sent).expect("a vector takes all");
    let bytes = [&checksum(kind, &payload)[..], &payload].concat();
    let fragment = format!("{kind}{FORMAT}{}{END}", BASE64.encode(bytes));
    check_length(fragment.len())?;
    Ok(fragment)
}

/// What the characters between the format and the end of a link of this kind were made from.
fn unpacked(kind: char, body: &str) -> Result<Vec<u8>, LinkError> {
    let mut bytes = BASE64.decode(body).map_err(|_| LinkError::Damaged)?;
    let payload = bytes.split_off(bytes.len().min(4));
    let is_whole = bytes == checksum(kind, &payload);
    is_whole.then_some(payload).ok_or(LinkError::Damaged)
}

/// Of the kind and all that follows. It keeps out accidents, not strangers.
fn checksum(kind: char, payload: &[u8]) -> [u8; 4] {
    let bytes = [&[kind as u8], payload].concat();
    (Hash::of(&bytes) as u32).to_le_bytes()
}

/// The first value in the bytes, and the rest.
fn taken<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Result<(T, &'a [u8]), LinkError> {
    postcard::take_from_bytes(bytes).map_err(|_| LinkError::Damaged)
}

/// The value that the bytes are.
fn all<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Result<T, LinkError> {
    let (value, rest) = taken(bytes)?;
    rest.is_empty().then_some(value).ok_or(LinkError::Damaged)
}

fn check_length(found: usize) -> Result<(), LinkError> {
    let is_short = found <= MAX_LENGTH;
    is_short.then_some(()).ok_or(LinkError::TooLong { found })
}

#[cfg(test)]
mod tests {
    use super::*;
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
        let read = Link::read(&packed(kind, sent).unwrap());
        let seconds = start.elapsed().as_secs_f32();
        assert!(seconds < 2.0, "{seconds} s");
        read.unwrap_err().to_string()
    }

    #[test]
    fn what_a_stranger_packed_well_is_checked_all_the_same() {
        let damaged = LinkError::Damaged.to_string();
        // Eight megabytes.
        let bomb = whole(&" ".repeat(8 << 20));
        assert_eq!(refusal(LEVEL, &bomb), damaged);
        assert_eq!(refusal(ROUND, &(VERSION, round(bomb, 1, vec![0]))), damaged);
        let mut noise = whole("");
        noise.content = Content::Whole(vec![0xff; 9]);
        assert_eq!(refusal(LEVEL, &noise), damaged);
        assert_eq!(
            refusal(LEVEL, &(classic(), 1_u8)),
            damaged,
            "something follows"
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
        assert!(unknown.contains("no level or file \"clasic\""), "{unknown}");
    }

    #[test]
    fn what_would_not_be_read_is_not_sent() {
        let mut scene = Level::open("cat").unwrap().scene().clone();
        scene.body[0].content = Some("AAAA".repeat(MAX_SCENE_BYTES / 3));
        let error = SentLevel::of("mine", &scene).unwrap_err().to_string();
        let expected = "mine: for a link, expected 131072 bytes at most, found 13";
        assert!(error.starts_with(expected), "{error}");
    }

    #[test]
    fn what_other_rules_and_levels_made_is_told_so() {
        let later = refusal(ROUND, &(VERSION + 1, "whatever comes then"));
        assert_eq!(later, LinkError::Newer.to_string());
        let earlier = refusal(ROUND, &(VERSION - 1, "whatever was then"));
        assert!(earlier.contains("this replay is of version"), "{earlier}");
        let mut level = classic();
        if let Content::Known { hash, .. } = &mut level.content {
            *hash ^= 1;
        }
        let other = refusal(LEVEL, &level);
        assert!(other.contains("\"classic\" is not what it was"), "{other}");
    }

    #[test]
    fn the_longest_round_of_few_bytes_is_read_at_once() {
        let mut random = fastrand::Rng::with_seed(1);
        for way in [0, 1, 30, 31] {
            let told = (0..100).map(|_| random.u8(..));
            let frames = [way].into_iter().chain(told).collect();
            let sent = round(classic(), MAX_TICKS as u32, frames);
            let start = Instant::now();
            let link = Link::read(&packed(ROUND, &(VERSION, sent)).unwrap());
            let seconds = start.elapsed().as_secs_f32();
            assert!(seconds < 2.0, "{seconds} s");
            let Ok(Link::Round(replay)) = link else {
                panic!("{link:?}");
            };
            assert_eq!(replay.ticks(), MAX_TICKS);
        }
    }

    #[test]
    fn the_most_that_fits_into_a_level_is_read_soon() {
        let (_, classic) = crate::level::NAMED[0];
        let ball = "[[obstacle]]\nball = { centre = [9.0, 9.0, 9.0], radius = 0.1 }\n";
        let room = MAX_SCENE_BYTES - classic.len() - 9;
        let text = [classic, &ball.repeat(room / ball.len())].concat();
        let refused = refusal(LEVEL, &whole(&text));
        assert!(refused.contains("expected 256 at most"), "{refused}");
    }
}

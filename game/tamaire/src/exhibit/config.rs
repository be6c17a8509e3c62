//! Configuration of a stand: `exhibit.toml`.

use crate::settings::Settings;
use crate::words::Language;
use jiff::civil::Time;
use serde::{Deserialize, Deserializer};
use std::sync::Arc;
use tamaire_play::level::{CHAPTERS, LevelError, PATH};
use tamaire_play::link::is_link;
use tamaire_play::{Assist, Level};
use toml_edit::{DocumentMut, Item, Value};

/// Default configuration file, with a comment on each line.
pub const DEFAULT_CONFIG: &str = include_str!("exhibit.toml");

/// Maximum number of levels that a visitor can choose from.
const MOST_LEVELS: usize = 3;

/// Configuration of a stand.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Name of the stand in the logbook.
    pub stand: StandName,
    /// Language of the stand before a visitor changes it.
    pub language: Language,
    /// Whether visitors may change the language.
    pub other_languages: bool,
    /// Levels to play: one, or several that visitors choose from.
    pub levels: Levels,
    /// Chapters of the path to play in place of `levels`, counted from 1; default none.
    #[serde(default)]
    pub chapters: Chapters,
    /// Calm mode for small children: nothing tears, and drawn faces stay happy. Default false.
    #[serde(default)]
    pub calm: bool,
    /// Whether visitors can let time run back. Default true.
    #[serde(default = "usual_rewind")]
    pub rewind: bool,
    /// Whether a second player may join.
    pub two_players: bool,
    /// Times without input until the stand is reset and until the pointer is hidden.
    pub times: Times,
    /// Sound volume.
    pub sound: SoundConfig,
    /// Force feedback.
    pub force: ForceConfig,
    /// Souvenirs: QR codes for visitors and clips for the operator.
    #[serde(default)]
    pub take_home: TakeHome,
    /// Staff access.
    #[serde(default)]
    pub staff: Staff,
    /// Opening hours. `None` (default) = always open.
    #[serde(default)]
    pub hours: Option<Hours>,
    /// Logbook and its retention.
    pub logbook: LogbookConfig,
}

/// Times without input until the stand is reset and until the pointer is hidden [s].
#[derive(Copy, Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Times {
    /// Time without input before the countdown ring appears.
    pub rest: Seconds,
    /// Length of the countdown, after which the stand is reset.
    pub countdown: Seconds,
    /// Time without mouse movement after which the pointer is hidden.
    pub pointer: Seconds,
}

/// Sound volume.
#[derive(Copy, Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SoundConfig {
    /// Master volume, 0 to 1.
    pub volume: Fraction,
}

/// Force feedback.
#[derive(Copy, Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForceConfig {
    /// Strength with which sticks push back, 0 to 1.
    pub strength: Fraction,
    /// Whether an idle stick moves gently to attract visitors.
    pub calls: bool,
}

/// Souvenirs: QR codes for visitors and clips for the operator.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TakeHome {
    /// Address of the page that opens links to rounds. `None` (default) = visitors are shown no QR code.
    pub page: Option<PageAddress>,
    /// Number of clips of won rounds that are kept for the operator. Older clips are deleted. 0 (default)
    /// keeps none.
    pub clips: usize,
}

/// Staff access.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Staff {
    /// PIN of the staff pages. `None` (default) = the staff pages are not accessible.
    pub pin: Option<Pin>,
}

/// Opening hours in the local time of the machine.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "StatedHours")]
pub struct Hours {
    /// Opening time.
    pub open: Hour,
    /// Closing time.
    pub close: Hour,
}

/// Logbook and its retention.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogbookConfig {
    /// Folder of the logbook, rounds and clips. `None` = `exhibit` in the data folder of the game.
    pub folder: Option<String>,
    /// Number of days for which visits and rounds are kept.
    pub days: u32,
    /// PostgreSQL server that receives a copy of the logbook. `None` = no copy.
    pub server: Option<Server>,
}

/// Defines the type of a checked configuration value. The check runs while the file is parsed, so that its
/// error message contains the line number.
macro_rules! checked {
    ($(#[$doc:meta])* $name:ident($kind:ty), $read:ty, $check:expr) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name(pub $kind);

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Self, D::Error> {
                let check: fn($read) -> Result<$kind, String> = $check;
                check(<$read>::deserialize(reader)?).map(Self).map_err(serde::de::Error::custom)
            }
        }
    };
}

checked! {
    /// Name of 1 to 40 characters.
    StandName(String), String, |name| match name.chars().count() {
        1..=40 if !name.contains(char::is_control) => Ok(name),
        _ => Err(format!("expected a name of 1 to 40 characters, found {name:?}")),
    }
}
checked! {
    /// One to three built-in levels that can be won, given by their ids.
    Levels(Vec<Arc<Level>>), Vec<String>, |ids| {
        if !(1..=MOST_LEVELS).contains(&ids.len()) {
            return Err(format!("expected 1 to {MOST_LEVELS} levels, found {}", ids.len()));
        }
        let open = |id: &String| match Level::open(id) {
            Ok(level) if level.has_basket() => Ok(Arc::new(level)),
            Ok(_) => Err(format!("expected a level that can be won, found {id:?}")),
            Err(LevelError::Unknown { known, .. }) => {
                let found = if is_link(id) { "the link " } else { "" };
                Err(format!("expected the name of a built-in level ({known}), found {found}{id:?}"))
            }
            Err(error) => Err(error.to_string()),
        };
        ids.iter().map(open).collect()
    }
}
checked! {
    /// Numbers of chapters of the path, counted from 1.
    #[derive(Default)]
    Chapters(Vec<usize>), Vec<usize>, |numbers| {
        let has_levels = |number: &usize| PATH.iter().any(|level| level.chapter == *number);
        match numbers.iter().find(|number| !has_levels(number)) {
            Some(wrong) => Err(format!("expected chapters from 1 to {}, found {wrong}", CHAPTERS.len())),
            None => Ok(numbers),
        }
    }
}
checked! {
    /// Address of a page, `https://…`.
    PageAddress(String), String, |page| match page.starts_with("https://") || page.starts_with("http://") {
        true if page.len() <= 200 && !page.contains(['#', ' ']) => Ok(page),
        _ => Err(format!("expected the address of a page (https://…) of at most 200 bytes, without # and spaces, found {page:?}")),
    }
}
checked! {
    /// PIN of four to eight digits.
    Pin(String), toml::Value, |pin| match pin.as_str() {
        Some(pin) if (4..=8).contains(&pin.len()) && pin.bytes().all(|digit| digit.is_ascii_digit()) => Ok(pin.into()),
        _ => Err("expected 4 to 8 digits in quotation marks, for example \"2004\"".into()),
    }
}

checked! {
    /// Address of a PostgreSQL server. Requires the feature `postgres`.
    Server(String), String, |address| match cfg!(feature = "postgres") {
        true => Ok(address),
        false => Err("a server requires the feature postgres, but this program was built without it".into()),
    }
}

checked! {
    /// Duration of 1 to 600 s.
    #[derive(Copy)]
    Seconds(f32), f32, |seconds| match (1.0..=600.0).contains(&seconds) {
        true => Ok(seconds),
        false => Err(format!("expected 1 to 600 seconds, found {seconds}")),
    }
}
checked! {
    /// Fraction, 0 to 1.
    #[derive(Copy)]
    Fraction(f32), f32, |share| match (0.0..=1.0).contains(&share) {
        true => Ok(share),
        false => Err(format!("expected a number from 0 to 1, found {share}")),
    }
}
checked! {
    /// Time of day, `10:00`.
    #[derive(Copy, Eq)]
    Hour(Time), String, |text| {
        let wrong = |_| format!("expected a time of day such as \"10:00\", found {text:?}");
        Time::strptime("%H:%M", &text).map_err(wrong)
    }
}

impl Seconds {
    /// Returns the longer of two durations.
    pub fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
}

/// Opening hours before validation.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StatedHours {
    open: Hour,
    close: Hour,
}

impl TryFrom<StatedHours> for Hours {
    type Error = String;

    fn try_from(stated: StatedHours) -> Result<Self, String> {
        let StatedHours { open, close } = stated;
        match open == close {
            true => Err("expected different times in open and close, found the same".into()),
            false => Ok(Self { open, close }),
        }
    }
}

impl Hours {
    /// Whether the stand is open at `now`. If the closing time is before the opening time, the stand is open
    /// over midnight.
    pub fn is_open(&self, now: Time) -> bool {
        let (open, close) = (self.open.0, self.close.0);
        match open <= close {
            true => open <= now && now < close,
            false => open <= now || now < close,
        }
    }
}

impl Config {
    /// Parses a configuration file.
    ///
    /// # Errors
    /// The error text describes the problem and names its line in the file.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut config: Self = toml::from_str(text).map_err(|error| error.to_string())?;
        let chapters = &config.chapters.0;
        if !chapters.is_empty() {
            let path = PATH
                .iter()
                .filter(|level| chapters.contains(&level.chapter));
            config.levels = Levels(path.map(|level| Arc::new(level.open())).collect());
        }
        if config.calm {
            config.levels = config.levels.calmed(!chapters.is_empty())?;
        }
        Ok(config)
    }

    /// Settings of the game after a reset of the stand.
    pub fn settings(&self) -> Settings {
        Settings {
            language: self.language,
            volume: self.sound.volume.0,
            haptics: self.force.strength.0,
            calm: self.calm,
            full_screen: true,
            ..Settings::default()
        }
    }
}

/// A configuration change that staff can make at the stand.
#[derive(Clone, Debug, PartialEq)]
pub enum ConfigChange {
    /// Default language of the stand.
    Language(Language),
    /// Sound volume, 0 to 1.
    Volume(f32),
    /// Force feedback strength, 0 to 1.
    Strength(f32),
    /// Ids of the levels to choose from.
    Levels(Vec<String>),
    /// Opening and closing time. `None` = always open.
    Hours(Option<(Time, Time)>),
}

impl ConfigChange {
    /// Returns the configuration file `text` with this change. All other lines, including comments, stay as
    /// the operator wrote them.
    ///
    /// # Errors
    /// The error text describes a problem in the file and names its line, or tells why the change is invalid.
    pub fn in_text(&self, text: &str) -> Result<String, String> {
        // Reports an error that was in the file before the change: the operator may have edited the file
        // since the stand last read it.
        Config::read(text)?;
        let mut file: DocumentMut = text.parse().map_err(|error| format!("{error}"))?;
        match self {
            Self::Language(language) => {
                let name = toml::Value::try_from(language).map_err(|error| error.to_string())?;
                put(&mut file["language"], name.as_str().unwrap_or_default());
            }
            Self::Volume(volume) => put(&mut file["sound"]["volume"], rounded(*volume)),
            Self::Strength(strength) => put(&mut file["force"]["strength"], rounded(*strength)),
            Self::Levels(ids) => {
                file.remove("chapters");
                put(
                    &mut file["levels"],
                    Value::from_iter(ids.iter().map(String::as_str)),
                );
            }
            Self::Hours(None) => drop(file.remove("hours")),
            Self::Hours(Some((open, close))) => {
                for (name, time) in [("open", open), ("close", close)] {
                    put(&mut file["hours"][name], time.strftime("%H:%M").to_string());
                }
            }
        }
        let text = file.to_string();
        Config::read(&text).map(|_| text)
    }
}

impl Levels {
    /// Returns the levels with nothing that tears. Levels in which things must tear are left out if `leaves_out`.
    ///
    /// # Errors
    /// A text that names a level in which things must tear, or tells that no level is left.
    fn calmed(&self, leaves_out: bool) -> Result<Self, String> {
        let must_tear = |level: &&Arc<Level>| level.must_tear();
        if let Some(level) = self.0.iter().find(must_tear).filter(|_| !leaves_out) {
            let id = &level.id;
            return Err(format!(
                "calm: expected false with the level {id:?}, in which things must tear"
            ));
        }
        let calm = self.0.iter().filter(|level| !must_tear(level));
        let calm = calm.map(|level| level.assisted(&[Assist::Unbreakable].into()).map(Arc::new));
        let calm: Result<Vec<_>, _> = calm.collect();
        let calm = calm.map_err(|error| error.to_string())?;
        match calm.is_empty() {
            true => {
                Err("calm: expected false, because things must tear in all these levels".into())
            }
            false => Ok(Self(calm)),
        }
    }
}

fn usual_rewind() -> bool {
    true
}

/// Rounds to two decimal digits.
fn rounded(share: f32) -> f64 {
    (f64::from(share) * 100.0).round() / 100.0
}

/// Replaces a value and keeps the comment beside it.
fn put(item: &mut Item, value: impl Into<Value>) {
    let mut value = value.into();
    if let Some(old) = item.as_value() {
        *value.decor_mut() = old.decor().clone();
    }
    *item = Item::Value(value);
}

#[cfg(test)]
mod tests {
    use super::*;
    use tamaire_play::level::built_in;

    #[test]
    fn default_file_is_valid_and_comments_every_value() {
        let config = Config::read(DEFAULT_CONFIG).unwrap();
        assert_eq!(config.levels.0[0].id, "classic");
        for line in DEFAULT_CONFIG.lines().filter(|line| line.contains(" = ")) {
            assert!(line.contains('#'), "{line}");
        }
    }

    #[test]
    fn invalid_value_is_reported_with_line_and_expectation() {
        let known: Vec<&str> = built_in().map(|(id, _)| id).collect();
        let known = known.join(", ");
        let refused = format!("a built-in level ({known}), found \"mine.toml\"");
        for (right, wrong, told) in [
            (
                "volume = 0.6",
                "volume = 7.0",
                "a number from 0 to 1, found 7",
            ),
            ("rest = 20", "rest = 0", "1 to 600 seconds, found 0"),
            ("rest = 20", "rest = \"long\"", "invalid type"),
            ("two_players = true", "two_player = true", "two_player"),
            (
                "levels = [\"classic\"]",
                "levels = []",
                "1 to 3 levels, found 0",
            ),
            (
                "levels = [\"classic\"]",
                "levels = [\"mine.toml\"]",
                &refused[..],
            ),
            (
                "levels = [\"classic\"]",
                "levels = [\"https://example.org/#l1abcz\"]",
                "found the link \"https://example.org/#l1abcz\"",
            ),
            ("language = \"japanese\"", "language = \"latin\"", "latin"),
            ("#page = ", "page = \"museum\" #", "address of a page"),
            ("#pin = ", "pin = \"12a4\" #", "4 to 8 digits"),
            ("#pin = ", "pin = 1234 #", "in quotation marks"),
            ("#open = ", "open = \"25:00\" #", "10:00"),
        ] {
            assert!(DEFAULT_CONFIG.contains(right), "{right}");
            let text = DEFAULT_CONFIG.replacen(right, wrong, 1);
            let text = match wrong.starts_with("open") {
                true => text
                    .replace("#[hours]", "[hours]")
                    .replace("#close", "close"),
                false => text,
            };
            let line = 1 + text
                .lines()
                .position(|line| line.starts_with(wrong))
                .unwrap();
            let error = Config::read(&text).unwrap_err();
            assert!(error.contains(told), "{error}");
            assert!(error.contains(&format!("line {line},")), "{line}: {error}");
        }
    }

    #[test]
    fn chapters_replace_levels_and_calm_leaves_out_what_must_tear() {
        let with = |lines: &str| Config::read(&format!("{lines}\n{DEFAULT_CONFIG}"));
        let ids = |config: &Config| -> Vec<String> {
            config
                .levels
                .0
                .iter()
                .map(|level| level.id.clone())
                .collect()
        };
        let of_path = |chapters: &[usize]| -> Vec<String> {
            let path = PATH
                .iter()
                .filter(|level| chapters.contains(&level.chapter));
            path.map(|level| level.id.to_string()).collect()
        };
        let config = with("chapters = [1, 5]").unwrap();
        assert_eq!(ids(&config), of_path(&[1, 5]));
        let calm = DEFAULT_CONFIG.replace("calm = false", "calm = true");
        let config = Config::read(&format!("chapters = [2, 4]\n{calm}")).unwrap();
        let (left, all) = (ids(&config), of_path(&[2, 4]));
        assert!(!left.contains(&"halves".to_string()) && all.contains(&"halves".to_string()));
        for level in &config.levels.0 {
            let tears = level
                .scene()
                .materials()
                .iter()
                .any(|material| material.strength.is_finite());
            assert!(!tears, "{}", level.id);
        }
        assert!(config.settings().calm);
        let halves = calm.replace("[\"classic\"]", "[\"halves\"]");
        let error = Config::read(&halves).unwrap_err();
        assert!(
            error.contains("calm: expected false with the level \"halves\""),
            "{error}"
        );
        let error = with("chapters = [7]").unwrap_err();
        assert!(
            error.contains("expected chapters from 1 to 5, found 7"),
            "{error}"
        );
        // Staff who choose levels replace the chapters.
        let chosen = ConfigChange::Levels(vec!["hoop".into()]);
        let text = chosen
            .in_text(&format!("chapters = [1]\n{DEFAULT_CONFIG}"))
            .unwrap();
        assert_eq!(ids(&Config::read(&text).unwrap()), ["hoop"]);
    }

    #[test]
    fn closing_before_opening_means_open_over_midnight() {
        let hours = |open: &str, close: &str| Hours {
            open: Hour(Time::strptime("%H:%M", open).unwrap()),
            close: Hour(Time::strptime("%H:%M", close).unwrap()),
        };
        let at = |hour| Time::constant(hour, 0, 0, 0);
        let day = hours("10:00", "18:00");
        assert_eq!(
            [9, 10, 17, 18].map(|hour| day.is_open(at(hour))),
            [false, true, true, false]
        );
        let night = hours("18:00", "02:00");
        assert_eq!(
            [17, 18, 1, 2].map(|hour| night.is_open(at(hour))),
            [false, true, true, false]
        );
    }

    #[test]
    fn change_keeps_rest_of_file() {
        let nine = Time::constant(9, 0, 0, 0);
        let changes = [
            ConfigChange::Volume(0.35),
            ConfigChange::Strength(0.0),
            ConfigChange::Language(Language::English),
            ConfigChange::Levels(vec!["classic".into(), "hoop".into()]),
            ConfigChange::Hours(Some((nine, Time::constant(17, 30, 0, 0)))),
        ];
        let changed = changes
            .iter()
            .try_fold(DEFAULT_CONFIG.to_string(), |text, change| {
                change.in_text(&text)
            });
        let changed = changed.unwrap();
        let config = Config::read(&changed).unwrap();
        assert_eq!(
            (config.sound.volume.0, config.force.strength.0),
            (0.35, 0.0)
        );
        assert_eq!(
            (config.language, config.levels.0.len()),
            (Language::English, 2)
        );
        assert_eq!(config.hours.unwrap().open.0, nine);
        let comments = |text: &str| text.matches('#').count();
        assert_eq!(comments(&changed), comments(DEFAULT_CONFIG));
        let broken = DEFAULT_CONFIG.replace("[sound]\nvolume = 0.6", "sound = 0.5");
        assert_ne!(broken, DEFAULT_CONFIG);
        assert!(ConfigChange::Volume(0.1).in_text(&broken).is_err());
        let always = ConfigChange::Hours(None).in_text(&changed).unwrap();
        assert_eq!(Config::read(&always).unwrap().hours, None);
        assert!(
            ConfigChange::Levels(Vec::new())
                .in_text(DEFAULT_CONFIG)
                .unwrap_err()
                .contains("1 to 3 levels")
        );
    }
}

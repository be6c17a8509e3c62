//! What the operator of a stand chose: `exhibit.toml`.

use crate::settings::Settings;
use crate::words::Language;
use jiff::civil::Time;
use serde::{Deserialize, Deserializer};
use std::sync::Arc;
use tamaire_play::Level;
use toml_edit::{DocumentMut, Item, Value};

/// A file for a stand as it usually is, with a word on each line.
pub const USUAL: &str = include_str!("exhibit.toml");

/// Most levels that a visitor can choose from.
const MOST_LEVELS: usize = 3;

/// What the operator of a stand chose.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// What the stand is called in the logbook.
    pub stand: StandName,
    /// What a fresh stand speaks.
    pub language: Language,
    /// Whether visitors may change that.
    pub other_languages: bool,
    /// What visitors play: one, or some that they choose from.
    pub levels: Levels,
    /// Whether a second player may come in.
    pub two_players: bool,
    /// When visitors are taken to have left.
    pub times: Times,
    /// How loud it is.
    pub sound: Loudness,
    /// How strongly sticks push back.
    pub force: Forces,
    /// What visitors take home.
    #[serde(default)]
    pub take_home: TakeHome,
    /// Who may look behind the stand.
    #[serde(default)]
    pub staff: Staff,
    /// When it is open; always if it does not say.
    #[serde(default)]
    pub hours: Option<Hours>,
    /// What is kept.
    pub logbook: Kept,
}

/// When visitors are taken to have left [s].
#[derive(Copy, Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Times {
    /// After so long without any movement a ring counts down …
    pub rest: Seconds,
    /// … for so long, and then the stand is fresh.
    pub countdown: Seconds,
    /// The mouse is hidden when it rested for so long.
    pub pointer: Seconds,
}

/// How loud it is, from 0 to 1.
#[derive(Copy, Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Loudness {
    /// All of it.
    pub volume: Share,
}

/// How strongly sticks push back.
#[derive(Copy, Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Forces {
    /// From 0 to 1.
    pub strength: Share,
    /// Whether a stick may stir by itself, gently, to call visitors.
    pub calls: bool,
}

/// What visitors take home.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TakeHome {
    /// The page that opens links to rounds; without one there is none to take home.
    pub page: Option<Page>,
    /// How many clips of won rounds are kept for the operator.
    pub clips: usize,
}

/// Who may look behind the stand.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Staff {
    /// Without one nobody may.
    pub pin: Option<Pin>,
}

/// From when to when it is open, on the clock of the machine.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "StatedHours")]
pub struct Hours {
    /// From then …
    pub open: Hour,
    /// … until then.
    pub close: Hour,
}

/// What is kept, and for how long.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kept {
    /// Where; the folder of the game if it does not say.
    pub folder: Option<String>,
    /// For how many days.
    pub days: u32,
    /// A PostgreSQL server that gets it too.
    pub server: Option<Server>,
}

/// Reads a value and checks it, so that a mistake is told with its line.
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
    /// A name of 1 to 40 letters.
    StandName(String), String, |name| match name.chars().count() {
        1..=40 if !name.contains(char::is_control) => Ok(name),
        _ => Err(format!("expected a name of 1 to 40 letters, found {name:?}")),
    }
}
checked! {
    /// Levels that come along.
    Levels(Vec<Arc<Level>>), Vec<String>, |ids| {
        if !(1..=MOST_LEVELS).contains(&ids.len()) {
            return Err(format!("expected 1 to {MOST_LEVELS} levels, found {}", ids.len()));
        }
        let open = |id: &String| match Level::open(id) {
            Ok(level) if level.game().basket.is_some() => Ok(Arc::new(level)),
            Ok(_) => Err(format!("expected a level that can be won, found {id:?}")),
            Err(error) => Err(error.to_string()),
        };
        ids.iter().map(open).collect()
    }
}
checked! {
    /// The address of a page, `https://…`.
    Page(String), String, |page| match page.starts_with("https://") || page.starts_with("http://") {
        true if page.len() <= 200 && !page.contains(['#', ' ']) => Ok(page),
        _ => Err(format!("expected the address of a page (https://…) of 200 letters at most, without #, found {page:?}")),
    }
}
checked! {
    /// Four to eight digits.
    Pin(String), toml::Value, |pin| match pin.as_str() {
        Some(pin) if (4..=8).contains(&pin.len()) && pin.bytes().all(|digit| digit.is_ascii_digit()) => Ok(pin.into()),
        _ => Err("expected 4 to 8 digits in quotation marks, as in \"2004\"".into()),
    }
}

checked! {
    /// The address of a PostgreSQL server, where the program can send to one.
    Server(String), String, |address| match cfg!(feature = "postgres") {
        true => Ok(address),
        false => Err("this program was built without the feature postgres, and sends nothing to a server".into()),
    }
}

/// From 1 to 600 seconds.
#[derive(Copy, Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "f32")]
pub struct Seconds(pub f32);

impl Seconds {
    /// The longer one.
    pub fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
}

impl TryFrom<f32> for Seconds {
    type Error = String;

    fn try_from(seconds: f32) -> Result<Self, String> {
        match (1.0..=600.0).contains(&seconds) {
            true => Ok(Self(seconds)),
            false => Err(format!("expected 1 to 600 seconds, found {seconds}")),
        }
    }
}

/// From 0 to 1.
#[derive(Copy, Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "f32")]
pub struct Share(pub f32);

impl TryFrom<f32> for Share {
    type Error = String;

    fn try_from(share: f32) -> Result<Self, String> {
        match (0.0..=1.0).contains(&share) {
            true => Ok(Self(share)),
            false => Err(format!("expected a number from 0 to 1, found {share}")),
        }
    }
}

/// A time of day, `10:00`.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct Hour(pub Time);

impl TryFrom<String> for Hour {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let wrong = |_| format!("expected a time of day such as \"10:00\", found {text:?}");
        Time::strptime("%H:%M", &text).map(Self).map_err(wrong)
    }
}

/// Hours as they are stated.
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
            true => Err("expected it to close at another time than it opens".into()),
            false => Ok(Self { open, close }),
        }
    }
}

impl Hours {
    /// Whether it is open at a time of day. Who closes before it opens is open over midnight.
    pub fn is_open(&self, now: Time) -> bool {
        let (open, close) = (self.open.0, self.close.0);
        match open <= close {
            true => open <= now && now < close,
            false => open <= now || now < close,
        }
    }
}

impl Config {
    /// What a file says.
    ///
    /// # Errors
    /// What is wrong, and in which line.
    pub fn read(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|error| error.to_string())
    }

    /// The settings of a fresh stand.
    pub fn settings(&self) -> Settings {
        Settings {
            language: self.language,
            volume: self.sound.volume.0,
            haptics: self.force.strength.0,
            full_screen: true,
            ..Settings::default()
        }
    }
}

/// What staff can change at the stand.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// What a fresh stand speaks.
    Language(Language),
    /// How loud it is, 0 to 1.
    Volume(f32),
    /// How strongly sticks push back, 0 to 1.
    Strength(f32),
    /// The levels to choose from, by name.
    Levels(Vec<String>),
    /// From when to when it is open; always without.
    Hours(Option<(Time, Time)>),
}

impl Change {
    /// A file with this in it: all else stays as the operator wrote it, with every word beside it.
    ///
    /// # Errors
    /// What is wrong with the file, and in which line; or why it cannot be so.
    pub fn in_text(&self, text: &str) -> Result<String, String> {
        // What somebody wrote into it since it was read may be anything.
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

/// Two digits are enough.
fn rounded(share: f32) -> f64 {
    (f64::from(share) * 100.0).round() / 100.0
}

/// Changes a value and leaves what stands beside it.
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

    #[test]
    fn the_usual_file_is_good_and_says_a_word_on_all() {
        let config = Config::read(USUAL).unwrap();
        assert_eq!(config.levels.0[0].id, "classic");
        for line in USUAL.lines().filter(|line| line.contains(" = ")) {
            assert!(line.contains('#'), "{line}");
        }
    }

    #[test]
    fn a_mistake_is_told_with_its_line_and_what_was_expected() {
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
                "levels = [\"nothing\"]",
                "nothing",
            ),
            ("language = \"japanese\"", "language = \"latin\"", "latin"),
            ("#page = ", "page = \"museum\" #", "address of a page"),
            ("#pin = ", "pin = \"12a4\" #", "4 to 8 digits"),
            ("#pin = ", "pin = 1234 #", "in quotation marks"),
            ("#open = ", "open = \"25:00\" #", "10:00"),
        ] {
            assert!(USUAL.contains(right), "{right}");
            let text = USUAL.replacen(right, wrong, 1);
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
    fn who_closes_after_midnight_is_open_over_it() {
        let hours = |open: &str, close: &str| Hours {
            open: Hour::try_from(open.to_string()).unwrap(),
            close: Hour::try_from(close.to_string()).unwrap(),
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
    fn a_change_leaves_all_else_as_it_was_written() {
        let nine = Time::constant(9, 0, 0, 0);
        let changes = [
            Change::Volume(0.35),
            Change::Strength(0.0),
            Change::Language(Language::English),
            Change::Levels(vec!["classic".into(), "hoop".into()]),
            Change::Hours(Some((nine, Time::constant(17, 30, 0, 0)))),
        ];
        let changed = changes
            .iter()
            .try_fold(USUAL.to_string(), |text, change| change.in_text(&text));
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
        assert_eq!(comments(&changed), comments(USUAL));
        let broken = USUAL.replace("[sound]\nvolume = 0.6", "sound = 0.5");
        assert_ne!(broken, USUAL);
        assert!(Change::Volume(0.1).in_text(&broken).is_err());
        let always = Change::Hours(None).in_text(&changed).unwrap();
        assert_eq!(Config::read(&always).unwrap().hours, None);
        assert!(
            Change::Levels(Vec::new())
                .in_text(USUAL)
                .unwrap_err()
                .contains("1 to 3 levels")
        );
    }
}

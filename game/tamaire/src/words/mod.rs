//! All texts of the game. A text that is missing in a language is a compile error.

mod en;
mod ja;
mod making;
mod said;
#[cfg(not(target_family = "wasm"))]
mod stand;

pub use making::MakingWords;
pub use said::Words;
#[cfg(not(target_family = "wasm"))]
pub use stand::StandWords;

use serde::{Deserialize, Serialize};
use tamaire_play::{LocalizedText as Name, Outcome};

/// A language of the game.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Language {
    /// English.
    #[default]
    English,
    /// Japanese (日本語).
    Japanese,
}

impl Language {
    /// All languages, each with its own name for itself.
    pub const ALL: [(Self, &'static str); 2] =
        [(Self::English, "English"), (Self::Japanese, "日本語")];

    /// Returns the language of a locale such as `ja-JP` or `ja_JP.UTF-8`; English if the game has no such language.
    pub fn of_locale(locale: &str) -> Self {
        match locale.split(['-', '_', '.']).next() {
            Some("ja") => Self::Japanese,
            _ => Self::English,
        }
    }

    /// Returns the other of the two languages.
    pub fn other(self) -> Self {
        match self {
            Self::English => Self::Japanese,
            Self::Japanese => Self::English,
        }
    }

    /// Language code [ISO 639-1].
    pub fn code(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::Japanese => "ja",
        }
    }

    /// Texts of the game in this language.
    pub fn words(self) -> &'static Words {
        match self {
            Self::English => &en::WORDS,
            Self::Japanese => &ja::WORDS,
        }
    }

    /// Returns `name` in this language; the English one if there is no translation.
    pub fn of(self, name: &Name) -> &str {
        match (self, &name.ja) {
            (Self::Japanese, Some(ja)) => ja,
            _ => &name.en,
        }
    }
}

/// Returns a share in whole percent, rounded down, so that a share below a limit never looks like the limit.
fn percent_below(share: f32) -> u32 {
    // The tolerance of 1e-4 covers rounding errors: 0.29 × 100 is less than 29.
    (100.0 * share + 1e-4).floor() as u32
}

/// Returns the share of the mass that was torn off, in whole percent, rounded up.
fn percent_lost(outcome: &Outcome) -> u32 {
    100 - percent_below(outcome.kept.min(1.0))
}

/// Returns a limit in percent with all of its digits, for example 62.5 for 0.625.
fn percent_of_limit(share: f32) -> f64 {
    // Rounding removes the error of single precision: 0.29 × 100 is less than 29.
    (1e3 * f64::from(100.0 * share)).round() / 1e3
}

/// Returns a time in tenths of a second, rounded up, so that a time above a limit never looks like the limit.
fn tenths_above(seconds: f32) -> f32 {
    // The sum turns −0 into 0.
    (10.0 * seconds - 1e-3).ceil() / 10.0 + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use tamaire_play::{Route, Wish};

    #[test]
    fn near_miss_names_only_missed_figures_and_never_shows_the_limit() {
        let outcome = Outcome {
            ticks: 1201,
            route: Route::Shave,
            kept: 0.8999,
            inside: 0.7,
            pieces: 3,
            lost: 0,
            broken: 0,
            torn: 0,
        };
        let wish = |seconds, kept, pieces| Wish {
            seconds,
            kept,
            pieces,
            ..Wish::default()
        };
        for (wish, english, japanese) in [
            (
                wish(Some(20.0), None, None),
                Some("20.1 s"),
                Some("20.1秒だった"),
            ),
            (
                wish(None, Some(0.9), None),
                Some("11 % torn off"),
                Some("11％ ちぎれた"),
            ),
            (wish(None, None, Some(5)), Some("3 of 5"), Some("3こだった")),
            (wish(Some(21.0), Some(0.5), Some(3)), None, None),
        ] {
            let told = |language: Language| (language.words().near_miss)(&wish, &outcome);
            assert_eq!(told(Language::English).as_deref(), english);
            assert_eq!(told(Language::Japanese).as_deref(), japanese);
        }
        assert_eq!((Language::English.words().share)(0.29, 0.6), "29 / 60 %");
        for (limit, expected) in [(0.625, "62.5"), (0.29, "29"), (0.9, "90"), (1.0, "100")] {
            assert_eq!(percent_of_limit(limit).to_string(), expected);
        }
        let kept = wish(None, Some(0.625), None);
        assert_eq!(
            (Language::English.words().wish)(&kept),
            "tear off at most 37.5 %"
        );
        assert_eq!(
            (Language::Japanese.words().goal)(&kept),
            "ちぎるのは37.5％まで"
        );
        assert_eq!((Language::English.words().share)(0.5999, 0.6), "59 / 60 %");
    }

    #[test]
    fn summary_agrees_with_the_missed_figures() {
        let outcome = Outcome {
            ticks: 1201,
            route: Route::Shave,
            kept: 0.8999,
            inside: 0.5999,
            pieces: 3,
            lost: 0,
            broken: 0,
            torn: 0,
        };
        let values = |language: Language| (language.words().summary)(&outcome).map(|row| row.1);
        let english = ["20.1 s", "11 %", "59 %", "3"].map(String::from);
        let japanese = ["20.1秒", "11％", "59％", "3こ"].map(String::from);
        assert_eq!(values(Language::English), english);
        assert_eq!(values(Language::Japanese), japanese);
    }
}

//! All texts of the game. A text that is missing in a language is a compile error.

mod en;
mod ja;
mod said;
#[cfg(not(target_family = "wasm"))]
mod stand;

pub use said::Words;
#[cfg(not(target_family = "wasm"))]
pub use stand::StandWords;

use serde::{Deserialize, Serialize};
use tamaire_play::LocalizedText as Name;

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

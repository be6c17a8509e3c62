//! Everything that the game says. A word that a language lacks is a compile error.

mod en;
mod ja;
mod said;
#[cfg(not(target_family = "wasm"))]
mod stand;

pub use said::Words;
#[cfg(not(target_family = "wasm"))]
pub use stand::StandWords;

use serde::{Deserialize, Serialize};
use tamaire_play::Words as Name;

/// A language of the game.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Language {
    /// English.
    #[default]
    English,
    /// 日本語
    Japanese,
}

impl Language {
    /// All of them, with their own names.
    pub const ALL: [(Self, &'static str); 2] =
        [(Self::English, "English"), (Self::Japanese, "日本語")];

    /// That of a locale such as `ja-JP` or `ja_JP.UTF-8`; English where the game does not speak it.
    pub fn of_locale(locale: &str) -> Self {
        match locale.split(['-', '_', '.']).next() {
            Some("ja") => Self::Japanese,
            _ => Self::English,
        }
    }

    /// The other one.
    pub fn other(self) -> Self {
        match self {
            Self::English => Self::Japanese,
            Self::Japanese => Self::English,
        }
    }

    /// Its code [ISO 639-1].
    pub fn code(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::Japanese => "ja",
        }
    }

    /// What the game says in it.
    pub fn words(self) -> &'static Words {
        match self {
            Self::English => &en::WORDS,
            Self::Japanese => &ja::WORDS,
        }
    }

    /// The name of something in it.
    pub fn of(self, name: &Name) -> &str {
        match (self, &name.ja) {
            (Self::Japanese, Some(ja)) => ja,
            _ => &name.en,
        }
    }
}

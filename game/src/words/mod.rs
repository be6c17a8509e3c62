//! Everything that the game says. A word that a language lacks is a compile error.

mod en;
mod ja;

use crate::input::{Action, Means};
use force_feedback::{Ability, Calibration, Stop};
use serde::{Deserialize, Serialize};
use tamaire_play::level::LevelError;
use tamaire_play::{Outcome, ReplayError, Route, Wish, Words as Name};

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

/// What the game says.
#[allow(missing_docs)] // each field says what it is
pub struct Words {
    pub play: &'static str,
    pub replays: &'static str,
    pub settings: &'static str,
    pub quit: &'static str,
    pub back: &'static str,
    pub paused: &'static str,
    pub go_on: &'static str,
    pub again: &'static str,
    pub levels: &'static str,
    pub next: &'static str,
    pub other_way: fn(Route) -> &'static str,
    pub route: fn(Route) -> &'static str,
    pub wish: fn(&Wish) -> String,
    pub summary: fn(&Outcome) -> [(&'static str, String); 4],
    pub new_best: &'static str,
    pub watch: &'static str,
    pub race: &'static str,
    pub save: &'static str,
    pub delete: &'static str,
    pub surely: &'static str,
    pub saved: &'static str,
    pub no_replays: &'static str,
    pub language: &'static str,
    pub volume: &'static str,
    pub effects: &'static str,
    pub music: &'static str,
    pub interface: &'static str,
    pub haptics: &'static str,
    pub forces: &'static str,
    pub try_forces: &'static str,
    pub no_devices: &'static str,
    pub ability: fn(Ability) -> &'static str,
    pub forces_off: &'static str,
    pub silent: fn(Stop) -> &'static str,
    pub motors: [&'static str; 2],
    pub gains: [&'static str; 2],
    pub try_it: &'static str,
    pub enough: &'static str,
    pub push_it: &'static str,
    pub measure: &'static str,
    pub hands_off: &'static str,
    pub measured: &'static str,
    pub not_measured: &'static str,
    pub built: fn(&Calibration) -> String,
    pub as_usual: &'static str,
    pub forces_cut: &'static str,
    pub cut_now: &'static str,
    pub cut_hint: fn(&[String; 2]) -> String,
    pub restore: &'static str,
    pub restored: &'static str,
    pub forces_zero: &'static str,
    pub speed: &'static str,
    pub sensitivity: &'static str,
    pub stick_places: &'static str,
    pub reduced_motion: &'static str,
    pub colour_safe: &'static str,
    pub text_size: &'static str,
    pub controls: &'static str,
    pub press_any: &'static str,
    pub reset: &'static str,
    pub sound_section: &'static str,
    pub play_section: &'static str,
    pub look_section: &'static str,
    pub action: fn(Action) -> &'static str,
    pub on: &'static str,
    pub off: &'static str,
    pub no_sound: &'static str,
    pub no_sticks: &'static str,
    pub join_hint: &'static str,
    pub how_in_space: fn(Means, &[String; 3]) -> [String; 3],
    /// How one looks deeper into bodies in space.
    pub look_inside: fn(Means, &[String; 2]) -> Option<String>,
    pub watching: &'static str,
    pub settings_kept: &'static str,
    pub not_written: &'static str,
    pub level_error: fn(&LevelError) -> String,
    pub replay_error: fn(&ReplayError) -> String,
}

//! What players chose. It is kept in a file that a person can read.

use crate::input::{Bindings, Scanning};
use crate::sift::{Sifted, sift};
use crate::words::Language;
use force_feedback::Calibration;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use tamaire_play::Assist;
use tamaire_sound::Volumes;

/// Felt as full force [N]. In the levels hands are pushed with 100 to 500: with less all bodies would feel alike, with
/// more a soft one would not be felt.
pub const FULL: f32 = 500.0;

/// What players chose.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// What the game speaks.
    pub language: Language,
    /// All sound, 0 to 1.
    pub volume: f32,
    /// What the world does, 0 to 1.
    pub effects: f32,
    /// The music, 0 to 1.
    pub music: f32,
    /// Menus and jingles, 0 to 1.
    pub interface: f32,
    /// How strongly sticks and pads push back, 0 to 1; at 0 they are not even taken hold of.
    pub haptics: f32,
    /// How those sticks are built in that were measured, by what names their model.
    pub calibrations: BTreeMap<String, Calibration>,
    /// Share of the usual speed, 0.5 to 1.
    pub speed: f32,
    /// How far keys and sticks move the hand, 0.3 to 3; 1 = usual.
    pub sensitivity: f32,
    /// Whether a stick points at a place in the arena, instead of saying how fast to go.
    pub stick_places: bool,
    /// Whether keys that move something stay down until they are pressed again.
    pub toggle_keys: bool,
    /// Whether a mouse that rests on a button presses it.
    pub dwell: bool,
    /// How fast what can be done is offered to whoever plays with one switch.
    pub scanning: Scanning,
    /// What is made easier in levels.
    pub assists: BTreeSet<Assist>,
    /// Whether one's fastest round is raced by itself.
    pub race_best: bool,
    /// Whether the window fills the screen.
    pub full_screen: bool,
    /// No shaking, no leaning, fewer particles.
    pub reduced_motion: bool,
    /// Colours that nobody mixes up.
    pub colour_safe: bool,
    /// 0.8 to 1.6; 1 = usual.
    pub text_size: f32,
    /// Keys and buttons.
    pub bindings: Bindings,
}

impl Default for Settings {
    fn default() -> Self {
        let Volumes {
            master,
            effects,
            music,
            interface,
        } = Volumes::default();
        Self {
            language: Language::default(),
            volume: master,
            effects,
            music,
            interface,
            haptics: 0.7,
            calibrations: BTreeMap::new(),
            speed: 1.0,
            sensitivity: 1.0,
            stick_places: false,
            toggle_keys: false,
            dwell: false,
            scanning: Scanning::default(),
            assists: BTreeSet::new(),
            race_best: false,
            full_screen: false,
            reduced_motion: false,
            colour_safe: false,
            text_size: 1.0,
            bindings: Bindings::default(),
        }
    }
}

impl Settings {
    /// Those in a text, and what of it could not be used. What is not known to be good is not felt.
    pub fn read(text: &str) -> (Self, Vec<String>) {
        let Sifted {
            value,
            table,
            mut refused,
        } = sift::<Self>(text);
        let mut settings = value.clone().in_range();
        let (found, kept) = (value.numbers(), settings.numbers());
        for ((name, found), (_, kept)) in found.into_iter().zip(kept) {
            // What is no number is not even itself.
            if found != kept {
                refused.push(format!("{name} ({found} is out of its range)"));
            }
        }
        let of_motors = |refused: &String| refused.starts_with("calibrations");
        let is_damaged = !refused.is_empty();
        if is_damaged && !table.contains_key("haptics") || refused.iter().any(of_motors) {
            // Nobody knows how strong it was to be, or how the motors lie.
            settings.haptics = 0.0;
        }
        (settings, refused)
    }

    /// It as a text.
    pub fn text(&self) -> String {
        toml::to_string(self).expect("settings have nothing that cannot be written")
    }

    /// Returns the values that [`Settings::in_range`] limits, with their names; without calibrations.
    fn numbers(&self) -> [(&'static str, f32); 8] {
        [
            ("volume", self.volume),
            ("effects", self.effects),
            ("music", self.music),
            ("interface", self.interface),
            ("haptics", self.haptics),
            ("speed", self.speed),
            ("sensitivity", self.sensitivity),
            ("text_size", self.text_size),
        ]
    }

    /// The same with every number in its range, and a key for every action.
    pub fn in_range(mut self) -> Self {
        let usual = Self::default();
        let fit = |value: &mut f32, low: f32, high: f32, usual: f32| {
            *value = if value.is_finite() {
                value.clamp(low, high)
            } else {
                usual
            };
        };
        fit(&mut self.volume, 0.0, 1.0, usual.volume);
        fit(&mut self.effects, 0.0, 1.0, usual.effects);
        fit(&mut self.music, 0.0, 1.0, usual.music);
        fit(&mut self.interface, 0.0, 1.0, usual.interface);
        fit(&mut self.haptics, 0.0, 1.0, 0.0);
        for calibration in self.calibrations.values_mut() {
            *calibration = calibration.bounded();
        }
        fit(&mut self.speed, 0.5, 1.0, usual.speed);
        fit(&mut self.sensitivity, 0.3, 3.0, usual.sensitivity);
        fit(&mut self.text_size, 0.8, 1.6, usual.text_size);
        self.bindings = self.bindings.complete();
        self
    }

    /// How a device of this model is to be felt; not at all where forces are off.
    pub fn force(&self, model: &str) -> Option<force_feedback::Settings> {
        let calibration = self.calibrations.get(model).copied();
        let settings = force_feedback::Settings {
            strength: self.haptics,
            full: FULL,
            calibration: calibration.unwrap_or_default(),
            ..force_feedback::Settings::default()
        };
        (self.haptics > 0.0).then_some(settings)
    }

    /// How loud what is.
    pub fn volumes(&self) -> Volumes {
        Volumes {
            master: self.volume,
            effects: self.effects,
            music: self.music,
            interface: self.interface,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_measured_is_kept_and_nonsense_is_not_felt() {
        let text = "haptics = nan\n[calibrations.stick]\nswap = true\ngain = [nan, 7.0]\n";
        let settings = toml::from_str::<Settings>(text).unwrap().in_range();
        let wanted = Calibration {
            swap: true,
            gain: [0.0, 1.0],
            ..Calibration::IDENTITY
        };
        assert_eq!(settings.calibrations["stick"], wanted);
        assert_eq!(settings.force("stick"), None, "no number is no force");
        let settings = Settings {
            haptics: 0.5,
            ..settings
        };
        assert_eq!(settings.force("stick").unwrap().calibration, wanted);
        assert_eq!(Settings::read(&settings.text()), (settings, Vec::new()));
    }

    #[test]
    fn a_bad_value_is_named_and_all_else_stays() {
        let text = "speed = 0.75\nvolume = 7.0\nmusic = \"loud\"\nhaptics = 0.4\n";
        let (settings, refused) = Settings::read(text);
        let wanted = Settings {
            speed: 0.75,
            volume: 1.0,
            haptics: 0.4,
            ..Settings::default()
        };
        assert_eq!(settings, wanted);
        assert!(refused[0].starts_with("music (") && refused[1].starts_with("volume (7 is"));
        for text in [
            "speed = \"fast\"",
            "haptics = \"much\"",
            "haptics = 0.4\n[calibrations.stick]\ngain = 3\n",
        ] {
            let (settings, refused) = Settings::read(text);
            let found = (settings.haptics, refused.len());
            assert_eq!(
                found,
                (0.0, 1),
                "{text}: nobody knows how strong it is to be"
            );
        }
        assert_eq!(Settings::read(""), (Settings::default(), Vec::new()));
    }
}

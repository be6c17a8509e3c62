//! Settings of the players, stored as TOML.

use crate::input::{Bindings, Scanning};
use crate::sift::{Sifted, sift};
use crate::words::Language;
use force_feedback::Calibration;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use tamaire_play::Assist;
use tamaire_sound::Volumes;

/// Contact force that is felt at full strength [N]. Players push with 100 to 500 N: with a lower value all
/// bodies would feel equally hard, with a higher one soft bodies could not be felt.
pub const FULL: f32 = 500.0;

/// Settings of the players.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Language of all text.
    pub language: Language,
    /// Master volume, 0 to 1.
    pub volume: f32,
    /// Volume of the sounds of the world, 0 to 1.
    pub effects: f32,
    /// Volume of the music, 0 to 1.
    pub music: f32,
    /// Volume of menus and jingles, 0 to 1.
    pub interface: f32,
    /// Strength of force feedback and rumble, 0 to 1; default 0.7. At 0 no device is opened for feedback.
    pub haptics: f32,
    /// Measured motor calibrations, by device model.
    pub calibrations: BTreeMap<String, Calibration>,
    /// Speed of the game, as a share of the usual speed, 0.5 to 1.
    pub speed: f32,
    /// Factor on the motion of the hand by keys and sticks, 0.3 to 3; 1 = usual.
    pub sensitivity: f32,
    /// Whether a stick sets the position of the hand in the arena instead of its velocity.
    pub stick_places: bool,
    /// Whether movement keys stay pressed until they are pressed again.
    pub toggle_keys: bool,
    /// Whether keeping the mouse pointer on a button presses it (dwell click).
    pub dwell: bool,
    /// Speed of scanning: for players with a single switch, the game offers one action after the other, and
    /// the switch chooses.
    pub scanning: Scanning,
    /// Assists that make levels easier.
    pub assists: BTreeSet<Assist>,
    /// Calm mode for small children: nothing tears, drawn faces stay happy, and all chapters are open. Levels in which
    /// things must tear are closed.
    pub calm: bool,
    /// Whether all chapters of the path are open.
    pub open_all: bool,
    /// Whether players race against the ghost of their own fastest round.
    pub race_best: bool,
    /// Whether the window is in full-screen mode.
    pub full_screen: bool,
    /// Whether motion is reduced: no camera shake, no camera lean, fewer particles.
    pub reduced_motion: bool,
    /// Whether colours are safe for colour-blind players.
    pub colour_safe: bool,
    /// Factor on the text size, 0.8 to 1.6; 1 = usual.
    pub text_size: f32,
    /// Picture quality of the world.
    pub quality: Quality,
    /// Name under which the player makes levels; may be empty.
    pub maker_name: String,
    /// Bindings of keys and buttons.
    pub bindings: Bindings,
}

/// Picture quality of the world.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quality {
    /// High, and lowered by steps if drawing is slow.
    #[default]
    Automatic,
    /// Full resolution of the window.
    High,
    /// Three quarters of the resolution.
    Medium,
    /// Half the resolution, fewer particles and no confetti.
    Low,
}

impl Quality {
    /// All choices, in the order of the settings.
    pub const ALL: [Self; 4] = [Self::Automatic, Self::High, Self::Medium, Self::Low];

    /// Returns the next lower quality.
    pub(crate) fn lower(self) -> Self {
        match self {
            Self::Automatic | Self::High => Self::Medium,
            Self::Medium | Self::Low => Self::Low,
        }
    }

    /// Resolution of the drawn world, relative to the window.
    pub(crate) fn resolution(self) -> f32 {
        match self {
            Self::Automatic | Self::High => 1.0,
            Self::Medium => 0.75,
            Self::Low => 0.5,
        }
    }
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
            calm: false,
            open_all: false,
            race_best: false,
            full_screen: false,
            reduced_motion: false,
            colour_safe: false,
            text_size: 1.0,
            quality: Quality::default(),
            maker_name: String::new(),
            bindings: Bindings::default(),
        }
    }
}

impl Settings {
    /// Reads settings from TOML. Also returns a description of each entry that could not be used. Turns force
    /// feedback off if its strength or a calibration could not be read.
    pub fn read(text: &str) -> (Self, Vec<String>) {
        let Sifted {
            value,
            table,
            mut refused,
        } = sift::<Self>(text);
        let mut settings = value.clone().in_range();
        let (found, kept) = (value.numbers(), settings.numbers());
        for ((name, found), (_, kept)) in found.into_iter().zip(kept) {
            // NaN differs from itself, so a NaN is reported, too.
            if found != kept {
                refused.push(format!("{name} ({found} is out of its range)"));
            }
        }
        let of_motors = |refused: &String| refused.starts_with("calibrations");
        let is_damaged = !refused.is_empty();
        if is_damaged && !table.contains_key("haptics") || refused.iter().any(of_motors) {
            // Turns force feedback off: the strength that the player chose or the calibration of the motors
            // is unknown.
            settings.haptics = 0.0;
        }
        (settings, refused)
    }

    /// Returns the assists that apply to levels which do not ignore them: those chosen, and those of calm mode.
    pub fn chosen_assists(&self) -> impl Iterator<Item = Assist> {
        let calm = self.calm.then_some(Assist::Unbreakable);
        let all: BTreeSet<Assist> = self.assists.iter().copied().chain(calm).collect();
        all.into_iter()
    }

    /// Returns the settings as TOML.
    pub fn text(&self) -> String {
        toml::to_string(self).expect("all fields can be written as TOML")
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

    /// Limits all numbers to their ranges and binds a key to every action.
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

    /// Returns the feedback settings for a device model, or `None` if feedback is off.
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

    /// Returns the volumes of all sounds.
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
    fn settings_keep_calibrations_and_limit_numbers() {
        let text = "haptics = nan\n[calibrations.stick]\nswap = true\ngain = [nan, 7.0]\n";
        let settings = toml::from_str::<Settings>(text).unwrap().in_range();
        let wanted = Calibration {
            swap: true,
            gain: [0.0, 1.0],
            ..Calibration::IDENTITY
        };
        assert_eq!(settings.calibrations["stick"], wanted);
        assert_eq!(
            settings.force("stick"),
            None,
            "a strength of NaN allows no force"
        );
        let settings = Settings {
            haptics: 0.5,
            ..settings
        };
        assert_eq!(settings.force("stick").unwrap().calibration, wanted);
        assert_eq!(Settings::read(&settings.text()), (settings, Vec::new()));
    }

    #[test]
    fn settings_read_reports_invalid_values_and_keeps_others() {
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
            assert_eq!(found, (0.0, 1), "{text}: the intended strength is unknown");
        }
        assert_eq!(Settings::read(""), (Settings::default(), Vec::new()));
    }
}

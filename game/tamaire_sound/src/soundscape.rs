//! Continuous sounds and volumes.

use crate::part::clean;

/// Continuous sounds. Must be reported in every frame: they fall silent after half a second without an
/// update.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Soundscape {
    /// Hands on a body, one for each of up to two players.
    pub presses: [Press; 2],
    /// Squash of the body, from 0 (none) to 1 (flat). Changes of the value cause a wobble.
    pub squash: f32,
    /// Elapsed share of the time for which the body must rest in the basket, from 0 to 1.
    pub hold: f32,
    /// Whether time runs back.
    pub rewind: bool,
    /// Whether background music plays.
    pub music: bool,
    /// Song of the background music, 0 to 5. A new one begins with the next chord.
    pub song: u8,
    /// Sounds that are muted for a while.
    pub hush: Mute,
}

/// A hand on a body.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Press {
    /// Contact force [N], usually about 400. Larger forces sound louder and higher.
    pub force: f32,
    /// Slip speed along the body [m/s], usually about 0.5. A hand squeaks only if it slips or its force
    /// changes.
    pub slip: f32,
    /// Position, from −1 at the left edge of the picture to 1 at the right.
    pub x: f32,
}

/// Sounds that are muted for a while.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Mute {
    /// Nothing is muted.
    #[default]
    Nothing,
    /// Mutes the sounds of the world while the game is paused; menus and music continue.
    World,
    /// Mutes everything while the window is in the background.
    Everything,
}

/// Volumes, each from 0 to 1.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Volumes {
    /// Overall volume, default 0.8.
    pub master: f32,
    /// Volume of hands, impacts, tears and all other sounds of the world, default 1.
    pub effects: f32,
    /// Volume of the background music, default 0.6.
    pub music: f32,
    /// Volume of menu sounds and jingles, default 0.8.
    pub interface: f32,
}

impl Default for Volumes {
    fn default() -> Self {
        Self {
            master: 0.8,
            effects: 1.0,
            music: 0.6,
            interface: 0.8,
        }
    }
}

impl Soundscape {
    /// Returns the soundscape with all numbers clamped to their ranges.
    pub(crate) fn cleaned(self) -> Self {
        let press = |press: Press| Press {
            force: clean(press.force, 0.0, 1e6),
            slip: clean(press.slip, 0.0, 1e3),
            x: clean(press.x, -1.0, 1.0),
        };
        Self {
            presses: self.presses.map(press),
            squash: clean(self.squash, 0.0, 1.0),
            hold: clean(self.hold, 0.0, 1.0),
            ..self
        }
    }
}

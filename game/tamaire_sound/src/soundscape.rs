//! What is heard for as long as it lasts, and how loud.

use crate::part::clean;

/// What lasts. To be told anew each frame: after half a second without news it falls silent.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Soundscape {
    /// What the hands of up to two players do.
    pub presses: [Press; 2],
    /// How much the body is squashed, from 0 for not at all to 1 for flat. A change of it wobbles.
    pub squash: f32,
    /// How much of the time is over for which the body must rest in the basket, from 0 to 1.
    pub hold: f32,
    /// Whether there is music in the background.
    pub music: bool,
    /// What is to be silent for a while.
    pub hush: Hush,
}

/// A hand on a body.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Press {
    /// How hard it presses [N]; about 400. Louder and higher with more.
    pub force: f32,
    /// How fast it slips along the body [m/s]; about 0.5. It squeaks only where it slips or stirs.
    pub slip: f32,
    /// Where, from -1 at the left edge of the picture to 1 at the right.
    pub x: f32,
}

/// What is to be silent for a while.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Hush {
    /// Nothing.
    #[default]
    Nothing,
    /// What the world does, while the game stands still; menus and music go on.
    World,
    /// Everything, while the window is in the background.
    Everything,
}

/// How loud, each from 0 to 1.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Volumes {
    /// All of it.
    pub master: f32,
    /// What the world does.
    pub effects: f32,
    /// The music in the background.
    pub music: f32,
    /// Menus and jingles.
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
    /// The same with every number in range.
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

//! What is heard at a moment.

use crate::part::clean;

/// Something that happened, and sounds once. Values that are no numbers count as nothing.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Cue {
    /// A body pressed on something rigid. May be sent every tick that it does: only a sudden rise is heard.
    Thud {
        /// Along the normals, over the tick [N s]; 1 is a soft landing, 30 a heavy one.
        impulse: f32,
        /// Where, from -1 at the left edge of the picture to 1 at the right.
        x: f32,
    },
    /// Something tore: one release, or all those of a tick together.
    Tear {
        /// Elastic energy set free [J]; 0.1 is a small release, 10 a rip right through.
        energy: f32,
        /// Where, from -1 to 1.
        x: f32,
    },
    /// A crumb landed.
    Crumb {
        /// How fast [m/s]; about 1.
        speed: f32,
        /// Where, from -1 to 1.
        x: f32,
    },
    /// The round was won, this way.
    Won(Route),
    /// Something was done in a menu.
    Menu(Menu),
}

/// How a round was won.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Route {
    /// The body went in whole.
    Squeeze,
    /// Bits were torn off until it fitted.
    Shave,
    /// Some of both.
    Mix,
}

/// What was done in a menu.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Menu {
    /// Another entry is chosen.
    Move,
    /// The entry was taken.
    Confirm,
    /// One screen back.
    Back,
}

impl Cue {
    /// The same with every number in range.
    pub(crate) fn cleaned(self) -> Self {
        let place = |x| clean(x, -1.0, 1.0);
        match self {
            Self::Thud { impulse, x } => Self::Thud {
                impulse: clean(impulse, 0.0, 1e4),
                x: place(x),
            },
            Self::Tear { energy, x } => Self::Tear {
                energy: clean(energy, 0.0, 1e4),
                x: place(x),
            },
            Self::Crumb { speed, x } => Self::Crumb {
                speed: clean(speed, 0.0, 1e4),
                x: place(x),
            },
            Self::Won(_) | Self::Menu(_) => self,
        }
    }
}

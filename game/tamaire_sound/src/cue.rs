//! Momentary sounds.

use crate::part::clean;

/// Event that causes one momentary sound. Numbers out of range are clamped, and NaN becomes 0.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Cue {
    /// A body hit a rigid body. May be sent in every tick of a contact: only a sudden rise of the impulse is
    /// heard.
    Thud {
        /// Normal impulse over the tick [N s]; 1 is a soft landing, 30 a heavy one.
        impulse: f32,
        /// Position, from −1 at the left edge of the picture to 1 at the right.
        x: f32,
    },
    /// A tear: a single node split, or all node splits of a tick together.
    Tear {
        /// Released elastic energy [J]; 0.1 for a small split, 10 for a rip through the whole body.
        energy: f32,
        /// Position, from −1 at the left edge of the picture to 1 at the right.
        x: f32,
    },
    /// A crumb landed.
    Crumb {
        /// Impact speed [m/s], usually about 1.
        speed: f32,
        /// Position, from −1 at the left edge of the picture to 1 at the right.
        x: f32,
    },
    /// A rope, spring or pin broke.
    Snap {
        /// Position, from −1 at the left edge of the picture to 1 at the right.
        x: f32,
    },
    /// A switch was pressed or released.
    Switch {
        /// Whether it was pressed.
        is_on: bool,
        /// Position, from −1 at the left edge of the picture to 1 at the right.
        x: f32,
    },
    /// The round was won.
    Won(Route),
    /// An action in a menu.
    Menu(Menu),
}

/// Route by which a round was won.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Route {
    /// The body went in whole.
    Squeeze,
    /// Parts were torn off until the body fitted.
    Shave,
    /// Squeezed in after parts were torn off.
    Mix,
}

/// Action in a menu.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Menu {
    /// Another entry was selected.
    Move,
    /// The selected entry was confirmed.
    Confirm,
    /// The player went back to the previous screen.
    Back,
}

impl Cue {
    /// Returns whether the cue is a sound of the world, of which there can be many, not one of the game around it.
    pub(crate) fn is_of_world(self) -> bool {
        !matches!(self, Self::Won(_) | Self::Menu(_))
    }

    /// Returns the cue with all numbers clamped to their ranges.
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
            Self::Snap { x } => Self::Snap { x: place(x) },
            Self::Switch { is_on, x } => Self::Switch { is_on, x: place(x) },
            Self::Won(_) | Self::Menu(_) => self,
        }
    }
}

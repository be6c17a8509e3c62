//! What devices say becomes what players want: places for their hands, and actions.

mod bindings;
mod devices;
mod latch;
mod manner;
mod players;
mod scan;

pub use bindings::{Bindings, PadKey};
pub use devices::{Devices, Seat};
pub use latch::Latch;
pub use manner::Manner;
pub use players::Players;
pub use scan::{Offer, Scan, Scanning};

use serde::{Deserialize, Serialize};

/// With what the game is played: what an explanation has to name.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum Means {
    /// A mouse.
    #[default]
    Mouse,
    /// Fingers on the screen.
    Fingers,
    /// Keys alone.
    Keys,
    /// A pad.
    Pad,
    /// A plain stick.
    Stick,
}

/// Something that a player can want, beside moving about with a mouse or a stick.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Action {
    /// The hand upwards.
    Up,
    /// The hand downwards.
    Down,
    /// The hand to the left.
    Left,
    /// The hand to the right.
    Right,
    /// The round from its start.
    Retry,
    /// A rest.
    Pause,
    /// The elements instead of the skin.
    Elements,
    /// A fifth of the speed.
    Slow,
    /// One tick.
    Step,
    /// A second player comes in on this device, or leaves.
    Join,
    /// In space the hand upwards, off the floor.
    Raise,
    /// In space the hand downwards.
    Lower,
    /// In space the camera around to the left.
    TurnLeft,
    /// In space the camera around to the right.
    TurnRight,
    /// In space, where elements are seen, further into bodies.
    Deeper,
    /// Less far into them.
    Shallower,
    /// An end to all that sticks and pads do to hands.
    CutForces,
}

impl Action {
    /// All of them, in the order in which settings list them.
    pub const ALL: [Self; 17] = [
        Self::Up,
        Self::Down,
        Self::Left,
        Self::Right,
        Self::Retry,
        Self::Pause,
        Self::Elements,
        Self::Slow,
        Self::Step,
        Self::Join,
        Self::Raise,
        Self::Lower,
        Self::TurnLeft,
        Self::TurnRight,
        Self::Deeper,
        Self::Shallower,
        Self::CutForces,
    ];
}

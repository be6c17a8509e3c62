//! Input: converts the state of devices to goals of hands and to actions.

mod bindings;
mod devices;
mod latch;
mod manner;
mod players;
mod scan;

pub use bindings::{Bindings, PadKey};
pub use devices::{Devices, InputSource};
pub use latch::StickyKeys;
pub use manner::InputMapping;
pub use players::Players;
pub use scan::{Scan, ScanAction, Scanning};

use serde::{Deserialize, Serialize};

/// Input method, which hints refer to.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum InputMethod {
    /// Mouse.
    #[default]
    Mouse,
    /// Touch.
    Fingers,
    /// Keyboard only.
    Keys,
    /// Pad.
    Pad,
    /// Plain stick.
    Stick,
}

/// An action of a player, apart from pointing with a mouse or stick.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Action {
    /// Moves the hand upwards.
    Up,
    /// Moves the hand downwards.
    Down,
    /// Moves the hand to the left.
    Left,
    /// Moves the hand to the right.
    Right,
    /// Restarts the round.
    Retry,
    /// Pauses the round.
    Pause,
    /// Switches between the skin and the elements.
    Elements,
    /// Switches slow motion: a fifth of the normal speed.
    Slow,
    /// Advances by one tick.
    Step,
    /// Lets a second player join or leave with this device.
    Join,
    /// In space: raises the hand off the floor.
    Raise,
    /// In space: lowers the hand.
    Lower,
    /// In space: turns the camera to the left.
    TurnLeft,
    /// In space: turns the camera to the right.
    TurnRight,
    /// In space: cuts bodies open further in the element view.
    Deeper,
    /// In space: cuts bodies open less far in the element view.
    Shallower,
    /// Stops all force feedback and rumble.
    CutForces,
}

impl Action {
    /// All actions, in the order of the settings.
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

//! Input: converts the state of devices to goals of the hands and to actions.

mod bindings;
mod devices;
mod latch;
mod manner;
mod players;
mod scan;

pub use bindings::{Bindings, PadKey};
pub use devices::{Devices, InputSource, KeyboardPart};
pub use latch::StickyKeys;
pub use manner::InputMapping;
pub use players::{Hands, Players};
pub use scan::{Scan, ScanAction, Scanning};

use serde::{Deserialize, Serialize};

/// Input method that a player last used. Hints are worded for it.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum InputMethod {
    /// Mouse.
    #[default]
    Mouse,
    /// Touch.
    Fingers,
    /// Keyboard only.
    Keys,
    /// Gamepad.
    Pad,
    /// Stick without the layout of a gamepad, such as a joystick.
    Stick,
}

/// An action of a player, apart from pointing with a mouse or stick.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Action {
    /// Moves the hand upwards; in 3D, away from the camera.
    Up,
    /// Moves the hand downwards; in 3D, towards the camera.
    Down,
    /// Moves the hand to the left.
    Left,
    /// Moves the hand to the right.
    Right,
    /// Restarts the round.
    Retry,
    /// Lets time run back while it is held.
    Rewind,
    /// Pauses the round.
    Pause,
    /// Changes the view: skin, elements coloured by level, elements coloured by strain.
    Elements,
    /// Turns slow motion on or off: a fifth of the normal speed.
    Slow,
    /// Advances by one tick.
    Step,
    /// Uses the tool of the hand while it is held, in a playground.
    Tool,
    /// Goes back to the paper or to the editor, in a round with what the player makes.
    Make,
    /// Lets a second player join with this device, or leave.
    Join,
    /// In 3D: raises the hand off the floor.
    Raise,
    /// In 3D: lowers the hand.
    Lower,
    /// In 3D: turns the camera to the left.
    TurnLeft,
    /// In 3D: turns the camera to the right.
    TurnRight,
    /// In 3D: cuts bodies open further in the element view.
    Deeper,
    /// In 3D: cuts bodies open less far in the element view.
    Shallower,
    /// Stops all force feedback and rumble.
    CutForces,
}

impl Action {
    /// All actions, in the order of the settings.
    pub const ALL: [Self; 20] = [
        Self::Up,
        Self::Down,
        Self::Left,
        Self::Right,
        Self::Retry,
        Self::Rewind,
        Self::Pause,
        Self::Elements,
        Self::Slow,
        Self::Step,
        Self::Tool,
        Self::Make,
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

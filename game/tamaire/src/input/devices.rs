//! Input of all devices at a moment, and the directions derived from it.

use super::{Action, Bindings, ScanAction};
use egui::{Key, Vec2};
use fuwafuwa::Vec3;
use std::collections::BTreeSet;
use sticks::{Device, DeviceId, Snapshot};

/// Deflection below which a stick counts as centred.
pub(super) const DEAD: f32 = 0.15;
/// Deflection above which a stick counts as fully deflected.
pub(super) const RIM: f32 = 0.95;

/// Input source of a player.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum InputSource {
    /// Mouse or first finger.
    Pointer,
    /// Second finger.
    Finger,
    /// Whole keyboard.
    Keys,
    /// All keys except the arrow keys and the block above them.
    LetterKeys,
    /// Stick or pad.
    Stick(DeviceId),
}

/// Part of the keyboard that a player uses.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum KeyboardPart {
    /// All keys.
    Whole,
    /// The arrow keys and the block above them.
    Arrows,
    /// All keys except those of [`KeyboardPart::Arrows`].
    Letters,
}

impl KeyboardPart {
    /// Whether a key belongs to this part.
    pub fn has(self, key: Key) -> bool {
        use Key::*;
        let is_arrow = matches!(
            key,
            ArrowUp
                | ArrowDown
                | ArrowLeft
                | ArrowRight
                | Home
                | End
                | PageUp
                | PageDown
                | Insert
                | Delete
        );
        match self {
            Self::Whole => true,
            Self::Arrows => is_arrow,
            Self::Letters => !is_arrow,
        }
    }
}

/// Input of all devices at a moment.
#[derive(Clone, Debug, Default)]
pub struct Devices {
    /// Position of the mouse or finger in the world [m], if it moved or is down.
    pub pointer: Option<Vec3>,
    /// Position of the second finger in the world [m]. It moves the hand of a second player who joined by
    /// touch.
    pub second: Option<Vec3>,
    /// Actions of the screen buttons held by fingers.
    pub pressed: BTreeSet<Action>,
    /// Action that the player has selected with one switch.
    pub taken: Option<ScanAction>,
    /// Keys that are held.
    pub keys: BTreeSet<Key>,
    /// Height by which the wheel or a second finger has raised the hand in 3D since the last tick [m].
    pub lift: f32,
    /// Sticks and pads.
    pub sticks: Snapshot,
    /// Devices with force feedback. They have no centring spring, so their position sets the position of the
    /// hand.
    pub pushing: BTreeSet<DeviceId>,
}

impl Devices {
    /// Requested rotation speed of the camera, to the right and up, -1 to 1. There is one camera for all
    /// players, which follows the largest request.
    pub fn turn(&self, bindings: &Bindings) -> Vec2 {
        let turn =
            |held: &dyn Fn(Action) -> bool| opposed(held, Action::TurnRight, Action::TurnLeft);
        let keys = Vec2::new(turn(&|action| self.holds(bindings, action)), 0.0);
        let sticks = self.sticks.devices.iter().map(|device| {
            let held = held_on(device, bindings);
            let right = device.pad.map_or([0.0; 2], |pad| pad.right);
            let right = Vec2::from(sticks::radial_dead_zone(right, DEAD, RIM));
            right + Vec2::new(turn(&|action| held.contains(&action)), 0.0)
        });
        let most = sticks.fold(keys, |most, asked| {
            if asked.length() > most.length() {
                asked
            } else {
                most
            }
        });
        most.clamp(Vec2::splat(-1.0), Vec2::splat(1.0))
    }

    /// Requested speed of cutting bodies open in the element view, -1 to 1.
    pub fn deeper(&self, bindings: &Bindings) -> f32 {
        let deeper =
            |held: &dyn Fn(Action) -> bool| opposed(held, Action::Deeper, Action::Shallower);
        let keys = deeper(&|action| self.holds(bindings, action));
        let sticks = self.sticks.devices.iter().map(|device| {
            let held = held_on(device, bindings);
            deeper(&|action| held.contains(&action))
        });
        (keys + sticks.sum::<f32>()).clamp(-1.0, 1.0)
    }

    /// Whether a key of a part of the keyboard with this action is held.
    pub(super) fn holds_key(
        &self,
        bindings: &Bindings,
        part: KeyboardPart,
        action: Action,
    ) -> bool {
        let means = |&key: &Key| part.has(key) && bindings.of_key(key) == Some(action);
        self.keys.iter().any(means)
    }

    /// Whether any device holds this action.
    pub fn is_held(&self, bindings: &Bindings, action: Action) -> bool {
        let mut sticks = self.sticks.devices.iter();
        self.holds(bindings, action)
            || sticks.any(|device| held_on(device, bindings).contains(&action))
    }

    /// Whether a key or screen button with this action is held.
    fn holds(&self, bindings: &Bindings, action: Action) -> bool {
        let is_held = self.holds_key(bindings, KeyboardPart::Whole, action);
        self.pressed.contains(&action) || is_held
    }
}

/// Returns the actions of the held buttons of a device.
pub(super) fn held_on(device: &Device, bindings: &Bindings) -> Vec<Action> {
    let held = device.controls().filter(|(_, button)| button.down);
    held.filter_map(|(control, _)| bindings.of_button(control))
        .collect()
}

/// Lift by the triggers of a pad, -1 to 1: the right one raises the hand, the left one lowers it.
pub(super) fn rise_of(device: &Device) -> f32 {
    let pulls = device.pad.map_or([0.0; 2], |pad| pad.triggers);
    let [left, right] = pulls.map(|pull| sticks::radial_dead_zone([pull, 0.0], DEAD, RIM)[0]);
    right - left
}

/// Returns 1 if only `more` is held, -1 if only `less` is held, otherwise 0.
pub(super) fn opposed(held: impl Fn(Action) -> bool, more: Action, less: Action) -> f32 {
    f32::from(i8::from(held(more)) - i8::from(held(less)))
}

/// Sum of the movement directions that are held: x to the right, y up.
pub(super) fn direction(held: impl Fn(Action) -> bool) -> Vec2 {
    Vec2::new(
        opposed(&held, Action::Right, Action::Left),
        opposed(&held, Action::Up, Action::Down),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use sticks::{DeviceInfo, Pad};

    fn pad(id: u32, right: [f32; 2], triggers: [f32; 2]) -> Device {
        let mut device = Device::at_rest(DeviceId(id), DeviceInfo::default(), 6, 12, 0);
        let mut held = Pad::default();
        (held.right, held.triggers) = (right, triggers);
        device.pad = Some(held);
        device
    }

    fn turn(devices: Vec<Device>, keys: &[Key]) -> [f32; 2] {
        let said = Devices {
            sticks: Snapshot { devices },
            keys: keys.iter().copied().collect(),
            ..Devices::default()
        };
        said.turn(&Bindings::default()).into()
    }

    #[test]
    fn camera_follows_largest_request() {
        let rest = || pad(1, [0.1, -0.1], [1.0, 1.0]);
        assert_eq!(turn(vec![rest()], &[]), [0.0; 2]);
        assert_eq!(
            turn(vec![rest(), pad(2, [0.0, 1.0], [0.0; 2])], &[]),
            [0.0, 1.0]
        );
        assert_eq!(turn(vec![rest()], &[Key::OpenBracket]), [-1.0, 0.0]);
        // Two equal requests turn no faster than one, and an opposite request does not slow the largest one
        // down.
        let both = vec![pad(1, [1.0, 0.0], [0.0; 2]), pad(2, [1.0, 0.0], [0.0; 2])];
        assert_eq!(turn(both, &[]), [1.0, 0.0]);
        let against = vec![pad(1, [-0.5, 0.0], [0.0; 2]), pad(2, [1.0, 0.0], [0.0; 2])];
        assert_eq!(turn(against, &[Key::CloseBracket]), [1.0, 0.0]);
        assert_eq!(turn(vec![pad(1, [f32::NAN, 1.0], [0.0; 2])], &[]), [0.0; 2]);
        let mut stick = pad(1, [0.0; 2], [0.0; 2]);
        stick.pad = None;
        stick.buttons[6].press();
        assert_eq!(
            turn(vec![stick], &[]),
            [-1.0, 0.0],
            "a button of a plain stick"
        );
    }

    #[test]
    fn triggers_raise_and_lower_hand_but_right_stick_does_not() {
        assert_eq!(rise_of(&pad(1, [1.0, 1.0], [0.0, 0.05])), 0.0);
        assert_eq!(rise_of(&pad(1, [0.0; 2], [0.0, 1.0])), 1.0);
        assert_eq!(rise_of(&pad(1, [0.0; 2], [1.0, 0.0])), -1.0);
        assert_eq!(rise_of(&pad(1, [0.0; 2], [1.0, 1.0])), 0.0);
        assert_eq!(rise_of(&pad(1, [0.0; 2], [0.0, f32::NAN])), 0.0);
    }
}

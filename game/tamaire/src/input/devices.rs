//! What devices say at a moment, and which way that leads.

use super::{Action, Bindings, Offer};
use egui::{Key, Vec2};
use fuwafuwa::Vector;
use std::collections::BTreeSet;
use sticks::{Device, DeviceId, Snapshot};

/// A stick that leans less than this does nothing, and one that leans more than `RIM` leans fully.
pub(super) const DEAD: f32 = 0.15;
pub(super) const RIM: f32 = 0.95;

/// A place at the table: what a player holds.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Seat {
    /// Mouse or touch.
    Pointer,
    /// A second finger.
    Finger,
    /// Keys.
    Keys,
    /// A stick or pad.
    Stick(DeviceId),
}

/// What the devices say at a moment.
#[derive(Clone, Debug, Default)]
pub struct Devices {
    /// Where the mouse or a finger points in the world [m], when it moved or is down.
    pub pointer: Option<Vector>,
    /// Where a second finger points, likewise: it is the hand of a second player who joined with it.
    pub second: Option<Vector>,
    /// What the buttons on the screen mean that fingers hold.
    pub pressed: BTreeSet<Action>,
    /// What the one switch has taken of what was offered.
    pub taken: Option<Offer>,
    /// Keys that are held.
    pub keys: BTreeSet<Key>,
    /// How far the wheel or a second finger was turned or drawn, for the hand to rise in space [m].
    pub lift: f32,
    /// Sticks and pads.
    pub sticks: Snapshot,
    /// Those of them that push back. They have no spring to the middle, so they point at places.
    pub pushing: BTreeSet<DeviceId>,
}

impl Devices {
    /// How fast the camera is to go around what it looks at, to the right and up, from -1 to 1. There is one
    /// camera: of all who ask, it obeys the one who asks for most.
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

    /// How fast bodies whose elements are seen are to be opened further, from -1 to 1.
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

    /// Whether a key that means this is held.
    pub(super) fn holds_key(&self, bindings: &Bindings, action: Action) -> bool {
        let means = |&key| bindings.of_key(key) == Some(action);
        self.keys.iter().any(means)
    }

    /// Whether a key that means this, or a button on the screen, is held.
    fn holds(&self, bindings: &Bindings, action: Action) -> bool {
        self.pressed.contains(&action) || self.holds_key(bindings, action)
    }
}

/// What the buttons mean that are held on a device.
pub(super) fn held_on(device: &Device, bindings: &Bindings) -> Vec<Action> {
    let held = device.controls().filter(|(_, button)| button.down);
    held.filter_map(|(control, _)| bindings.of_button(control))
        .collect()
}

/// How far the triggers of a pad are pulled, for the hand to rise: the right one up, the left one down.
pub(super) fn rise_of(device: &Device) -> f32 {
    let pulls = device.pad.map_or([0.0; 2], |pad| pad.triggers);
    let [left, right] = pulls.map(|pull| sticks::radial_dead_zone([pull, 0.0], DEAD, RIM)[0]);
    right - left
}

/// 1, -1 or 0.
pub(super) fn opposed(held: impl Fn(Action) -> bool, more: Action, less: Action) -> f32 {
    f32::from(i8::from(held(more)) - i8::from(held(less)))
}

/// The way in which the four ways that are held lead together.
pub(super) fn direction(held: impl Fn(Action) -> bool) -> Vec2 {
    Vec2::new(
        opposed(&held, Action::Right, Action::Left),
        opposed(&held, Action::Up, Action::Down),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use sticks::{About, Pad};

    fn pad(id: u32, right: [f32; 2], triggers: [f32; 2]) -> Device {
        let about = About {
            name: String::new(),
            guid: String::new(),
            labels: sticks::Labels::default(),
        };
        let mut device = Device::at_rest(DeviceId(id), about, 6, 12, 0);
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
    fn one_camera_obeys_the_one_who_asks_for_most() {
        let rest = || pad(1, [0.1, -0.1], [1.0, 1.0]);
        assert_eq!(turn(vec![rest()], &[]), [0.0; 2]);
        assert_eq!(
            turn(vec![rest(), pad(2, [0.0, 1.0], [0.0; 2])], &[]),
            [0.0, 1.0]
        );
        assert_eq!(turn(vec![rest()], &[Key::OpenBracket]), [-1.0, 0.0]);
        // Two who lean alike are no faster than one, and who leans further is not held back.
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
    fn the_right_trigger_lifts_the_left_one_lowers_and_the_right_stick_does_neither() {
        assert_eq!(rise_of(&pad(1, [1.0, 1.0], [0.0, 0.05])), 0.0);
        assert_eq!(rise_of(&pad(1, [0.0; 2], [0.0, 1.0])), 1.0);
        assert_eq!(rise_of(&pad(1, [0.0; 2], [1.0, 0.0])), -1.0);
        assert_eq!(rise_of(&pad(1, [0.0; 2], [1.0, 1.0])), 0.0);
        assert_eq!(rise_of(&pad(1, [0.0; 2], [0.0, f32::NAN])), 0.0);
    }
}

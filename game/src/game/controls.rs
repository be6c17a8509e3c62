//! With what the game is played: what devices say, and who holds which.

use crate::input::{Action, Devices, Means, Players};
use crate::platform::Pads;
use sticks::{Change, DeviceId};

/// With what the game is played.
pub struct Controls {
    /// The sticks and pads that are listened to.
    pub pads: Pads,
    /// What all devices say.
    pub devices: Devices,
    /// Who plays.
    pub players: Players,
    /// With what something was done last.
    pub means: Means,
    /// An action whose key or button the next one pressed becomes.
    pub rebinding: Option<Action>,
}

impl Controls {
    /// Nothing was done yet.
    pub(super) fn new(pads: Pads) -> Self {
        Self {
            pads,
            devices: Devices::default(),
            players: Players::default(),
            means: Means::default(),
            rebinding: None,
        }
    }

    /// Another round begins: what pointed at places of the last one counts no more.
    pub(super) fn begin(&mut self) {
        self.players.start();
        (self.devices.pointer, self.devices.lift) = (None, 0.0);
    }

    /// Takes in what sticks and pads say; gives back what was pressed since.
    pub(super) fn hear_sticks(&mut self) -> Vec<Change> {
        let now = self.pads.snapshot();
        let changes = now.since(&self.devices.sticks);
        self.devices.sticks = now;
        changes
    }

    /// Something was done with a stick or pad.
    pub fn note_stick(&mut self, id: DeviceId) {
        let device = self.devices.sticks.device(id);
        self.means = match device.is_some_and(|device| device.pad.is_some()) {
            true => Means::Pad,
            false => Means::Stick,
        };
    }
}

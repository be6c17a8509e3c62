//! With what the game is played: what devices say, and who holds which.

use crate::input::{Action, Devices, Latch, Means, Players, Scan, Seat};
use crate::platform::Pads;
use egui::Rect;
use sticks::{Change, DeviceId, Labels};

/// A button that is on the screen over a round.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ScreenButton {
    /// What it asks for.
    pub action: Action,
    /// Where fingers press it [points].
    pub rect: Rect,
}

impl ScreenButton {
    /// Who presses it.
    pub fn seat(&self) -> Seat {
        match self.action {
            // The first finger has a hand already.
            Action::Join => Seat::Finger,
            _ => Seat::Pointer,
        }
    }
}

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
    /// The stick or pad with which something was done last.
    in_hand: Option<DeviceId>,
    /// Keys that stay down, where that is wished.
    pub latch: Latch,
    /// What is offered to whoever plays with one switch.
    pub scan: Scan,
    /// What fingers can press, as it was seen last.
    pub buttons: Vec<ScreenButton>,
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
            in_hand: None,
            latch: Latch::default(),
            scan: Scan::default(),
            buttons: Vec::new(),
            rebinding: None,
        }
    }

    /// Another round begins: what pointed at places of the last one counts no more.
    pub(super) fn begin(&mut self, is_space: bool) {
        self.players.start();
        self.latch.release();
        self.scan.start();
        self.devices.taken = None;
        // In space a second finger raises the hand of the first.
        if is_space && self.players.second() == Some(Seat::Finger) {
            self.players.join(Seat::Finger);
        }
        (self.devices.pointer, self.devices.second) = (None, None);
        self.devices.lift = 0.0;
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
        self.in_hand = Some(id);
        let device = self.devices.sticks.device(id);
        self.means = match device.is_some_and(|device| device.pad.is_some()) {
            true => Means::Pad,
            false => Means::Stick,
        };
    }

    /// What is printed on the pad in hand, or on whichever there is.
    pub fn labels(&self) -> Labels {
        let sticks = &self.devices.sticks;
        let in_hand = self.in_hand.and_then(|id| sticks.device(id)).into_iter();
        let mut pads = in_hand.chain(&sticks.devices);
        let pad = pads.find(|device| device.pad.is_some());
        pad.map_or(Labels::Unknown, |pad| pad.about.labels)
    }
}

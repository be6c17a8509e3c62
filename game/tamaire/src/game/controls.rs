//! Input devices, and the assignment of devices to players.

use crate::input::{Action, Devices, InputMethod, InputSource, Players, Scan, StickyKeys};
use app_shell::Pads;
use egui::Rect;
use sticks::{Change, DeviceId, Labels};

/// A button on the screen during a round.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ScreenButton {
    /// Action of the button.
    pub action: Action,
    /// Touch area [points].
    pub rect: Rect,
}

impl ScreenButton {
    /// Returns the input source for which the button acts.
    pub fn seat(&self) -> InputSource {
        match self.action {
            // The first finger already moves a hand, so the second finger joins.
            Action::Join => InputSource::Finger,
            _ => InputSource::Pointer,
        }
    }
}

/// Input devices and players.
pub struct Controls {
    /// Source of stick and pad input.
    pub pads: Pads,
    /// Current input of all devices.
    pub devices: Devices,
    /// Players and their input sources.
    pub players: Players,
    /// Input method used last.
    pub means: InputMethod,
    /// Stick or pad used last.
    in_hand: Option<DeviceId>,
    /// Sticky keys, if the player has turned them on.
    pub latch: StickyKeys,
    /// Scanning, for play with one switch.
    pub scan: Scan,
    /// Buttons on the screen in the last frame.
    pub buttons: Vec<ScreenButton>,
    /// Other parts of the screen on which fingers do not point, in the last frame.
    pub covers: Vec<Rect>,
    /// Action that the next pressed key or button is bound to.
    pub rebinding: Option<Action>,
}

impl Controls {
    /// Creates the state at the start of the game.
    pub(super) fn new(pads: Pads) -> Self {
        Self {
            pads,
            devices: Devices::default(),
            players: Players::default(),
            means: InputMethod::default(),
            in_hand: None,
            latch: StickyKeys::default(),
            scan: Scan::default(),
            buttons: Vec::new(),
            covers: Vec::new(),
            rebinding: None,
        }
    }

    /// Prepares for a new round: clears held keys and positions, which refer to the previous round.
    pub(super) fn begin(&mut self, is_space: bool) {
        self.players.start();
        self.latch.release();
        self.scan.start();
        self.devices.taken = None;
        // In 3D the second finger raises the hand of the first player, so it cannot move a second hand.
        if is_space && self.players.second() == Some(InputSource::Finger) {
            self.players.join(InputSource::Finger);
        }
        (self.devices.pointer, self.devices.second) = (None, None);
        self.devices.lift = 0.0;
    }

    /// Reads sticks and pads, and returns their changes since the last call.
    pub(super) fn hear_sticks(&mut self) -> Vec<Change> {
        let now = self.pads.snapshot();
        let changes = now.since(&self.devices.sticks);
        self.devices.sticks = now;
        changes
    }

    /// Notes that a stick or pad was used.
    pub fn note_stick(&mut self, id: DeviceId) {
        self.in_hand = Some(id);
        let device = self.devices.sticks.device(id);
        self.means = match device.is_some_and(|device| device.pad.is_some()) {
            true => InputMethod::Pad,
            false => InputMethod::Stick,
        };
    }

    /// Button labels of the pad used last, or of any connected pad.
    pub fn labels(&self) -> Labels {
        let sticks = &self.devices.sticks;
        let in_hand = self.in_hand.and_then(|id| sticks.device(id)).into_iter();
        let mut pads = in_hand.chain(&sticks.devices);
        let pad = pads.find(|device| device.pad.is_some());
        pad.map_or(Labels::Unknown, |pad| pad.about.labels)
    }
}

//! Force feedback and rumble of sticks and gamepads.

use crate::Pads;
use force_feedback::{ForceThread, Line, Report, Settings, State, Stop};
use std::collections::BTreeMap;
use sticks::{Device, DeviceId, Snapshot};

/// Update rate of devices [Hz].
const RATE: u32 = 250;

/// Connections to all devices with feedback. Devices are opened on first use and released when dropped.
#[derive(Default)]
pub struct Forces {
    lines: BTreeMap<DeviceId, Line>,
    /// Background driver that updates all devices, usually a thread. `None` until the first device is found.
    force: Option<ForceThread>,
    is_cut: bool,
}

impl Forces {
    /// Opens new devices and releases disconnected ones. `settings` returns the feedback settings of a
    /// device, or `None` to release it.
    pub fn attend(
        &mut self,
        devices: &Snapshot,
        pads: &Pads,
        settings: impl Fn(&Device) -> Option<Settings>,
    ) {
        let wanted = devices.devices.iter();
        let wanted: BTreeMap<DeviceId, Settings> = wanted
            .filter_map(|device| Some((device.id, settings(device)?)))
            .collect();
        self.lines.retain(|id, _| wanted.contains_key(id));
        if wanted.is_empty() {
            self.force = None;
        }
        for (id, settings) in wanted {
            if let Some(line) = self.lines.get(&id) {
                line.set(settings);
            } else if let Some(force) = self.force() {
                let line = force.add(pads.haptic(id), settings);
                self.lines.insert(id, line);
            }
        }
    }

    /// Returns the driver of the devices and starts it if necessary. `None` if the system cannot start a
    /// thread; no device then gets feedback. In a browser the driver has no thread, so the caller runs it
    /// with [`Self::update`].
    fn force(&mut self) -> Option<&ForceThread> {
        if self.force.is_none() {
            self.force = match cfg!(target_family = "wasm") {
                true => Some(ForceThread::without_thread()),
                false => ForceThread::start(RATE).ok(),
            };
            if let (Some(force), true) = (&self.force, self.is_cut) {
                force.emergency_stop();
            }
        }
        self.force.as_ref()
    }

    /// Updates the feedback of each device with the result of `wish`: `Ok` is the new feedback, `Err` the
    /// reason why the device gets none.
    pub fn tell(&self, wish: impl Fn(DeviceId) -> Result<State, Stop>) {
        for (&id, line) in &self.lines {
            match wish(id) {
                Ok(state) => line.set_state(state),
                Err(why) => line.stop(why),
            }
        }
    }

    /// Updates the devices in a browser; call it once a frame. Elsewhere the thread updates them.
    pub fn update(&mut self) {
        if let Some(force) = &mut self.force {
            force.update();
        }
    }

    /// Plays a short rumble on a device when a body tears; `size` is 0 to 1 (strongest).
    pub fn tear(&self, device: DeviceId, size: f32) {
        if let Some(line) = self.lines.get(&device) {
            line.tear(size);
        }
    }

    /// Stops all feedback at once, until [`Self::restore`].
    pub fn cut(&mut self) {
        self.is_cut = true;
        if let Some(force) = &self.force {
            force.emergency_stop();
        }
    }

    /// Allows feedback again after [`Self::cut`].
    pub fn restore(&mut self) {
        self.is_cut = false;
        if let Some(force) = &self.force {
            force.release();
        }
    }

    /// Whether all feedback is stopped.
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// Capabilities and current state of a device.
    pub fn report(&self, device: DeviceId) -> Option<Report> {
        let mut report = self.lines.get(&device)?.report();
        if self.is_cut {
            report.silent = Some(Stop::Emergency);
        }
        Some(report)
    }
}

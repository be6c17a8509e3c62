//! What the hands that hold sticks and pads are made to feel.

use super::Pads;
use force_feedback::{Force, Line, Report, Settings, State, Stop};
use std::collections::BTreeMap;
use sticks::{Device, DeviceId, Snapshot};

/// How often a second devices are told what to do.
const RATE: u32 = 250;

/// Leads to all devices that can be felt. Nothing is taken hold of before it is asked for, and dropping this lets go of all.
#[derive(Default)]
pub struct Forces {
    lines: BTreeMap<DeviceId, Line>,
    /// None while there is no device.
    force: Option<Force>,
    is_cut: bool,
}

impl Forces {
    /// Takes hold of devices that came and lets go of those that left. `settings` says how each is to be felt; those of which
    /// it says nothing are let go too.
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

    /// The thread, unless the system has none to give: then nothing is felt. A browser does without.
    fn force(&mut self) -> Option<&Force> {
        if self.force.is_none() {
            self.force = match cfg!(target_family = "wasm") {
                true => Some(Force::without_thread()),
                false => Force::start(RATE).ok(),
            };
            if let (Some(force), true) = (&self.force, self.is_cut) {
                force.emergency_stop();
            }
        }
        self.force.as_ref()
    }

    /// Tells each device what there is to feel, or why there is nothing.
    pub fn tell(&self, wish: impl Fn(DeviceId) -> Result<State, Stop>) {
        for (&id, line) in &self.lines {
            match wish(id) {
                Ok(state) => line.feel(state),
                Err(why) => line.stop(why),
            }
        }
    }

    /// Passes on what was told, where no thread does.
    pub fn update(&mut self) {
        if let Some(force) = &mut self.force {
            force.update();
        }
    }

    /// Something tore that a device is to feel; 1 is as large as a tear gets.
    pub fn tear(&self, device: DeviceId, size: f32) {
        if let Some(line) = self.lines.get(&device) {
            line.tear(size);
        }
    }

    /// Ends all forces at once, and for as long as this is not taken back.
    pub fn cut(&mut self) {
        self.is_cut = true;
        if let Some(force) = &self.force {
            force.emergency_stop();
        }
    }

    /// Takes back that.
    pub fn restore(&mut self) {
        self.is_cut = false;
        if let Some(force) = &self.force {
            force.release();
        }
    }

    /// Whether all forces were cut.
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// What a device can do, and what it does.
    pub fn report(&self, device: DeviceId) -> Option<Report> {
        let mut report = self.lines.get(&device)?.report();
        if self.is_cut {
            report.silent = Some(Stop::Emergency);
        }
        Some(report)
    }
}

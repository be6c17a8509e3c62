//! Test and measurement of a device on the force-feedback screen.

use crate::settings::FULL;
use force_feedback::{Calibration, Measured, Measurement, Settings, State, StickMode};
use sticks::{DeviceId, Snapshot};

/// Deflection beyond which a stick under test is at its rim and gives a tear impulse.
const RIM: f32 = 0.95;
/// Deflection below which a stick under test has left its rim and can give another tear impulse.
const BACK: f32 = 0.85;

/// A device under test or measurement.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Id of the device.
    pub device: DeviceId,
    act: Act,
    state: State,
    is_at_rim: bool,
    tear: Option<f32>,
}

#[derive(Clone, Copy, Debug)]
enum Act {
    /// Spring force that grows with the deflection, and a tear impulse at the rim.
    Spring,
    Measure(Measurement),
}

/// Result of a step of a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TrialStatus {
    /// The trial continues.
    GoesOn,
    /// The device was disconnected.
    Gone,
    /// The measurement has ended. `None` = the directions of the motors could not be determined.
    Known(Option<Calibration>),
}

impl Trial {
    /// Creates a test in which the device pushes back like a spring and gives a tear impulse at its rim.
    pub fn spring(device: DeviceId) -> Self {
        Self::of(device, Act::Spring)
    }

    /// Creates a measurement of the motor directions of the device.
    pub fn measure(device: DeviceId) -> Self {
        Self::of(device, Act::Measure(Measurement::default()))
    }

    fn of(device: DeviceId, act: Act) -> Self {
        let state = State {
            contact: [0.0; 2],
            manner: StickMode::Velocity,
        };
        Self {
            device,
            act,
            state,
            is_at_rim: false,
            tear: None,
        }
    }

    /// Advances the trial by `seconds` [s].
    pub fn pass(&mut self, sticks: &Snapshot, seconds: f32) -> TrialStatus {
        let Some(device) = sticks.device(self.device) else {
            return TrialStatus::Gone;
        };
        let aim = device.aim();
        match &mut self.act {
            Act::Spring => {
                self.state.contact = aim.map(|k| -FULL * k);
                let lean = aim[0].hypot(aim[1]);
                if lean > RIM && !self.is_at_rim {
                    self.tear = Some(1.0);
                }
                self.is_at_rim = lean > if self.is_at_rim { BACK } else { RIM };
            }
            Act::Measure(measurement) => match measurement.step(aim, seconds) {
                Measured::Pushing(contact) => {
                    let manner = StickMode::OpenLoop;
                    self.state = State { contact, manner };
                }
                Measured::Known(calibration) => return TrialStatus::Known(calibration),
            },
        }
        TrialStatus::GoesOn
    }

    /// Returns the force feedback for a device. `None` if another device is under trial.
    pub fn state(&self, device: DeviceId) -> Option<State> {
        (device == self.device).then_some(self.state)
    }

    /// Returns each tear impulse once, before it is sent: the device and the size (1 = maximum).
    pub fn take_tear(&mut self) -> Option<(DeviceId, f32)> {
        Some((self.device, self.tear.take()?))
    }

    /// Returns the force settings for a device during its measurement. `None` = the player's settings apply.
    pub fn settings(&self, device: DeviceId) -> Option<Settings> {
        let is_measured = device == self.device && matches!(self.act, Act::Measure(_));
        is_measured.then_some(Measurement::SETTINGS)
    }

    /// Progress of a measurement, 0 to 1. `None` for a test.
    pub fn progress(&self) -> Option<f32> {
        match &self.act {
            Act::Spring => None,
            Act::Measure(measurement) => Some(measurement.progress()),
        }
    }
}

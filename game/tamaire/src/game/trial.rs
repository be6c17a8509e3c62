//! What a device is made to do on the screen where people try it.

use crate::settings::FULL;
use force_feedback::{Calibration, Manner, Measured, Measurement, Settings, State};
use sticks::{DeviceId, Snapshot};

/// A stick that leans so far is at its rim, where it tears.
const RIM: f32 = 0.95;
/// And has left it again when it leans less than this.
const BACK: f32 = 0.85;

/// A device that is tried or measured.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Which.
    pub device: DeviceId,
    act: Act,
    state: State,
    is_at_rim: bool,
    tear: Option<f32>,
}

#[derive(Clone, Copy, Debug)]
enum Act {
    /// It pushes back the further it is pushed, and tears at its rim.
    Spring,
    Measure(Measurement),
}

/// What came of a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// It goes on.
    GoesOn,
    /// The device has gone.
    Gone,
    /// It is known how it is built in, or it could not be found out.
    Known(Option<Calibration>),
}

impl Trial {
    /// A device that pushes back, and tears when it is pushed to its rim.
    pub fn spring(device: DeviceId) -> Self {
        Self::of(device, Act::Spring)
    }

    /// A device of which is found out how it is built in.
    pub fn measure(device: DeviceId) -> Self {
        Self::of(device, Act::Measure(Measurement::default()))
    }

    fn of(device: DeviceId, act: Act) -> Self {
        let state = State {
            contact: [0.0; 2],
            manner: Manner::Steers,
        };
        Self {
            device,
            act,
            state,
            is_at_rim: false,
            tear: None,
        }
    }

    /// Lets time pass [s].
    pub fn pass(&mut self, sticks: &Snapshot, seconds: f32) -> Outcome {
        let Some(device) = sticks.device(self.device) else {
            return Outcome::Gone;
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
                    let manner = Manner::Yields;
                    self.state = State { contact, manner };
                }
                Measured::Known(calibration) => return Outcome::Known(calibration),
            },
        }
        Outcome::GoesOn
    }

    /// What its device feels now.
    pub fn state(&self, device: DeviceId) -> Option<State> {
        (device == self.device).then_some(self.state)
    }

    /// A tear that it has not felt yet.
    pub fn take_tear(&mut self) -> Option<(DeviceId, f32)> {
        Some((self.device, self.tear.take()?))
    }

    /// How a device is to be felt, if not as usual.
    pub fn settings(&self, device: DeviceId) -> Option<Settings> {
        let is_measured = device == self.device && matches!(self.act, Act::Measure(_));
        is_measured.then_some(Measurement::SETTINGS)
    }

    /// How much of a measurement is over, 0 to 1; None if it is none.
    pub fn progress(&self) -> Option<f32> {
        match &self.act {
            Act::Spring => None,
            Act::Measure(measurement) => Some(measurement.progress()),
        }
    }
}

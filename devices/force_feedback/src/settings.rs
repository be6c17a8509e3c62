//! What people and games may choose about one device.

use std::ops::RangeInclusive;

/// The stiffest that a coupling may be [full forces for the way of the stick from its middle to its rim].
pub const HARDEST: f32 = 0.4;

/// How strongly and how quickly a device may push.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Share of the force that is played, 0 to 1: the slider. At 0 nothing is sent at all.
    pub strength: f32,
    /// This much is full force [N], 1 to 10,000; about 150. Less makes everything stronger and sooner clipped.
    pub full: f32,
    /// Stiffness of the coupling [full forces for the way of the stick from its middle to its rim], 0 to [`HARDEST`].
    /// Less makes everything softer.
    pub stiffness: f32,
    /// The force changes no faster than this [full forces/s], 10 to 100; about 30. Slower lags behind the hand and swings,
    /// faster jerks.
    pub slew: f32,
    /// No axis ever gets more than this [full forces], 0 to 1.
    pub clamp: f32,
    /// How the device is built in.
    pub calibration: Calibration,
}

/// How the axes of a device's motors lie to those of its stick.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default))]
pub struct Calibration {
    /// The motor that is called x pushes along y, and the other way round.
    pub swap: bool,
    /// This motor pushes the wrong way; after `swap`.
    pub invert: [bool; 2],
    /// Share of the force that this motor gets, 0 to 1, to make a strong one as weak as the other; after `swap`.
    pub gain: [f32; 2],
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            strength: 0.8,
            full: 150.0,
            stiffness: HARDEST,
            slew: 30.0,
            clamp: 0.9,
            calibration: Calibration::default(),
        }
    }
}

impl Default for Calibration {
    fn default() -> Self {
        Self::USUAL
    }
}

impl Settings {
    /// Bounds of `strength`, `clamp` and the gains.
    pub const SHARE: RangeInclusive<f32> = 0.0..=1.0;
    /// Bounds of `full` [N].
    pub const FULL: RangeInclusive<f32> = 1.0..=10_000.0;
    /// Bounds of `stiffness`.
    pub const STIFFNESS: RangeInclusive<f32> = 0.0..=HARDEST;
    /// Bounds of `slew` [full forces/s].
    pub const SLEW: RangeInclusive<f32> = 10.0..=100.0;

    /// The same within all bounds. What is no number at all becomes what is felt least.
    pub fn bounded(self) -> Self {
        Self {
            strength: within(self.strength, Self::SHARE, 0.0),
            full: within(self.full, Self::FULL, *Self::FULL.end()),
            stiffness: within(self.stiffness, Self::STIFFNESS, 0.0),
            slew: within(self.slew, Self::SLEW, *Self::SLEW.start()),
            clamp: within(self.clamp, Self::SHARE, 0.0),
            calibration: self.calibration.bounded(),
        }
    }
}

/// A value within its bounds, or this if it is no number.
fn within(value: f32, range: RangeInclusive<f32>, otherwise: f32) -> f32 {
    let value = if value.is_nan() { otherwise } else { value };
    value.clamp(*range.start(), *range.end())
}

impl Calibration {
    /// Nothing to put right.
    pub const USUAL: Self = Self {
        swap: false,
        invert: [false; 2],
        gain: [1.0; 2],
    };

    /// The same with gains within their bounds.
    pub fn bounded(self) -> Self {
        let gain = self.gain.map(|gain| within(gain, Settings::SHARE, 0.0));
        Self { gain, ..self }
    }

    /// How a device is built in whose stick moved by `moves[0]` when the motor x pushed and by `moves[1]` when the motor y
    /// did. None if that is not clear: somebody held it too firmly, or nothing pushed.
    ///
    /// Better measured than guessed: a stick that is pushed the wrong way runs away from the hand, as far and as strongly
    /// as the clamp lets it.
    pub fn measured(moves: [[f32; 2]; 2]) -> Option<Self> {
        let main = moves.map(|[x, y]| usize::from(y.abs() > x.abs()));
        let is_clear = |motor: usize| {
            let (most, other) = (moves[motor][main[motor]], moves[motor][1 - main[motor]]);
            most.abs() > 0.02 && most.abs() > 2.0 * other.abs()
        };
        if main[0] == main[1] || !is_clear(0) || !is_clear(1) {
            return None;
        }
        Some(Self {
            swap: main[0] == 1,
            invert: [0, 1].map(|motor| moves[motor][main[motor]] < 0.0),
            ..Self::USUAL
        })
    }

    /// What the motors are told so that the stick is pushed by `force`.
    pub fn apply(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let swapped = if self.swap { [y, x] } else { [x, y] };
        [0, 1].map(|axis| {
            let sign = if self.invert[axis] { -1.0 } else { 1.0 };
            sign * self.gain[axis] * swapped[axis]
        })
    }
}

//! User and game settings of a device.

use std::ops::RangeInclusive;

/// Maximum stiffness of a coupling [full forces per stick travel from the middle to the rim]. With a stiffer
/// coupling, a stick with a delay could oscillate.
pub const MAX_STIFFNESS: f32 = 0.4;

/// Strength and speed limits of the forces of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Overall strength of the forces, 0 to 1, default 0.8: the slider in the menu. At 0 no force is sent.
    pub strength: f32,
    /// Contact force in the simulation that gives one full force before the soft clip [N], 1 to 10,000,
    /// default
    /// 150. A smaller value makes forces stronger and clips them earlier.
    pub full: f32,
    /// Stiffness of the coupling [full forces per stick travel from the middle to the rim], 0 to
    /// [`MAX_STIFFNESS`], which is the default. A smaller value makes all contacts softer.
    pub stiffness: f32,
    /// Maximum rate of change of the force [full forces/s], 10 to 100, default 30. With a smaller value the
    /// force lags behind the hand and oscillates; with a larger one it jerks.
    pub slew: f32,
    /// Maximum force per axis [full forces], 0 to 1, default 0.9.
    pub clamp: f32,
    /// Mounting of the motors.
    pub calibration: Calibration,
}

/// Relation between the motor axes and the stick axes of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default))]
pub struct Calibration {
    /// Whether the x motor pushes the stick along y, and the y motor along x.
    pub swap: bool,
    /// Whether the motor pushes in the opposite direction, per motor. Applied after `swap`.
    pub invert: [bool; 2],
    /// Gain per motor, 0 to 1. Weakens the stronger motor of an uneven pair. Applied after `swap`.
    pub gain: [f32; 2],
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            strength: 0.8,
            full: 150.0,
            stiffness: MAX_STIFFNESS,
            slew: 30.0,
            clamp: 0.9,
            calibration: Calibration::default(),
        }
    }
}

impl Default for Calibration {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Settings {
    /// Range of `strength`, `clamp` and the gains of the calibration.
    pub const SHARE: RangeInclusive<f32> = 0.0..=1.0;
    /// Range of `full` [N].
    pub const FULL: RangeInclusive<f32> = 1.0..=10_000.0;
    /// Range of `stiffness` [full forces per stick travel from the middle to the rim].
    pub const STIFFNESS: RangeInclusive<f32> = 0.0..=MAX_STIFFNESS;
    /// Range of `slew` [full forces/s].
    pub const SLEW: RangeInclusive<f32> = 10.0..=100.0;

    /// Clamps all settings to their ranges. NaN becomes the value that gives the weakest force.
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

/// Clamps a value to a range; NaN becomes `otherwise`.
fn within(value: f32, range: RangeInclusive<f32>, otherwise: f32) -> f32 {
    let value = if value.is_nan() { otherwise } else { value };
    value.clamp(*range.start(), *range.end())
}

impl Calibration {
    /// Calibration of a device with the default mounting, which needs no correction.
    pub const IDENTITY: Self = Self {
        swap: false,
        invert: [false; 2],
        gain: [1.0; 2],
    };

    /// Clamps the gains to their range.
    pub fn bounded(self) -> Self {
        let gain = self.gain.map(|gain| within(gain, Settings::SHARE, 0.0));
        Self { gain, ..self }
    }

    /// Returns the calibration for measured stick movements: `moves[0]` when the x motor pushed and
    /// `moves[1]` when the y motor pushed. Returns `None` if the result is unclear, for example because the
    /// stick was held or no motor pushed.
    ///
    /// A wrong guess would be dangerous: a stick pushed in the wrong direction runs away from the hand,
    /// limited only by its travel and the clamp.
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
            ..Self::IDENTITY
        })
    }

    /// Returns the motor forces that push the stick with `force`.
    pub fn apply(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let swapped = if self.swap { [y, x] } else { [x, y] };
        [0, 1].map(|axis| {
            let sign = if self.invert[axis] { -1.0 } else { 1.0 };
            sign * self.gain[axis] * swapped[axis]
        })
    }
}

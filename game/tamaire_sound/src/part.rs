//! Basic building blocks: noise, tones, filters, and smoothed values.

use std::f32::consts::{PI, TAU};

/// Left and right sample.
pub(crate) type Stereo = [f32; 2];

/// Clamps `value` to `low..=high`; NaN becomes 0 if that is in range, otherwise `low`.
pub(crate) fn clean(value: f32, low: f32, high: f32) -> f32 {
    if value.is_nan() {
        low.max(0.0)
    } else {
        value.clamp(low, high)
    }
}

/// Maps an amount to 0..1: 0 for 0, 0.5 for `usual`, towards 1 for large amounts.
pub(crate) fn share(amount: f32, usual: f32) -> f32 {
    amount / (amount + usual)
}

/// Returns the gains of left and right for a position `x`, −1 to 1, at equal power. Neither side becomes
/// silent, which would be tiring with headphones.
pub(crate) fn panned(x: f32) -> Stereo {
    let angle = PI / 4.0 * (1.0 + 0.7 * x);
    [angle.cos(), angle.sin()]
}

/// Returns the frequency of a MIDI note number [Hz]; 69 is A at 440 Hz.
pub(crate) fn note(number: f32) -> f32 {
    440.0 * ((number - 69.0) / 12.0).exp2()
}

/// Deterministic white noise [Marsaglia 2003].
pub(crate) struct Noise(u32);

impl Noise {
    pub(crate) fn new() -> Self {
        Self(0x2545_f491)
    }

    /// Returns a number from −1 to 1.
    pub(crate) fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0 as i32 as f32 / 2_147_483_648.0
    }

    /// Returns a number from `low` to `high`.
    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * (0.5 + 0.5 * self.next())
    }
}

/// Value that follows its target without a jump.
#[derive(Copy, Clone)]
pub(crate) struct Smooth {
    pub(crate) value: f32,
    pub(crate) target: f32,
    step: f32,
}

impl Smooth {
    /// Creates a value with the time constant `seconds`, for `rate` calls of `next` per second.
    pub(crate) fn new(seconds: f32, rate: f32) -> Self {
        Self {
            value: 0.0,
            target: 0.0,
            step: 1.0 - (-1.0 / (seconds * rate)).exp(),
        }
    }

    pub(crate) fn next(&mut self) -> f32 {
        let left = self.target - self.value;
        // Reaches the target exactly, so that silence is exact: 0.00001 is 100 dB below full scale.
        self.value = if left.abs() < 1e-5 {
            self.target
        } else {
            self.value + self.step * left
        };
        self.value
    }

    /// Returns whether the value is zero and stays zero.
    pub(crate) fn is_silent(&self) -> bool {
        self.value == 0.0 && self.target == 0.0
    }
}

/// Sine with phase feedback: a larger `edge` approaches a sawtooth, with overtones that fall off before they
/// alias [Tomisawa 1981].
#[derive(Copy, Clone, Default)]
pub(crate) struct Tone {
    /// Phase [cycles], 0 to 1.
    phase: f32,
    last: f32,
}

impl Tone {
    /// Returns the next sample. `frequency` in cycles per sample, `edge` from 0 (sine) to 1.
    pub(crate) fn next(&mut self, frequency: f32, edge: f32) -> f32 {
        self.phase = (self.phase + frequency).fract();
        // Feeds back a running mean; the last sample alone oscillates at high frequencies.
        let out = (TAU * self.phase + edge * self.last).sin();
        self.last = 0.5 * (self.last + out);
        out
    }
}

/// Two-pole band-pass that can be retuned while it plays: a state-variable filter with trapezoidal
/// integrators [Simper 2013].
#[derive(Copy, Clone, Default)]
pub(crate) struct Band {
    gains: [f32; 3],
    width: f32,
    lift: f32,
    state: [f32; 2],
}

impl Band {
    /// Sets the centre `frequency` [cycles/sample]; the bandwidth is `frequency`/`sharpness`.
    pub(crate) fn tune(&mut self, frequency: f32, sharpness: f32) {
        let g = (PI * frequency.clamp(1e-4, 0.45)).tan();
        self.width = 1.0 / sharpness;
        let first = 1.0 / (1.0 + g * (g + self.width));
        self.gains = [first, g * first, g * g * first];
        // Such a band passes π·frequency/sharpness of the power of white noise.
        self.lift = (sharpness / (PI * frequency.max(1e-4))).sqrt();
    }

    /// Returns band-passed noise at the level of the unfiltered noise.
    pub(crate) fn hiss(&mut self, noise: &mut Noise) -> f32 {
        self.lift * self.next(noise.next())
    }

    /// Filters a sample, with unit gain at the centre frequency.
    pub(crate) fn next(&mut self, sample: f32) -> f32 {
        let [a, b, c] = self.gains;
        let [one, two] = self.state;
        let rest = sample - two;
        let band = a * one + b * rest;
        let low = two + b * one + c * rest;
        // Flushes values below 1e-15, which would soon become subnormal and slow.
        self.state =
            [2.0 * band - one, 2.0 * low - two].map(|k| if k.abs() < 1e-15 { 0.0 } else { k });
        self.width * band
    }
}

/// Smooth random walk between −1 and 1.
pub(crate) struct Drift {
    value: Smooth,
    /// Samples between two targets, and samples left until the next one.
    pace: u32,
    left: u32,
}

impl Drift {
    /// Creates a walk with about `times` targets per second.
    pub(crate) fn new(times: f32, rate: f32) -> Self {
        Self {
            value: Smooth::new(0.5 / times, rate),
            pace: (rate / times) as u32,
            left: 0,
        }
    }

    pub(crate) fn next(&mut self, noise: &mut Noise) -> f32 {
        if self.left == 0 {
            self.left = self.pace;
            self.value.target = noise.next();
        }
        self.left -= 1;
        self.value.next()
    }
}

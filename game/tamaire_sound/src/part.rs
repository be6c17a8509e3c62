//! Building blocks of sounds: noise, tones, filters, and smoothed values.

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

/// Maps an amount to the range 0 to 1: 0 to 0, `usual` to 0.5, large amounts to almost 1.
pub(crate) fn share(amount: f32, usual: f32) -> f32 {
    amount / (amount + usual)
}

/// Returns the gains of the left and the right channel for a position `x`, −1 to 1, at equal total power.
/// Neither channel becomes silent, because that would be tiring with headphones.
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

    /// Returns a random number from −1 to 1.
    pub(crate) fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0 as i32 as f32 / 2_147_483_648.0
    }

    /// Returns a random number from `low` to `high`.
    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * (0.5 + 0.5 * self.next())
    }
}

/// Value that approaches its target exponentially, without a jump.
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
        // Sets the value to the target once both are within 1e-5 (100 dB below full scale), so that silence
        // is exact.
        self.value = if left.abs() < 1e-5 {
            self.target
        } else {
            self.value + self.step * left
        };
        self.value
    }

    /// Returns whether the value and its target are zero.
    pub(crate) fn is_silent(&self) -> bool {
        self.value == 0.0 && self.target == 0.0
    }
}

/// Sine oscillator with phase feedback [Tomisawa 1981]. A larger `edge` brings the wave closer to a sawtooth,
/// with overtones that become faint before they alias.
#[derive(Copy, Clone, Default)]
pub(crate) struct Tone {
    /// Phase [cycles], 0 to 1.
    phase: f32,
    last: f32,
}

impl Tone {
    /// Returns the next sample, at `frequency` [cycles/sample]. `edge` is the overtone content, from 0 (sine)
    /// to 1.
    pub(crate) fn next(&mut self, frequency: f32, edge: f32) -> f32 {
        self.phase = (self.phase + frequency).fract();
        // Feeds back a running mean of samples, because feedback of the last sample alone oscillates at high
        // frequencies.
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
        // A band-pass lets π·frequency/sharpness of the power of white noise through. `lift` compensates for
        // the loss.
        self.lift = (sharpness / (PI * frequency.max(1e-4))).sqrt();
    }

    /// Returns white noise after the band-pass, amplified to the level of the unfiltered noise.
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
        // Sets values below 1e-15 to zero. They would soon become subnormal, and arithmetic with them is
        // slow.
        self.state =
            [2.0 * band - one, 2.0 * low - two].map(|k| if k.abs() < 1e-15 { 0.0 } else { k });
        self.width * band
    }
}

/// Smooth random walk between −1 and 1.
pub(crate) struct Drift {
    value: Smooth,
    /// Number of samples from one random target to the next.
    pace: u32,
    left: u32,
}

impl Drift {
    /// Creates a random walk with about `times` targets per second, for `rate` samples per second.
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

//! What sounds are made of: noise, tones, filters, and values that change without a jump.

use std::f32::consts::{PI, TAU};

/// Left and right.
pub(crate) type Stereo = [f32; 2];

/// `value` within `low..=high`; what is not a number counts as `low`, or as 0 where that is in range.
pub(crate) fn clean(value: f32, low: f32, high: f32) -> f32 {
    if value.is_nan() {
        low.max(0.0)
    } else {
        value.clamp(low, high)
    }
}

/// From 0 for nothing over 0.5 for `usual` towards 1 for any amount.
pub(crate) fn share(amount: f32, usual: f32) -> f32 {
    amount / (amount + usual)
}

/// How loud something at `x` (-1 to 1) is on the left and on the right, at equal power. Never on one
/// side alone, which is tiresome with headphones.
pub(crate) fn panned(x: f32) -> Stereo {
    let angle = PI / 4.0 * (1.0 + 0.7 * x);
    [angle.cos(), angle.sin()]
}

/// The frequency of a note of the piano [Hz]; 69 is the A of 440 Hz.
pub(crate) fn note(number: f32) -> f32 {
    440.0 * ((number - 69.0) / 12.0).exp2()
}

/// White noise, the same one every time [Marsaglia 2003].
pub(crate) struct Noise(u32);

impl Noise {
    pub(crate) fn new() -> Self {
        Self(0x2545_f491)
    }

    /// From -1 to 1.
    pub(crate) fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0 as i32 as f32 / 2_147_483_648.0
    }

    /// From `low` to `high`.
    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * (0.5 + 0.5 * self.next())
    }
}

/// A value that follows its target without a jump.
#[derive(Copy, Clone)]
pub(crate) struct Smooth {
    pub(crate) value: f32,
    pub(crate) target: f32,
    step: f32,
}

impl Smooth {
    /// Comes to within 1/e of its target in `seconds`, if asked `rate` times a second.
    pub(crate) fn new(seconds: f32, rate: f32) -> Self {
        Self {
            value: 0.0,
            target: 0.0,
            step: 1.0 - (-1.0 / (seconds * rate)).exp(),
        }
    }

    pub(crate) fn next(&mut self) -> f32 {
        let left = self.target - self.value;
        // Arrives at last, so that silence is silence: 0.00001 is 100 dB below full scale.
        self.value = if left.abs() < 1e-5 {
            self.target
        } else {
            self.value + self.step * left
        };
        self.value
    }

    /// Whether it is nothing and stays so.
    pub(crate) fn is_silent(&self) -> bool {
        self.value == 0.0 && self.target == 0.0
    }
}

/// A sine that is fed back into its own phase: with more `edge` it nears a sawtooth, with
/// overtones that fall off before they alias [Tomisawa 1981].
#[derive(Copy, Clone, Default)]
pub(crate) struct Tone {
    /// In turns, 0 to 1.
    phase: f32,
    last: f32,
}

impl Tone {
    /// `frequency` in turns a sample, `edge` from 0 for a sine to 1.
    pub(crate) fn next(&mut self, frequency: f32, edge: f32) -> f32 {
        self.phase = (self.phase + frequency).fract();
        // Fed back is a running mean: the last sample alone hunts at high frequencies.
        let out = (TAU * self.phase + edge * self.last).sin();
        self.last = 0.5 * (self.last + out);
        out
    }
}

/// A band-pass with two poles that may be tuned while it sounds: a state-variable filter with
/// trapezoidal integrators [Simper 2013].
#[derive(Copy, Clone, Default)]
pub(crate) struct Band {
    gains: [f32; 3],
    width: f32,
    lift: f32,
    state: [f32; 2],
}

impl Band {
    /// Passes `frequency` [turns a sample]; the band is 1/`sharpness` of it wide.
    pub(crate) fn tune(&mut self, frequency: f32, sharpness: f32) {
        let g = (PI * frequency.clamp(1e-4, 0.45)).tan();
        self.width = 1.0 / sharpness;
        let first = 1.0 / (1.0 + g * (g + self.width));
        self.gains = [first, g * first, g * g * first];
        // Of white noise a band of this kind passes π·frequency/sharpness of the power.
        self.lift = (sharpness / (PI * frequency.max(1e-4))).sqrt();
    }

    /// A band of noise, as loud as the noise was.
    pub(crate) fn hiss(&mut self, noise: &mut Noise) -> f32 {
        self.lift * self.next(noise.next())
    }

    /// The middle of the band passes as loud as it was.
    pub(crate) fn next(&mut self, sample: f32) -> f32 {
        let [a, b, c] = self.gains;
        let [one, two] = self.state;
        let rest = sample - two;
        let band = a * one + b * rest;
        let low = two + b * one + c * rest;
        // Below 1e-15 numbers become subnormal soon, and those are slow.
        self.state =
            [2.0 * band - one, 2.0 * low - two].map(|k| if k.abs() < 1e-15 { 0.0 } else { k });
        self.width * band
    }
}

/// A random walk between -1 and 1, smooth.
pub(crate) struct Drift {
    value: Smooth,
    /// Samples from one goal to the next, and those that are left.
    pace: u32,
    left: u32,
}

impl Drift {
    /// About `times` turns a second.
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

//! Grains: short sounds from which all cues and the music are composed.

use crate::part::{Band, Noise, Stereo, Tone, panned};

/// Maximum number of simultaneous grains.
pub(crate) const MOST_VOICES: usize = 64;

/// Number of samples in a block. Filters are retuned once per block.
pub(crate) const CHUNK: usize = 32;

/// Group of sounds with its own volume.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) enum Bus {
    Effects,
    Music,
    Interface,
}

/// Number of buses.
pub(crate) const BUSES: usize = 3;

/// A block of samples per bus.
pub(crate) type Buses = [[Stereo; CHUNK]; BUSES];

/// Short sound: a tone and a band of noise with a common envelope and pitch glide.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Grain {
    pub(crate) bus: Bus,
    /// Delay before the start [s].
    pub(crate) delay: f32,
    /// Rise time from silence to the maximum amplitude [s]. A time below 0.001 is heard as a click.
    pub(crate) attack: f32,
    /// Time in which the amplitude decays from its maximum to 1/e of it [s].
    pub(crate) decay: f32,
    /// Maximum amplitude, 0 to 1.
    pub(crate) gain: f32,
    /// Position, from −1 at the left edge of the picture to 1 at the right.
    pub(crate) x: f32,
    /// Initial and final frequency of the tone [Hz].
    pub(crate) pitch: [f32; 2],
    /// Time constant of the glide from the initial to the final frequency [s].
    pub(crate) glide: f32,
    /// Amplitude of the tone, 0 to 1.
    pub(crate) tone: f32,
    /// Overtone content of the tone, from 0 (sine) to 1 (almost a sawtooth).
    pub(crate) edge: f32,
    /// Amplitude of the noise, 0 to 1.
    pub(crate) noise: f32,
    /// Centre frequency of the noise band, as a multiple of the tone's frequency.
    pub(crate) above: f32,
    /// Ratio of the noise band's centre frequency to its bandwidth.
    pub(crate) sharpness: f32,
}

impl Default for Grain {
    fn default() -> Self {
        Self {
            bus: Bus::Effects,
            delay: 0.0,
            attack: 0.002,
            decay: 0.1,
            gain: 0.5,
            x: 0.0,
            pitch: [440.0; 2],
            glide: 0.05,
            tone: 1.0,
            edge: 0.0,
            noise: 0.0,
            above: 1.0,
            sharpness: 1.5,
        }
    }
}

/// Grains that are playing or waiting for their start.
pub(crate) struct Voices {
    rate: f32,
    voices: Vec<Voice>,
    /// Last sample of cut-off grains, per bus. It fades out, because a sudden end would click.
    cut: [Stereo; BUSES],
}

impl Voices {
    pub(crate) fn new(rate: f32) -> Self {
        Self {
            rate,
            voices: Vec::with_capacity(MOST_VOICES),
            cut: [[0.0; 2]; BUSES],
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.voices.len()
    }

    /// Starts a grain. If [`MOST_VOICES`] grains are present, replaces the faintest one, or drops the new
    /// grain if that is fainter still.
    pub(crate) fn start(&mut self, grain: Grain) {
        let voice = Voice::new(grain, self.rate);
        if self.voices.len() < MOST_VOICES {
            self.voices.push(voice);
            return;
        }
        let faintest = self
            .voices
            .iter_mut()
            .min_by(|a, b| a.loudness().total_cmp(&b.loudness()));
        let faintest = faintest.expect("the voice list is full, so it is not empty");
        if faintest.loudness() < grain.gain {
            let cut = &mut self.cut[faintest.grain.bus as usize];
            *cut = [cut[0] + faintest.last[0], cut[1] + faintest.last[1]];
            *faintest = voice;
        }
    }

    /// Adds the next `count` samples of all grains to the buses.
    pub(crate) fn add(&mut self, noise: &mut Noise, buses: &mut Buses, count: usize) {
        for voice in &mut self.voices {
            let bus = voice.grain.bus as usize;
            voice.add(noise, &mut buses[bus][..count]);
        }
        self.voices.retain(|voice| !voice.is_over());
        let keep = 1.0 - 300.0 / self.rate;
        for (bus, cut) in buses.iter_mut().zip(&mut self.cut) {
            for sample in &mut bus[..count] {
                for side in 0..2 {
                    sample[side] += cut[side];
                    cut[side] = if cut[side].abs() < 1e-6 {
                        0.0
                    } else {
                        cut[side] * keep
                    };
                }
            }
        }
    }
}

/// Grain that is playing.
struct Voice {
    grain: Grain,
    sides: Stereo,
    /// Number of samples until the grain starts.
    wait: u32,
    /// Current value of the envelope, 0 to 1.
    envelope: f32,
    /// Whether the envelope is still rising.
    rises: bool,
    /// Increment of the envelope per sample while it rises.
    rise: f32,
    /// Factor on the envelope per sample while it falls.
    fall: f32,
    /// Current frequency [cycles/sample].
    frequency: f32,
    /// Final frequency [cycles/sample].
    frequency_end: f32,
    /// Factor per sample on the difference between the current and the final frequency.
    approach: f32,
    tone: Tone,
    band: Band,
    last: Stereo,
}

impl Voice {
    fn new(grain: Grain, rate: f32) -> Self {
        let [first, last] = grain.pitch.map(|pitch| (pitch / rate).min(0.45));
        Self {
            grain,
            sides: panned(grain.x),
            wait: (grain.delay * rate) as u32,
            envelope: 0.0,
            rises: true,
            rise: 1.0 / (grain.attack * rate).max(1.0),
            fall: (-1.0 / (grain.decay * rate)).exp(),
            frequency: first,
            frequency_end: last,
            approach: (-1.0 / (grain.glide * rate)).exp(),
            tone: Tone::default(),
            band: Band::default(),
            last: [0.0; 2],
        }
    }

    /// Returns the loudness of the grain: its current amplitude, or its future maximum while it waits or
    /// rises.
    fn loudness(&self) -> f32 {
        self.grain.gain * if self.rises { 1.0 } else { self.envelope }
    }

    /// Returns whether the grain has faded to 80 dB below full scale.
    fn is_over(&self) -> bool {
        !self.rises && self.loudness() < 1e-4
    }

    fn add(&mut self, noise: &mut Noise, out: &mut [Stereo]) {
        let waited = (self.wait as usize).min(out.len());
        self.wait -= waited as u32;
        let grain = self.grain;
        if grain.noise > 0.0 {
            self.band
                .tune(self.frequency * grain.above, grain.sharpness);
        }
        for sample in &mut out[waited..] {
            if self.rises {
                self.envelope = (self.envelope + self.rise).min(1.0);
                self.rises = self.envelope < 1.0;
            } else {
                self.envelope *= self.fall;
            }
            self.frequency =
                self.frequency_end + (self.frequency - self.frequency_end) * self.approach;
            let mut sound = 0.0;
            if grain.tone > 0.0 {
                sound += grain.tone * self.tone.next(self.frequency, grain.edge);
            }
            if grain.noise > 0.0 {
                sound += grain.noise * self.band.hiss(noise);
            }
            sound *= grain.gain * self.envelope;
            self.last = self.sides.map(|side| side * sound);
            *sample = [sample[0] + self.last[0], sample[1] + self.last[1]];
        }
    }
}

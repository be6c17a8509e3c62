//! Final processing of all sounds: a small reverb and a limiter.

use crate::part::Stereo;

/// Reverb of a small room: a feedback delay network of four lines [Jot 1991].
pub(crate) struct Room {
    lines: [Line; 4],
}

/// Delay line of the reverb, with a low-pass filter.
struct Line {
    samples: Vec<f32>,
    place: usize,
    dull: f32,
}

impl Room {
    pub(crate) fn new(rate: f32) -> Self {
        // The delays of the four lines have no small common multiple; otherwise some pitch would stand out.
        let line = |seconds: f32| Line {
            samples: vec![0.0; (seconds * rate) as usize],
            place: 0,
            dull: 0.0,
        };
        Self {
            lines: [0.0233, 0.0297, 0.0371, 0.0419].map(line),
        }
    }

    /// Returns the reverberation for an input sample.
    pub(crate) fn next(&mut self, dry: Stereo) -> Stereo {
        let [a, b, c, d] = self.lines.each_ref().map(|line| line.samples[line.place]);
        // Mixes the lines by a Hadamard matrix, one row per line. Each line feeds all lines, and the total
        // energy stays.
        let mixed = [a + b + c + d, a - b + c - d, a + b - c - d, a - b - c + d];
        for (place, (line, mixed)) in self.lines.iter_mut().zip(mixed).enumerate() {
            line.dull += 0.55 * (mixed - line.dull);
            if line.dull.abs() < 1e-7 {
                line.dull = 0.0;
            }
            line.samples[line.place] = dry[place % 2] + 0.5 * 0.74 * line.dull;
            line.place = (line.place + 1) % line.samples.len();
        }
        [a + c, b + d]
    }
}

/// High-pass filter that removes inaudible low frequencies. For example, a tone with many overtones has a
/// non-zero mean. Without the filter, such a mean would make the limiter lower the volume.
#[derive(Default)]
pub(crate) struct HighPass {
    mean: Stereo,
}

impl HighPass {
    /// Removes frequencies below about 15 Hz, at `rate` samples per second.
    pub(crate) fn next(&mut self, sample: Stereo, rate: f32) -> Stereo {
        [0, 1].map(|side| {
            let mean = self.mean[side] + 100.0 / rate * (sample[side] - self.mean[side]);
            self.mean[side] = if mean.abs() < 1e-7 { 0.0 } else { mean };
            sample[side] - self.mean[side]
        })
    }
}

/// Limiter: lowers the volume fast but without a jump, and raises it slowly.
pub(crate) struct Limiter {
    peak: f32,
    attack: f32,
    release: f32,
}

impl Limiter {
    pub(crate) fn new(rate: f32) -> Self {
        let share = |seconds: f32| 1.0 - (-1.0 / (seconds * rate)).exp();
        Self {
            peak: 0.0,
            attack: share(0.000_5),
            release: share(0.2),
        }
    }

    /// Returns a sample within −1 to 1.
    pub(crate) fn next(&mut self, sample: Stereo) -> Stereo {
        /// Level up to which samples pass unchanged.
        const CLEAN: f32 = 0.7;
        let loud = sample[0].abs().max(sample[1].abs());
        let pace = if loud > self.peak {
            self.attack
        } else {
            self.release
        };
        self.peak += pace * (loud - self.peak);
        let gain = CLEAN / self.peak.max(CLEAN);
        // Soft-clips peaks that come faster than the limiter lowers the volume.
        let bent = |side: f32| {
            let over = (gain * side.abs() - CLEAN).max(0.0) / (1.0 - CLEAN);
            (gain * side.abs()).min(CLEAN) + (1.0 - CLEAN) * over.tanh()
        };
        sample.map(|side| bent(side).copysign(side))
    }
}

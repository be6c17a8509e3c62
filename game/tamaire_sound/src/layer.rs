//! Continuous sounds: squeaking hands, the wobble of the body, and the chord while the body rests in the
//! basket.

use crate::part::{Band, Drift, Noise, Smooth, Stereo, Tone, note, panned, share};
use crate::soundscape::Press;
use std::f32::consts::{PI, TAU};

/// Sound of a hand that rubs and squashes rubber. It consists of a squeak and of wet noise from the displaced
/// material. The force raises the pitch of the squeak and opens a mouth-like filter.
pub(crate) struct Squeak {
    rate: f32,
    /// Contact force, smoothed: 0 for none, 0.5 for a usual force, towards 1 for large ones.
    firm: Smooth,
    /// Slip speed, smoothed and scaled like `firm`.
    slide: Smooth,
    x: Smooth,
    /// Delayed copy of `firm`. The difference between both shows how the force changes.
    late: Smooth,
    stir: Smooth,
    /// Phase of the current squeak, 0 to 1.
    squeak: f32,
    /// Squeaks per second at very fast slip.
    hurry: f32,
    /// Modulation within a squeak, which imitates the stick-slip of rubber.
    jerk: Drift,
    tone: Tone,
    mouth: Band,
    /// Two band-pass filters in series for the wet noise. One alone would let hiss above its band through.
    wet: [Band; 2],
}

impl Squeak {
    pub(crate) fn new(rate: f32) -> Self {
        let smooth = |seconds| Smooth::new(seconds, rate);
        Self {
            rate,
            firm: smooth(0.02),
            slide: smooth(0.03),
            x: smooth(0.05),
            late: smooth(0.12),
            stir: smooth(0.02),
            squeak: 0.0,
            hurry: 14.0,
            jerk: Drift::new(38.0, rate),
            tone: Tone::default(),
            mouth: Band::default(),
            wet: [Band::default(); 2],
        }
    }

    pub(crate) fn hear(&mut self, press: &Press) {
        self.firm.target = share(press.force, 400.0);
        self.slide.target = share(press.slip, 0.5);
        self.x.target = press.x;
        if self.is_silent() {
            self.x.value = press.x;
        }
    }

    /// Returns whether the sound has faded out.
    fn is_silent(&self) -> bool {
        self.firm.value == 0.0 && self.late.value == 0.0 && self.stir.value == 0.0
    }

    pub(crate) fn add(&mut self, noise: &mut Noise, out: &mut [Stereo]) {
        if self.is_silent() && self.firm.is_silent() {
            return;
        }
        let firm = self.firm.value;
        let sides = panned(self.x.value);
        let height = 150.0 * (2.4 * firm).exp2() * (1.0 + 0.25 * self.slide.value);
        self.mouth.tune(2.6 * height / self.rate, 1.6);
        for band in &mut self.wet {
            band.tune((200.0 + 1100.0 * firm) / self.rate, 1.2);
        }
        for sample in out {
            self.x.next();
            let (firm, slide) = (self.firm.next(), self.slide.next());
            self.late.target = firm;
            self.stir.target = (4.0 * (firm - self.late.next())).abs().min(1.0);
            let stir = self.stir.next();
            let moves = 1.0 - (1.0 - slide) * (1.0 - 0.6 * stir);
            // A slipping hand squeaks once every few centimetres, with random spacing.
            self.squeak += slide * self.hurry / self.rate;
            if self.squeak >= 1.0 {
                self.squeak -= 1.0;
                self.hurry = noise.between(9.0, 18.0);
            }
            let swell = (PI * self.squeak).sin();
            let jerk = 0.75 + 0.25 * self.jerk.next(noise);
            // The pitch of each squeak rises.
            let frequency = height * (0.85 + 0.3 * self.squeak) / self.rate;
            let tone = self.tone.next(frequency, 0.3 + 0.4 * firm);
            let voice = 0.45 * tone + 0.8 * self.mouth.next(tone);
            let loud = firm * firm * (0.05 + 0.95 * moves * swell * swell);
            let squeak = 2.6 * loud * jerk * voice;
            let [first, second] = &mut self.wet;
            let squish = 0.32 * firm * moves * jerk * second.next(first.hiss(noise));
            let sound = squeak + squish;
            *sample = [sample[0] + sides[0] * sound, sample[1] + sides[1] * sound];
        }
    }
}

/// Wobble of a mochi-like body: a simulated weight on a spring follows the squash and overshoots. Its speed
/// sets the loudness.
pub(crate) struct Wobble {
    rate: f32,
    squash: Smooth,
    /// Position of the weight, as a value of squash.
    place: f32,
    /// Speed of the weight [1/s].
    speed: f32,
    gain: Smooth,
    tone: Tone,
}

impl Wobble {
    pub(crate) fn new(rate: f32) -> Self {
        Self {
            rate,
            squash: Smooth::new(0.02, rate),
            place: 0.0,
            speed: 0.0,
            gain: Smooth::new(0.015, rate),
            tone: Tone::default(),
        }
    }

    pub(crate) fn hear(&mut self, squash: f32) {
        self.squash.target = squash;
    }

    pub(crate) fn add(&mut self, out: &mut [Stereo]) {
        /// Angular frequency of the weight on its spring [rad/s].
        const SWING: f32 = TAU * 5.5;
        /// Damping ratio of the weight on its spring.
        const DAMPING: f32 = 0.16;
        let still = self.squash.value == self.squash.target && self.gain.is_silent();
        if still && self.speed.abs() < 1e-3 && (self.place - self.squash.value).abs() < 1e-4 {
            return;
        }
        for sample in out {
            let away = self.squash.next() - self.place;
            let push = SWING * SWING * away - 2.0 * DAMPING * SWING * self.speed;
            self.speed += push / self.rate;
            self.place += self.speed / self.rate;
            // Squares the speed, so that a slight tremor is not heard.
            let quick = self.speed * self.speed;
            self.gain.target = share(quick, 3.0);
            let frequency = 88.0 * (1.0 + 0.9 * self.place) / self.rate;
            let sound = 0.6 * self.gain.next() * self.tone.next(frequency, 0.45);
            *sample = sample.map(|side| side + sound);
        }
    }
}

/// Four voices that start one after the other and rise in pitch while the body rests in the basket.
pub(crate) struct Chord {
    rate: f32,
    hold: Smooth,
    /// Highest value of `hold` so far, which sets the pitch. If the body leaves the basket, the pitch stays
    /// until the sound has faded out.
    risen: f32,
    shimmer: f32,
    tones: [Tone; 4],
}

impl Chord {
    pub(crate) fn new(rate: f32) -> Self {
        Self {
            rate,
            hold: Smooth::new(0.04, rate),
            risen: 0.0,
            shimmer: 0.0,
            tones: [Tone::default(); 4],
        }
    }

    pub(crate) fn hear(&mut self, hold: f32) {
        self.hold.target = hold;
    }

    pub(crate) fn add(&mut self, out: &mut [Stereo]) {
        /// MIDI note of the lowest voice at the start: G.
        const LOWEST: f32 = 55.0;
        /// Rise of all voices during the hold [semitones]. The lowest ends at C, the first note of the
        /// squeeze jingle.
        const RISE: f32 = 5.0;
        /// Intervals of the voices above the lowest one [semitones].
        const ABOVE: [f32; 4] = [0.0, 4.0, 7.0, 12.0];
        if self.hold.is_silent() {
            self.risen = 0.0;
            return;
        }
        self.risen = self.risen.max(self.hold.value);
        let risen = self.risen;
        let frequencies = ABOVE.map(|above| note(LOWEST + above + RISE * risen) / self.rate);
        let sides = [-0.6, 0.6, -0.2, 0.3].map(panned);
        for sample in out {
            let hold = self.hold.next();
            self.shimmer = (self.shimmer + (4.0 + 6.0 * risen) / self.rate).fract();
            let shimmer = 0.8 + 0.2 * (TAU * self.shimmer).sin();
            for place in 0..4 {
                let loud = (4.0 * hold - place as f32).clamp(0.0, 1.0);
                let sound = 0.1 * loud * shimmer * self.tones[place].next(frequencies[place], 0.5);
                for side in 0..2 {
                    sample[side] += sides[place][side] * sound;
                }
            }
        }
    }
}

/// Chimes played backwards, while time runs back: each swells from nothing and ends at once, and they climb.
pub(crate) struct Shimmer {
    rate: f32,
    gain: Smooth,
    /// Time of the current chime, 0 to 1.
    swell: f32,
    /// Number of chimes so far.
    count: usize,
    tones: [Tone; 2],
}

impl Shimmer {
    pub(crate) fn new(rate: f32) -> Self {
        Self {
            rate,
            gain: Smooth::new(0.06, rate),
            swell: 0.0,
            count: 0,
            tones: [Tone::default(); 2],
        }
    }

    pub(crate) fn hear(&mut self, is_on: bool) {
        self.gain.target = f32::from(u8::from(is_on));
    }

    pub(crate) fn add(&mut self, out: &mut [Stereo]) {
        /// MIDI notes of the chimes: C major without the fourth and the seventh.
        const NOTES: [f32; 8] = [72.0, 76.0, 74.0, 79.0, 76.0, 81.0, 79.0, 84.0];
        /// Number of chimes per second.
        const PER_SECOND: f32 = 6.0;
        if self.gain.is_silent() && self.gain.target == 0.0 {
            (self.swell, self.count) = (0.0, 0);
            return;
        }
        for sample in out {
            self.swell += PER_SECOND / self.rate;
            if self.swell >= 1.0 {
                self.swell -= 1.0;
                self.count += 1;
            }
            let height = NOTES[self.count % NOTES.len()];
            let sides = panned(if self.count.is_multiple_of(2) {
                -0.5
            } else {
                0.5
            });
            // Rises slowly and falls within a thirtieth of the chime.
            let loud = self.swell.powi(3) * (30.0 * (1.0 - self.swell)).min(1.0);
            let [low, high] = [0.0, 12.0].map(|above| note(height + above) / self.rate);
            let voice = self.tones[0].next(low, 0.3) + 0.4 * self.tones[1].next(high, 0.2);
            let sound = 0.22 * self.gain.next() * loud * voice;
            *sample = [sample[0] + sides[0] * sound, sample[1] + sides[1] * sound];
        }
    }
}

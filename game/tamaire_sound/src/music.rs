//! Background music: slow chords with a few random notes that fit the chords. The music never repeats exactly.

use crate::grain::{Bus, Grain, Voices};
use crate::part::{Noise, note};
use crate::recipe::{bell, strike};

/// Duration of a beat [s].
const BEAT: f32 = 0.42;
/// Number of beats per chord.
const BEATS: u32 = 12;

/// MIDI notes of the chords C, A minor, F and G, widely spaced.
const CHORDS: [[f32; 3]; 4] = [
    [48.0, 55.0, 64.0],
    [45.0, 52.0, 60.0],
    [41.0, 57.0, 60.0],
    [43.0, 55.0, 62.0],
];

/// MIDI notes of the melody. They fit all chords.
const SCALE: [f32; 6] = [67.0, 69.0, 72.0, 74.0, 76.0, 79.0];

/// Generator of the background music.
pub(crate) struct Music {
    rate: f32,
    /// Number of samples until the next beat.
    left: f32,
    beat: u32,
    /// Index in [`SCALE`] of the last melody note.
    place: i32,
}

impl Music {
    pub(crate) fn new(rate: f32) -> Self {
        Self {
            rate,
            left: 0.0,
            beat: 0,
            place: 2,
        }
    }

    /// Starts the notes that begin within the next `count` samples.
    pub(crate) fn play(&mut self, noise: &mut Noise, voices: &mut Voices, count: usize) {
        if self.left < count as f32 {
            let delay = self.left.max(0.0) / self.rate;
            if self.beat.is_multiple_of(BEATS) {
                let chord = CHORDS[(self.beat / BEATS) as usize % CHORDS.len()];
                for (place, number) in chord.iter().enumerate() {
                    voices.start(pad(*number, delay, 0.6 * (place as f32 - 1.0)));
                }
            }
            // Probability of a melody note on each of four beats, highest on the first.
            let chance = [0.55, 0.15, 0.35, 0.2][self.beat as usize % 4];
            if noise.between(0.0, 1.0) < chance {
                let walk = noise.between(-2.5, 2.5).round() as i32;
                self.place = (self.place + walk).clamp(0, SCALE.len() as i32 - 1);
                let pluck = Grain {
                    bus: Bus::Music,
                    x: noise.between(-0.7, 0.7),
                    ..bell(
                        SCALE[self.place as usize],
                        delay,
                        noise.between(0.1, 0.2),
                        0.35,
                    )
                };
                voices.start(pluck);
                voices.start(strike(pluck));
            }
            self.beat += 1;
            self.left += BEAT * self.rate;
        }
        self.left -= count as f32;
    }
}

/// Returns a note of a chord. The note becomes louder over the first half of the chord and then fades.
fn pad(number: f32, delay: f32, x: f32) -> Grain {
    let chord = BEAT * BEATS as f32;
    Grain {
        bus: Bus::Music,
        delay,
        attack: 0.45 * chord,
        decay: 0.6 * chord,
        gain: 0.16,
        x,
        pitch: [note(number); 2],
        edge: 0.6,
        noise: 0.06,
        above: 4.0,
        sharpness: 3.0,
        ..Grain::default()
    }
}

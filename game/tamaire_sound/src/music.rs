//! Background music: slow chords with a few random notes that fit the chords. The music never repeats exactly.

use crate::grain::{Bus, Grain, Voices};
use crate::part::{Noise, note};
use crate::recipe::{bell, strike};

/// Number of beats per chord.
const BEATS: u32 = 12;

/// Material of the music: its tempo, chords and notes.
struct Song {
    /// Duration of a beat [s].
    beat: f32,
    /// MIDI notes of the chords, widely spaced.
    chords: [[f32; 3]; 4],
    /// MIDI notes of the melody. They fit all chords.
    scale: [f32; 6],
    /// Probability of a melody note on each beat of a bar, highest on the first.
    chances: &'static [f32],
    /// Decay of a melody note [s].
    ring: f32,
}

/// The songs; see [`Soundscape::song`](crate::Soundscape::song).
const SONGS: [Song; 6] = [
    // C, A minor, F and G.
    Song {
        beat: 0.42,
        chords: [
            [48.0, 55.0, 64.0],
            [45.0, 52.0, 60.0],
            [41.0, 57.0, 60.0],
            [43.0, 55.0, 62.0],
        ],
        scale: [67.0, 69.0, 72.0, 74.0, 76.0, 79.0],
        chances: &[0.55, 0.15, 0.35, 0.2],
        ring: 0.35,
    },
    // A morning at home: F, D minor, B flat and C, with long notes.
    Song {
        beat: 0.46,
        chords: [
            [41.0, 57.0, 60.0],
            [50.0, 57.0, 65.0],
            [46.0, 53.0, 62.0],
            [48.0, 55.0, 64.0],
        ],
        scale: [65.0, 67.0, 69.0, 72.0, 74.0, 77.0],
        chances: &[0.6, 0.1, 0.3, 0.15],
        ring: 0.5,
    },
    // In the kitchen: G, E minor, C and D, quick and short as chopping.
    Song {
        beat: 0.3,
        chords: [
            [43.0, 55.0, 59.0],
            [40.0, 55.0, 59.0],
            [48.0, 55.0, 64.0],
            [50.0, 57.0, 66.0],
        ],
        scale: [67.0, 69.0, 71.0, 74.0, 76.0, 79.0],
        chances: &[0.7, 0.4, 0.55, 0.4],
        ring: 0.12,
    },
    // At the fair: C, A minor, D minor and G, as a waltz.
    Song {
        beat: 0.34,
        chords: [
            [48.0, 55.0, 64.0],
            [45.0, 57.0, 60.0],
            [50.0, 57.0, 65.0],
            [43.0, 59.0, 62.0],
        ],
        scale: [72.0, 74.0, 76.0, 79.0, 81.0, 84.0],
        chances: &[0.75, 0.3, 0.3],
        ring: 0.25,
    },
    // A festival in summer: open fifths under the notes of a Japanese folk scale.
    Song {
        beat: 0.38,
        chords: [
            [38.0, 57.0, 62.0],
            [40.0, 55.0, 64.0],
            [43.0, 55.0, 62.0],
            [45.0, 57.0, 64.0],
        ],
        scale: [62.0, 64.0, 67.0, 69.0, 71.0, 74.0],
        chances: &[0.65, 0.2, 0.5, 0.3],
        ring: 0.22,
    },
    // At night: slow, dark chords and a scale with two half steps.
    Song {
        beat: 0.58,
        chords: [
            [45.0, 52.0, 60.0],
            [41.0, 57.0, 60.0],
            [40.0, 52.0, 59.0],
            [45.0, 57.0, 64.0],
        ],
        scale: [69.0, 71.0, 72.0, 76.0, 77.0, 81.0],
        chances: &[0.45, 0.1, 0.3, 0.1],
        ring: 0.9,
    },
];

/// Generator of the background music.
pub(crate) struct Music {
    rate: f32,
    /// Number of samples until the next beat.
    left: f32,
    beat: u32,
    /// Index in the scale of the last melody note.
    place: i32,
    /// Index in [`SONGS`].
    song: usize,
    /// Index in [`SONGS`] of the song that follows at the next chord.
    next: usize,
}

impl Music {
    pub(crate) fn new(rate: f32) -> Self {
        Self {
            rate,
            left: 0.0,
            beat: 0,
            place: 2,
            song: 0,
            next: 0,
        }
    }

    /// Chooses the song that follows at the next chord.
    pub(crate) fn hear(&mut self, song: u8) {
        self.next = usize::from(song).min(SONGS.len() - 1);
    }

    /// Starts the notes that begin within the next `count` samples.
    pub(crate) fn play(&mut self, noise: &mut Noise, voices: &mut Voices, count: usize) {
        if self.left < count as f32 {
            let delay = self.left.max(0.0) / self.rate;
            if self.beat.is_multiple_of(BEATS) {
                self.song = self.next;
            }
            let song = &SONGS[self.song];
            if self.beat.is_multiple_of(BEATS) {
                let chord = song.chords[(self.beat / BEATS) as usize % song.chords.len()];
                let duration = song.beat * BEATS as f32;
                for (place, number) in chord.iter().enumerate() {
                    let x = 0.6 * (place as f32 - 1.0);
                    voices.start(pad(*number, duration, delay, x));
                }
            }
            let chance = song.chances[self.beat as usize % song.chances.len()];
            if noise.between(0.0, 1.0) < chance {
                let walk = noise.between(-2.5, 2.5).round() as i32;
                self.place = (self.place + walk).clamp(0, song.scale.len() as i32 - 1);
                let pluck = Grain {
                    bus: Bus::Music,
                    x: noise.between(-0.7, 0.7),
                    ..bell(
                        song.scale[self.place as usize],
                        delay,
                        noise.between(0.1, 0.2),
                        song.ring,
                    )
                };
                voices.start(pluck);
                voices.start(strike(pluck));
            }
            self.beat += 1;
            self.left += song.beat * self.rate;
        }
        self.left -= count as f32;
    }
}

/// Returns a note of a chord of duration `chord` [s]. The note becomes louder over the first half of the chord and then
/// fades.
fn pad(number: f32, chord: f32, delay: f32, x: f32) -> Grain {
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

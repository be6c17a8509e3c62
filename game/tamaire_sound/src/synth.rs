//! Synthesiser that renders sounds to samples.

use crate::cue::Cue;
use crate::grain::{BUSES, Bus, Buses, CHUNK, Voices};
use crate::layer::{Chord, Shimmer, Squeak, Wobble};
use crate::master::{HighPass, Limiter, Room};
use crate::music::Music;
use crate::part::{Noise, Smooth, clean};
use crate::recipe;
use crate::soundscape::{Mute, Soundscape, Volumes};

/// Time after which continuous sounds end if no update arrives [s]: the game then hangs or has ended.
const STALE: f32 = 0.5;

/// Reverb send level of each [`Bus`], 0 to 1.
const INTO_ROOM: [f32; BUSES] = [0.1, 0.3, 0.12];

/// Synthesiser. Equal calls give equal samples on the same machine.
pub struct Synth {
    rate: f32,
    soundscape: Soundscape,
    /// Number of samples rendered since the last update of the continuous sounds.
    age: usize,
    volumes: Volumes,
    squeaks: [Squeak; 2],
    wobble: Wobble,
    chord: Chord,
    shimmer: Shimmer,
    music: Music,
    voices: Voices,
    thuds: Thuds,
    noise: Noise,
    /// Volume of each [`Bus`].
    gains: [Smooth; BUSES],
    master: Smooth,
    room: Room,
    floor: HighPass,
    limiter: Limiter,
    buses: Buses,
}

impl Synth {
    /// Creates a synthesiser with a sample rate [Hz], about 48,000; clamped to 8,000 to 400,000.
    pub fn new(rate: u32) -> Self {
        let rate = rate.clamp(8_000, 400_000) as f32;
        let mut synth = Self {
            rate,
            soundscape: Soundscape::default(),
            age: 0,
            volumes: Volumes::default(),
            squeaks: [Squeak::new(rate), Squeak::new(rate)],
            wobble: Wobble::new(rate),
            chord: Chord::new(rate),
            shimmer: Shimmer::new(rate),
            music: Music::new(rate),
            voices: Voices::new(rate),
            thuds: Thuds::default(),
            noise: Noise::new(),
            gains: [0.015, 0.3, 0.015].map(|seconds| Smooth::new(seconds, rate)),
            master: Smooth::new(0.015, rate),
            room: Room::new(rate),
            floor: HighPass::default(),
            limiter: Limiter::new(rate),
            buses: [[[0.0; 2]; CHUNK]; BUSES],
        };
        synth.aim();
        for gain in synth.gains.iter_mut().chain([&mut synth.master]) {
            gain.value = gain.target;
        }
        synth
    }

    /// Sets the continuous sounds.
    pub fn set_soundscape(&mut self, soundscape: &Soundscape) {
        self.soundscape = soundscape.cleaned();
        self.age = 0;
        self.aim();
    }

    /// Sets the volumes.
    pub fn set_volumes(&mut self, volumes: &Volumes) {
        self.volumes = *volumes;
        self.aim();
    }

    /// Starts a momentary sound.
    pub fn play(&mut self, cue: Cue) {
        let cue = cue.cleaned();
        if let Cue::Thud { impulse, .. } = cue
            && !self.thuds.is_heard(impulse)
        {
            return;
        }
        recipe::start(cue, &mut self.noise, &mut self.voices);
    }

    /// Fills `out` with interleaved left and right samples. Allocates nothing and takes no lock.
    pub fn render(&mut self, out: &mut [f32]) {
        for chunk in out.chunks_mut(2 * CHUNK) {
            let count = chunk.len().div_ceil(2);
            self.fill_buses(count);
            for (place, sides) in chunk.chunks_mut(2).enumerate() {
                let sample = self.mix(place);
                sides.copy_from_slice(&sample[..sides.len()]);
            }
        }
    }

    /// Returns the number of grains (short sounds) that are playing or waiting, at most 64. A cue consists of
    /// several grains.
    pub fn voice_count(&self) -> usize {
        self.voices.count()
    }

    /// Renders the next `count` samples of every bus.
    fn fill_buses(&mut self, count: usize) {
        self.age += count;
        if self.age as f32 > STALE * self.rate {
            self.set_soundscape(&Soundscape::default());
        }
        self.thuds.forget(count as f32 / self.rate);
        self.buses = [[[0.0; 2]; CHUNK]; BUSES];
        let effects = &mut self.buses[Bus::Effects as usize][..count];
        for squeak in &mut self.squeaks {
            squeak.add(&mut self.noise, effects);
        }
        self.wobble.add(effects);
        self.chord.add(effects);
        self.shimmer.add(effects);
        if self.soundscape.music {
            self.music.play(&mut self.noise, &mut self.voices, count);
        }
        self.voices.add(&mut self.noise, &mut self.buses, count);
    }

    /// Mixes sample `place` of all buses to left and right.
    fn mix(&mut self, place: usize) -> [f32; 2] {
        let (mut dry, mut into_room) = ([0.0; 2], [0.0; 2]);
        for ((bus, gain), into) in self.buses.iter().zip(&mut self.gains).zip(INTO_ROOM) {
            let gain = gain.next();
            for side in 0..2 {
                dry[side] += gain * bus[place][side];
                into_room[side] += gain * into * bus[place][side];
            }
        }
        let room = self.room.next(into_room);
        let master = self.master.next();
        let all = [0, 1].map(|side| master * (dry[side] + room[side]));
        self.limiter.next(self.floor.next(all, self.rate))
    }

    /// Passes the soundscape and the volumes on to the parts of the synthesiser.
    fn aim(&mut self) {
        let Soundscape {
            presses,
            squash,
            hold,
            rewind,
            music,
            song,
            hush,
        } = self.soundscape;
        for (squeak, press) in self.squeaks.iter_mut().zip(&presses) {
            squeak.hear(press);
        }
        self.wobble.hear(squash);
        self.chord.hear(hold);
        self.shimmer.hear(rewind);
        self.music.hear(song);
        let volumes = &self.volumes;
        // Squares the volume, so that half of the slider sounds about half as loud.
        let loudness = |is_on, volume| {
            if is_on {
                clean(volume, 0.0, 1.0).powi(2)
            } else {
                0.0
            }
        };
        self.gains[Bus::Effects as usize].target = loudness(hush != Mute::World, volumes.effects);
        self.gains[Bus::Music as usize].target = loudness(music, volumes.music);
        self.gains[Bus::Interface as usize].target = loudness(true, volumes.interface);
        self.master.target = loudness(hush != Mute::Everything, volumes.master);
    }
}

/// Filter for impacts: lets a thud be heard only if its impulse is much larger than recent ones.
#[derive(Default)]
struct Thuds {
    /// Largest recent impulse, which decays with time [N s].
    usual: f32,
}

impl Thuds {
    fn is_heard(&mut self, impulse: f32) -> bool {
        let heard = impulse > 0.05 && impulse > 1.6 * self.usual;
        self.usual = self.usual.max(impulse);
        heard
    }

    fn forget(&mut self, seconds: f32) {
        self.usual *= (-seconds / 0.15).exp();
    }
}

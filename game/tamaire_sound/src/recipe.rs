//! Sounds of the cues. Each sound consists of grains, short sounds of a tone and noise.

use crate::cue::{Cue, Menu, Route};
use crate::grain::{Bus, Grain, Voices};
use crate::part::{Noise, note, share};

/// Starts the grains of a cue. Thuds, tears and crumbs vary randomly, because they are frequent.
pub(crate) fn start(cue: Cue, noise: &mut Noise, voices: &mut Voices) {
    match cue {
        Cue::Thud { impulse, x } => thud(impulse, x, noise, voices),
        Cue::Tear { energy, x } => tear(energy, x, noise, voices),
        Cue::Crumb { speed, x } => crumb(speed, x, noise, voices),
        Cue::Snap { x } => snap(x, noise, voices),
        Cue::Switch { is_on, x } => switch(is_on, x, voices),
        Cue::Won(route) => jingle(route, voices),
        Cue::Menu(menu) => blip(menu, voices),
    }
}

/// Pillow-like impact: a low, falling tone with dull noise. Heavier impacts sound lower and last longer.
fn thud(impulse: f32, x: f32, noise: &mut Noise, voices: &mut Voices) {
    let heavy = share(impulse, 10.0);
    let pitch = (150.0 - 60.0 * heavy) * noise.between(0.93, 1.07);
    voices.start(Grain {
        x,
        attack: 0.004,
        decay: 0.05 + 0.09 * heavy,
        gain: 0.08 + 0.75 * heavy,
        pitch: [1.7 * pitch, 0.75 * pitch],
        glide: 0.04,
        edge: 0.25,
        noise: 0.35,
        above: 1.8,
        sharpness: 0.8,
        ..Grain::default()
    });
}

/// Wet sound of a tear: a band of noise with a falling pitch, a drop with a rising pitch, and random
/// crackles. A large tear also pops.
fn tear(energy: f32, x: f32, noise: &mut Noise, voices: &mut Voices) {
    let strong = share(energy, 1.0);
    // Makes a tear fainter if many grains are playing, so that a long rip does not drown everything else.
    let crowd = 1.0 + 0.03 * voices.count() as f32;
    let gain = (0.07 + 0.43 * strong) / crowd;
    let high = noise.between(900.0, 2200.0);
    voices.start(Grain {
        x,
        attack: 0.0015,
        decay: 0.014 + 0.05 * strong,
        gain,
        pitch: [high, 0.3 * high],
        glide: 0.03,
        tone: 0.0,
        noise: 0.5,
        sharpness: 2.2,
        ..Grain::default()
    });
    let drop = noise.between(260.0, 520.0) * (1.0 - 0.4 * strong);
    voices.start(Grain {
        x,
        delay: noise.between(0.0, 0.02),
        attack: 0.003,
        decay: 0.018 + 0.02 * strong,
        gain: 0.7 * gain,
        pitch: [drop, 2.6 * drop],
        glide: 0.025,
        edge: 0.3,
        ..Grain::default()
    });
    for _ in 0..(1.0 + 3.0 * strong) as u32 {
        voices.start(Grain {
            x,
            delay: noise.between(0.004, 0.03 + 0.09 * strong),
            attack: 0.001,
            decay: 0.004,
            gain: gain * noise.between(0.2, 0.6),
            pitch: [noise.between(1800.0, 4500.0); 2],
            tone: 0.0,
            noise: 0.7,
            sharpness: 4.0,
            ..Grain::default()
        });
    }
    let pop = strong - 0.4;
    if pop > 0.0 {
        voices.start(Grain {
            x,
            decay: 0.045,
            gain: pop / crowd,
            pitch: [320.0, 95.0],
            glide: 0.03,
            edge: 0.4,
            ..Grain::default()
        });
    }
}

/// Sound of a landing crumb: a faint, short tick, like a rice grain falling on felt.
fn crumb(speed: f32, x: f32, noise: &mut Noise, voices: &mut Voices) {
    let fast = share(speed, 1.0);
    let pitch = noise.between(1300.0, 2800.0);
    voices.start(Grain {
        x,
        attack: 0.001,
        decay: 0.007 + 0.006 * fast,
        gain: 0.04 + 0.2 * fast,
        pitch: [pitch, 0.7 * pitch],
        glide: 0.01,
        tone: 0.6,
        noise: 0.3,
        sharpness: 2.0,
        ..Grain::default()
    });
}

/// Twang of a string that breaks: a bright note that falls and trembles out, after a click.
fn snap(x: f32, noise: &mut Noise, voices: &mut Voices) {
    let pitch = noise.between(300.0, 360.0);
    for (high, gain, decay) in [(1.0, 0.4, 0.22), (2.01, 0.2, 0.12), (5.0, 0.16, 0.02)] {
        voices.start(Grain {
            x,
            attack: 0.001,
            decay,
            gain,
            pitch: [high * pitch, 0.72 * high * pitch],
            glide: 0.12,
            edge: 0.5,
            ..Grain::default()
        });
    }
}

/// Click of a switch: two wooden taps, up when it is pressed and down when it is released.
fn switch(is_on: bool, x: f32, voices: &mut Voices) {
    let notes = if is_on { [67.0, 74.0] } else { [74.0, 67.0] };
    for (delay, number) in [0.0, 0.08].into_iter().zip(notes) {
        let tap = Grain {
            x,
            ..bell(number, delay, 0.3, 0.07)
        };
        voices.start(tap);
        voices.start(strike(tap));
    }
}

/// Notes of a jingle: start time [s] and MIDI note number of each.
type Tune = &'static [(f32, f32)];

/// Jingle for a body squeezed in: a run up to a broad chord, as round as the body.
const SQUEEZE: Tune = &[
    (0.0, 60.0),
    (0.09, 64.0),
    (0.18, 67.0),
    (0.27, 72.0),
    (0.36, 76.0),
    (0.54, 72.0),
    (0.54, 76.0),
    (0.54, 79.0),
    (0.56, 84.0),
];

/// Jingle for a body with parts shaved off: quick hops down and up, like chips.
const SHAVE: Tune = &[
    (0.0, 84.0),
    (0.08, 79.0),
    (0.16, 81.0),
    (0.24, 76.0),
    (0.40, 79.0),
    (0.48, 84.0),
    (0.56, 88.0),
    (0.72, 79.0),
    (0.72, 84.0),
    (0.72, 91.0),
];

/// Jingle for a mix of squeezing and shaving: the run of `SQUEEZE`, then hops like those of `SHAVE`.
const MIX: Tune = &[
    (0.0, 60.0),
    (0.09, 64.0),
    (0.18, 67.0),
    (0.32, 81.0),
    (0.40, 79.0),
    (0.54, 72.0),
    (0.54, 76.0),
    (0.54, 84.0),
];

/// Returns whether a note that starts at `delay` [s] belongs to the final chord of a jingle. The chord's top
/// note may start a little later than the others.
fn is_last(tune: Tune, delay: f32) -> bool {
    delay >= tune[tune.len() - 2].0
}

fn jingle(route: Route, voices: &mut Voices) {
    let (tune, ring) = match route {
        Route::Squeeze => (SQUEEZE, 0.5),
        Route::Shave => (SHAVE, 0.16),
        Route::Mix => (MIX, 0.3),
    };
    for (place, (delay, number)) in tune.iter().enumerate() {
        let x = if place % 2 == 0 { -0.3 } else { 0.3 };
        let ring = if is_last(tune, *delay) {
            2.0 * ring
        } else {
            ring
        };
        let bell = Grain {
            bus: Bus::Interface,
            x,
            ..bell(*number, *delay, 0.3, ring)
        };
        voices.start(bell);
        voices.start(strike(bell));
    }
    if route == Route::Squeeze {
        voices.start(Grain {
            bus: Bus::Interface,
            attack: 0.03,
            decay: 0.16,
            gain: 0.3,
            pitch: [90.0, 330.0],
            glide: 0.2,
            edge: 0.5,
            ..Grain::default()
        });
    }
}

fn blip(menu: Menu, voices: &mut Voices) {
    let notes: Tune = match menu {
        Menu::Move => &[(0.0, 79.0)],
        Menu::Confirm => &[(0.0, 79.0), (0.07, 84.0)],
        Menu::Back => &[(0.0, 76.0), (0.07, 71.0)],
    };
    let gain = if menu == Menu::Move { 0.3 } else { 0.45 };
    for (delay, number) in notes {
        let blip = bell(*number, *delay, gain, 0.06);
        voices.start(Grain {
            bus: Bus::Interface,
            ..blip
        });
    }
}

/// Returns a marimba-like note.
pub(crate) fn bell(number: f32, delay: f32, gain: f32, ring: f32) -> Grain {
    Grain {
        delay,
        attack: 0.003,
        decay: ring,
        gain,
        pitch: [note(number); 2],
        edge: 0.1,
        ..Grain::default()
    }
}

/// Returns the attack of a bell, like a mallet on a wooden bar: a short grain two octaves above the bell.
pub(crate) fn strike(bell: Grain) -> Grain {
    Grain {
        decay: 0.12 * bell.decay + 0.01,
        gain: 0.25 * bell.gain,
        pitch: bell.pitch.map(|pitch| 3.93 * pitch),
        ..bell
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn final_chord_of_each_jingle_rings_longer() {
        let notes = [SQUEEZE, SHAVE, MIX].map(|tune| {
            let last = tune.iter().filter(|(delay, _)| is_last(tune, *delay));
            last.count()
        });
        assert_eq!(notes, [4, 3, 3]);
    }
}

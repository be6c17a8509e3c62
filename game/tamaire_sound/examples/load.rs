//! Measures how much processor time the synthesiser takes while it plays, as a share of one core.
//!
//! `cargo run --release -p tamaire_sound --example load`

use std::time::Instant;
use tamaire_sound::{Cue, Press, Soundscape, Synth};

const RATE: u32 = 48_000;
const SECONDS: u32 = 10;

fn main() {
    let press = Press {
        force: 600.0,
        slip: 0.5,
        x: 0.0,
    };
    let presses = [press, Press::default()];
    let everything = Soundscape {
        presses: [press; 2],
        squash: 0.0,
        hold: 0.9,
        rewind: false,
        music: true,
        ..Soundscape::default()
    };
    report("nothing", Soundscape::default(), 0);
    let one = Soundscape {
        presses,
        ..Soundscape::default()
    };
    report("one hand rubs", one, 0);
    report("everything, and 20 tears a tick", everything, 20);
}

fn report(what: &str, soundscape: Soundscape, tears: u32) {
    let mut synth = Synth::new(RATE);
    let mut tick = [0.0; 2 * RATE as usize / 60];
    let (mut worst, mut most_voices) = (0.0_f64, 0);
    let start = Instant::now();
    for time in 0..60 * SECONDS {
        let start = Instant::now();
        let squash = soundscape.squash + 0.3 * (time / 30 % 2) as f32 * soundscape.hold;
        synth.set_soundscape(&Soundscape {
            squash,
            ..soundscape
        });
        for _ in 0..tears {
            synth.play(Cue::Tear {
                energy: 1.0,
                x: 0.0,
            });
        }
        synth.render(&mut tick);
        most_voices = most_voices.max(synth.voice_count());
        worst = worst.max(start.elapsed().as_secs_f64());
    }
    let share = 100.0 * start.elapsed().as_secs_f64() / f64::from(SECONDS);
    let worst = 100.0 * 60.0 * worst;
    println!(
        "{what}: {share:.2} % of real time, {worst:.1} % in the worst tick, {most_voices} voices"
    );
}

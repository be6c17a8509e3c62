//! Test that the device thread never allocates memory: neither starting cues nor rendering may allocate.

mod shared;

use shared::TAKEN;
use tamaire_sound::{Cue, Press, Route, Soundscape, Synth};

#[test]
fn playing_allocates_no_memory() {
    let mut synth = Synth::new(48_000);
    let mut samples = [0.0; 1600];
    let press = Press {
        force: 500.0,
        slip: 0.5,
        x: 0.0,
    };
    let soundscape = Soundscape {
        presses: [press; 2],
        squash: 0.3,
        hold: 0.7,
        rewind: false,
        music: true,
        ..Soundscape::default()
    };
    let before = TAKEN.get();
    assert!(before > 0);
    for _ in 0..60 {
        synth.set_soundscape(&soundscape);
        for _ in 0..30 {
            synth.play(Cue::Tear {
                energy: 2.0,
                x: 0.0,
            });
        }
        synth.play(Cue::Won(Route::Squeeze));
        synth.render(&mut samples);
    }
    assert_eq!(TAKEN.get() - before, 0);
}

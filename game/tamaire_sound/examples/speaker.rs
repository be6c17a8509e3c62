//! Plays a few seconds on the sound device, or prints why it cannot.
//!
//! `cargo run --release -p tamaire_sound --features output --example speaker`

use std::time::Duration;
use tamaire_sound::{Cue, Press, Route, Soundscape, Speaker, Volumes};

fn main() {
    let speaker = match Speaker::open() {
        Ok(speaker) => speaker,
        Err(why) => return println!("No sound: {why}."),
    };
    if let Some(why) = speaker.trouble() {
        println!("No sound at present: {why}.");
    }
    for tick in 0..300 {
        let time = tick as f32 / 60.0;
        let press = Press {
            force: if tick < 180 { 300.0 * time } else { 0.0 },
            slip: 0.5 + 0.5 * (4.0 * time).sin(),
            x: (2.0 * time).sin(),
        };
        if tick == 180 {
            speaker.play(Cue::Won(Route::Squeeze));
        }
        let presses = [press, Press::default()];
        speaker.update(
            &Soundscape {
                presses,
                ..Soundscape::default()
            },
            &Volumes::default(),
        );
        std::thread::sleep(Duration::from_millis(16));
    }
}

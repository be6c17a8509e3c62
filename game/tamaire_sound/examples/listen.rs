//! Example that writes WAV files of all sounds of the game to a folder.
//!
//! `cargo run --release -p tamaire_sound --example listen -- folder`

use std::path::Path;
use tamaire_sound::{Cue, Menu, Press, Route, Soundscape, Synth};

const RATE: u32 = 48_000;

/// Function that starts the cues of a tick (1/60 s) and returns its continuous sounds.
type Story = fn(tick: u32, synth: &mut Synth) -> Soundscape;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args()
        .nth(1)
        .ok_or("missing argument: the output folder")?;
    std::fs::create_dir_all(&folder)?;
    let stories: [(&str, u32, Story); 9] = [
        ("press", 240, press),
        ("thuds", 200, thuds),
        ("tears", 240, tears),
        ("crumbs", 180, crumbs),
        ("wobble", 180, wobble),
        ("hold", 200, hold),
        ("wins", 420, wins),
        ("menu", 150, menu),
        ("music", 2400, music),
    ];
    for (name, ticks, story) in stories {
        let spec = hound::WavSpec {
            channels: 2,
            sample_rate: RATE,
            bits_per_sample: 16,
            sample_format: hound::SampleFormat::Int,
        };
        let mut file =
            hound::WavWriter::create(Path::new(&folder).join(name).with_extension("wav"), spec)?;
        let mut synth = Synth::new(RATE);
        let mut tick_samples = [0.0; 2 * RATE as usize / 60];
        for tick in 0..ticks {
            let soundscape = story(tick, &mut synth);
            synth.set_soundscape(&soundscape);
            synth.render(&mut tick_samples);
            for sample in tick_samples {
                file.write_sample((sample * f32::from(i16::MAX)) as i16)?;
            }
        }
        file.finalize()?;
        println!("{name}.wav: {:.1} s", ticks as f32 / 60.0);
    }
    Ok(())
}

/// A hand presses harder and harder, then rubs back and forth, then releases.
fn press(tick: u32, _: &mut Synth) -> Soundscape {
    let time = tick as f32 / 60.0;
    let force = if time < 3.5 {
        1200.0 * (time / 3.0).min(1.0)
    } else {
        0.0
    };
    let slip = 0.5 * (1.0 - (5.0 * time).cos());
    let press = Press {
        force,
        slip,
        x: (time - 2.0) / 2.0,
    };
    Soundscape {
        presses: [press, Press::default()],
        ..Soundscape::default()
    }
}

/// Impacts on a wall, each harder than the last, with resting contact in between.
fn thuds(tick: u32, synth: &mut Synth) -> Soundscape {
    let heavy = (tick / 40) as f32;
    let lean = if tick.is_multiple_of(40) { 1.0 } else { 0.4 };
    if tick % 40 < 20 {
        synth.play(Cue::Thud {
            impulse: lean * 0.5 * (2.2 * heavy).exp2(),
            x: heavy / 2.0 - 1.0,
        });
    }
    Soundscape::default()
}

/// Single tears, then a rip with many tears per tick, as in the engine's scene `tear`.
fn tears(tick: u32, synth: &mut Synth) -> Soundscape {
    let x = tick as f32 / 120.0 - 1.0;
    if tick < 120 && tick.is_multiple_of(20) {
        synth.play(Cue::Tear {
            energy: 0.1 * 2_f32.powi(tick as i32 / 20),
            x,
        });
    }
    if (130..190).contains(&tick) && tick % 3 != 1 {
        for part in 0..tick % 7 {
            synth.play(Cue::Tear {
                energy: 0.1 + 0.2 * part as f32,
                x,
            });
        }
    }
    Soundscape::default()
}

fn crumbs(tick: u32, synth: &mut Synth) -> Soundscape {
    for part in 0..(tick * 7 % 11) / 5 {
        synth.play(Cue::Crumb {
            speed: 0.3 + 0.2 * (tick % 5) as f32,
            x: part as f32 - 0.5,
        });
    }
    Soundscape::default()
}

fn wobble(tick: u32, _: &mut Synth) -> Soundscape {
    let squash = [0.0, 0.35, 0.0][tick as usize / 60];
    Soundscape {
        squash,
        ..Soundscape::default()
    }
}

/// The body rests in the basket for almost the required time, leaves, and then rests for the whole time.
fn hold(tick: u32, synth: &mut Synth) -> Soundscape {
    let hold = match tick {
        0..40 => tick as f32 / 60.0,
        60..120 => (tick - 60) as f32 / 60.0,
        _ => 0.0,
    };
    if tick == 120 {
        synth.play(Cue::Won(Route::Squeeze));
    }
    Soundscape {
        hold,
        ..Soundscape::default()
    }
}

fn wins(tick: u32, synth: &mut Synth) -> Soundscape {
    let routes = [Route::Squeeze, Route::Shave, Route::Mix];
    if tick.is_multiple_of(140) {
        synth.play(Cue::Won(routes[tick as usize / 140]));
    }
    Soundscape::default()
}

fn menu(tick: u32, synth: &mut Synth) -> Soundscape {
    let acts = [
        Menu::Move,
        Menu::Move,
        Menu::Confirm,
        Menu::Move,
        Menu::Back,
    ];
    if tick.is_multiple_of(30) {
        synth.play(Cue::Menu(acts[tick as usize / 30]));
    }
    Soundscape::default()
}

fn music(_: u32, _: &mut Synth) -> Soundscape {
    Soundscape {
        music: true,
        ..Soundscape::default()
    }
}

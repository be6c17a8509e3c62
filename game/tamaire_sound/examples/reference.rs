//! Renders ten seconds of all sounds natively, as the reference for the WebAssembly module.
//!
//! For each block of 128 frames it writes to standard output, in little-endian order: the length of the
//! block's message (`u32`), the message, and the interleaved left and right samples (256 × `f32`).
//!
//! `cargo run --release -p tamaire_sound --features worklet --example reference > reference.bin`

use std::io::{self, BufWriter, Write};
use tamaire_sound::worklet::{MOST_FRAMES, Worklet};
use tamaire_sound::{Cue, Menu, Message, Press, Route, Soundscape, Volumes};

const RATE: usize = 48_000;
const SECONDS: usize = 10;

fn main() -> io::Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    let mut worklet = Worklet::new(RATE as u32);
    let mut told = 0;
    for block in 0..SECONDS * RATE / MOST_FRAMES {
        let mut message = Message::default();
        // Sends messages 60 times a second, as the game does.
        if told * RATE <= block * MOST_FRAMES * 60 {
            tell(told, &mut message);
            told += 1;
        }
        let bytes = message.bytes();
        worklet.message()[..bytes.len()].copy_from_slice(bytes);
        worklet.take(bytes.len());
        out.write_all(&(bytes.len() as u32).to_le_bytes())?;
        out.write_all(bytes)?;
        for sample in worklet.render(MOST_FRAMES) {
            out.write_all(&sample.to_le_bytes())?;
        }
    }
    out.flush()
}

/// Adds the sounds of a tick. Hands rub for five seconds, then the body rests in the basket; pieces tear off;
/// the round is won at the end.
fn tell(tick: usize, message: &mut Message) {
    let seconds = tick as f32 / 60.0;
    let stroke = (3.0 * seconds).sin();
    let force = if seconds < 5.0 { 600.0 } else { 0.0 };
    let press = |x: f32| Press {
        force: force * (1.0 + 0.5 * stroke),
        slip: 0.5 * stroke.abs(),
        x,
    };
    message.set_volumes(&Volumes::default());
    message.hear(&Soundscape {
        presses: [press(-0.5), press(0.8 * stroke)],
        squash: 0.3 * (tick / 40 % 2) as f32,
        hold: (seconds - 6.0).clamp(0.0, 1.0),
        music: true,
        ..Soundscape::default()
    });
    let x = stroke;
    match tick {
        180..280 => message.play(Cue::Tear { energy: 1.0, x }),
        420 => message.play(Cue::Won(Route::Squeeze)),
        60 | 500 => message.play(Cue::Menu(Menu::Confirm)),
        _ if tick.is_multiple_of(30) => message.play(Cue::Thud { impulse: 20.0, x }),
        _ if tick.is_multiple_of(7) => message.play(Cue::Crumb { speed: 1.0, x }),
        _ => {}
    }
}

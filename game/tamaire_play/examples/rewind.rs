//! Measures rewind in torn rooms.
//!
//! `cargo run --release -p tamaire_play --example rewind -- LEVEL…` lets a bot tear the bodies of each level until there
//! are `--pieces` pieces, or for two minutes. Then it prints the number of pieces and nodes, the time of a tick in which a
//! copy is kept and of one in which none is, how far and in which steps time can run back, and the time from the
//! beginning of a rewind to its first earlier state. Times are medians.

use clap::Parser;
use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;
use tamaire_play::{AnyRound, Bot, BotKind, InputFrame, Level, Rewind};

/// Longest time of tearing [ticks].
const LONGEST: u64 = 2 * 60 * 60;
/// Number of repetitions of each measurement.
const TIMES: usize = 21;

/// Measures rewind in torn rooms.
#[derive(Parser)]
struct Options {
    /// Levels.
    levels: Vec<String>,
    /// Number of pieces to tear.
    #[arg(long, default_value_t = 60)]
    pieces: usize,
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    println!("level         pieces  nodes  tick ms  with copy ms  back s  step  begin ms");
    for id in &options.levels {
        measure(id, options.pieces)?;
    }
    Ok(())
}

fn measure(id: &str, pieces: usize) -> Result<(), Box<dyn Error>> {
    let mut round = AnyRound::new(Arc::new(Level::open(id)?));
    let mut rewind = Rewind::new(&round);
    let mut bot = Bot::new(BotKind::Shave, 1);
    while round.progress().pieces < pieces && round.ticks() < LONGEST {
        let frame = round.ask(&mut bot);
        round.step(frame);
        rewind.note(&round);
        if round.progress().outcome.is_some() {
            break;
        }
    }
    let mut ticks = Vec::new();
    let mut copies = Vec::new();
    for _ in 0..TIMES {
        let began = Instant::now();
        round.step(InputFrame::default());
        ticks.push(began.elapsed());
        let began = Instant::now();
        black_box(round.clone());
        copies.push(began.elapsed());
        rewind.note(&round);
    }
    let mut begins = Vec::new();
    for _ in 0..TIMES {
        let mut running = rewind.clone();
        let began = Instant::now();
        running.begin(&round);
        while !running.is_ready() && running.left(&round) > 0 {
            running.prepare(&round);
        }
        begins.push(began.elapsed());
        round.step(InputFrame::default());
        rewind.note(&round);
    }
    let [tick, copy, begin] = [ticks, copies, begins].map(|mut times| {
        times.sort_unstable();
        1000.0 * times[times.len() / 2].as_secs_f64()
    });
    let nodes: usize = match &round {
        AnyRound::Plane(round) => { round.world().soft_bodies() }
            .map(|(_, body)| body.mesh().nodes().count())
            .sum(),
        AnyRound::Space(round) => { round.world().soft_bodies() }
            .map(|(_, body)| body.mesh().nodes().count())
            .sum(),
    };
    println!(
        "{id:<14}{:6}{nodes:7}{tick:9.2}{:14.2}{:8.1}{:6}{begin:10.1}",
        round.progress().pieces,
        tick + copy,
        rewind.left(&round) as f64 / 60.0,
        rewind.stride(),
    );
    Ok(())
}

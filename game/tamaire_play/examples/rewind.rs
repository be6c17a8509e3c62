//! Measures rewind in torn rooms.
//!
//! `cargo run --release -p tamaire_play --example rewind -- LEVEL…` strikes about in each level until there are `--pieces`
//! pieces, for two minutes at most. Then it prints the number of pieces and nodes; the time of a tick and of a copy; the
//! memory of a copy per node that it does not share; how far and in which steps time can run back; and the time from the
//! beginning of a rewind to its first earlier state. Times are medians.

use clap::Parser;
use fuwafuwa::Vec3;
use std::alloc::{GlobalAlloc, Layout, System};
use std::error::Error;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use tamaire_play::{AnyRound, InputFrame, Level, Rewind};

/// Longest time of striking [ticks].
const LONGEST: u64 = 2 * 60 * 60;
/// Number of repetitions of each measurement.
const TIMES: usize = 21;

/// Allocator that counts the allocated memory.
struct Counting;

/// Memory that was allocated so far [bytes].
static ALLOCATED: AtomicUsize = AtomicUsize::new(0);

// SAFETY: forwards everything to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATED.fetch_add(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller fulfils the same contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

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
    println!("level           pieces  nodes  tick ms  copy ms  bytes/node  back s  step  begin ms");
    for id in &options.levels {
        measure(id, options.pieces)?;
    }
    Ok(())
}

/// Returns the input of a hand that strikes about.
fn strike(round: &AnyRound, random: &mut fastrand::Rng) -> InputFrame {
    let [low, high] = round.level().arena();
    let share = Vec3::new(random.f32(), random.f32(), random.f32());
    InputFrame::towards(low + share * (high - low))
}

fn measure(id: &str, pieces: usize) -> Result<(), Box<dyn Error>> {
    let mut round = AnyRound::new(Arc::new(Level::open(id)?));
    let mut rewind = Rewind::new(&round);
    let mut random = fastrand::Rng::with_seed(1);
    let mut frame = InputFrame::default();
    while round.progress().pieces < pieces && round.ticks() < LONGEST {
        if round.ticks().is_multiple_of(15) {
            frame = strike(&round, &mut random);
        }
        round.step(frame);
        rewind.note(&round);
        if round.progress().outcome.is_some() {
            break;
        }
    }
    let nodes = round.nodes();
    let (mut ticks, mut copies, mut begins) = (Vec::new(), Vec::new(), Vec::new());
    let mut bytes = 0;
    for _ in 0..TIMES {
        ticks.push(timed(|| {
            round.step(InputFrame::default());
        }));
        rewind.note(&round);
        let before = ALLOCATED.load(Ordering::Relaxed);
        let mut copy = None;
        copies.push(timed(|| copy = Some(round.clone())));
        // The recording is not part of a copy.
        let recorded = size_of_val(round.frames()) + size_of_val(round.hashes());
        bytes = ALLOCATED.load(Ordering::Relaxed) - before - recorded;
        let mut running = rewind.clone();
        begins.push(timed(|| {
            running.begin(&round);
            while !running.is_ready() && running.left(&round) > 0 {
                running.prepare(&round);
            }
        }));
    }
    let [tick, copy, begin] = [ticks, copies, begins].map(|mut times: Vec<Duration>| {
        times.sort_unstable();
        1000.0 * times[times.len() / 2].as_secs_f64()
    });
    println!(
        "{id:<16}{:6}{nodes:7}{tick:9.2}{copy:9.2}{:12}{:8.1}{:6}{begin:10.1}",
        round.progress().pieces,
        bytes / nodes.max(1),
        rewind.left(&round) as f64 / 60.0,
        rewind.stride(),
    );
    Ok(())
}

fn timed(mut act: impl FnMut()) -> Duration {
    let began = Instant::now();
    act();
    began.elapsed()
}

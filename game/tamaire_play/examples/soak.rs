//! Soak test: two hands move at random for minutes. Nothing may break, leak or leave the room.
//!
//! `cargo run --release -p tamaire_play --example soak -- [MINUTES [LEVEL …]]` plays the given levels for the
//! given time, each on its own thread. By default it plays all built-in levels for ten minutes. `cargo xtask
//! soak` takes the same arguments. The test prints a row per minute and level, and fails if a check failed.

use fuwafuwa::{Dim, Dim2, Dim3, DimVector, Vec3};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::thread;
use std::time::Instant;
use tamaire_play::level::{NAMED, NAMED_3D, PATH};
use tamaire_play::{Bot, BotKind, Level, Round};

/// Default and maximum number of minutes per level.
const USUAL_MINUTES: usize = 10;
const MOST_MINUTES: usize = 60;
/// Seed of the hands' movement.
const SEED: u64 = 7;

/// Number of ticks in a minute.
const MINUTE: usize = 60 * 60;
/// Number of ticks between two checks of the room and the memory.
const LOOK: usize = 60;

/// Tolerated depth of a piece in a wall, in voxels. A crumb between a hand and a wall is pressed flat and
/// slightly into the wall.
const MARGIN: f32 = 1.0;
/// Tolerated depth of a hand in a wall [m], and of the centre of a piece that stays there.
const HAND_MARGIN: f32 = 1e-3;
/// Number of checks in a row in which the centre of a piece may be deeper in a wall, pressed by a hand.
const PRESSED: u32 = 3;

/// Maximum memory per element or node [bytes]. Memory is checked per part because tearing adds elements and
/// nodes.
const MOST_EACH: f32 = 1200.0;
/// Maximum factor by which the memory per element or node grows from the first half of a run to the second.
/// It is above 1 because vectors double their capacity now and then.
const GROWTH: f32 = 1.3;

/// Allocator that counts the memory held by each thread.
struct Counting;

thread_local! {
    static HELD: Cell<usize> = const { Cell::new(0) };
}

fn count(change: impl Fn(usize) -> usize) {
    // Ignores the error: a thread may free memory after its thread-local counter was destroyed.
    let _ = HELD.try_with(|held| held.set(change(held.get())));
}

// SAFETY: forwards all calls to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(|held| held.wrapping_add(layout.size()));
        // SAFETY: the caller upholds the same contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        count(|held| held.wrapping_sub(layout.size()));
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let failures = match parse(&words) {
        Ok((minutes, levels)) => play_all(minutes, levels),
        Err(complaint) => vec![complaint],
    };
    for failure in &failures {
        eprintln!("soak: {failure}");
    }
    match failures.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    }
}

/// Returns the number of minutes and the levels, or an error message.
fn parse(words: &[String]) -> Result<(usize, Vec<Level>), String> {
    let minutes = match words.first() {
        None => USUAL_MINUTES,
        Some(word) => (word.parse().ok())
            .filter(|minutes| (1..=MOST_MINUTES).contains(minutes))
            .ok_or_else(|| format!("expected 1 to {MOST_MINUTES} minutes first, found {word:?}"))?,
    };
    // Puts 3D levels first, because they take longest.
    let path = PATH.iter().map(|level| level.id);
    let all = NAMED_3D.iter().chain(&NAMED).map(|(id, _)| *id);
    let all = all.chain(path).map(String::from);
    let named = words.iter().skip(1).cloned();
    let ids: Vec<String> = match words.len() {
        0 | 1 => all.collect(),
        _ => named.collect(),
    };
    let levels: Result<_, _> = ids.iter().map(|id| Level::open(id)).collect();
    Ok((minutes, levels.map_err(|error| error.to_string())?))
}

/// Plays all levels in parallel, and returns the failures.
fn play_all(minutes: usize, levels: Vec<Level>) -> Vec<String> {
    let heads = format!(
        "{:12} {:>6} {:>6} {:>6} {:>8} {:>7} {:>8} | {:>8} {:>8} | into walls",
        "level", "minute", "pieces", "awake", "elements", "MB", "B each", "ms, half", "worst"
    );
    say(&heads);
    thread::scope(|scope| {
        let start = |level: Level| (level.id.clone(), scope.spawn(move || soak(level, minutes)));
        let threads: Vec<_> = levels.into_iter().map(start).collect();
        let ends = threads.into_iter().filter_map(|(id, thread)| {
            let end = thread.join().unwrap_or(Err("panicked, see above".into()));
            end.err().map(|reason| format!("{id}: {reason}"))
        });
        ends.collect()
    })
}

fn soak(level: Level, minutes: usize) -> Result<(), String> {
    match level.scene().dim {
        2 => play::<Dim2>(level, minutes),
        _ => play::<Dim3>(level, minutes),
    }
}

/// Plays a level, and returns the first failure.
fn play<D: Dim>(level: Level, minutes: usize) -> Result<(), String> {
    let id = level.id.clone();
    let mut round = Round::<D>::new(Arc::new(level));
    let mut bot = Bot::new(BotKind::Random, SEED);
    let (mut times, mut deepest, mut held) = (Vec::new(), f32::MIN, Vec::new());
    let mut pressed = BTreeMap::new();
    for tick in 1..=minutes * MINUTE {
        let frame = bot.frame(&round);
        let start = Instant::now();
        let report = round.step(frame);
        times.push(1e3 * start.elapsed().as_secs_f32());
        let wrong = |reason| format!("tick {tick}, seed {SEED}: {reason}");
        if report.quarantined > 0 {
            return Err(wrong("a piece was quarantined".to_string()));
        }
        if !tick.is_multiple_of(LOOK) {
            continue;
        }
        deepest = deepest.max(depth(&round, &mut pressed).map_err(wrong)?);
        held.push(held_each(&round));
        if tick.is_multiple_of(MINUTE) {
            times.sort_by(f32::total_cmp);
            let half = times[times.len() / 2];
            let worst = times.pop().unwrap_or(half);
            tell(&id, tick / MINUTE, &round, [half, worst, 1e3 * deepest]);
            times.clear();
        }
    }
    let (early, late) = held.split_at(held.len() / 2);
    let most = |held: &[f32]| held.iter().copied().fold(0.0, f32::max);
    let allowed = (GROWTH * most(early)).min(MOST_EACH);
    match most(late) <= allowed {
        true => Ok(()),
        false => Err(format!(
            "memory per element and node grew from {:.0} to {:.0} bytes, expected at most {allowed:.0}",
            most(early),
            most(late)
        )),
    }
}

/// Returns how deep the deepest node is in a wall [m]. Returns an error if something is outside the room or
/// not finite. `pressed` counts the checks in a row in which the centre of a piece is in a wall, by body and piece.
fn depth<D: Dim>(
    round: &Round<D>,
    pressed: &mut BTreeMap<(usize, u32), u32>,
) -> Result<f32, String> {
    let [low, high] = round.level().arena();
    let beyond = |from: Vec3, to: Vec3| {
        let axes = (0..D::N).map(|axis| (low[axis] - from[axis]).max(to[axis] - high[axis]));
        axes.fold(f32::MIN, f32::max)
    };
    for hand in round.hands() {
        let at = hand.position().to_vec3();
        let is_in = at.is_finite() && beyond(at, at) <= HAND_MARGIN;
        if !is_in {
            return Err(format!("a hand is out of the room: {at:?}"));
        }
    }
    let mut deepest = f32::MIN;
    let before = std::mem::take(pressed);
    for (number, (_, body)) in round.world().soft_bodies().enumerate() {
        for piece in body.piece_views() {
            let depth = beyond(piece.low, piece.high);
            // Checks the centre too, because the bounds ignore non-finite values.
            let middle = beyond(piece.centre, piece.centre);
            let most = MARGIN * body.grid().voxel_size();
            let mut stays = false;
            if middle > HAND_MARGIN {
                let key = (number, piece.number.0);
                let count = before.get(&key).map_or(1, |count| count + 1);
                pressed.insert(key, count);
                stays = count > PRESSED;
            }
            if !piece.centre.is_finite() || depth > most || middle > most || stays {
                return Err(format!(
                    "a piece is {depth} m out of the room, its centre {middle} m: {piece:?}"
                ));
            }
            deepest = deepest.max(depth);
        }
    }
    Ok(deepest)
}

/// Returns the number of elements and of nodes.
fn parts<D: Dim>(round: &Round<D>) -> [usize; 2] {
    let meshes = round.world().soft_bodies().map(|(_, body)| body.mesh());
    let elements = meshes.clone().map(|mesh| mesh.element_count()).sum();
    [elements, meshes.map(|mesh| mesh.node_count()).sum()]
}

/// Returns the memory that this thread holds per element or node [bytes], without the memory for recorded
/// input.
fn held_each<D: Dim>(round: &Round<D>) -> f32 {
    // Counts the recorded input twice, because the capacity of a growing vector is up to twice its length.
    let record = 2 * size_of_val(round.frames()) + 2 * size_of_val(round.hashes());
    let rest = HELD.get().saturating_sub(record);
    rest as f32 / parts(round).iter().sum::<usize>() as f32
}

/// Prints the row of a minute.
fn tell<D: Dim>(id: &str, minute: usize, round: &Round<D>, [half, worst, deepest]: [f32; 3]) {
    let bodies = round.world().soft_bodies();
    let pieces = bodies.flat_map(|(_, body)| &body.pieces().list);
    say(&format!(
        "{id:12} {minute:>6} {:>6} {:>6} {:>8} {:>7.1} {:>8.0} | {half:>8.1} {worst:>8.1} | {deepest:.1} mm",
        pieces.clone().count(),
        pieces.filter(|piece| !piece.asleep).count(),
        parts(round)[0],
        HELD.get() as f32 / 1e6,
        held_each(round),
    ));
}

/// Prints a line. Ignores a closed output, so that the rounds continue.
fn say(line: &str) {
    let _ = writeln!(io::stdout(), "{line}");
}

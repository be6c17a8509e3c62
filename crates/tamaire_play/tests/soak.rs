//! Ten minutes with two hands that do anything, on every level. It takes minutes of many cores:
//! `cargo xtask soak`.

use fuwafuwa::{Dim, Dim2, Dim3};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;
use std::thread;
use tamaire_play::level::{NAMED, NAMED_3D};
use tamaire_play::{Bot, BotKind, InputFrame, Level, Round};

const MINUTE: usize = 60 * 60;
const MINUTES: usize = 10;
/// A round that goes on keeps what was played.
const KEPT: usize = 2 * MINUTES * MINUTE * size_of::<InputFrame>();

/// So far into a wall is not out of the room: a fifteenth of a voxel [m].
const MARGIN: f32 = 1e-3;

/// Counts the memory that each thread holds.
struct Counting;

thread_local! {
    static HELD: Cell<usize> = const { Cell::new(0) };
}

fn count(change: impl Fn(usize) -> usize) {
    // A thread that ends gives back memory when this is gone.
    let _ = HELD.try_with(|held| held.set(change(held.get())));
}

// SAFETY: hands everything on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(|held| held.wrapping_add(layout.size()));
        // SAFETY: the caller keeps the same promises.
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

/// Plays a level, looks at it every second, and says what it held after each minute [bytes].
fn play<D: Dim>(id: &str) -> Vec<usize> {
    let level = Arc::new(Level::open(id).unwrap());
    let [low, high] = level.arena();
    // A crumb between a hand and a wall is pressed flat, and a hair into the wall.
    let is_in = |at: [f32; 3]| {
        (0..D::N).all(|axis| at[axis] > low[axis] - MARGIN && at[axis] < high[axis] + MARGIN)
    };
    let mut round = Round::<D>::new(level);
    let mut bot = Bot::new(BotKind::Random, 7);
    let mut held = Vec::new();
    for tick in 1..=MINUTES * MINUTE {
        let frame = bot.frame(&round);
        let report = round.step(frame);
        assert_eq!(report.quarantined, 0, "{id}, tick {tick}: not finite");
        if tick % 60 == 0 {
            for hand in round.world().manipulators() {
                assert!(is_in(hand.position()), "{id}, tick {tick}: {hand:?}");
            }
            for body in round.world().bodies() {
                for piece in body.piece_views() {
                    assert!(is_in(piece.centre), "{id}, tick {tick}: {piece:?}");
                }
            }
        }
        if tick % MINUTE == 0 {
            held.push(HELD.get());
        }
    }
    println!("{id}: {} pieces, {held:?} bytes", round.progress().pieces);
    held
}

/// Plays some levels at once, a thread each.
fn soak(levels: &'static [(&str, &str)], play: fn(&str) -> Vec<usize>) {
    thread::scope(|scope| {
        let start = |(id, _): &'static (&str, &str)| (id, scope.spawn(move || play(id)));
        let threads: Vec<_> = levels.iter().map(start).collect();
        for (id, thread) in threads {
            let held = thread.join().unwrap();
            // By then what can be ground is ground; tables double now and then.
            let (early, late) = held.split_at(7);
            let early = early.iter().max().unwrap();
            let most = early + early / 4 + KEPT;
            assert!(late.iter().all(|&held| held < most), "{id}: {held:?}");
        }
    });
}

#[test]
#[ignore = "takes minutes"]
fn ten_minutes_of_anything_on_every_level() {
    soak(&NAMED, play::<Dim2>);
}

#[test]
#[ignore = "takes an hour"]
fn ten_minutes_of_anything_on_every_level_in_space() {
    soak(&NAMED_3D, play::<Dim3>);
}

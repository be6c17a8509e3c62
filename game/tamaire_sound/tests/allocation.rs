//! The device's thread must never wait for memory: neither cues nor samples take any.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use tamaire_sound::{Cue, Press, Route, Soundscape, Synth};

/// Counts how often a thread takes memory: that of the test harness may do so meanwhile.
struct Counting;

thread_local! {
    static TAKEN: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: hands everything on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // A thread that ends may take memory when this is gone.
        let _ = TAKEN.try_with(|taken| taken.set(taken.get() + 1));
        // SAFETY: the caller keeps the same promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn playing_takes_no_memory() {
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
        music: true,
        ..Soundscape::default()
    };
    let before = TAKEN.get();
    assert!(before > 0);
    for _ in 0..60 {
        synth.hear(&soundscape);
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

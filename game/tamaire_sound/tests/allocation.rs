//! The device thread must never allocate memory: neither cues nor rendering do.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use tamaire_sound::{Cue, Press, Route, Soundscape, Synth};

/// Allocator that counts allocations per thread, since the test harness may allocate meanwhile.
struct Counting;

thread_local! {
    static TAKEN: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: forwards everything to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // A thread may allocate while it ends, after the counter was destroyed.
        let _ = TAKEN.try_with(|taken| taken.set(taken.get() + 1));
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

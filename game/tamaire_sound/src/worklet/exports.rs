//! A [`Worklet`] for a program that loads this library as a WebAssembly module. An instance has one, at a place
//! in memory that stays.
//!
//! Plain numbers only, so that no generated glue is needed: a worklet has neither `fetch` nor `TextDecoder`.
#![allow(unsafe_code)] // names without mangling, and nothing else

use super::Worklet;
use std::cell::RefCell;

thread_local! {
    static WORKLET: RefCell<Worklet> = RefCell::new(Worklet::new(48_000));
}

/// Begins anew, for so many samples a second. No other call takes memory, once this one was made.
#[unsafe(no_mangle)]
pub extern "C" fn sound_begin(rate: u32) {
    WORKLET.replace(Worklet::new(rate));
}

/// Where a message is to be put.
#[unsafe(no_mangle)]
pub extern "C" fn sound_message() -> *mut u8 {
    WORKLET.with_borrow_mut(|worklet| worklet.message().as_mut_ptr())
}

/// How many bytes there is room for.
#[unsafe(no_mangle)]
pub extern "C" fn sound_message_room() -> usize {
    WORKLET.with_borrow_mut(|worklet| worklet.message().len())
}

/// Takes a message of so many bytes.
#[unsafe(no_mangle)]
pub extern "C" fn sound_take(length: usize) {
    WORKLET.with_borrow_mut(|worklet| worklet.take(length));
}

/// Works out so many frames, at most [`super::MOST_FRAMES`]. Returns where they are: left and right in turns.
#[unsafe(no_mangle)]
pub extern "C" fn sound_render(frames: usize) -> *const f32 {
    WORKLET.with_borrow_mut(|worklet| worklet.render(frames).as_ptr())
}

//! Exports of a [`Worklet`] for a program that loads this library as a WebAssembly module. Each module
//! instance has one worklet, at a fixed address.
//!
//! The functions use plain numbers only and need no generated glue code. Such code would call `fetch` and
//! `TextDecoder`, which an audio worklet lacks.
#![allow(unsafe_code)] // only for `no_mangle`

use super::Worklet;
use std::cell::RefCell;

thread_local! {
    static WORKLET: RefCell<Worklet> = RefCell::new(Worklet::new(48_000));
}

/// Resets the worklet to a sample rate [Hz]. No other call allocates memory after this one.
#[unsafe(no_mangle)]
pub extern "C" fn sound_begin(rate: u32) {
    WORKLET.replace(Worklet::new(rate));
}

/// Returns the address of the message buffer.
#[unsafe(no_mangle)]
pub extern "C" fn sound_message() -> *mut u8 {
    WORKLET.with_borrow_mut(|worklet| worklet.message().as_mut_ptr())
}

/// Returns the size of the message buffer [bytes].
#[unsafe(no_mangle)]
pub extern "C" fn sound_message_room() -> usize {
    WORKLET.with_borrow_mut(|worklet| worklet.message().len())
}

/// Executes the calls in a message of `length` bytes, which the message buffer contains.
#[unsafe(no_mangle)]
pub extern "C" fn sound_take(length: usize) {
    WORKLET.with_borrow_mut(|worklet| worklet.take(length));
}

/// Renders `frames` frames, at most [`super::MOST_FRAMES`]. Returns the address of the interleaved left and
/// right samples.
#[unsafe(no_mangle)]
pub extern "C" fn sound_render(frames: usize) -> *const f32 {
    WORKLET.with_borrow_mut(|worklet| worklet.render(frames).as_ptr())
}

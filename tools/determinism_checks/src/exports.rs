//! Exports of the checks for a program that loads this library as a WebAssembly module. The golden scenes are
//! in [`golden`].
//!
//! The interface uses plain numbers only, so that no generated glue code is needed. Text goes through an
//! input and an output buffer, in UTF-8. Functions that can fail return 1 for success and 0 for failure. The
//! output then contains the result or the reason for the failure.
#![allow(unsafe_code)] // only for `no_mangle`

pub mod golden;

use crate::rounds::{Game, MOST_TICKS, record, series, verify};
use std::cell::RefCell;
use std::ptr::null_mut;

#[derive(Default)]
struct State {
    input: Vec<u8>,
    output: String,
    game: Option<Game>,
}

thread_local! {
    static STATE: RefCell<State> = RefCell::default();
}

impl State {
    fn text(&self) -> Result<&str, String> {
        std::str::from_utf8(&self.input).map_err(|error| error.to_string())
    }

    /// Stores `came`, a result or the reason for a failure, in the output. Returns 1 for a result and 0 for a
    /// failure.
    fn answer(&mut self, came: Result<String, String>) -> u32 {
        let went_well = came.is_ok();
        self.output = came.unwrap_or_else(|reason| reason);
        went_well.into()
    }
}

/// Allocates an input buffer of `length` bytes. Returns its address; 0 if there is not enough memory.
#[unsafe(no_mangle)]
pub extern "C" fn checks_input(length: usize) -> *mut u8 {
    STATE.with_borrow_mut(|state| {
        state.input.clear();
        if state.input.try_reserve_exact(length).is_err() {
            return null_mut();
        }
        state.input.resize(length, 0);
        state.input.as_mut_ptr()
    })
}

/// Returns the address of the output buffer.
#[unsafe(no_mangle)]
pub extern "C" fn checks_output() -> *const u8 {
    STATE.with_borrow(|state| state.output.as_ptr())
}

/// Returns the length of the text in the output buffer, in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn checks_output_length() -> usize {
    STATE.with_borrow(|state| state.output.len())
}

/// Returns the maximum number of ticks of a round of a series.
#[unsafe(no_mangle)]
pub extern "C" fn checks_most_ticks() -> usize {
    MOST_TICKS
}

/// Outputs the rounds of a series, one per line.
#[unsafe(no_mangle)]
pub extern "C" fn checks_series(number: usize) {
    STATE.with_borrow_mut(|state| state.output = series(number).join("\n"));
}

/// Plays the round that the input names, and outputs its replay.
#[unsafe(no_mangle)]
pub extern "C" fn checks_record() -> u32 {
    STATE.with_borrow_mut(|state| state.answer(state.text().and_then(record)))
}

/// Plays the replay in the input and outputs the final hash of the world in hexadecimal.
#[unsafe(no_mangle)]
pub extern "C" fn checks_verify() -> u32 {
    STATE.with_borrow_mut(|state| {
        let hash = verify(&state.input);
        state.answer(hash.map(|hash| format!("{hash:016x}")))
    })
}

/// Starts the round that the input names. The caller then plays the round tick by tick with `checks_ask` and
/// `checks_step`.
#[unsafe(no_mangle)]
pub extern "C" fn checks_begin() -> u32 {
    STATE.with_borrow_mut(|state| match state.text().and_then(Game::begin) {
        Ok(game) => {
            state.game = Some(game);
            state.answer(Ok(String::new()))
        }
        Err(reason) => state.answer(Err(reason)),
    })
}

/// Computes the bot's input for the next tick.
#[unsafe(no_mangle)]
pub extern "C" fn checks_ask() {
    STATE.with_borrow_mut(|state| state.game.iter_mut().for_each(Game::ask));
}

/// Runs a tick. Returns 1 if the round continues.
#[unsafe(no_mangle)]
pub extern "C" fn checks_step() -> u32 {
    STATE.with_borrow_mut(|state| state.game.as_mut().is_some_and(Game::step).into())
}

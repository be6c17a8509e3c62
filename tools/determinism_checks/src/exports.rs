//! The checks for a program that loads this library as a WebAssembly module; the golden scenes are in
//! [`fuwafuwa_golden::exports`].
//!
//! Plain numbers only, so that no generated glue is needed. Text goes in and out through a buffer each, in UTF-8. What
//! can fail returns 1 when it went well and 0 when not; what came of it, or the reason, is in the output then.
#![allow(unsafe_code)] // names without mangling, and nothing else

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

    /// Puts what came of it into the output, or the reason.
    fn answer(&mut self, came: Result<String, String>) -> u32 {
        let went_well = came.is_ok();
        self.output = came.unwrap_or_else(|reason| reason);
        went_well.into()
    }
}

/// Makes room for an input of so many bytes. Returns where it is; 0 where there is no room.
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

/// Where the output begins.
#[unsafe(no_mangle)]
pub extern "C" fn checks_output() -> *const u8 {
    STATE.with_borrow(|state| state.output.as_ptr())
}

/// Bytes of the output.
#[unsafe(no_mangle)]
pub extern "C" fn checks_output_length() -> usize {
    STATE.with_borrow(|state| state.output.len())
}

/// Ticks of the longest round of a series.
#[unsafe(no_mangle)]
pub extern "C" fn checks_most_ticks() -> usize {
    MOST_TICKS
}

/// Puts out what to play in a series, a round a line.
#[unsafe(no_mangle)]
pub extern "C" fn checks_series(number: usize) {
    STATE.with_borrow_mut(|state| state.output = series(number).join("\n"));
}

/// Plays a round of a series, which is the input, and puts out its replay.
#[unsafe(no_mangle)]
pub extern "C" fn checks_record() -> u32 {
    STATE.with_borrow_mut(|state| state.answer(state.text().and_then(record)))
}

/// Plays a replay, which is the input, and puts out the world's last hash, in hexadecimal.
#[unsafe(no_mangle)]
pub extern "C" fn checks_verify() -> u32 {
    STATE.with_borrow_mut(|state| {
        let hash = verify(&state.input);
        state.answer(hash.map(|hash| format!("{hash:016x}")))
    })
}

/// Begins the round that is the input, to be played tick by tick.
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

/// Lets the bot decide on the next tick.
#[unsafe(no_mangle)]
pub extern "C" fn checks_ask() {
    STATE.with_borrow_mut(|state| state.game.iter_mut().for_each(Game::ask));
}

/// Lets a tick pass. Returns 1 while the round goes on.
#[unsafe(no_mangle)]
pub extern "C" fn checks_step() -> u32 {
    STATE.with_borrow_mut(|state| state.game.as_mut().is_some_and(Game::step).into())
}

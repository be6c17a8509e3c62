//! The synth of tamaire as a WebAssembly module, for an audio worklet of a browser. It is a module of its own
//! because a worklet shares no memory with the game, and needs a hundredth of its code.
//!
//! `cargo rustc --release -p tamaire_worklet --crate-type cdylib --target wasm32-unknown-unknown -- -Cstrip=symbols`
//! builds it, `xtask/web/test/module.mjs` plays it under Node.
//!
//! A [`Worklet`] has room for what it is told and for what it plays; `game/web/worklet.js` fills the one and
//! empties the other through the [`exports`].
pub mod exports;

use crate::{Message, Synth};

/// As many frames as a browser asks for at a time; a call renders no more.
pub const MOST_FRAMES: usize = 128;

/// A synth, with its letter box and its output.
pub struct Worklet {
    synth: Synth,
    message: [u8; Message::MOST_BYTES],
    /// Left and right in turns.
    samples: [f32; 2 * MOST_FRAMES],
}

impl Worklet {
    /// One for `rate` samples a second, within 8,000 to 400,000.
    pub fn new(rate: u32) -> Self {
        Self {
            synth: Synth::new(rate),
            message: [0; Message::MOST_BYTES],
            samples: [0.0; 2 * MOST_FRAMES],
        }
    }

    /// Where a [`Message`] is to be put.
    pub fn message(&mut self) -> &mut [u8] {
        &mut self.message
    }

    /// Takes the first `length` bytes of what was put there.
    pub fn take(&mut self, length: usize) {
        let length = length.min(self.message.len());
        self.synth.take(&self.message[..length]);
    }

    /// Works out the next `frames`: left and right in turns.
    pub fn render(&mut self, frames: usize) -> &[f32] {
        let samples = &mut self.samples[..2 * frames.min(MOST_FRAMES)];
        self.synth.render(samples);
        samples
    }
}

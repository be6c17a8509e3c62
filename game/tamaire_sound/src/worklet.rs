//! The synthesiser of tamaire as a WebAssembly module for an audio worklet. It is a separate module, because
//! a worklet shares no memory with the game and needs only a hundredth of the game's code.
//!
//! `cargo rustc --release -p tamaire_sound --features worklet --crate-type cdylib --target
//! wasm32-unknown-unknown -- -Cstrip=symbols` builds the module, and `tools/xtask/web/test/synth.mjs`
//! compares it under Node with the native synthesiser.
//!
//! A [`Worklet`] has a message buffer and a sample buffer. `game/tamaire/web/worklet.js` fills the message
//! buffer and reads the sample buffer through the [`exports`].
pub mod exports;

use crate::{Message, Synth};

/// Maximum number of frames per call of [`Worklet::render`]: the block size of browsers.
pub const MOST_FRAMES: usize = 128;

/// Synthesiser with a message buffer and a sample buffer.
pub struct Worklet {
    synth: Synth,
    message: [u8; Message::MOST_BYTES],
    /// Interleaved left and right samples.
    samples: [f32; 2 * MOST_FRAMES],
}

impl Worklet {
    /// Creates a worklet with a sample rate [Hz], clamped to 8,000 to 400,000.
    pub fn new(rate: u32) -> Self {
        Self {
            synth: Synth::new(rate),
            message: [0; Message::MOST_BYTES],
            samples: [0.0; 2 * MOST_FRAMES],
        }
    }

    /// Returns the buffer into which the caller writes the bytes of a [`Message`].
    pub fn message(&mut self) -> &mut [u8] {
        &mut self.message
    }

    /// Executes the calls in the first `length` bytes of the message buffer.
    pub fn take(&mut self, length: usize) {
        let length = length.min(self.message.len());
        self.synth.take(&self.message[..length]);
    }

    /// Renders the next `frames` frames as interleaved left and right samples.
    pub fn render(&mut self, frames: usize) -> &[f32] {
        let samples = &mut self.samples[..2 * frames.min(MOST_FRAMES)];
        self.synth.render(samples);
        samples
    }
}

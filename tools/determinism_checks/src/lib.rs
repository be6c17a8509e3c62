//! Simulations whose bits must be equal on every platform, and their durations.
//!
//! - [`golden`]: scenes of the engine with their hashes;
//! - [`rounds`]: rounds that bots play, recorded on one platform and verified on another;
//! - [`exports`]: both for a program that loads this library as a WebAssembly module.
//!
//! `cargo xtask test` runs them natively. `cargo xtask wasm` runs the scenes under Node, through
//! `tools/xtask/golden.mjs`. `cargo xtask web --test` loads the module into browsers, through
//! `tools/xtask/web/test/bits.mjs` and `speed.mjs`.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod exports;
pub mod golden;
pub mod rounds;

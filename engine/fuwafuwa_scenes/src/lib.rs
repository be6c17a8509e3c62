//! Scenes for the soft-body engine fuwafuwa: worlds as data files, and recordings of hand movements whose
//! replays are bit-identical. Tests, benchmarks, the command line and the game use them.
#![deny(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // brackets hold units, such as [m]
#![allow(clippy::needless_range_loop)] // an axis indexes several vectors at once

#[cfg(not(target_family = "wasm"))]
pub mod disk;
pub mod import;
pub mod recording;
pub mod scene;

pub use recording::Recording;
pub use scene::{Scene, SceneError};

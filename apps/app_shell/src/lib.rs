//! Parts shared by programs with a window: the game `tamaire` and the surgery trainer `fuwafuwa_surgery`.
//!
//! - [`Clock`] and [`Pace`]: monotonic time, and number of ticks for each frame
//! - [`Pads`] and [`Forces`]: input of sticks and pads, and their force feedback
//! - [`direction`]: directions of the user and of the world
//! - [`CameraRig`] and [`View`]: camera, and mapping between world and screen
//! - [`GpuWatch`]: detection of a lost GPU
//! - [`pass`] and [`SpaceStage`]: drawing of worlds in egui
//! - [`Theme`], [`theme`], [`style`] and [`widgets`]: colours, fonts and buttons
//! - `window`: opening a window on a desktop, and the reason why it ended
//!
//! No module opens a file. All modules except `window` also compile for a browser.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units are written in brackets: [m]

mod camera;
mod clock;
pub mod direction;
mod forces;
mod gpu;
mod pace;
mod pads;
pub mod pass;
mod space_stage;
pub mod style;
pub mod theme;
pub mod widgets;
#[cfg(not(target_family = "wasm"))]
pub mod window;

pub use camera::{CameraRig, View};
pub use clock::Clock;
pub use forces::Forces;
pub use gpu::{GpuWatch, NoGpu, with_small_memory_blocks};
pub use pace::Pace;
pub use pads::Pads;
pub use space_stage::SpaceStage;
pub use theme::Theme;

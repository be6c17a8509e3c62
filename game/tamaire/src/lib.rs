//! Tamaire (玉入れ): push a soft body into a basket that is too small for it, whole or in pieces.
//!
//! Each module uses only the modules listed above it, except that [`platform`] draws pictures with [`film`]:
//!
//! - [`input`]: device input, converted to actions and goals of the hands
//! - [`words`]: texts in each language
//! - [`sift`]: tolerant reading of files that users may have edited
//! - [`licences`]: third-party parts and their licences
//! - [`settings`]: the player's settings
//! - [`records`]: the player's results
//! - [`platform`]: files, sound and dialogs
//! - [`session`]: playing a round or watching a replay in real time
//! - [`haptics`]: force feedback and rumble
//! - [`qr`]: QR codes of links
//! - [`attract`]: the recorded rounds behind the title screen
//! - [`look`]: rendering of rounds
//! - [`film`]: films and photos of rounds
//! - [`headless`]: rounds without a window
//! - [`game`]: the state of the game, and the actions that change it
//! - [`exhibit`]: a public stand
//! - [`screens`]: the screens and menus
//! - [`app`]: the main loop
//! - [`desktop`] and `browser`: entry points
//!
//! Rules, levels, bots and replays are in the crate `tamaire_play`, which does not depend on a window. The window, its
//! devices, its camera and the pace of ticks are in the crate `app_shell`.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units are written in brackets: [m]

pub mod app;
pub mod attract;
#[cfg(target_family = "wasm")]
pub mod browser;
#[cfg(not(target_family = "wasm"))]
pub mod desktop;
#[cfg(not(target_family = "wasm"))]
pub mod exhibit;
pub mod film;
pub mod game;
pub mod haptics;
#[cfg(not(target_family = "wasm"))]
pub mod headless;
pub mod input;
pub mod journey;
pub mod licences;
pub mod look;
pub mod platform;
pub mod qr;
pub mod records;
pub mod screens;
pub mod session;
pub mod settings;
pub mod sift;
pub mod words;

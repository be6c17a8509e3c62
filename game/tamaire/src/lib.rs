//! Tamaire (玉入れ): push a soft body into a basket that is too small for it, whole or in pieces.
//!
//! The way through, each module using only those above it:
//! [`input`] devices become wishes for the hands → [`words`] what is said, in each language → [`sift`] what can be used of a text → [`licences`] what is inside, and whose it is → [`settings`] what players chose → [`records`] what they reached
//! → [`platform`] files, sound and sticks
//! → [`pace`] how many ticks a frame plays → [`session`] a round in time, played or watched → [`haptics`] what there is to feel of it → [`attract`] what plays behind the title → [`look`] how it looks
//! → [`film`] films and photos of it → [`headless`] a round without a window → [`game`] the state, and what can happen to it → [`exhibit`] a stand in public that leads it → [`screens`] what there is to see and to choose → [`app`] the loop → [`desktop`] and [`browser`] the ways in.
//!
//! The rules, levels, bots and replays are the crate `tamaire_play`, which knows no window.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units stand in brackets: [m]

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
pub mod licences;
pub mod look;
pub mod pace;
pub mod platform;
pub mod records;
pub mod screens;
pub mod session;
pub mod settings;
pub mod sift;
pub mod words;

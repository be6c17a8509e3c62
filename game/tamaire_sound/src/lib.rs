//! Synthesised sounds of tamaire. The crate does not depend on the engine: in each frame the game reports the
//! sounds to play.
//!
//! - [`Soundscape`]: continuous sounds: pressing and slipping hands, the squash of the body, its rest in the
//!   basket, and music.
//! - [`Cue`]: momentary sounds: thud, tear, crumb, menu, win.
//! - [`Synth`]: renders soundscapes and cues to samples. It is deterministic: equal calls give equal samples.
//! - [`Message`]: calls of [`Synth`] as bytes, for a synthesiser in another process or thread (feature
//!   `serde`).
//! - [`Speaker`]: playback on the sound device (feature `output`).
//!
//! ```
//! use tamaire_sound::{Cue, Press, Soundscape, Synth};
//!
//! let mut synth = Synth::new(48_000);
//! let press = Press { force: 400.0, slip: 0.5, x: -0.3 };
//! synth.set_soundscape(&Soundscape { presses: [press, Press::default()], ..Soundscape::default() });
//! synth.play(Cue::Tear { energy: 1.0, x: 0.2 });
//! let mut stereo = [0.0; 2 * 800]; // left, right, left, ... for 1/60 s
//! synth.render(&mut stereo);
//! assert!(stereo.iter().any(|sample| *sample != 0.0));
//! ```
#![deny(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units in brackets, such as [m], are no links

mod cue;
mod part;
mod soundscape;

mod grain;
mod recipe;

mod layer;
mod music;

mod master;
mod synth;

#[cfg(feature = "serde")]
mod message;
#[cfg(feature = "output")]
mod speaker;
#[cfg(feature = "worklet")]
pub mod worklet;

pub use cue::{Cue, Menu, Route};
#[cfg(feature = "serde")]
pub use message::Message;
pub use soundscape::{Mute, Press, Soundscape, Volumes};
#[cfg(feature = "output")]
pub use speaker::{SoundError, Speaker};
pub use synth::Synth;

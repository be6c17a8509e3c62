//! Force feedback for joysticks, with the safety functions that it needs.
//!
//! This crate knows neither soft bodies nor drivers: it takes newtons and positions and gives device units.
//! The unit of an output is a *full force*, the strongest force of the device. Data flow, which is also the
//! reading order:
//!
//! ```text
//! the game, at its own pace                             one thread, 125 to 250 times a second
//! ─────────────────────────                             ─────────────────────────────────────
//! Line::set_state(State) ──► latest mail ──► Watchdog ──► Coupling ──► TearFeedback ──► Chain ──► Sink
//! Line::tear(size)                           may it act?  F = K (…)    tears            safe      a device
//! Line::stop(why)
//! ```
//!
//! - [`Settings`]: user and game settings with their ranges.
//! - [`Chain`]: newtons → full forces: gain, soft clip, slew limit, clamp; ramps up after each stop.
//! - [`Watchdog`]: blocks forces, because of a requested stop or because the last state is too old.
//! - [`Coupling`]: spring and damper from the *current* stick position to a proxy that the contact force
//!   holds. A slow frame makes the stick neither harder nor softer.
//! - [`ForceController`]: all of these for one device, one step at a time, without a clock. Used by headless
//!   runs and tests.
//! - [`Measurement`]: finds the mounting of the motors. It pushes the stick and observes its movement.
//! - [`Sink`]: interface of a device. [`Recording`] and [`Nothing`] are stand-ins.
//! - [`ForceThread`]: the thread that owns all sinks. A [`Line`] connects the game to one sink. Dropping the
//!   line, also by a panic, stops the device.
//!
//! An output ends by itself after [`OUTPUT_DURATION`] unless it is repeated. A force therefore outlives the
//! thread by at most that time.
//!
//! ```
//! use force_feedback::{ForceThread, StickMode, Recording, Settings, State, Stop};
//!
//! let force = ForceThread::start(250)?;
//! let recording = Recording::default();
//! let line = force.add(Box::new(recording.clone()), Settings::default());
//! line.set_state(State {
//!     contact: [-30.0, 0.0],
//!     manner: StickMode::Position,
//! });
//! line.stop(Stop::Paused);
//! assert_eq!(line.report().silent, Some(Stop::Paused));
//! # Ok::<(), std::io::Error>(())
//! ```

#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units are given in brackets: [m]

mod chain;
mod coupling;
mod feel;
mod measurement;
mod settings;
mod sink;
mod thread;
mod watchdog;

pub use chain::Chain;
pub use coupling::{Coupling, State, StickMode, TearFeedback};
pub use feel::{ForceController, StepOutput};
pub use measurement::{Measured, Measurement};
pub use settings::{Calibration, MAX_STIFFNESS, Settings};
pub use sink::{Ability, Gone, Nothing, OUTPUT_DURATION, Output, Played, Recording, Sink};
pub use thread::{ForceThread, Line, RATES, Report};
pub use watchdog::{Command, MAX_STATE_AGE, Stop, Watchdog};

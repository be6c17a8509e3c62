//! Forces for the hand that holds a stick, and all that keeps them safe.
//!
//! Nothing here knows of soft bodies or of drivers. Newtons and places come in, a device's own units go out. The way
//! through, which is the reading order too:
//!
//! ```text
//! the game, at its own pace                        one thread, 125 to 250 times a second
//! ─────────────────────────                        ─────────────────────────────────────
//! Line::feel(State) ──► latest mail ──► Watchdog ──► Coupling ──► Give ──► Chain ──► Sink
//! Line::tear(size)                      may it act?  F = K (…)    tears    safe      a device
//! Line::stop(why)
//! ```
//!
//! - [`Settings`]: what people and games may choose, and within which bounds.
//! - [`Chain`]: newtons → full forces: gain, soft clip, slew limit, clamp; armed gently after each stop.
//! - [`Watchdog`]: why there is no force now. Old mail is one reason, a stop that was asked for another.
//! - [`Coupling`]: a spring with a damper from where the stick points *now* to a proxy that the contact force holds, so
//!   that a slow frame makes the stick neither hard nor loose.
//! - [`Feel`]: those together for one device, a step at a time, with no clock: what a headless run and the tests use.
//! - [`Measurement`]: how a device is built in, found out by pushing it.
//! - [`Sink`]: a device, as seen from here. [`Recording`] and [`Nothing`] stand in for one.
//! - [`Force`]: the thread that owns all sinks. A [`Line`] leads from the game to one of them; to drop it, as a panic does,
//!   is to stop.
//!
//! What a sink is told lasts [`LENGTH`] and is told again before that is over, so that a force cannot outlive this thread.
//!
//! ```
//! use force_feedback::{Force, Manner, Recording, Settings, State, Stop};
//!
//! let force = Force::start(250)?;
//! let recording = Recording::default();
//! let line = force.add(Box::new(recording.clone()), Settings::default());
//! line.feel(State {
//!     contact: [-30.0, 0.0],
//!     manner: Manner::CellIndexing,
//! });
//! line.stop(Stop::Paused);
//! assert_eq!(line.report().silent, Some(Stop::Paused));
//! # Ok::<(), std::io::Error>(())
//! ```

#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units stand in brackets: [m]

mod chain;
mod coupling;
mod feel;
mod measurement;
mod settings;
mod sink;
mod thread;
mod watchdog;

pub use chain::Chain;
pub use coupling::{Coupling, Give, Manner, State};
pub use feel::{Feel, Felt};
pub use measurement::{Measured, Measurement};
pub use settings::{Calibration, HARDEST, Settings};
pub use sink::{Ability, Gone, LENGTH, Nothing, Output, Played, Recording, Sink};
pub use thread::{Force, Line, RATES, Report};
pub use watchdog::{Mail, OLDEST, Stop, Watchdog};

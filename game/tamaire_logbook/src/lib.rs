//! What happened at a stand, kept in SQLite: visits, rounds and events, week after week, and nothing about who it was.
//!
//! The way through, each module using only those above it: [`id`] and [`moment`] by what and when something is known →
//! [`row`] what is kept → [`error`] why it could not be → [`today`] what came of a day → [`logbook`] the file → [`server`] where it may
//! be sent → `sender` a thread that sends it (feature `postgres`) → [`recorder`] a thread that writes it while people play.
//!
//! What orders rows is the sequence in which they came, never the clock, which may be set.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units stand in brackets: [ms]

pub mod error;
pub mod id;
pub mod logbook;
pub mod moment;
pub mod recorder;
pub mod row;
#[cfg(feature = "postgres")]
pub mod sender;
pub mod server;
pub mod today;

pub use error::Error;
pub use id::Id;
pub use logbook::{Logbook, SetAside};
pub use moment::Moment;
pub use recorder::{Health, Options, Recorder};
pub use row::{End, Entry, Event, Kind, Round, Visit};
#[cfg(feature = "postgres")]
pub use sender::Sender;
pub use server::Server;
pub use today::Today;

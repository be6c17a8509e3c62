//! Record of the visits, rounds and events at a stand, in an SQLite file. A stand is a public installation of
//! the game. The file holds nothing that identifies a visitor.
//!
//! The modules, each of which uses only those above it:
//!
//! - [`id`] and [`moment`]: identifiers and times
//! - [`row`]: the records
//! - [`error`]: the errors
//! - [`today`]: the summary of a day
//! - [`logbook`]: the file
//! - [`server`]: the address of an optional PostgreSQL server
//! - `sender`: the thread that sends the rows to that server (feature `postgres`)
//! - [`recorder`]: the thread that writes the file during play
//!
//! Rows are ordered by the sequence in which they were written, never by their times, because the clock may
//! be set back.
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
pub use row::{Entry, Event, Kind, Round, RoundEnd, Visit};
#[cfg(feature = "postgres")]
pub use sender::Sender;
pub use server::Server;
pub use today::Today;

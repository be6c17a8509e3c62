//! What visitors did, from the logbooks of any number of stands and days: a page to be read by whoever looks after a stand,
//! and figures for whoever analyses them.
//!
//! The way through, each module using only those above it. What is asked for: [`day`] days and hours of a wall → [`error`] why
//! there is no report → [`options`] what it is to have. What is counted: [`figures`] all that it knows → `spread` medians and
//! bins → `visits` each once → `story` what became of one → `tally` rows in, figures out. What is run again: `room` the map
//! of a level → `rerun` a round → `kept` what came of it, on file → `check` all of them → `heat` where hands were. What is
//! written: `drafts` files that are whole or not there → `csv`, `tables` for analysts → `plot` as SVG → `html` →
//! `reading` what was seen in 2004 → `words` → `clips` → `page`. [`report`](mod@report) puts all of it in order.
//!
//! Rows are read one at a time, and of each no more is kept than its visit asks for.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units stand in brackets: [s]

mod check;
mod clips;
mod csv;
pub mod day;
mod drafts;
pub mod error;
pub mod figures;
mod heat;
mod html;
mod kept;
pub mod options;
mod page;
mod plot;
mod reading;
pub mod report;
mod rerun;
mod room;
mod spread;
mod story;
mod tables;
mod tally;
mod visits;
mod words;

pub use day::Day;
pub use error::Error;
pub use figures::Figures;
pub use options::{Clip, Language, Options, Progress, Stage};
pub use report::{Report, report};

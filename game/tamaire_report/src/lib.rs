//! Reports on visits, from the logbooks of any number of stands and days: an HTML page for operators, and
//! figures for analysis.
//!
//! The modules, each of which uses only those above it:
//!
//! - Input: [`day`] (days and hours in local time), [`error`] (errors), [`options`] (options of a report)
//! - Counting: [`figures`] (all figures), `spread` (medians and histograms), `visits` (each visit once),
//!   `story` (summary of a visit), `tally` (from rows to figures)
//! - Running rounds again: `room` (map of a level), `rerun` (one round), `kept` (stored results), `check`
//!   (all rounds), `heat` (hand positions)
//! - Output: `drafts` (files that appear when all are complete), `csv` and `tables` (for analysis), `plot`
//!   (SVG plots), `html` (elements), `comparison_2004` (comparison with the observations of 2004), `words`
//!   (texts), `clips`, `page`
//! - [`report`](mod@report): all steps in order
//!
//! Rows are read one at a time. Only the values that the summary of each visit needs are kept in memory.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units stand in brackets: [s]

mod check;
mod clips;
mod comparison_2004;
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

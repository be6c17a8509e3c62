//! Output of command-line programs.
//!
//! - [`write`](write()), [`write_together`] and [`Draft`]: files that appear whole or not at all
//! - [`print`](print()): text on standard output, which may be closed or full
//! - [`warn`]: a line on standard error
//! - [`parse`]: the command line, with help and version printed by [`print`](print())
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod file;
mod streams;

pub use file::{Draft, write, write_together};
pub use streams::{parse, print, warn};

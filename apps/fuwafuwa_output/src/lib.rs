//! Output of command-line programs.
//!
//! - [`write`](write()), [`write_together`] and [`Draft`]: files that appear whole or not at all
//! - [`print`](print()): text on standard output, which may be closed or full
//! - [`warn`]: a line on standard error
//! - [`quantile`]: medians and other quantiles of measured numbers
//! - [`parse`]: the command line, with help and version printed by [`print`](print())
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod file;
mod numbers;
mod streams;

pub use file::{Draft, check_folder, write, write_together};
pub use numbers::quantile;
pub use streams::{parse, print, warn};

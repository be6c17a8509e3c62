//! Documentation of the workspace, without warnings and without dead links.
//!
//! rustdoc takes units in brackets, such as `[m]`, for links. The crates therefore allow broken links, and
//! this module finds them: every unresolved link except a unit is an error.

use crate::shell::{Failure, cargo, root, show};
use std::process::Stdio;

/// Units that rustdoc takes for links.
const UNITS: [&str; 27] = [
    "cells",
    "m",
    "m²",
    "m³",
    "mm",
    "µm",
    "ml",
    "s",
    "ms",
    "min",
    "days",
    "ticks",
    "N",
    "J",
    "Pa",
    "kg",
    "rad",
    "Hz",
    "W",
    "px",
    "pixels",
    "voxels",
    "points",
    "characters",
    "bytes",
    "KiB",
    "MiB",
];

/// Builds the documentation.
///
/// # Errors
/// Fails if rustdoc fails or warns, or if a link leads nowhere.
pub fn check_documents() -> Result<(), Failure> {
    let mut command = cargo();
    command.args(["doc", "--workspace", "--all-features", "--no-deps"]);
    let line = show(&command);
    eprintln!("xtask: {line}");
    command.arg("--message-format=short").current_dir(root());
    command.env(
        "RUSTDOCFLAGS",
        "-Dwarnings --force-warn rustdoc::broken_intra_doc_links",
    );
    let output = command.stderr(Stdio::piped()).output();
    let output = output
        .map_err(|error| Failure::failed(format!("`{line}` could not be started: {error}")))?;
    let messages = String::from_utf8_lossy(&output.stderr);
    let (mut dead, mut others) = (Vec::new(), Vec::new());
    for message in messages.lines() {
        match broken_link(message) {
            Some(target) if UNITS.contains(&target) => {}
            Some(_) => dead.push(message),
            None => others.push(message),
        }
    }
    match output.status.success() {
        false => Err(Failure::failed(format!(
            "`{line}` failed\n{}",
            others.join("\n")
        ))),
        true if !dead.is_empty() => Err(Failure::failed(format!(
            "links lead nowhere:\n{}",
            dead.join("\n")
        ))),
        true => Ok(()),
    }
}

/// Returns the target of a link that a rustdoc message reports as unresolved.
fn broken_link(message: &str) -> Option<&str> {
    let (_, rest) = message.split_once("unresolved link to `")?;
    rest.split_once('`').map(|(target, _)| target)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broken_link_returns_target_of_message() {
        let message = "src/lib.rs:3:9: warning: unresolved link to `super::costs`: no item named";
        assert_eq!(broken_link(message), Some("super::costs"));
        assert_eq!(broken_link("warning: unused variable: `m`"), None);
    }
}

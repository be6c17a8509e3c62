//! The comparison with Rapier. Rapier takes minutes to build and nothing else needs it, so that it stands in a program
//! of its own, which cargo builds when it is first asked for. That program runs both engines and prints.

use anyhow::{Context, Result, bail};
use std::path::Path;
use std::process::{Command, ExitCode};

/// The program's place beside this crate.
const MANIFEST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../against_rapier/Cargo.toml");

/// Builds and runs it with these arguments.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    if !Path::new(MANIFEST).exists() {
        bail!(
            "{MANIFEST} is missing: the comparison needs the sources that this program was built from"
        );
    }
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(["run", "--release", "--manifest-path", MANIFEST, "--"])
        .args(arguments)
        .status()
        .context("cargo, which builds Rapier, could not be started")?;
    Ok(match status.success() {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_is_there() {
        assert!(Path::new(MANIFEST).exists());
    }
}

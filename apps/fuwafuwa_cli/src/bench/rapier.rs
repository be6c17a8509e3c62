//! The comparison with Rapier. Rapier takes minutes to build and nothing else needs it, so that it stands in a program
//! of its own, which cargo builds when it is first asked for. That program runs both engines and prints.

use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// The place of this crate. What is handed out must not depend on the folder that it was built in, and gets another name for it.
const HERE: &str = match option_env!("FUWAFUWA_SOURCES") {
    Some(path) => path,
    None => env!("CARGO_MANIFEST_DIR"),
};

/// Builds and runs it with these arguments.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let manifest = manifest();
    if !manifest.exists() {
        bail!(
            "{} is missing: the comparison needs the sources that this program was built from",
            manifest.display()
        );
    }
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(["run", "--release", "--manifest-path"])
        .arg(manifest)
        .arg("--")
        .args(arguments)
        .status()
        .context("cargo, which builds Rapier, could not be started")?;
    Ok(match status.success() {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    })
}

/// The program's place beside this crate.
fn manifest() -> PathBuf {
    Path::new(HERE).join("../../tools/against_rapier/Cargo.toml")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_is_there() {
        assert!(manifest().exists());
    }
}

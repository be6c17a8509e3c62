//! Comparison with Rapier in a separate program, which cargo builds on first use. It is separate because
//! Rapier takes minutes to build and only this command needs it.

use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Source folder of this crate. Release builds set `FUWAFUWA_SOURCES`, so that the program does not contain
/// the path of the build folder.
const HERE: &str = match option_env!("FUWAFUWA_SOURCES") {
    Some(path) => path,
    None => env!("CARGO_MANIFEST_DIR"),
};

/// Builds the comparison program and runs it with the arguments.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let manifest = manifest();
    if !manifest.exists() {
        bail!(
            "{} not found: the comparison needs the source folder that this program was built from",
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
        .context("cannot start cargo, which builds Rapier")?;
    Ok(match status.success() {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    })
}

/// Returns the Cargo manifest of the comparison program, `tools/against_rapier`.
fn manifest() -> PathBuf {
    Path::new(HERE).join("../../tools/against_rapier/Cargo.toml")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn manifest_exists() {
        assert!(manifest().exists());
    }
}

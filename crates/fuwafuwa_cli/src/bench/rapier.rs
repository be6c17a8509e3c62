//! The comparison with Rapier. Rapier takes minutes to build and nothing else needs it, so that it stands in a program
//! of its own, which cargo builds when it is first asked for. That program runs both engines and prints.

use super::Arguments;
use anyhow::{Context, Result, bail};
use std::path::Path;
use std::process::{Command, ExitCode};

/// The program's place beside this crate.
const MANIFEST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../against_rapier/Cargo.toml");

/// Builds and runs it.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    if !Path::new(MANIFEST).exists() {
        bail!(
            "{MANIFEST} is missing: the comparison needs the sources that this program was built from"
        );
    }
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(["run", "--release", "--manifest-path", MANIFEST, "--"])
        .args(passed_on(arguments))
        .status()
        .context("cargo, which builds Rapier, could not be started")?;
    Ok(match status.success() {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    })
}

/// The arguments of that program.
fn passed_on(arguments: &Arguments) -> Vec<String> {
    let mut passed = vec![format!("--dim={}", arguments.dim)];
    passed.extend(arguments.n.map(|n| format!("--n={n}")));
    passed.extend(
        arguments
            .scene
            .as_ref()
            .map(|scene| format!("--scene={scene}")),
    );
    passed.extend(arguments.frames.map(|frames| format!("--frames={frames}")));
    passed.extend(arguments.json.then(|| "--json".into()));
    passed
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        arguments: Arguments,
    }

    fn check(line: &str, expect: &[&str]) {
        let line = Line::parse_from(line.split(' '));
        assert_eq!(passed_on(&line.arguments), expect);
    }

    #[test]
    fn what_was_asked_for_is_passed_on() {
        assert!(Path::new(MANIFEST).exists());
        check("bench --against rapier", &["--dim=2"]);
        check(
            "bench --against rapier --dim 3 --n 16 --scene soft --frames 9 --json",
            &["--dim=3", "--n=16", "--scene=soft", "--frames=9", "--json"],
        );
    }
}

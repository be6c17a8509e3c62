//! Tasks of the Bevy plugin, `plugins/bevy_fuwafuwa`: a separate workspace with its own target folder.

use crate::packages::{IfMissing, Purpose, provide};
use crate::shell::{Failure, cargo_in, execute, root, target};
use std::fs;
use std::process::Command;

/// Task for the plugin.
#[derive(Debug, PartialEq)]
pub enum Bevy {
    /// Checks format, lints, tests without a window and documentation of the plugin. Of the examples,
    /// which need all of Bevy, only the format.
    Check,
    /// Checks the examples, and renders pictures of their scene on a virtual display.
    Pictures,
}

const MANIFEST: &str = "plugins/bevy_fuwafuwa/Cargo.toml";

pub fn run(bevy: Bevy, if_missing: IfMissing) -> Result<(), Failure> {
    match bevy {
        Bevy::Check => check(),
        Bevy::Pictures => pictures(if_missing),
    }
}

fn check() -> Result<(), Failure> {
    for (words, hint) in [
        (
            "fmt --all --check",
            "run `cargo fmt --all` in plugins/bevy_fuwafuwa",
        ),
        (
            "clippy --all-targets -- -D warnings",
            "fix the warnings above",
        ),
        (
            "test",
            "a test of the plugin failed or did not compile, see above",
        ),
        ("doc --no-deps", "fix the documentation warnings above"),
    ] {
        let mut command = in_workspace(words);
        command.env("RUSTDOCFLAGS", "-Dwarnings");
        execute(&mut command, hint)?;
    }
    Ok(())
}

fn pictures(if_missing: IfMissing) -> Result<(), Failure> {
    provide(
        &[Purpose::Build, Purpose::Drawing, Purpose::Staging],
        if_missing,
    );
    for (words, hint) in [
        (
            "clippy --package bevy_fuwafuwa_examples --all-targets -- -D warnings",
            "fix the warnings above; the examples may use an outdated API of the plugin or of Bevy",
        ),
        (
            "build --package bevy_fuwafuwa_examples --bin scene",
            "the scene does not compile, see above",
        ),
    ] {
        execute(&mut in_workspace(words), hint)?;
    }
    let folder = folder().join("pictures");
    fs::create_dir_all(&folder).map_err(|error| {
        Failure::failed(format!(
            "{}: cannot create the folder: {error}",
            folder.display()
        ))
    })?;
    let mut play = Command::new("xvfb-run");
    play.args(["--auto-servernum", "--server-args=-screen 0 1280x720x24"]);
    play.arg(folder.with_file_name("debug").join("scene"))
        .arg(&folder);
    execute(
        &mut play,
        "the scene was not drawn: is a Vulkan driver installed, for example mesa-vulkan-drivers?",
    )?;
    eprintln!("xtask: the pictures are in {}", folder.display());
    Ok(())
}

/// Returns a cargo command for the workspace of the plugin.
fn in_workspace(words: &str) -> Command {
    cargo_in(MANIFEST, &folder(), words)
}

fn folder() -> std::path::PathBuf {
    root().join(target()).join("bevy")
}

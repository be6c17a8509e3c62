//! The plugin for Bevy, `plugins/bevy_fuwafuwa`: a workspace of its own, built in a folder of its own.

use crate::packages::{IfMissing, Purpose, provide};
use crate::shell::{FAILED, Failure, cargo, execute, root, target};
use std::fs;
use std::process::Command;

/// What is wanted of it.
#[derive(Debug, PartialEq)]
pub enum Bevy {
    /// That it holds: format, lints, tests without a window, documentation; and that its examples compile.
    Check,
    /// Pictures of its scene, on a screen that nobody sees.
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
    let steps: [(&[&str], &str); 4] = [
        (
            &["fmt", "--all", "--check"],
            "run `cargo fmt --all` in plugins/bevy_fuwafuwa",
        ),
        (
            &[
                "clippy",
                "--workspace",
                "--all-targets",
                "--",
                "-D",
                "warnings",
            ],
            "mend the warnings above: perhaps the examples do not follow the plugin or Bevy any more",
        ),
        (
            &["test"],
            "a test of the plugin failed or did not compile, see above",
        ),
        (
            &["doc", "--no-deps"],
            "mend the documentation warnings above",
        ),
    ];
    for (words, hint) in steps {
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
    let example = ["--package", "bevy_fuwafuwa_examples", "--bin", "scene"];
    let mut build = in_workspace(&["build"]);
    build.args(example);
    execute(&mut build, "the scene does not compile, see above")?;
    let folder = folder().join("pictures");
    fs::create_dir_all(&folder).map_err(|error| Failure {
        message: format!("{} cannot be made: {error}", folder.display()),
        code: FAILED,
    })?;
    let mut play = Command::new("xvfb-run");
    play.args(["--auto-servernum", "--server-args=-screen 0 1280x720x24"]);
    play.arg(folder.with_file_name("debug").join("scene"))
        .arg(&folder);
    execute(
        &mut play,
        "the scene drew nothing: is there a Vulkan driver, mesa-vulkan-drivers for one?",
    )?;
    eprintln!("xtask: look at {}", folder.display());
    Ok(())
}

/// A call of cargo for the workspace of the plugin.
fn in_workspace(words: &[&str]) -> Command {
    let (task, rest) = words.split_first().expect("a task comes first");
    let mut command = cargo();
    command.args([task, "--manifest-path", MANIFEST]).args(rest);
    command.env("CARGO_TARGET_DIR", folder());
    command
}

fn folder() -> std::path::PathBuf {
    root().join(target()).join("bevy")
}

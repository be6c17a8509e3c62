//! Replays a recording and compares the hashes.

use crate::report::print_json;
use anyhow::{Context, Result};
use fuwafuwa::{Dim2, Dim3};
use fuwafuwa_scenes::disk::read_text;
use fuwafuwa_scenes::recording::{MAX_BYTES, Recording};
use std::path::PathBuf;
use std::process::ExitCode;

/// Replay a recording and compare its hashes. The exit code is 1 if they differ.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// File written by `fuwafuwa run SCENE --record FILE`.
    file: PathBuf,
    /// Print JSON instead of a sentence.
    #[arg(long)]
    json: bool,
}

/// Replays the recording and prints the result.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let name = arguments.file.display().to_string();
    let text = read_text(&arguments.file, MAX_BYTES).with_context(|| name.clone())?;
    let recording = Recording::read(&name, &text)?;
    let comparison = match recording.scene.dim {
        2 => recording.replay::<Dim2>(|_| {})?,
        _ => recording.replay::<Dim3>(|_| {})?,
    };
    if arguments.json {
        print_json(&comparison)?;
    } else {
        output::print(&match comparison.differs_at {
            None => format!(
                "{name}: {} ticks, identical to the recording\n",
                comparison.ticks
            ),
            Some(tick) => format!(
                "{name}: differs from the recording at tick {tick} or in the second before it\n"
            ),
        })?;
    }
    Ok(ExitCode::from(u8::from(comparison.differs_at.is_some())))
}

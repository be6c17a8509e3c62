//! Materials from measured curves.

pub mod fit;

use anyhow::Result;
use clap::Subcommand;
use std::process::ExitCode;

/// Fit materials to measured curves.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Fit(fit::Arguments),
}

/// Runs a subcommand.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    match &arguments.command {
        Command::Fit(arguments) => fit::run(arguments),
    }
}

//! The library of materials, and materials from measured curves.

pub mod fit;
mod list;

use anyhow::Result;
use clap::Subcommand;
use std::process::ExitCode;

/// Show the library of materials, or fit a material to a measured curve
#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    List(list::List),
    Show(list::Show),
    Fit(fit::Arguments),
}

/// Runs a subcommand.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    match &arguments.command {
        Command::List(_) => list::list(),
        Command::Show(arguments) => list::show(arguments),
        Command::Fit(arguments) => fit::run(arguments),
    }
}

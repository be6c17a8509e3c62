//! Command line of the fuwafuwa library: counts, figures, checks, benchmarks, scenes and scans.
//!
//! ```text
//! fuwafuwa count --dim 3 --shape ball --n 16 32 64
//! fuwafuwa figure all --out figures
//! fuwafuwa check all
//! fuwafuwa experiment all
//! fuwafuwa material fit curve.csv
//! fuwafuwa run tear --film tear.gif
//! fuwafuwa scan grey.nii.gz white.nii.gz --out brain.toml
//! ```
//!
//! Each subcommand is a module with its own `Arguments` and `run`.

mod bench;
mod check;
mod count;
mod experiment;
mod figure;
mod material;
mod plot;
mod replay;
mod report;
mod run;
mod scan;
mod validation;

use anyhow::Result;
use clap::{CommandFactory, Parser, Subcommand};
use std::process::ExitCode;

/// Run, draw, count, check and measure graded soft bodies.
#[derive(Parser)]
#[command(name = "fuwafuwa", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Bench(bench::Arguments),
    Count(count::Arguments),
    Figure(figure::Arguments),
    Check(check::Arguments),
    Experiment(experiment::Arguments),
    Material(material::Arguments),
    Run(run::Arguments),
    Replay(replay::Arguments),
    Scan(scan::Arguments),
    Manual(manual::Options),
}

fn main() -> ExitCode {
    run(output::parse()).unwrap_or_else(|error| {
        output::warn(format_args!("error: {error:#}"));
        ExitCode::from(2)
    })
}

fn run(arguments: Arguments) -> Result<ExitCode> {
    match arguments.command {
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Count(arguments) => count::run(&arguments),
        Command::Figure(arguments) => figure::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Experiment(arguments) => experiment::run(&arguments),
        Command::Material(arguments) => material::run(&arguments),
        Command::Run(arguments) => run::run(&arguments),
        Command::Replay(arguments) => replay::run(&arguments),
        Command::Scan(arguments) => scan::run(&arguments),
        Command::Manual(options) => Ok(manual::run(Arguments::command(), &options)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn out_of_range_values_are_rejected() {
        let refused = |line: &str| Arguments::try_parse_from(line.split(' ')).is_err();
        assert!(refused("fuwafuwa count --dim 4"));
        assert!(refused("fuwafuwa count --n 2"));
        assert!(refused("fuwafuwa count --n 2000"));
        assert!(refused("fuwafuwa figure 7 --out x"));
        assert!(!refused("fuwafuwa count --dim 2 --shape cube --n 3 1024"));
    }
}

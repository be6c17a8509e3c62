//! Counts, figures and checks of the fuwafuwa library on the command line.
//!
//! ```text
//! fuwafuwa count --dim 3 --shape ball --n 16 32 64
//! fuwafuwa figure all --out figures
//! fuwafuwa check all
//! ```

mod beam;
mod count;
mod figure;
mod patch;
mod picture;
mod report;

use anyhow::Result;
use clap::{Parser, Subcommand, ValueEnum};
use report::{Outcome, Progress};
use std::path::PathBuf;
use std::process::ExitCode;

/// Counts, figures and checks of graded soft bodies.
#[derive(Parser)]
#[command(name = "fuwafuwa", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Count voxels, elements, nodes and vertices, beside the paper's formulas.
    Count {
        /// Space dimensions: 2 or 3.
        #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u8).range(2..=3))]
        dim: u8,
        /// What fills the grid; in 2D a square or a disc.
        #[arg(long, value_enum, default_value_t = count::Form::Ball)]
        shape: count::Form,
        /// Voxels across, 3 to 1024; several may be given.
        #[arg(long, num_args = 1.., default_values_t = [16, 32, 64],
              value_parser = clap::value_parser!(u16).range(3..=1024))]
        n: Vec<u16>,
        /// Print JSON instead of a table.
        #[arg(long)]
        json: bool,
    },
    /// Draw figures from live data, each as SVG and PNG.
    Figure {
        /// Which figure: 1 = a graded disc, 2 = the levels of its look-up table.
        #[arg(value_enum)]
        which: figure::Which,
        /// Folder for the files; it is made when it does not exist.
        #[arg(long)]
        out: PathBuf,
    },
    /// Check the mechanics; the exit code is 1 when a check fails.
    Check {
        /// Which check: uniform strain, bending, or both.
        #[arg(value_enum)]
        which: Check,
        /// Print JSON instead of a table.
        #[arg(long)]
        json: bool,
    },
}

#[derive(Copy, Clone, PartialEq, Eq, ValueEnum)]
enum Check {
    /// Uniform strain of random cut shapes must leave inner nodes at rest.
    Patch,
    /// Graded cantilevers must bend as Timoshenko's theory says.
    Beam,
    /// Both.
    All,
}

fn main() -> Result<ExitCode> {
    match Arguments::parse().command {
        Command::Count {
            dim,
            shape,
            n,
            json,
        } => {
            let counts = count::count(dim, shape, &n)?;
            if json {
                println!("{}", serde_json::to_string_pretty(&counts)?);
            } else {
                print!("{}", count::table(&counts));
            }
            Ok(ExitCode::SUCCESS)
        }
        Command::Figure { which, out } => {
            for path in figure::write(which, &out)? {
                println!("{}", path.display());
            }
            Ok(ExitCode::SUCCESS)
        }
        Command::Check { which, json } => {
            let outcomes = check(which)?;
            if json {
                println!("{}", serde_json::to_string_pretty(&outcomes)?);
            } else {
                print!("{}", report::outcome_table(&outcomes));
            }
            let failed = outcomes.iter().any(|outcome| outcome.pass == Some(false));
            Ok(ExitCode::from(u8::from(failed)))
        }
    }
}

fn check(which: Check) -> Result<Vec<Outcome>> {
    let mut outcomes = Vec::new();
    if which != Check::Beam {
        outcomes.extend(patch::check(patch::FULL, &Progress::new())?);
    }
    if which != Check::Patch {
        outcomes.extend(beam::check(&Progress::new())?);
    }
    Ok(outcomes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn values_out_of_range_are_refused() {
        let refused = |line: &str| Arguments::try_parse_from(line.split(' ')).is_err();
        assert!(refused("fuwafuwa count --dim 4"));
        assert!(refused("fuwafuwa count --n 2"));
        assert!(refused("fuwafuwa count --n 2000"));
        assert!(refused("fuwafuwa figure 3 --out x"));
        assert!(!refused("fuwafuwa count --dim 2 --shape cube --n 3 1024"));
    }
}

//! The mechanics against references; the exit code is 1 when a check fails.

mod beam;
mod doughnut;
mod energy;
mod momentum;
mod motion;
mod parallel;
mod patch;
mod period;
mod pile;
mod random;
mod sag;
mod spin;
mod stack;
mod statics;
mod tear;

use crate::report::{self, Outcome, Progress};
use anyhow::Result;
use clap::ValueEnum;
use std::process::ExitCode;

/// Check the mechanics against references; the exit code is 1 when a check fails.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Which check.
    #[arg(value_enum)]
    which: Which,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
enum Which {
    /// Uniform strain of random cut shapes must leave inner nodes at rest.
    Patch,
    /// Graded cantilevers must bend as Timoshenko's theory says.
    Beam,
    /// Graded bodies must sag under their weight as uniform ones do, boxes as one that is fine enough.
    Sag,
    /// Graded bodies must ring as uniform ones do, and keep their energy.
    Period,
    /// A free body must keep its spin, and so must the halves of one that was cut.
    Spin,
    /// Releases must leave mass and momentum as they are.
    Momentum,
    /// Bars must break at the load their material bears, at any resolution.
    Tear,
    /// Dust must come to rest, and none of it be lost.
    Pile,
    /// A stack of bodies must stand still.
    Stack,
    /// A ring squeezed shut must not pass through itself.
    Doughnut,
    /// All of them.
    All,
}

type Check = fn(&Progress) -> Result<Vec<Outcome>>;

/// Runs the checks and prints what they found.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let checks: [(Which, Check); 10] = [
        (Which::Patch, patch::check),
        (Which::Beam, beam::check),
        (Which::Sag, sag::check),
        (Which::Period, period::check),
        (Which::Spin, spin::check),
        (Which::Momentum, momentum::check),
        (Which::Tear, tear::check),
        (Which::Pile, pile::check),
        (Which::Stack, stack::check),
        (Which::Doughnut, doughnut::check),
    ];
    let mut outcomes = Vec::new();
    for (name, check) in checks {
        if arguments.which == name || arguments.which == Which::All {
            outcomes.extend(check(&Progress::new())?);
        }
    }
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&outcomes)?);
    } else {
        print!("{}", report::outcome_table(&outcomes));
    }
    let failed = outcomes.iter().any(|outcome| outcome.pass == Some(false));
    Ok(ExitCode::from(u8::from(failed)))
}

//! Checks of the mechanics against theory and reference solutions. The exit status is 1 if a check fails.

mod beam;
mod bounce;
mod damping;
mod doughnut;
mod energy;
mod far;
mod free_fall;
mod heap;
mod impact;
mod momentum;
mod motion;
mod overlap;
mod parallel;
mod patch;
mod period;
mod pile;
mod random;
mod reaction;
mod sag;
mod scale;
mod slope;
mod slow;
mod sphere;
mod spin;
mod stack;
mod statics;
mod tear;

use crate::report::{self, Outcome, Progress};
use anyhow::Result;
use clap::ValueEnum;
use std::process::ExitCode;

/// Check the mechanics against references. The exit code is 1 if a check fails.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Check to run.
    #[arg(value_enum)]
    which: Which,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
enum Which {
    /// Under uniform strain, no force must act on inner nodes of randomly shaped and cut bodies.
    Patch,
    /// Graded cantilevers must bend according to Timoshenko's theory.
    Beam,
    /// Graded bodies must sag under their weight like uniform ones; graded boxes, like one very fine uniform
    /// box.
    Sag,
    /// Graded bodies must oscillate like uniform ones and keep their energy.
    Period,
    /// Bars and balls must have the damping ratio of Rayleigh's law, at every shape and resolution.
    Damping,
    /// A free body must keep its angular momentum, and so must the halves of a body that was cut.
    Spin,
    /// Splits of nodes must preserve mass and momentum.
    Momentum,
    /// Bars must break at the load given by the strength of their material, at any resolution.
    Tear,
    /// A pile of crumbs (pieces of one voxel) must come to rest, and no crumb may be lost.
    Pile,
    /// A stack of bodies must stand still.
    Stack,
    /// Heaps of balls and cubes must fall asleep and stay asleep.
    Heap,
    /// Bodies that sag, float or slide slowly must not be stopped.
    Slow,
    /// A ball must resist a plate as a smooth elastic ball does.
    Sphere,
    /// Blocks on inclined planes must slide as Coulomb's law says, or rest.
    Slope,
    /// A ring squeezed shut must not pass through itself.
    Doughnut,
    /// Bodies in flight must move like a point mass, at every size and speed.
    FreeFall,
    /// Fast bodies must not pass through a plate, must keep their momentum, and a pin on a fast carrier must hold.
    Impact,
    /// Far from the origin, bodies must keep their shape, up to the distance at which they are refused.
    Far,
    /// Supports must carry the weight of sleeping bodies, and stretched bars must pull as in theory.
    Reaction,
    /// Objects placed inside each other must come apart.
    Overlap,
    /// Bodies of 1 m to 0.5 mm must rest, tear and oscillate alike, exact or with scaled mass.
    Scale,
    /// Bodies of 1 m to 2 mm with scaled mass must bounce like exact ones, up to a stated scale.
    Bounce,
    /// All checks.
    All,
}

type Check = fn(&Progress) -> Result<Vec<Outcome>>;

/// Runs the checks and prints their outcomes.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let checks: [(Which, Check); 22] = [
        (Which::Patch, patch::check),
        (Which::Beam, beam::check),
        (Which::Sag, sag::check),
        (Which::Period, period::check),
        (Which::Damping, damping::check),
        (Which::Spin, spin::check),
        (Which::Momentum, momentum::check),
        (Which::Tear, tear::check),
        (Which::Pile, pile::check),
        (Which::Stack, stack::check),
        (Which::Heap, heap::check),
        (Which::Slow, slow::check),
        (Which::Sphere, sphere::check),
        (Which::Slope, slope::check),
        (Which::Doughnut, doughnut::check),
        (Which::FreeFall, free_fall::check),
        (Which::Impact, impact::check),
        (Which::Far, far::check),
        (Which::Reaction, reaction::check),
        (Which::Overlap, overlap::check),
        (Which::Scale, scale::check),
        (Which::Bounce, bounce::check),
    ];
    let mut outcomes = Vec::new();
    for (name, check) in checks {
        if arguments.which == name || arguments.which == Which::All {
            outcomes.extend(check(&Progress::new())?);
        }
    }
    if arguments.json {
        report::print_json(&outcomes)?;
    } else {
        output::print(&report::outcome_table(&outcomes))?;
    }
    let failed = outcomes.iter().any(|outcome| outcome.pass == Some(false));
    Ok(ExitCode::from(u8::from(failed)))
}

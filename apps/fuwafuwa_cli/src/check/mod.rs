//! Checks of the mechanics against theory and reference solutions. The exit status is 1 if a check fails.

mod beam;
mod bounce;
mod damping;
mod doughnut;
mod elastica;
mod energy;
mod far;
mod free_fall;
mod greenhill;
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
mod ring;
mod sag;
mod scale;
mod shooting;
mod slope;
mod slow;
mod spin;
mod stack;
mod statics;
mod tear;
mod turek_hron;

use crate::report::{self, Findings, Outcome, Progress};
use crate::validation::{self, Section};
use anyhow::{Context, Result};
use clap::ValueEnum;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

/// Check the mechanics against references. The exit code is 1 if a check fails.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Check to run.
    #[arg(value_enum)]
    which: Which,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
    /// Write a report in Markdown, with a picture of each check in a folder beside it. Files that would not change
    /// are left alone.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Compare the report with its files instead of writing it. The exit code is 1 if they differ.
    #[arg(long, requires = "report")]
    compare: bool,
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
    /// Clamped bars under a tip load or their own weight must bend like the elastica.
    Elastica,
    /// A clamped column must buckle under its own weight at Greenhill's load.
    Greenhill,
    /// A ring pinched at two opposite points must resist and bulge like the elastica.
    Ring,
    /// The bar behind a cylinder of Turek and Hron's benchmark must bend and oscillate as published.
    TurekHron,
    /// All checks.
    All,
}

type Check = fn(&Progress) -> Result<Findings>;

/// All checks, in the order of their output.
const CHECKS: [(Which, Check); 25] = [
    (Which::Patch, |progress| Ok(patch::check(progress)?.into())),
    (Which::Beam, |progress| Ok(beam::check(progress)?.into())),
    (Which::Sag, |progress| Ok(sag::check(progress)?.into())),
    (
        Which::Period,
        |progress| Ok(period::check(progress)?.into()),
    ),
    (Which::Damping, |progress| {
        Ok(damping::check(progress)?.into())
    }),
    (Which::Spin, |progress| Ok(spin::check(progress)?.into())),
    (Which::Momentum, |progress| {
        Ok(momentum::check(progress)?.into())
    }),
    (Which::Tear, |progress| Ok(tear::check(progress)?.into())),
    (Which::Pile, |progress| Ok(pile::check(progress)?.into())),
    (Which::Stack, |progress| Ok(stack::check(progress)?.into())),
    (Which::Heap, |progress| Ok(heap::check(progress)?.into())),
    (Which::Slow, |progress| Ok(slow::check(progress)?.into())),
    (Which::Slope, |progress| Ok(slope::check(progress)?.into())),
    (Which::Doughnut, |progress| {
        Ok(doughnut::check(progress)?.into())
    }),
    (Which::FreeFall, |progress| {
        Ok(free_fall::check(progress)?.into())
    }),
    (
        Which::Impact,
        |progress| Ok(impact::check(progress)?.into()),
    ),
    (Which::Far, |progress| Ok(far::check(progress)?.into())),
    (Which::Reaction, |progress| {
        Ok(reaction::check(progress)?.into())
    }),
    (Which::Overlap, |progress| {
        Ok(overlap::check(progress)?.into())
    }),
    (Which::Scale, |progress| Ok(scale::check(progress)?.into())),
    (
        Which::Bounce,
        |progress| Ok(bounce::check(progress)?.into()),
    ),
    (Which::Elastica, elastica::check),
    (Which::Greenhill, greenhill::check),
    (Which::Ring, ring::check),
    (Which::TurekHron, turek_hron::check),
];

/// Runs the checks and prints their outcomes.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let is_chosen = |which| arguments.which == which || arguments.which == Which::All;
    let checks: Vec<_> = CHECKS
        .into_iter()
        .filter(|(which, _)| is_chosen(*which))
        .collect();
    if let Some(path) = &arguments.report {
        output::check_folder(path).with_context(|| path.display().to_string())?;
    }
    let progress = Progress::new();
    let mut sections = Vec::new();
    run_all(&checks, &progress, |which, findings| {
        if !arguments.json {
            let table = report::outcome_table(&findings.outcomes);
            let gap = if sections.is_empty() { "" } else { "\n" };
            progress.suspend(|| output::print(&format!("{gap}{table}")))?;
        }
        sections.push(which.section(findings));
        Ok(())
    })?;
    drop(progress);
    let outcomes = || {
        sections
            .iter()
            .flat_map(|section| &section.findings.outcomes)
    };
    if arguments.json {
        report::print_json(&outcomes().collect::<Vec<&Outcome>>())?;
    }
    let mut failed = outcomes().any(|outcome| outcome.pass == Some(false));
    if let Some(path) = &arguments.report {
        let files = validation::files(path, &sections);
        if arguments.compare {
            let differences = validation::differences(&files);
            differences.iter().for_each(output::warn);
            failed |= !differences.is_empty();
        } else {
            validation::write(&files)?;
        }
    }
    Ok(ExitCode::from(u8::from(failed)))
}

impl Which {
    /// Returns the section of the report for this check.
    fn section(self, findings: Findings) -> Section {
        let value = self.to_possible_value();
        let about = value.as_ref().and_then(|value| value.get_help());
        Section {
            name: value
                .as_ref()
                .map_or(String::new(), |value| value.get_name().to_owned()),
            about: about.map_or(String::new(), ToString::to_string),
            findings,
        }
    }
}

/// Runs checks on all threads. `done` receives the findings of each check in the order of the checks, as soon as all
/// checks before it are done. After an error, no further check begins.
fn run_all(
    checks: &[(Which, Check)],
    progress: &Progress,
    mut done: impl FnMut(Which, Findings) -> Result<()>,
) -> Result<()> {
    progress.expect(checks.len() as u64);
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..parallel::threads().min(checks.len()) {
            let sender = sender.clone();
            let next = &next;
            scope.spawn(move || {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some((_, check)) = checks.get(index) else {
                        break;
                    };
                    let found = check(progress);
                    progress.step();
                    if found.is_err() {
                        next.store(checks.len(), Ordering::Relaxed);
                    }
                    if sender.send((index, found)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let (mut waiting, mut count, mut result) = (BTreeMap::new(), 0, Ok(()));
        for (index, found) in receiver {
            waiting.insert(index, found);
            while let Some(found) = waiting.remove(&count) {
                result = result.and_then(|()| done(checks[count].0, found?));
                count += 1;
            }
        }
        result
    })
}

//! Checks of the mechanics against theory and reference solutions. The exit status is 1 if a check fails.

pub mod bar;
mod beam;
mod bounce;
mod crack_path;
mod damping;
mod doughnut;
pub mod elastica;
mod energy;
mod far;
mod free_fall;
pub mod greenhill;
mod grid;
mod heap;
mod impact;
mod knife;
mod lefm;
mod momentum;
pub mod motion;
mod overlap;
pub mod parallel;
mod patch;
mod path;
mod period;
mod pile;
mod plate;
mod random;
mod reaction;
pub mod ring;
mod sag;
mod scale;
pub mod shooting;
mod slope;
mod slow;
pub mod sphere;
mod spin;
mod stack;
pub mod statics;
mod tear;
pub mod turek_hron;

use crate::report::{self, Findings, Outcome, Progress};
use crate::validation::{self, Page, Suite};
use anyhow::Result;
use clap::ValueEnum;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

/// Check the mechanics against references. The exit code is 1 if a check fails.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Check to run. All checks take some minutes.
    #[arg(value_enum)]
    which: Which,
    /// Run the checks `lefm`, `path`, `grid` and `knife` with all their cases, which take much longer.
    #[arg(long)]
    full: bool,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
    /// Write a report in Markdown, with a picture of each check in a folder beside it. Writing needs `check all`. Files that would
    /// not change are left alone.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Compare the sections of the chosen checks with those of the report instead of writing it. The exit code is 1 if they
    /// differ.
    #[arg(long, requires = "report")]
    compare: bool,
}

#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
enum Which {
    /// Under uniform strain, no force must act on inner nodes of randomly shaped and cut bodies. Reference: 0, by the
    /// patch test of Irons. The paper's law is shown for comparison.
    Patch,
    /// Graded cantilevers must bend like beams. Reference: Timoshenko's theory in closed form, w = P L³ / 3 E'I + P L
    /// / κGA with κ = 5/6.
    Beam,
    /// Graded bodies must sag under their weight like uniform ones. Reference: a uniform mesh of the same voxels,
    /// solved exactly; for boxes, one very fine uniform box.
    Sag,
    /// Graded bodies must oscillate like uniform ones and keep their energy. Reference: the period of a uniform mesh
    /// of the same voxels, and the energy at the start.
    Period,
    /// Bars and balls must have the damping ratio of Rayleigh's law, at every shape and resolution. Reference: α / 2ω +
    /// β ω / 2 at the measured frequency.
    Damping,
    /// A free body must keep its angular momentum, and so must the halves of a body that was cut. Reference: the
    /// momentum at the start.
    Spin,
    /// Splits of nodes must preserve mass and momentum. Reference: the values before the splits.
    Momentum,
    /// Bars must break at the load given by the strength of their material, at any resolution. Reference: strength ×
    /// section for whole bars; the mean over all resolutions for notched ones.
    Tear,
    /// A pile of crumbs (pieces of one voxel) must come to rest, and no crumb may be lost. Reference: limits set here.
    Pile,
    /// A stack of ten bodies must stand still. Reference: its place after 5 s; Young's modulus is 1.6 times that at
    /// which a column buckles by Greenhill's formula.
    Stack,
    /// Heaps of balls and cubes must fall asleep and stay asleep. Reference: limits set here.
    Heap,
    /// Bodies that sag, float or slide slowly must not be stopped. Reference: the static solution of the same mesh, the
    /// speed at the start, and Coulomb's law without friction.
    Slow,
    /// A ball must resist a plate as a smooth elastic ball does. Reference: axisymmetric finite elements of the same law.
    /// Two balls, and balls with smoothed voxels, are shown for comparison.
    Sphere,
    /// Blocks on inclined planes must slide as Coulomb's law says, or rest. Reference: v = g (tan φ − µ) cos φ · t in
    /// closed form.
    Slope,
    /// A ring squeezed shut must not pass through itself. Reference: limits set here.
    Doughnut,
    /// Bodies in flight must move like a point mass, at every size and speed. Reference: v t + g t² / 2 and v + g t.
    FreeFall,
    /// Fast bodies must not pass through a plate, must keep their momentum, and a pin on a fast carrier must hold.
    /// Reference: the momentum at the start, and limits set here.
    Impact,
    /// Far from the origin, bodies must keep their shape, up to the distance at which they are refused. Reference: the
    /// same body at the origin.
    Far,
    /// Supports must carry the weight of sleeping bodies, and stretched bars must pull as in theory. Reference: m g, its
    /// moment, and E A ε.
    Reaction,
    /// Objects placed inside each other must come apart. Reference: limits set here.
    Overlap,
    /// Bodies of 1 m to 0.5 mm must rest, tear and oscillate alike, exact or with scaled mass. Reference: a similar body
    /// 1 m wide, and its load, which is strength × section.
    Scale,
    /// Bodies of 1 m to 2 mm with scaled mass must bounce like exact ones, up to a stated scale. Reference: the same
    /// body without scaling.
    Bounce,
    /// Clamped bars must bend under a tip load or their own weight like the elastica. Reference: the equation of the
    /// elastica, solved here, as tabulated for tip loads by Bisshopp and Drucker (Quarterly of Applied Mathematics 3,
    /// 1945).
    Elastica,
    /// A clamped column must sway ever slower under its own weight and buckle at Greenhill's load. Reference: q L³ / E'I
    /// = 7.8373 (Greenhill 1881) and the frequencies of linearised beam theory, solved here.
    Greenhill,
    /// A ring pinched at two opposite points must resist and bulge like the elastica. Reference: the equation of the
    /// elastica, solved here; for small forces Timoshenko's theory of thick rings in closed form.
    Ring,
    /// An elastic bar behind a cylinder must bend and oscillate as published. Reference: the cases CSM1 to CSM3 of Turek
    /// and Hron (2006, doi 10.1007/3-540-34596-5_15), finite elements.
    TurekHron,
    /// Cracks must grow when their stress intensity reaches the toughness, at any resolution and direction of the voxels,
    /// and dissipate toughness² (1 − ν²) / E per area. Reference: K by energy release from static solutions, compared
    /// with the factors of Tada and Feddersen.
    Lefm,
    /// Cracks must follow the load and not the grid. Reference: square to the load for straight cracks; displacement
    /// discontinuities (Crouch 1976) with maximal hoop stress (Erdogan and Sih 1963) for oblique ones.
    Path,
    /// Bars and blunt slots must fail at the same load at every resolution. Reference: strength × area; the line method
    /// of the theory of critical distances (Taylor 1999).
    Grid,
    /// A knife must spend the fracture energy. Reference: toughness² (1 − ν²) / E, and 2 r × strength for a dull edge of radius r.
    Knife,
    /// The checks that take some seconds each.
    Quick,
    /// All checks.
    All,
}

/// Number of cases of a check of fracture.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum Extent {
    /// Cases that take at most some minutes.
    Usual,
    /// All cases.
    Full,
}

impl Suite for Which {
    const ALL: Self = Self::All;
    const QUICK: Self = Self::Quick;
    // Checks that take more than some five seconds on two cores.
    const LONG: &'static [Self] = &[
        Self::Beam,
        Self::Sag,
        Self::Period,
        Self::Tear,
        Self::Pile,
        Self::Heap,
        Self::Sphere,
        Self::FreeFall,
        Self::Impact,
        Self::Scale,
        Self::Ring,
        Self::Lefm,
        Self::Path,
        Self::Grid,
    ];
}

/// Introduction of the report.
const PAGE: Page = Page {
    title: "Validation",
    about: "What `fuwafuwa check` measures, beside theory, published values, or a second way to compute. A program wrote this\n\
            page: `cargo run --package fuwafuwa_cli -- check all --report docs/validation.md`. `cargo xtask test` compares\n\
            the quick checks with new measurements.\n\n\
            Pictures show measured points upon the curve of the reference. Where there is no curve, they show the deviation\n\
            from the reference in units of its bound: all points must lie in the green band.",
    kind: "check",
    value: "measured",
    command: "check",
};

type Check = fn(&Progress, Extent) -> Result<Findings>;

/// All checks, in the order of their output.
const CHECKS: [(Which, Check); 30] = [
    (Which::Patch, |progress, _| patch::check(progress)),
    (Which::Beam, |progress, _| beam::check(progress)),
    (Which::Sag, |progress, _| sag::check(progress)),
    (Which::Period, |progress, _| period::check(progress)),
    (Which::Damping, |progress, _| damping::check(progress)),
    (Which::Spin, |progress, _| spin::check(progress)),
    (Which::Momentum, |progress, _| momentum::check(progress)),
    (Which::Tear, |progress, _| tear::check(progress)),
    (Which::Pile, |progress, _| pile::check(progress)),
    (Which::Stack, |progress, _| stack::check(progress)),
    (Which::Heap, |progress, _| heap::check(progress)),
    (Which::Slow, |progress, _| slow::check(progress)),
    (Which::Sphere, |progress, _| sphere::check(progress)),
    (Which::Slope, |progress, _| slope::check(progress)),
    (Which::Doughnut, |progress, _| doughnut::check(progress)),
    (Which::FreeFall, |progress, _| free_fall::check(progress)),
    (Which::Impact, |progress, _| impact::check(progress)),
    (Which::Far, |progress, _| far::check(progress)),
    (Which::Reaction, |progress, _| reaction::check(progress)),
    (Which::Overlap, |progress, _| overlap::check(progress)),
    (Which::Scale, |progress, _| scale::check(progress)),
    (Which::Bounce, |progress, _| bounce::check(progress)),
    (Which::Elastica, |progress, _| elastica::check(progress)),
    (Which::Greenhill, |progress, _| greenhill::check(progress)),
    (Which::Ring, |progress, _| ring::check(progress)),
    (Which::TurekHron, |progress, _| turek_hron::check(progress)),
    (Which::Lefm, lefm::check),
    (Which::Path, path::check),
    (Which::Grid, grid::check),
    (Which::Knife, knife::check),
];

/// Runs the checks and prints their outcomes.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let extent = match arguments.full {
        true => Extent::Full,
        false => Extent::Usual,
    };
    let checks: Vec<(Which, Check)> = CHECKS
        .into_iter()
        .filter(|(which, _)| arguments.which.includes(which))
        .collect();
    if let Some(path) = &arguments.report {
        arguments
            .which
            .check_report(path, &PAGE, arguments.compare)?;
    }
    let progress = Progress::new();
    let mut sections = Vec::new();
    let work = |index: usize| checks[index].1(&progress, extent);
    run_all(checks.len(), work, &progress, |index, findings| {
        if !arguments.json {
            let table = report::outcome_table(&findings.outcomes);
            let gap = if sections.is_empty() { "" } else { "\n" };
            progress.suspend(|| output::print(&format!("{gap}{table}")))?;
        }
        sections.push(checks[index].0.section(findings));
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
        let is_complete = arguments.which == Which::All;
        failed |= validation::report(path, &PAGE, &sections, is_complete, arguments.compare)?;
    }
    Ok(ExitCode::from(u8::from(failed)))
}

/// Runs `work` for each of `count` checks on all threads. `done` receives the index and the result of each check in the
/// order of the checks, as soon as all checks before it are done. After an error, no further check begins.
pub fn run_all<Found: Send>(
    count: usize,
    work: impl Fn(usize) -> Result<Found> + Sync,
    progress: &Progress,
    mut done: impl FnMut(usize, Found) -> Result<()>,
) -> Result<()> {
    progress.expect(count as u64);
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..parallel::threads().min(count) {
            let sender = sender.clone();
            let (next, work) = (&next, &work);
            scope.spawn(move || {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count {
                        break;
                    }
                    let found = work(index);
                    progress.step();
                    if found.is_err() {
                        next.store(count, Ordering::Relaxed);
                    }
                    if sender.send((index, found)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let (mut waiting, mut finished, mut result) = (BTreeMap::new(), 0, Ok(()));
        for (index, found) in receiver {
            waiting.insert(index, found);
            while let Some(found) = waiting.remove(&finished) {
                result = result.and_then(|()| done(finished, found?));
                if result.is_err() {
                    next.store(count, Ordering::Relaxed);
                }
                finished += 1;
            }
        }
        result
    })
}

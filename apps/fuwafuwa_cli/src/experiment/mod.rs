//! Experiments, rebuilt: reference values beside those of the engine.
//!
//! Each experiment is a module with a function that returns its [`Record`]. The references are measurements, published
//! computations, theory or a second way to compute, see [`Source`]. Constants may be fitted to some of the rows, see
//! [`Role`].

mod balloon;
mod biaxial;
mod cook;
mod crack_speed;
mod dragon_skin;
mod fracture;
mod gel_layer;
mod half_space;
mod hanging_bar;
mod patch;
mod pull;
mod sphere;
mod strength;
mod truth_cube;
mod uniaxial;
mod wire;

use crate::check::{self, run_all};
use crate::plot::Plot;
use crate::report::{self, Findings, Outcome, Progress, Standing, digits};
use crate::validation::{self, Page, ReportFile, Section, Suite, check_output};
use anyhow::Result;
use clap::ValueEnum;
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Rebuild experiments and compare the results with measurements, published computations and theory. The exit code is 1 if
/// a result misses its bound, except for the misses that are marked as known.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Experiment to run. All together take up to ten minutes on two cores. Without a name, the names are listed.
    #[arg(value_enum, default_value_t = Which::List)]
    which: Which,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
    /// Write a report in Markdown, with a picture of each experiment in a folder beside it. Writing needs `experiment
    /// all`.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Compare the sections of the chosen experiments with those of the report instead of writing it. The exit code is 1
    /// if they differ.
    #[arg(long, requires = "report")]
    compare: bool,
    /// Write the reference curves and the computed points of each picture as CSV files into a folder.
    #[arg(long, value_name = "FOLDER")]
    csv: Option<PathBuf>,
}

#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
enum Which {
    /// A beam of silicone rubber with a weight at its tip is released from straight and swings until it rests. Three
    /// constants are fitted to the runs with 52 g, which were chosen after the calibrations with the other runs had been
    /// tried and had fitted worse. Missed: the frequency and the damping ratio without weight and the damping ratio with
    /// 102 g. To match them, the stiffness would have to fall with the frequency. The bound of a damping ratio is the
    /// range of the two measured runs. Reference: motion capture of Dubied et al. (2022), arXiv 2201.12560.
    DragonSkin,
    /// An elastic bar behind a cylinder bends and oscillates. Reference: the cases CSM1 to CSM3 of Turek and Hron (2006),
    /// finite elements.
    TurekHron,
    /// Clamped bars bend under a tip load or their own weight. Reference: the equation of the elastica, solved here, with
    /// the table of Bisshopp and Drucker (1945).
    Elastica,
    /// A column buckles under its own weight. Reference: Greenhill (1881).
    Greenhill,
    /// A ring is pinched between two points. Reference: the equation of the elastica, solved here.
    Ring,
    /// A layer of gel hangs under a dish, and its surface becomes unstable at a critical weight. Reference: the theory of
    /// small ripples of Mora et al. (2014) for gel that keeps its volume, and for a Poisson's ratio of 0.49 finite
    /// elements along the depth, computed for this project with a program that is not part of it. The measurements of the
    /// paper are not compared.
    GelLayer,
    /// A tube and a balloon of rubber are inflated. Reference: the equation of radial equilibrium with a Poisson's ratio
    /// of 0.49, solved here. It tends to the exact solution of Green and Zerna (1954) for rubber that keeps its volume,
    /// which the pictures show, too.
    Balloon,
    /// A force presses on a point of a half-space. Reference: Boussinesq (1885).
    HalfSpace,
    /// A bar hangs under its own weight. Reference: exact solution, Timoshenko and Goodier.
    HangingBar,
    /// A ball is pressed between plates, a rigid ball is pressed into a half-space, and a soft ball hits a floor. Without a
    /// bound: balls of coarse voxels at small depths, smoothed voxels, whose surface is uncertain by half a voxel, and two
    /// balls, whose contact spheres lie on the staircase of voxels. At small depths, some of these forces are 100 % too small.
    /// Reference: axisymmetric finite elements, computed for this project with a program that is not part of it, Sneddon
    /// (1965) and Hertz (1882).
    Sphere,
    /// A cube of soft silicone is compressed between plates, with slip and with bonded ends. The compressions are those of
    /// the Truth Cube of Kerdok et al. (2003), whose displacements of beads were not available, so that nothing measured is
    /// compared. Reference: the neo-Hookean law, Gent and Lindley (1959), and linear finite elements, computed for this
    /// project with a program that is not part of it.
    TruthCube,
    /// Silicones and rubber are stretched along one axis. Three constants of a Yeoh law are fitted to each curve; the
    /// engine must give the stress of this law. The clamped strip has the law that was fitted to the same curve, which was
    /// itself measured with a clamped specimen, so that the clamps count twice: its rows are no test. Reference: curves
    /// measured by Marechal et al. (2020) and Treloar (1944), and the fitted law.
    Uniaxial,
    /// Rubber is stretched along two axes, with laws fitted to uniaxial tension alone, which mostly give too little stress
    /// because they ignore the second invariant, and to all tests. The engine must give the stress of the law of all tests.
    /// Missed: equibiaxial tension, where the Poisson's ratio of 0.49 lowers the stress by up to 2.6 %. Reference: curves
    /// measured by Treloar (1944) and Kawabata et al. (1981), and the fitted law.
    Biaxial,
    /// Cracks begin to grow in a strip in pure shear, a notched bar and a double cantilever beam. Reference: formulas for
    /// energy release and stress intensity in the challenge set of Kamarei, Zeng, Dolbow and Lopez-Pamies (2026), and for
    /// notched bars factors of finite elements, computed for this project with a program that is not part of it.
    Fracture,
    /// A poker chip must crack inside. A twisted tube must crack at its shear strength, and blocks under several stresses
    /// must fail at the criterion of Drucker and Prager, whose tensile and hydrostatic strength the engine is given.
    /// Reference: this criterion, with the strengths of Kumar, Bourdin, Francfort and Lopez-Pamies (2020) and of the
    /// challenge set of Kamarei, Zeng, Dolbow and Lopez-Pamies (2026). No measured failure is compared.
    Strength,
    /// A sharp edge cuts gelatine at three speeds. The force on the edge must be the fracture energy that the engine is
    /// given, which grows with the speed as Forte, D'Amico, Charalambides, Dini and Williams (2015) measured. Reference:
    /// this fracture energy. No measured force is compared.
    Wire,
    /// A tapered panel bends and shears under a load on its edge, large with a Poisson's ratio of 0.3 and 0.49 and small
    /// with 1/3 and 0.49. Reference: published computations for Cook's membrane (deal.II, OpenGeoSys, CoFEA), and finite
    /// elements with nine nodes, computed for this project with a program that is not part of it.
    Cook,
    /// Cracks in stretched strips run slower than Rayleigh waves. Reference: the limit speed of dynamic fracture mechanics.
    CrackSpeed,
    /// The names of all experiments.
    List,
    /// The experiments that take some seconds each.
    Quick,
    /// All experiments.
    All,
}

/// Kind of a reference.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum Source {
    /// Values that others measured.
    Laboratory,
    /// Values that others computed, mostly with finite elements.
    PublishedComputation,
    /// Published formulas.
    Theory,
    /// Values that were computed for this project in another way than by the engine.
    SecondComputation,
    /// Constants that the engine is given.
    Input,
}

impl Source {
    fn name(self) -> &'static str {
        match self {
            Self::Laboratory => "laboratory",
            Self::PublishedComputation => "published computation",
            Self::Theory => "theory",
            Self::SecondComputation => "second computation",
            Self::Input => "input",
        }
    }
}

impl Suite for Which {
    const ALL: Self = Self::All;
    const QUICK: Self = Self::Quick;
    // Experiments that take more than some five seconds on two cores.
    const LONG: &'static [Self] = &[
        Self::DragonSkin,
        Self::Ring,
        Self::GelLayer,
        Self::Balloon,
        Self::HalfSpace,
        Self::Sphere,
        Self::Fracture,
        Self::Strength,
        Self::Wire,
    ];
}

impl Which {
    /// Returns the kinds of the references of an experiment.
    fn sources(self) -> &'static [Source] {
        match self {
            Self::DragonSkin => &[Source::Laboratory],
            Self::TurekHron => &[Source::PublishedComputation],
            Self::Uniaxial | Self::Biaxial => &[Source::Laboratory, Source::SecondComputation],
            Self::Cook => &[Source::PublishedComputation, Source::SecondComputation],
            Self::Balloon => &[Source::SecondComputation],
            Self::Strength => &[Source::Theory, Source::Input],
            Self::Wire => &[Source::Input],
            Self::GelLayer | Self::Sphere | Self::TruthCube | Self::Fracture => {
                &[Source::Theory, Source::SecondComputation]
            }
            Self::Elastica
            | Self::Greenhill
            | Self::Ring
            | Self::HalfSpace
            | Self::HangingBar
            | Self::CrackSpeed => &[Source::Theory],
            Self::List | Self::Quick | Self::All => &[],
        }
    }
}

type Experiment = fn(&Progress) -> Result<Record>;

/// All experiments, in the order of their output.
const EXPERIMENTS: [(Which, Experiment); 18] = [
    (Which::DragonSkin, dragon_skin::run),
    (Which::TurekHron, |progress| {
        of_check(check::turek_hron::check, 8, progress)
    }),
    (Which::Elastica, |progress| {
        of_check(check::elastica::check, 4, progress)
    }),
    (Which::Greenhill, |progress| {
        of_check(check::greenhill::check, 4, progress)
    }),
    (Which::Ring, |progress| {
        let mut record = of_check(check::ring::check, 8, progress)?;
        record.set_voxels("16 voxels", 16);
        Ok(record)
    }),
    (Which::GelLayer, gel_layer::run),
    (Which::Balloon, balloon::run),
    (Which::HalfSpace, half_space::run),
    (Which::HangingBar, hanging_bar::run),
    (Which::Sphere, sphere::experiment),
    (Which::TruthCube, truth_cube::experiment),
    (Which::Uniaxial, uniaxial::experiment),
    (Which::Biaxial, biaxial::experiment),
    (Which::Fracture, fracture::run),
    (Which::Strength, strength::run),
    (Which::Wire, wire::run),
    (Which::Cook, cook::run),
    (Which::CrackSpeed, crack_speed::run),
];

/// Introduction of the report.
const PAGE: Page = Page {
    title: "Experiments",
    about: "What `fuwafuwa experiment` computes, beside references. A program wrote this page:\n\
            `cargo run --release --package fuwafuwa_cli -- experiment all --report docs/experiments.md`. `cargo xtask test`\n\
            compares the quick experiments with new results.\n\n\
            The references are of five kinds. *Laboratory*: measured by others. *Published computation*: computed by others,\n\
            mostly with finite elements. *Theory*: published formulas. *Second computation*: computed for this project in\n\
            another way than by the engine. *Input*: a constant that the engine is given and must reproduce.\n\n\
            In a *calibration*, constants of the material are fitted to the reference; it does not count as passed. A\n\
            *prediction* uses constants that were fitted to other values. All other rows are *verifications*: they follow from\n\
            given constants. In pictures, points are computed and lines are references.",
    kind: "experiment",
    value: "computed",
    command: "experiment",
};

/// Results of an experiment.
#[derive(Clone, Debug, Default)]
pub struct Record {
    /// Reference values and computed values.
    pub rows: Vec<Row>,
    /// Plots with computed points and curves of the references.
    pub plots: Vec<Plot>,
}

/// Reference value beside that of the engine.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name of the experiment and the quantity with its unit.
    pub case: String,
    /// Origin of the constants.
    pub role: Role,
    /// Value of the reference; `None` if there is only a bound, or nothing to compare with.
    pub reference: Option<f64>,
    /// Half the range of the reference, for example between two measured runs; `None` if it is not known.
    pub spread: Option<f64>,
    /// Value of the engine.
    pub computed: f64,
    /// Allowed values.
    pub bound: Bound,
    /// Discretisation.
    pub setup: Setup,
}

/// Allowed values of the engine.
#[derive(Copy, Clone, Debug, Serialize)]
pub enum Bound {
    /// Largest deviation from the reference, as a share of it.
    Relative(f64),
    /// Smallest and largest value; infinite if there is no limit on a side.
    Within(f64, f64),
    /// Smallest and largest value of a row that is known to miss them. The row is marked as missed, without failing the
    /// run.
    Missed(f64, f64),
    /// None: the row is for comparison.
    None,
}

/// Origin of the constants of a row.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize)]
pub enum Role {
    /// Constants are fitted to the reference.
    Calibration,
    /// The value follows from constants that were fitted to other values.
    Prediction,
    /// The value follows from given constants.
    Verification,
}

/// Discretisation of a row.
#[derive(Copy, Clone, Debug, Default, Serialize)]
pub struct Setup {
    /// Voxels across the shortest side of the body.
    pub n: usize,
    /// Substeps in 1/60 s; `None` if they differ within the row.
    pub substeps: Option<u32>,
    /// Computing time [s] of the simulation.
    pub seconds: f64,
}

/// Returns the record of a check whose bodies have `n` voxels across. The computing time is that of the whole check.
fn of_check(
    check: fn(&Progress) -> Result<Findings>,
    n: usize,
    progress: &Progress,
) -> Result<Record> {
    let start = Instant::now();
    let findings = check(progress)?;
    let setup = Setup {
        n,
        substeps: None,
        seconds: start.elapsed().as_secs_f64(),
    };
    let row = |outcome: Outcome| Row {
        bound: match (outcome.low, outcome.high) {
            (None, None) => Bound::None,
            (low, high) => Bound::Within(
                low.unwrap_or(f64::NEG_INFINITY),
                high.unwrap_or(f64::INFINITY),
            ),
        },
        case: outcome.case,
        role: Role::Verification,
        reference: outcome.reference,
        spread: None,
        computed: outcome.value,
        setup,
    };
    Ok(Record {
        rows: findings.outcomes.into_iter().map(row).collect(),
        plots: findings.plots,
    })
}

impl Record {
    /// Sets the number of voxels across of the rows whose case contains a text.
    fn set_voxels(&mut self, part: &str, n: usize) {
        let rows = self.rows.iter_mut();
        let rows = rows.filter(|row| row.case.contains(part));
        rows.for_each(|row| row.setup.n = n);
    }
}

impl Bound {
    /// Returns the smallest and the largest allowed value; `None` if there is no bound.
    fn range(self, reference: Option<f64>) -> Option<(f64, f64)> {
        match self {
            Self::Relative(share) => {
                let reference = reference.unwrap_or(f64::NAN);
                let half = share * reference.abs();
                Some((reference - half, reference + half))
            }
            Self::Within(low, high) | Self::Missed(low, high) => Some((low, high)),
            Self::None => None,
        }
    }
}

impl Row {
    /// Returns the outcome for the report, which contains no computing time.
    fn outcome(&self) -> Outcome {
        let Setup { n, substeps, .. } = self.setup;
        let role = match self.role {
            Role::Calibration => "calibration, ",
            Role::Prediction => "prediction, ",
            Role::Verification => "",
        };
        let spread = self.spread.map_or(String::new(), |spread| {
            format!(", reference ± {}", digits(spread))
        });
        let substeps = substeps.map_or(String::new(), |count| format!(", {count} substeps"));
        let case = format!("{} ({role}n = {n}{substeps}{spread})", self.case);
        let outcome = match (self.bound, self.reference) {
            (Bound::Relative(share), Some(reference)) => {
                Outcome::relative(case, self.computed, reference, share)
            }
            (bound, reference) => match bound.range(reference) {
                Some((low, high)) => Outcome::within(case, self.computed, low..=high),
                None => Outcome::shown(case, self.computed),
            },
        };
        let is_missed = matches!(self.bound, Bound::Missed(..)) && outcome.pass == Some(false);
        Outcome {
            reference: self.reference,
            pass: outcome.pass.filter(|_| !is_missed),
            standing: match self.role {
                _ if is_missed => Standing::KnownMiss,
                Role::Calibration => Standing::Calibration,
                Role::Prediction | Role::Verification => Standing::Test,
            },
            ..outcome
        }
    }

    /// Returns the columns of the table.
    fn columns(&self) -> Vec<String> {
        let error = self.reference.filter(|reference| *reference != 0.0);
        let error = error.map_or(String::new(), |reference| {
            format!("{:+.1} %", 100.0 * (self.computed / reference - 1.0))
        });
        let bound = match self.bound {
            Bound::Relative(share) => format!("± {} %", digits(100.0 * share)),
            Bound::Within(f64::NEG_INFINITY, high) => format!("<= {}", digits(high)),
            Bound::Within(low, f64::INFINITY) => format!(">= {}", digits(low)),
            Bound::Within(low, high) | Bound::Missed(low, high) => {
                format!("{} to {}", digits(low), digits(high))
            }
            Bound::None => "for comparison".into(),
        };
        let outcome = self.outcome();
        let verdict = match (outcome.pass, outcome.standing) {
            (Some(true), _) => "pass",
            (Some(false), _) => "FAIL",
            (None, Standing::KnownMiss) => "missed",
            (None, _) => "-",
        };
        let Setup {
            n,
            substeps,
            seconds,
        } = self.setup;
        vec![
            self.case.clone(),
            format!("{:?}", self.role).to_lowercase(),
            self.reference.map_or("–".into(), digits),
            self.spread.map_or(String::new(), digits),
            digits(self.computed),
            error,
            bound,
            n.to_string(),
            substeps.map_or("–".into(), |count| count.to_string()),
            format!("{seconds:.1}"),
            verdict.into(),
        ]
    }
}

/// Runs the experiments and prints their results.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    if arguments.which == Which::List {
        output::print(&list())?;
        return Ok(ExitCode::SUCCESS);
    }
    let chosen: Vec<(Which, Experiment)> = EXPERIMENTS
        .into_iter()
        .filter(|(which, _)| arguments.which.includes(which))
        .collect();
    if let Some(path) = &arguments.report {
        arguments
            .which
            .check_report(path, &PAGE, arguments.compare)?;
    }
    if let Some(folder) = &arguments.csv {
        check_output(&folder.join("curves.csv"))?;
    }
    let progress = Progress::new();
    let experiments: Vec<Experiment> = chosen.iter().map(|(_, run)| *run).collect();
    let mut records: Vec<(Which, Record)> = Vec::new();
    let work = |index: usize| experiments[index](&progress);
    run_all(chosen.len(), work, &progress, |index, record| {
        if !arguments.json {
            let gap = if records.is_empty() { "" } else { "\n" };
            let table = table(&record.rows);
            progress.suspend(|| output::print(&format!("{gap}{table}")))?;
        }
        records.push((chosen[index].0, record));
        Ok(())
    })?;
    drop(progress);
    if arguments.json {
        let rows = records.iter().flat_map(|(_, record)| &record.rows);
        report::print_json(&rows.collect::<Vec<&Row>>())?;
    }
    if let Some(folder) = &arguments.csv {
        write_csv(folder, &records)?;
    }
    let sections: Vec<Section> = records.into_iter().map(section).collect();
    let mut outcomes = sections
        .iter()
        .flat_map(|section| &section.findings.outcomes);
    let mut failed = outcomes.any(|outcome| outcome.pass == Some(false));
    if let Some(path) = &arguments.report {
        let is_complete = arguments.which == Which::All;
        failed |= validation::report(path, &PAGE, &sections, is_complete, arguments.compare)?;
    }
    Ok(ExitCode::from(u8::from(failed)))
}

/// Returns the section of the report for an experiment.
fn section((which, record): (Which, Record)) -> Section {
    let sources: Vec<&str> = which.sources().iter().map(|one| one.name()).collect();
    let findings = Findings {
        outcomes: record.rows.iter().map(Row::outcome).collect(),
        plots: record.plots,
    };
    Section {
        sources: Some(sources.join(", ")),
        ..which.section(findings)
    }
}

/// Returns the names of all experiments with the kinds of their references, as a table.
fn list() -> String {
    let mut lines = vec![["experiment", "reference"].map(String::from).to_vec()];
    for (which, _) in EXPERIMENTS {
        let sources: Vec<&str> = which.sources().iter().map(|one| one.name()).collect();
        lines.push(vec![which.name(), sources.join(", ")]);
    }
    for which in [Which::Quick, Which::All] {
        lines.push(vec![which.name(), which.about()]);
    }
    report::table(&lines, &[false, false])
}

/// Formats rows as a table.
fn table(rows: &[Row]) -> String {
    let head = [
        "experiment",
        "role",
        "reference",
        "±",
        "computed",
        "error",
        "bound",
        "n",
        "substeps",
        "time [s]",
        "",
    ];
    let mut lines = vec![head.map(String::from).to_vec()];
    lines.extend(rows.iter().map(Row::columns));
    let right = [
        false, false, true, true, true, true, false, true, true, true, false,
    ];
    report::table(&lines, &right)
}

/// Writes a CSV file for each plot. Experiments without a plot are named on stderr.
fn write_csv(folder: &Path, records: &[(Which, Record)]) -> Result<()> {
    for (which, record) in records {
        if record.plots.is_empty() {
            output::warn(format_args!(
                "note: {} has no curves, so no CSV file is written",
                which.name()
            ));
        }
    }
    validation::write(&csv_files(folder, records))?;
    // Removes the folder if it is empty.
    let _ = fs::remove_dir(folder);
    Ok(())
}

/// Returns a CSV file for each plot: whether a point is of the reference or computed, name of the curve or of the points,
/// x and y.
fn csv_files(folder: &Path, records: &[(Which, Record)]) -> Vec<ReportFile> {
    let mut files = Vec::new();
    for (which, record) in records {
        for (index, plot) in record.plots.iter().enumerate() {
            let mut text = format!("kind,series,\"{}\",\"{}\"\n", plot.x, plot.y);
            let curves =
                { plot.curves.iter() }.map(|curve| ("reference", &curve.name, &curve.points));
            let points =
                { plot.points.iter() }.map(|points| ("computed", &points.name, &points.points));
            for (kind, name, series) in curves.chain(points) {
                for (x, y) in series {
                    text += &format!("{kind},\"{}\",{x},{y}\n", name.replace('"', "\"\""));
                }
            }
            let path = folder.join(format!("{}-{}.csv", which.name(), index + 1));
            files.push(ReportFile { path, text });
        }
    }
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(role: Role, bound: Bound) -> Row {
        Row {
            case: "swing".into(),
            role,
            reference: Some(1.0),
            spread: None,
            computed: 0.74,
            bound,
            setup: Setup::default(),
        }
    }

    #[test]
    fn check_with_limits_and_without_references_keeps_its_verdicts() {
        let check = |_: &Progress| {
            let case = || "pile".to_owned();
            Ok(Findings::from(vec![
                Outcome::within(case(), 3.0, 0.0..=2.0),
                Outcome::at_most(case(), 3.0, 2.0),
                Outcome::at_most(case(), f64::NAN, 2.0),
                Outcome::within(case(), 3.0, 4.0..=f64::INFINITY),
                Outcome::at_most(case(), 1.0, 2.0),
                Outcome::relative(case(), 1.0, 1.0, 0.1),
                Outcome::shown(case(), 1.0),
            ]))
        };
        let record = of_check(check, 4, &Progress::new()).unwrap();
        let found: Vec<Option<bool>> = { record.rows.iter() }
            .map(|row| row.outcome().pass)
            .collect();
        let [no, yes] = [Some(false), Some(true)];
        assert_eq!(found, [no, no, no, no, yes, yes, None]);
    }

    #[test]
    fn number_of_voxels_is_set_by_the_text_of_the_case() {
        let check = |_: &Progress| {
            let case = |n| format!("ring, {n} voxels thick");
            Ok(Findings::from(vec![
                Outcome::shown(case(8), 1.0),
                Outcome::shown(case(16), 1.0),
            ]))
        };
        let mut record = of_check(check, 8, &Progress::new()).unwrap();
        record.set_voxels("16 voxels", 16);
        let found: Vec<usize> = record.rows.iter().map(|row| row.setup.n).collect();
        assert_eq!(found, [8, 16]);
    }

    #[test]
    fn known_miss_does_not_fail_and_passes_inside_of_its_bound() {
        let missed = row(Role::Prediction, Bound::Missed(0.9, 1.1)).outcome();
        assert_eq!((missed.pass, missed.standing), (None, Standing::KnownMiss));
        let kept = row(Role::Prediction, Bound::Missed(0.5, 1.1)).outcome();
        assert_eq!((kept.pass, kept.standing), (Some(true), Standing::Test));
        let failed = row(Role::Prediction, Bound::Within(0.9, 1.1)).outcome();
        assert_eq!(failed.pass, Some(false));
    }

    #[test]
    fn calibration_is_marked() {
        let outcome = row(Role::Calibration, Bound::Relative(0.5)).outcome();
        assert_eq!(outcome.standing, Standing::Calibration);
        assert!(outcome.case.contains("calibration"));
    }

    #[test]
    fn csv_file_tells_reference_and_computed_points_apart() {
        use crate::plot::{Curve, Points};
        let record = Record {
            rows: Vec::new(),
            plots: vec![Plot {
                curves: vec![Curve::new([(1.0, 2.0)]).named("rubber")],
                points: vec![Points::new("rubber", [(1.0, 2.5)])],
                ..Plot::default()
            }],
        };
        let files = csv_files(Path::new("out"), &[(Which::Uniaxial, record)]);
        let lines: Vec<&str> = files[0].text.lines().skip(1).collect();
        assert_eq!(
            lines,
            ["reference,\"rubber\",1,2", "computed,\"rubber\",1,2.5"]
        );
    }

    #[test]
    fn each_experiment_is_listed_with_the_kind_of_its_reference() {
        let text = list();
        for (which, _) in EXPERIMENTS {
            assert!(text.contains(&which.name()) && !which.sources().is_empty());
        }
    }
}

//! Published experiments, rebuilt: measured values beside those of the engine.
//!
//! Each experiment is a module with a function that returns its [`Record`]. A row of a record is a calibration, which
//! fits one constant to one measured value, or a prediction, which uses that constant; see [`Role`].

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
use crate::report::{self, Findings, Outcome, Progress, digits};
use crate::validation::{self, Page, ReportFile, Section};
use anyhow::{Context, Result, ensure};
use clap::ValueEnum;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Rebuild published experiments and compare the results. The exit code is 1 if a result misses its bound.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Experiment to run. All together take up to ten minutes on two cores.
    #[arg(value_enum)]
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
    /// Write the curves and points of each picture as CSV files into a folder.
    #[arg(long, value_name = "FOLDER")]
    csv: Option<PathBuf>,
}

#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
enum Which {
    /// A beam of silicone rubber with a weight at its tip is released from straight and swings until it rests. The runs with
    /// 52 g calibrate the material. Rows without a bound miss the measurement: it calls for a dynamic stiffness that falls
    /// with the frequency. Reference: motion capture of Dubied et al. (2022), arXiv 2201.12560.
    DragonSkin,
    /// An elastic bar behind a cylinder bends and oscillates. Reference: the cases CSM1 to CSM3 of Turek and Hron (2006),
    /// finite elements.
    TurekHron,
    /// Clamped bars bend under a tip load or their own weight. Reference: Bisshopp and Drucker (1945), and the equation
    /// of the elastica.
    Elastica,
    /// A column buckles under its own weight. Reference: Greenhill (1881).
    Greenhill,
    /// A ring is pinched between two points. Reference: the equation of the elastica.
    Ring,
    /// A layer of gel hangs under a dish, and its surface becomes unstable at a critical weight. Reference: Mora
    /// et al. (2014), and the theory of small ripples.
    GelLayer,
    /// A tube and a balloon of rubber are inflated. Reference: exact solutions of neo-Hookean bodies, Green and Zerna (1954).
    Balloon,
    /// A force presses on a point of a half-space. Reference: Boussinesq (1885).
    HalfSpace,
    /// A bar hangs under its own weight. Reference: exact solution, Timoshenko and Goodier.
    HangingBar,
    /// A ball is pressed between plates, a rigid ball is pressed into a half-space, and a soft ball hits a floor.
    /// Reference: finite elements, Sneddon (1965) and Hertz (1882).
    Sphere,
    /// A cube of soft silicone is compressed between plates, with slip and with bonded ends. Reference: the compressions
    /// of the Truth Cube of Kerdok et al. (2003), with forces of the neo-Hookean law and of Gent and Lindley (1959). The
    /// measured displacements of the beads were not available.
    TruthCube,
    /// Silicones and rubber are stretched along one axis, with Yeoh laws fitted to their curves, and a clamped strip.
    /// Reference: curves measured by Marechal et al. (2020) and Treloar (1944).
    Uniaxial,
    /// Rubber is stretched along two axes, with laws fitted to uniaxial tension alone, which mostly give too little stress
    /// because they ignore the second invariant, and to all tests. Reference: curves measured by Treloar (1944) and
    /// Kawabata et al. (1981).
    Biaxial,
    /// Cracks begin to grow in a strip in pure shear, a notched bar and a double cantilever beam. Reference: energy release
    /// and stress intensity of the challenge set of Kamarei, Zeng, Dolbow and Lopez-Pamies (2026).
    Fracture,
    /// A poker chip cracks inside, and a twisted tube at its shear strength. Reference: the strength surface of Kumar,
    /// Bourdin, Francfort and Lopez-Pamies (2020), and the challenge set of Kamarei, Zeng, Dolbow and Lopez-Pamies (2026).
    Strength,
    /// An edge cuts gelatine at three speeds. Reference: the fracture energy of Forte, D'Amico, Charalambides, Dini and
    /// Williams (2015).
    Wire,
    /// A tapered panel bends and shears under a load on its edge, with a Poisson's ratio of 0.3 and of 0.49. Reference: the
    /// examples of deal.II and OpenGeoSys for Cook's membrane, and finite elements with nine nodes.
    Cook,
    /// Cracks in stretched strips run slower than Rayleigh waves. Reference: the limit speed of dynamic fracture mechanics.
    CrackSpeed,
    /// The experiments that take some seconds each.
    Quick,
    /// All experiments.
    All,
}

/// Experiments that take more than some five seconds on two cores, which [`Which::Quick`] leaves out.
const LONG: [Which; 9] = [
    Which::DragonSkin,
    Which::Ring,
    Which::GelLayer,
    Which::Balloon,
    Which::HalfSpace,
    Which::Sphere,
    Which::Fracture,
    Which::Strength,
    Which::Wire,
];

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
        of_check(check::ring::check, 8, progress)
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
    about: "What `fuwafuwa experiment` measures, beside published experiments and exact solutions. A program wrote this page:\n\
            `cargo run --release --package fuwafuwa_cli -- experiment all --report docs/experiments.md`. `cargo xtask test`\n\
            compares the quick experiments with new measurements.\n\n\
            A *calibration* fits one constant of the material to one measured value; a *prediction* uses that constant.\n\
            *Theory* needs no constant. Pictures show the results of the engine as points upon the published curves.",
    kind: "experiment",
};

/// Results of an experiment.
#[derive(Clone, Debug, Default)]
pub struct Record {
    /// Published and computed values.
    pub rows: Vec<Row>,
    /// Plots of computed points upon published curves.
    pub plots: Vec<Plot>,
}

/// Published value beside that of the engine.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name of the experiment and the quantity with its unit.
    pub case: String,
    /// Origin of the constants.
    pub role: Role,
    /// Published value.
    pub published: f64,
    /// Half the range of the published values, for example between two runs; `None` if it is not known.
    pub spread: Option<f64>,
    /// Value of the engine.
    pub ours: f64,
    /// Greatest allowed deviation.
    pub bound: Bound,
    /// Discretisation.
    pub setup: Setup,
}

/// Greatest allowed deviation from a published value.
#[derive(Copy, Clone, Debug, Serialize)]
pub enum Bound {
    /// Share of the published value.
    Relative(f64),
    /// Range of the value of the engine.
    Within(f64, f64),
    /// None: the row is for comparison.
    None,
}

/// Origin of the constants of a row.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize)]
pub enum Role {
    /// One constant is fitted to this value.
    Calibration,
    /// The value follows from constants that were fitted to other values.
    Prediction,
    /// The value follows from the given constants.
    Theory,
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
    let row = |outcome: Outcome| {
        let published = outcome.reference?;
        let bound = match (outcome.low, outcome.high) {
            (Some(low), Some(high)) => Bound::Within(low, high),
            _ => Bound::None,
        };
        Some(Row {
            case: outcome.case,
            role: Role::Theory,
            published,
            spread: None,
            ours: outcome.value,
            bound,
            setup,
        })
    };
    Ok(Record {
        rows: findings.outcomes.into_iter().filter_map(row).collect(),
        plots: findings.plots,
    })
}

impl Row {
    /// Returns the outcome for the report, which contains no computing time.
    fn outcome(&self) -> Outcome {
        let Setup { n, substeps, .. } = self.setup;
        let role = match self.role {
            Role::Calibration => "calibration, ",
            Role::Prediction => "prediction, ",
            Role::Theory => "",
        };
        let spread = self.spread.map_or(String::new(), |spread| {
            format!(", published ± {}", digits(spread))
        });
        let substeps = substeps.map_or(String::new(), |count| format!(", {count} substeps"));
        let case = format!("{} ({role}n = {n}{substeps}{spread})", self.case);
        let shown = Outcome::shown(case.clone(), self.ours);
        let shown = Outcome {
            reference: Some(self.published),
            ..shown
        };
        match self.bound {
            Bound::Relative(share) => Outcome::relative(case, self.ours, self.published, share),
            Bound::Within(low, high) => Outcome {
                reference: Some(self.published),
                ..Outcome::within(case, self.ours, low..=high)
            },
            Bound::None => shown,
        }
    }

    /// Returns the columns of the table.
    fn columns(&self) -> Vec<String> {
        let error = match self.published == 0.0 {
            true => String::new(),
            false => format!("{:+.1} %", 100.0 * (self.ours / self.published - 1.0)),
        };
        let bound = match self.bound {
            Bound::Relative(share) => format!("± {} %", digits(100.0 * share)),
            Bound::Within(low, high) => format!("{} to {}", digits(low), digits(high)),
            Bound::None => "for comparison".into(),
        };
        let verdict = match self.outcome().pass {
            Some(true) => "pass",
            Some(false) => "FAIL",
            None => "-",
        };
        let Setup {
            n,
            substeps,
            seconds,
        } = self.setup;
        vec![
            self.case.clone(),
            format!("{:?}", self.role).to_lowercase(),
            digits(self.published),
            self.spread.map_or(String::new(), digits),
            digits(self.ours),
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
    let chosen: Vec<(Which, Experiment)> = EXPERIMENTS
        .into_iter()
        .filter(|(which, _)| arguments.which.contains(*which))
        .collect();
    if let Some(path) = &arguments.report {
        ensure!(
            arguments.which == Which::All || arguments.compare,
            "writing a report needs `experiment all`: it has a section for each experiment. With --compare, any \
             experiment is possible"
        );
        output::check_folder(path).with_context(|| path.display().to_string())?;
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
        validation::write(&csv_files(folder, &records))?;
    }
    let sections: Vec<Section> = records.into_iter().map(Which::section).collect();
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

impl Which {
    /// Returns whether the choice of this experiment includes an experiment.
    fn contains(self, experiment: Self) -> bool {
        match self {
            Self::All => true,
            Self::Quick => !LONG.contains(&experiment),
            _ => self == experiment,
        }
    }

    fn name(self) -> String {
        let value = self.to_possible_value();
        value.map_or(String::new(), |value| value.get_name().to_owned())
    }

    /// Returns the section of the report for an experiment.
    fn section((which, record): (Self, Record)) -> Section {
        let value = which.to_possible_value();
        let about = value.as_ref().and_then(|value| value.get_help());
        Section {
            name: which.name(),
            // The command line strips the full stop at the end.
            about: about.map_or(String::new(), |about| format!("{about}.")),
            findings: Findings {
                outcomes: record.rows.iter().map(Row::outcome).collect(),
                plots: record.plots,
            },
        }
    }
}

/// Formats rows as a table.
fn table(rows: &[Row]) -> String {
    let head = [
        "experiment",
        "role",
        "published",
        "±",
        "ours",
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

/// Returns a CSV file for each plot: name of the curve or of the points, x and y.
fn csv_files(folder: &Path, records: &[(Which, Record)]) -> Vec<ReportFile> {
    let mut files = Vec::new();
    for (which, record) in records {
        for (index, plot) in record.plots.iter().enumerate() {
            let mut text = format!("series,\"{}\",\"{}\"\n", plot.x, plot.y);
            let curves = plot.curves.iter().map(|curve| (&curve.name, &curve.points));
            let points = plot
                .points
                .iter()
                .map(|points| (&points.name, &points.points));
            for (name, series) in curves.chain(points) {
                for (x, y) in series {
                    text += &format!("\"{}\",{x},{y}\n", name.replace('"', "\"\""));
                }
            }
            let path = folder.join(format!("{}-{}.csv", which.name(), index + 1));
            files.push(ReportFile { path, text });
        }
    }
    files
}

//! Procedures without a window: an automatic trainee, or a replay of a recording.

use crate::loading::{LoadRequest, Loaded, load};
use crate::measures::parts;
use crate::procedure::Procedure;
use crate::record::{Playback, Recording};
use crate::report;
use crate::save::write;
use crate::trainee::Trainee;
use cpu_time::ThreadTime;
use fuwafuwa::DEFAULT_TICK;
use indicatif::{ProgressBar, ProgressStyle};
use std::path::PathBuf;
use std::time::Instant;

/// Options of a procedure without a window.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// Seed of the automatic trainee
    #[arg(long, default_value_t = 0, value_name = "NUMBER")]
    seed: u64,
    /// Maximum duration of the procedure, 0 to 3600
    #[arg(long, default_value_t = 60.0, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    seconds: f32,
    /// Write the recording to FILE
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// Write a table of all ticks to FILE (CSV)
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write plots to FILE (SVG)
    #[arg(long, value_name = "FILE")]
    plots: Option<PathBuf>,
    /// Print the processor time of ticks on this thread; set RAYON_NUM_THREADS=1 to include all of the work
    #[arg(long)]
    bench: bool,
}

/// Runs a procedure and prints a summary.
///
/// # Errors
/// A message if a file cannot be read or written, or if a replay differs from its recording.
pub fn operate(wanted: &LoadRequest, options: &Options) -> Result<(), String> {
    let bar = ProgressBar::new(1000);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {msg} {elapsed}") {
        bar.set_style(style);
    }
    bar.set_message("organ");
    let began = Instant::now();
    let mut progress = |done: f32| bar.set_position((1000.0 * done) as u64);
    let (loaded, warnings) = load(wanted, &mut progress).map_err(|error| error.to_string())?;
    let laid = began.elapsed().as_secs_f32();
    bar.set_message("procedure");
    for warning in warnings {
        bar.suspend(|| output::warn(format_args!("warning: {warning}")));
    }
    let mut costs = Vec::new();
    let procedure = match loaded {
        Loaded::Procedure(procedure) => by_itself(*procedure, options, &bar, &mut costs)?,
        Loaded::Playback(playback) => again(*playback, &bar, &mut costs)?,
    };
    bar.finish_and_clear();
    let pieces = parts(procedure.organ(), procedure.case().millilitres());
    let mut text = report::summary(&procedure, &pieces);
    if options.bench {
        text += &format!("\n{}", told(&procedure, laid, costs));
    }
    if let Some(path) = &options.save {
        write(path, &Recording::of(&procedure).bytes())?;
    }
    if let Some(path) = &options.csv {
        write(path, report::csv(procedure.samples()).as_bytes())?;
    }
    if let Some(path) = &options.plots {
        let plots = report::svg(procedure.samples()).map_err(|error| error.to_string())?;
        write(path, plots.as_bytes())?;
    }
    output::print(&(text + "\n")).map_err(|error| error.to_string())
}

fn by_itself(
    mut procedure: Procedure,
    options: &Options,
    bar: &ProgressBar,
    costs: &mut Vec<f64>,
) -> Result<Procedure, String> {
    let trainee = Trainee::new(&procedure, options.seed);
    let most = (options.seconds / DEFAULT_TICK) as usize;
    let ticks = trainee.ticks().min(most);
    for tick in 0..ticks {
        bar.set_position((1000 * tick / ticks) as u64);
        let began = ThreadTime::now();
        procedure
            .step(trainee.input(tick))
            .map_err(|error| error.to_string())?;
        costs.push(began.elapsed().as_secs_f64());
    }
    Ok(procedure)
}

fn again(
    mut playback: Playback,
    bar: &ProgressBar,
    costs: &mut Vec<f64>,
) -> Result<Procedure, String> {
    let ticks = playback.recording().ticks();
    while !playback.is_over() {
        bar.set_position((1000 * playback.procedure().ticks() / ticks) as u64);
        let began = ThreadTime::now();
        playback.step().map_err(|error| error.to_string())?;
        costs.push(began.elapsed().as_secs_f64());
    }
    bar.suspend(|| output::warn("the replay is identical to the recording, bit for bit"));
    Ok(playback.into_procedure())
}

/// Parses the duration of a procedure [s].
fn seconds(text: &str) -> Result<f32, String> {
    let seconds: Option<f32> = text.parse().ok();
    seconds
        .filter(|seconds| (0.0..=3600.0).contains(seconds))
        .ok_or_else(|| "expected 0 to 3600 seconds".into())
}

/// Summarizes the loading time `laid`, and the processor times of all ticks except the first.
fn told(procedure: &Procedure, laid: f32, mut costs: Vec<f64>) -> String {
    costs = costs.split_off(costs.len().min(1));
    costs.sort_by(f64::total_cmp);
    let at = |share| 1e3 * output::quantile(&costs, share).unwrap_or(0.0);
    let late = costs
        .iter()
        .filter(|cost| **cost > f64::from(DEFAULT_TICK))
        .count();
    format!(
        "{} elements, loaded in {laid:.1} s; processor time of {} ticks, without the first: median {:.1} ms, 99th percentile {:.1} ms, \
         maximum {:.1} ms, {late} longer than {:.1} ms",
        procedure.organ().mesh().element_count(),
        costs.len(),
        at(0.5),
        at(0.99),
        at(1.0),
        1e3 * DEFAULT_TICK,
    )
}

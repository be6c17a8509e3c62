//! Output of results: aligned tables, outcomes of checks, a progress bar.

use crate::plot::Plot;
use anyhow::Result;
use fuwafuwa::{Dim, SoftBody, StiffBodies, World};
use fuwafuwa_scenes::Scene;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;
use std::ops::RangeInclusive;
use std::time::{Duration, Instant};

/// Running time of a command after which its progress bar appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// Prints notes on the pictures and models of a scene to stderr.
pub fn notes(scene: &Scene) {
    for note in scene.notes() {
        output::warn(format_args!("note: {note}"));
    }
}

/// Returns the number of soft bodies with scaled mass or stiffness, and the largest scale of a soft body, 1 if none
/// is scaled.
pub fn scales<D: Dim>(world: &World<D>) -> (u32, f64) {
    let scale = |body: &SoftBody<D>| body.mass_scale() / body.stiffness_scale();
    let scales = world.soft_bodies().map(|(_, body)| scale(body));
    scales.fold((0, 1.0), |(count, largest), scale| {
        (count + u32::from(scale > 1.0), scale.max(largest))
    })
}

/// Prints a warning to stderr if soft bodies are scaled, because they require more substeps than the world allows.
pub fn warn_of_scales<D: Dim>(world: &World<D>) {
    let (count, largest) = scales(world);
    if count == 0 {
        return;
    }
    let what = match world.config().stiff_bodies {
        StiffBodies::Softened => "their stiffness is divided",
        StiffBodies::MassScaled | StiffBodies::Exact => {
            "the inertia of their deformation is multiplied"
        }
    };
    output::warn(format!(
        "{count} soft bodies require more substeps than {}: {what} by up to {largest:.3}",
        world.substeps()
    ));
}

/// Results of a check.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// Measured values with their requirements.
    pub outcomes: Vec<Outcome>,
    /// Plots of measured values upon curves of a reference; empty if the check traces no curve.
    pub plots: Vec<Plot>,
}

impl From<Vec<Outcome>> for Findings {
    fn from(outcomes: Vec<Outcome>) -> Self {
        Self {
            outcomes,
            plots: Vec::new(),
        }
    }
}

/// Outcome of a check for one measured value.
#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    /// Name of the check and its case.
    pub case: String,
    /// Measured value.
    pub value: f64,
    /// Requirement on the measured value, as text.
    pub wanted: String,
    /// Value of theory or of another reference; `None` if there is only a range or a limit.
    pub reference: Option<f64>,
    /// Smallest allowed value; `None` if there is no lower bound.
    pub low: Option<f64>,
    /// Largest allowed value; `None` if there is no upper bound.
    pub high: Option<f64>,
    /// Whether the value meets the requirement; `None` if it is shown for comparison only.
    pub pass: Option<bool>,
    /// Part of the outcome in the summary of a report.
    #[serde(skip)]
    pub standing: Standing,
}

/// Part of an outcome in the summary of a report.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum Standing {
    /// The outcome tests the engine.
    #[default]
    Test,
    /// Constants are fitted to the reference.
    Calibration,
    /// The value is known to lie outside of its bound, which does not fail the run.
    KnownMiss,
}

impl Outcome {
    /// Creates an outcome that passes if the value differs from `ideal` by at most `tolerance`.
    pub fn near(case: String, value: f64, ideal: f64, tolerance: f64) -> Self {
        Self {
            reference: Some(ideal),
            low: Some(ideal - tolerance),
            high: Some(ideal + tolerance),
            pass: Some((value - ideal).abs() <= tolerance),
            ..Self::shown(case, value).wanting(format!("{} +- {tolerance}", digits(ideal)))
        }
    }

    /// Creates an outcome that passes if the value differs from `reference` by at most the share `tolerance` of it.
    pub fn relative(case: String, value: f64, reference: f64, tolerance: f64) -> Self {
        let wanted = format!("{} +- {} %", digits(reference), 100.0 * tolerance);
        Self {
            wanted,
            ..Self::near(case, value, reference, tolerance * reference.abs())
        }
    }

    /// Creates an outcome that passes if the value lies in a range.
    pub fn within(case: String, value: f64, range: RangeInclusive<f64>) -> Self {
        let wanted = format!("{} to {}", range.start(), range.end());
        Self {
            low: Some(*range.start()).filter(|low| low.is_finite()),
            high: Some(*range.end()).filter(|high| high.is_finite()),
            pass: Some(range.contains(&value)),
            ..Self::shown(case, value).wanting(wanted)
        }
    }

    /// Creates an outcome that passes if the value is at most `limit`; NaN fails.
    pub fn at_most(case: String, value: f64, limit: f64) -> Self {
        Self {
            high: Some(limit),
            pass: Some(value <= limit),
            ..Self::shown(case, value).wanting(format!("<= {limit:e}"))
        }
    }

    /// Creates an outcome without a requirement, shown for comparison.
    pub fn shown(case: String, value: f64) -> Self {
        Self {
            case,
            value,
            wanted: "for comparison".into(),
            reference: None,
            low: None,
            high: None,
            pass: None,
            standing: Standing::Test,
        }
    }

    /// Returns the deviation from the reference in units of the bound: from −1 to 1 if the value meets its requirement.
    /// Without a reference in the allowed range, the deviation is that from the middle of the range. With a limit on one
    /// side only, a passing value has a deviation from 0 to 1. `None` if there is no bound.
    pub fn deviation(&self) -> Option<f64> {
        let deviation = match (self.low, self.high) {
            (Some(low), Some(high)) => {
                let middle = 0.5 * (low + high);
                let inside = |reference: &f64| (low..=high).contains(reference);
                let zero = self.reference.filter(inside).unwrap_or(middle);
                let side = match self.value > zero && high > zero || zero == low {
                    true => high - zero,
                    false => zero - low,
                };
                (self.value - zero) / side
            }
            (None, Some(high)) => (self.value / high).max(0.0),
            (Some(low), None) => low / self.value,
            (None, None) => return None,
        };
        // A bound of 0 allows one value only.
        Some(match deviation.is_nan() {
            true if self.pass == Some(true) => 0.0,
            true => f64::INFINITY,
            false => deviation,
        })
    }

    fn wanting(self, wanted: String) -> Self {
        Self { wanted, ..self }
    }
}

/// Formats a number with at most four significant digits, without trailing zeros. Numbers below 0.001 and from
/// 100,000 on have an exponent.
pub fn digits(value: f64) -> String {
    let size = value.abs();
    let scientific = format!("{value:.3e}");
    let Ok(rounded) = scientific.parse::<f64>() else {
        return scientific;
    };
    if rounded == 0.0 || (1e-3..1e5).contains(&size) {
        return (rounded + 0.0).to_string();
    }
    format!("{rounded:e}")
}

/// Prints a value as JSON.
pub fn print_json(value: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value)? + "\n";
    Ok(output::print(&text)?)
}

/// Progress bar on standard error. It appears only after [`PATIENCE`].
pub struct Progress {
    start: Instant,
    bar: ProgressBar,
}

impl Progress {
    /// Creates a hidden bar and starts its timer.
    pub fn new() -> Self {
        let bar = ProgressBar::hidden();
        if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} {elapsed}") {
            bar.set_style(style);
        }
        Self {
            start: Instant::now(),
            bar,
        }
    }

    /// Adds to the total number of steps that the progress bar expects.
    pub fn expect(&self, steps: u64) {
        self.bar.inc_length(steps);
    }

    /// Reports a finished step.
    pub fn step(&self) {
        self.bar.inc(1);
        self.show_if_slow();
    }

    /// Hides the progress bar while `print` prints.
    pub fn suspend<Printed>(&self, print: impl FnOnce() -> Printed) -> Printed {
        self.bar.suspend(print)
    }

    /// Shows the progress bar if the command has run longer than [`PATIENCE`]. Cheap enough for inner loops.
    pub fn show_if_slow(&self) {
        if self.bar.is_hidden() && self.start.elapsed() > PATIENCE {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            self.bar.tick();
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Formats outcomes as a table.
pub fn outcome_table(outcomes: &[Outcome]) -> String {
    let mut rows = vec![["check", "value", "wanted", ""].map(String::from).to_vec()];
    for outcome in outcomes {
        let value = if outcome.value.abs() < 1e-3 {
            format!("{:.1e}", outcome.value)
        } else {
            format!("{:.4}", outcome.value)
        };
        let verdict = match outcome.pass {
            Some(true) => "pass",
            Some(false) => "FAIL",
            None => "-",
        };
        rows.push(vec![
            outcome.case.clone(),
            value,
            outcome.wanted.clone(),
            verdict.into(),
        ]);
    }
    table(&rows, &[false, true, false, false])
}

/// Formats rows with columns padded to their widest entry. `right` selects right-aligned columns.
pub fn table(rows: &[Vec<String>], right: &[bool]) -> String {
    let width = |column: usize| {
        let entries = rows.iter().filter_map(|row| row.get(column));
        entries
            .map(|entry| entry.chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<usize> = (0..right.len()).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for ((entry, &width), &right) in row.iter().zip(&widths).zip(right) {
            line += &if right {
                format!("{entry:>width$}  ")
            } else {
                format!("{entry:<width$}  ")
            };
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}

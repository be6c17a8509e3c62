//! Fit of a stress law to a measured curve.
//!
//! The material is incompressible. With the stretch λ, the first invariant I and μ/2 = C₁, the engineering stress is
//!
//! ```text
//! P = μ g(y) k(λ)       y = I − 3       g = 1 + 2 a y + 3 b y²,  constant beyond y = −a / 3b if b < 0
//!
//! uniaxial      k = λ − λ⁻²      I = λ² + 2/λ
//! equibiaxial   k = λ − λ⁻⁵      I = 2 λ² + λ⁻⁴
//! pure shear    k = λ − λ⁻³      I = λ² + 1 + λ⁻²
//! ```
//!
//! as [`StressLaw::Yeoh`] with `second` a and `third` b; a = b = 0 is the neo-Hookean law. The fit minimises the squares of
//! the deviations, each divided by |P| plus 3 % of the largest |P| of the test.
//!
//! Every Yeoh law is μ g = A + B (1 − y/Y)². For a given Y, the stress is linear in A and B, and the laws that the engine
//! accepts and under which the stress grows with the stretch form a cone: A, B = α ray + β ray, α and β at least 0. The
//! fit therefore solves a small linear problem for each of many Y, and refines the best.

mod curve;

pub use curve::parse;

use curve::Curve;

use crate::plot::{self, Plot, Points};
use crate::report;
use anyhow::{Context, Result, ensure};
use clap::ValueEnum;
use fuwafuwa::{Elasticity, Material, StressLaw};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Fit a stress law to a measured curve of uniaxial tension or compression. Prints the constants with their standard errors,
/// and a material for scenes.
///
/// The fit minimises the relative errors: the squares of the deviations, each divided by the stress plus 3 % of the largest
/// stress.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// CSV file with a header that names the engineering strain, `strain` or `stretch`, and the engineering stress,
    /// `stress_pa`, `stress_kpa` or `stress_mpa`. Other columns are ignored. Compression has negative strains and stresses.
    /// The lines can be in any order; stresses at equal strains are averaged. Lines that begin with # are comments.
    #[arg(value_name = "DATA.csv")]
    data: PathBuf,
    /// Stress law. Default: `yeoh`, or `neo-hookean` if all strains are below 0.3, which do not determine three constants.
    #[arg(long, value_enum)]
    law: Option<Law>,
    /// Slack of the clamps: strain at which the stress begins, subtracted from all strains of a tensile curve. `auto` finds
    /// the slack with the best fit. With a slack or `auto`, points up to a strain of 0.02 after the slack are left out.
    #[arg(long, value_name = "auto|STRAIN", default_value = "0", value_parser = Slack::parse)]
    slack: Slack,
    /// Poisson's ratio of the material for scenes, 0 to 0.49. The fit itself is incompressible.
    #[arg(long, default_value_t = 0.49)]
    poisson: f64,
    /// Draw the curve and the fit as an SVG file; its name must end in `.svg`.
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Stress law to fit.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// One constant: rubber and gels up to a stretch of about 1.5.
    NeoHookean,
    /// Three constants: rubber that stiffens at large stretches.
    Yeoh,
}

/// Slack of the clamps.
#[derive(Copy, Clone, Debug, PartialEq)]
enum Slack {
    Auto,
    Given(f64),
}

impl Slack {
    fn parse(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case("auto") {
            return Ok(Self::Auto);
        }
        let given: Result<f64, _> = text.parse();
        let valid = given.ok().filter(|slack| (0.0..=0.5).contains(slack));
        valid
            .map(Self::Given)
            .ok_or_else(|| "expected `auto` or a strain from 0 to 0.5".into())
    }
}

/// Deformation of a test.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Free across.
    Uniaxial,
    /// Stretched equally along two axes, free along the third.
    Equibiaxial,
    /// Stretched along one axis, held along the second, free along the third.
    PureShear,
}

impl Mode {
    const ALL: [Self; 3] = [Self::Uniaxial, Self::Equibiaxial, Self::PureShear];

    /// Returns the stretches along the three axes at constant volume.
    pub fn stretches(self, stretch: f64) -> [f64; 3] {
        match self {
            Self::Uniaxial => [stretch, stretch.powf(-0.5), stretch.powf(-0.5)],
            Self::Equibiaxial => [stretch, stretch, stretch.powi(-2)],
            Self::PureShear => [stretch, 1.0, 1.0 / stretch],
        }
    }

    /// Returns k and y.
    fn factors(self, stretch: f64) -> (f64, f64) {
        let exponent = match self {
            Self::Uniaxial => -2,
            Self::Equibiaxial => -5,
            Self::PureShear => -3,
        };
        let squares = self.stretches(stretch).map(|stretch| stretch * stretch);
        let y = (squares.iter().sum::<f64>() - 3.0).max(0.0);
        (stretch - stretch.powi(exponent), y)
    }

    /// Largest stretch up to which the stress of a fit grows. The smallest is its inverse in uniaxial tests, 1 in others.
    fn reach(self) -> f64 {
        match self {
            Self::Uniaxial | Self::PureShear => 8.0,
            Self::Equibiaxial => 4.0,
        }
    }
}

/// Measured point of a curve.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Sample {
    pub mode: Mode,
    pub stretch: f64,
    /// Engineering stress [Pa].
    pub stress: f64,
}

/// Least number of points of a fit.
const LEAST_POINTS: usize = 4;
/// Share of the largest stress of a test that is added to the divisor of each deviation.
const FLOOR: f64 = 0.03;
/// Number of values of Y to each side of 0, and their smallest and largest ratio to the largest y of the points.
const PLACES: usize = 160;
const SPAN: [f64; 2] = [0.02, 100.0];
/// Distance of a ray from the border of the laws that the engine accepts, as a share.
const MARGIN: f64 = 1e-3;
/// Candidates for the slack: steps and number.
const SLACK_STEP: f64 = 0.001;
const MOST_SLACK: usize = 60;
/// Largest strain of the points that determine the slack.
const SLACK_REACH: f64 = 1.5;
/// Strain after the slack up to which points are left out: the specimen straightens there.
const TOE: f64 = 0.02;
/// Largest strain below which a curve does not determine the three constants of Yeoh.
const LEAST_REACH: f64 = 0.3;
/// Root mean square deviation, divided by the largest stress, above which a fit is bad.
const BAD: f64 = 0.1;
/// Usual shear moduli of soft materials [Pa].
const USUAL_MODULI: [f64; 2] = [50.0, 1e9];

/// Fitted stress law.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Fit {
    pub law: Law,
    /// Shear modulus μ [Pa].
    pub shear_modulus: f64,
    /// a, 0 for the neo-Hookean law.
    pub second: f64,
    /// b, 0 for the neo-Hookean law.
    pub third: f64,
}

/// Deviations of a fit from the points.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct Deviations {
    /// Root mean square, divided by the largest stress.
    pub of_largest: f64,
    /// Root mean square of the relative deviations, of points with a stress other than 0.
    pub relative: f64,
}

impl Deviations {
    /// Returns the deviations of computed stresses from measured ones.
    pub fn between(samples: &[Sample], computed: impl IntoIterator<Item = f64>) -> Self {
        let largest = samples
            .iter()
            .map(|one| one.stress.abs())
            .fold(0.0, f64::max);
        let (mut squares, mut relative) = (Vec::new(), Vec::new());
        for (sample, computed) in samples.iter().zip(computed) {
            let deviation = computed - sample.stress;
            squares.push((deviation / largest).powi(2));
            if sample.stress != 0.0 {
                relative.push((deviation / sample.stress).powi(2));
            }
        }
        let root_mean = |all: &[f64]| (all.iter().sum::<f64>() / all.len() as f64).sqrt();
        Self {
            of_largest: root_mean(&squares),
            relative: root_mean(&relative),
        }
    }
}

impl Fit {
    /// Fits a law to points.
    ///
    /// # Errors
    /// If there are too few points, or no law that the engine accepts has the sign of the stresses.
    pub fn to(law: Law, samples: &[Sample]) -> Result<Self> {
        ensure!(
            samples.len() >= LEAST_POINTS,
            "a fit needs at least {LEAST_POINTS} points, found {}",
            samples.len()
        );
        let fit = match law {
            Law::NeoHookean => {
                let points = weighted(samples);
                let Best { along, .. } = best(&points, f64::INFINITY, [[1.0, 0.0]; 2], false);
                Self {
                    law,
                    shear_modulus: along[0],
                    second: 0.0,
                    third: 0.0,
                }
            }
            Law::Yeoh => yeoh(samples),
        };
        ensure!(
            fit.shear_modulus > 0.0,
            "the stresses do not grow with the stretch: no law fits with a positive shear modulus"
        );
        let fit = Self {
            shear_modulus: rounded(fit.shear_modulus),
            second: rounded(fit.second),
            third: rounded(fit.third),
            law,
        };
        fit.material(0.49)
            .check()
            .context("the engine rejects the fitted law")?;
        Ok(fit)
    }

    /// Returns the engineering stress [Pa] at a stretch, at constant volume.
    pub fn stress(&self, mode: Mode, stretch: f64) -> f64 {
        let (k, y) = mode.factors(stretch);
        let most = match self.third < 0.0 {
            true => -self.second / (3.0 * self.third),
            false => f64::INFINITY,
        };
        let y = y.min(most);
        self.shear_modulus * (1.0 + 2.0 * self.second * y + 3.0 * self.third * y * y) * k
    }

    /// Returns the deviations from points.
    pub fn deviations(&self, samples: &[Sample]) -> Deviations {
        let stress = |sample: &Sample| self.stress(sample.mode, sample.stretch);
        Deviations::between(samples, samples.iter().map(stress))
    }

    /// Returns Young's modulus [Pa] for a Poisson's ratio.
    pub fn young(&self, poisson: f64) -> f64 {
        rounded(2.0 * self.shear_modulus * (1.0 + poisson))
    }

    /// Returns the stress law of the engine.
    pub fn stress_law(&self) -> StressLaw {
        match self.law {
            Law::NeoHookean => StressLaw::NeoHookean,
            Law::Yeoh => StressLaw::Yeoh {
                second: self.second,
                third: self.third,
            },
        }
    }

    /// Returns the default material with the fitted law and a Poisson's ratio.
    pub fn material(&self, poisson: f64) -> Material {
        Material {
            elasticity: Elasticity {
                young: self.young(poisson),
                poisson,
            },
            stress_law: self.stress_law(),
            ..Material::default()
        }
    }

    /// Returns the text of the material in a scene.
    fn toml(&self, poisson: f64) -> String {
        let law = match self.law {
            Law::NeoHookean => "\"neo_hookean\"".into(),
            Law::Yeoh => format!("{{ yeoh = [{:?}, {:?}] }}", self.second, self.third),
        };
        let young = self.young(poisson);
        format!(
            "[[material]]\nyoung = {young:?}\npoisson = {poisson:?}\nstress_law = {law}\n\
             unbreakable = true    # or strength, as true stress, and toughness: this curve gives neither\n\
             # density = 1000.0    # of the specimen [kg/m³]; by default 100\n"
        )
    }

    /// Returns the standard errors of μ, a and b; `None` if the points do not determine them.
    ///
    /// They are those of a linear fit: the limits of the constants are ignored.
    fn standard_errors(&self, samples: &[Sample]) -> Option<[f64; 3]> {
        let points = weighted(samples);
        let count = match self.law {
            Law::NeoHookean => 1,
            Law::Yeoh => 3,
        };
        let most = points.iter().map(|point| point.y).fold(0.0, f64::max);
        let is_limited = self.third < 0.0 && most > -self.second / (3.0 * self.third);
        if points.len() <= count || most <= 0.0 || is_limited {
            return None;
        }
        // Normal matrix of μ, μ a most and μ b most².
        let (mut matrix, mut squares) = ([[0.0; 3]; 3], 0.0);
        for (point, sample) in points.iter().zip(samples) {
            let share = point.y / most;
            let columns = [1.0, 2.0 * share, 3.0 * share * share];
            let columns = columns.map(|column| point.weight * point.k * column);
            for i in 0..3 {
                (0..3).for_each(|j| matrix[i][j] += columns[i] * columns[j]);
            }
            let deviation = self.stress(sample.mode, sample.stretch) - sample.stress;
            squares += (point.weight * deviation).powi(2);
        }
        let variance = squares / (points.len() - count) as f64;
        if count == 1 {
            return Some([(variance / matrix[0][0]).sqrt(), 0.0, 0.0]);
        }
        let inverse = inverse(matrix)?;
        let relative = |place: usize, value: f64| {
            let ratio = value * most.powi(place as i32);
            let square = inverse[place][place] - 2.0 * ratio * inverse[0][place]
                + ratio * ratio * inverse[0][0];
            (variance * square.max(0.0)).sqrt() / self.shear_modulus / most.powi(place as i32)
        };
        Some([
            (variance * inverse[0][0]).sqrt(),
            relative(1, self.second),
            relative(2, self.third),
        ])
    }
}

/// Returns the inverse of a symmetric matrix; `None` if it is singular.
fn inverse(m: [[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let minor = |i: usize, j: usize| {
        let [a, b, c, d] = [(i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3];
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
    let is_regular = determinant > 1e-12 * m[0][0] * m[1][1] * m[2][2];
    is_regular
        .then(|| [0, 1, 2].map(|i: usize| [0, 1, 2].map(|j: usize| minor(j, i) / determinant)))
}

/// Rounds to six significant digits, so that the constants that are printed are those that were checked.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Point with its factors k and y.
#[derive(Copy, Clone, Debug)]
struct Weighted {
    k: f64,
    y: f64,
    stress: f64,
    /// Inverse of the divisor of the deviation.
    weight: f64,
}

/// Returns the points with their weights.
fn weighted(samples: &[Sample]) -> Vec<Weighted> {
    let largest = Mode::ALL.map(|mode| {
        let of_mode = samples.iter().filter(|one| one.mode == mode);
        of_mode.map(|one| one.stress.abs()).fold(0.0, f64::max)
    });
    { samples.iter() }
        .map(
            |&Sample {
                 mode,
                 stretch,
                 stress,
             }| {
                let (k, y) = mode.factors(stretch);
                let weight = 1.0 / (stress.abs() + FLOOR * largest[mode as usize]);
                Weighted {
                    k,
                    y,
                    stress,
                    weight,
                }
            },
        )
        .collect()
}

/// Best law for a given Y and a cone.
#[derive(Copy, Clone, Debug)]
struct Best {
    /// A and B.
    along: [f64; 2],
    /// Sum of the squares of the weighted deviations.
    cost: f64,
}

/// Returns the law with a given Y whose A and B lie in a cone between two rays.
fn best(points: &[Weighted], place: f64, rays: [[f64; 2]; 2], is_limited: bool) -> Best {
    // Normal equations of both factors.
    let (mut matrix, mut right, mut rest) = ([[0.0; 2]; 2], [0.0; 2], 0.0);
    for point in points {
        let y = if is_limited {
            point.y.min(place)
        } else {
            point.y
        };
        let square = (1.0 - y / place).powi(2);
        let columns = rays.map(|ray| point.weight * point.k * (ray[0] + ray[1] * square));
        let goal = point.weight * point.stress;
        for i in 0..2 {
            (0..2).for_each(|j| matrix[i][j] += columns[i] * columns[j]);
            right[i] += columns[i] * goal;
        }
        rest += goal * goal;
    }
    let [[a, b], [_, d]] = matrix;
    let determinant = a * d - b * b;
    let both = [
        (right[0] * d - right[1] * b) / determinant,
        (right[1] * a - right[0] * b) / determinant,
    ];
    let single = |k: usize| (right[k] / matrix[k][k]).max(0.0);
    let is_inside = determinant > 1e-12 * a * d && both.iter().all(|&factor| factor >= 0.0);
    let candidates = match is_inside {
        true => vec![both],
        false => vec![[single(0), 0.0], [0.0, single(1)]],
    };
    let cost = |[p, q]: [f64; 2]| {
        rest - 2.0 * (p * right[0] + q * right[1]) + a * p * p + 2.0 * b * p * q + d * q * q
    };
    let all = candidates.into_iter().map(|factors| {
        let along = [0, 1].map(|k| factors[0] * rays[0][k] + factors[1] * rays[1][k]);
        let cost = cost(factors);
        Best { along, cost }
    });
    all.min_by(|one, other| one.cost.total_cmp(&other.cost))
        .expect("there is at least one candidate")
}

/// Returns the best Yeoh law.
fn yeoh(samples: &[Sample]) -> Fit {
    let points = weighted(samples);
    let most = points.iter().map(|point| point.y).fold(1e-6, f64::max);
    let scale = |share: f64| most * SPAN[0] * (SPAN[1] / SPAN[0]).powf(share);
    // Kinds of law: sign of Y, and whether g stays constant beyond Y.
    let kinds = [(1.0, false), (1.0, true), (-1.0, false)];
    let at = |(sign, is_limited): (f64, bool), share: f64| {
        let place = sign * scale(share);
        let border = match (sign > 0.0, is_limited) {
            (true, false) => [1.0, steepest(place)],
            (true, true) => [1.0, MARGIN - 1.0],
            _ => [MARGIN - 1.0, 1.0],
        };
        (
            place,
            best(&points, place, [[1.0, 0.0], border], is_limited),
        )
    };
    let mut found: Option<(f64, Best)> = None;
    for kind in kinds {
        let share = |index: usize| index as f64 / (PLACES - 1) as f64;
        let costs = (0..PLACES).map(|index| (index, at(kind, share(index)).1.cost));
        let (index, _) = costs
            .min_by(|one, other| one.1.total_cmp(&other.1))
            .expect("there are some places");
        let (mut low, mut high) = (
            share(index.saturating_sub(1)),
            share((index + 1).min(PLACES - 1)),
        );
        for _ in 0..60 {
            let third = (high - low) / 3.0;
            match at(kind, low + third).1.cost < at(kind, high - third).1.cost {
                true => high -= third,
                false => low += third,
            }
        }
        let refined = at(kind, 0.5 * (low + high));
        if found.is_none_or(|(_, best)| refined.1.cost < best.cost) {
            found = Some(refined);
        }
    }
    let (place, Best { along: [a, b], .. }) = found.expect("there are three kinds");
    let shear_modulus = a + b;
    Fit {
        law: Law::Yeoh,
        shear_modulus,
        second: -b / (place * shear_modulus),
        third: b / (3.0 * place * place * shear_modulus),
    }
}

/// Returns the largest B at A = 1 and a positive Y for which the stress grows with the stretch in every mode.
fn steepest(place: f64) -> f64 {
    let mut most = 1.0 / MARGIN;
    for mode in Mode::ALL {
        let low = match mode {
            Mode::Uniaxial => 1.0 / mode.reach(),
            Mode::Equibiaxial | Mode::PureShear => 1.0,
        };
        let stretch = |index: u32| low * (mode.reach() / low).powf(f64::from(index) / 200.0);
        let mut before = (mode.factors(low), low);
        for index in 1..=200 {
            let (k, y) = mode.factors(stretch(index));
            let ((k_before, y_before), _) = before;
            let square = |y: f64| (1.0 - y / place).powi(2);
            let change = k * square(y) - k_before * square(y_before);
            if change < 0.0 {
                most = most.min((1.0 - MARGIN) * (k - k_before) / -change);
            }
            before = ((k, y), stretch(index));
        }
    }
    most
}

/// Returns the points of a curve of uniaxial stretches and stresses. With a slack above 0, strains are reduced by the slack,
/// and points up to a strain of [`TOE`] are left out.
pub fn after_slack(curve: &[(f64, f64)], slack: f64) -> Vec<Sample> {
    samples_after(curve, slack, slack > 0.0)
}

/// Returns the points of a curve with strains reduced by the slack, with or without the toe: the points up to a strain of
/// [`TOE`].
fn samples_after(curve: &[(f64, f64)], slack: f64, is_toe_left_out: bool) -> Vec<Sample> {
    let points = { curve.iter() }.map(|&(stretch, stress)| (stretch - slack, stress));
    let is_kept = |&(stretch, _): &(f64, f64)| !is_toe_left_out || stretch > 1.0 + TOE;
    points
        .filter(is_kept)
        .map(|(stretch, stress)| Sample {
            mode: Mode::Uniaxial,
            stretch,
            stress,
        })
        .collect()
}

/// Returns the slack with the best fit: the Yeoh law with the smallest deviation in the part of the curve with strains up
/// to [`SLACK_REACH`].
///
/// # Errors
/// If there are too few points with such strains.
pub fn find_slack(curve: &[(f64, f64)]) -> Result<f64> {
    let most = SLACK_STEP * MOST_SLACK as f64;
    let within = |&&(stretch, _): &&(f64, f64)| stretch <= 1.0 + SLACK_REACH;
    let part: Vec<(f64, f64)> = curve.iter().filter(within).copied().collect();
    let kept = after_slack(&part, most).len();
    ensure!(
        kept > LEAST_POINTS,
        "finding the slack needs at least {} points with a strain of {} to {SLACK_REACH}, found {kept}",
        LEAST_POINTS + 1,
        most + TOE
    );
    let mut best = (f64::INFINITY, 0.0);
    for step in 0..=MOST_SLACK {
        let slack = SLACK_STEP * step as f64;
        let samples = samples_after(&part, slack, true);
        let fit = Fit::to(Law::Yeoh, &samples)?;
        let deviation = fit.deviations(&samples).of_largest;
        if deviation < best.0 {
            best = (deviation, slack);
        }
    }
    Ok(best.1)
}

/// Result of a fit.
#[derive(Clone, Debug, Serialize)]
struct Outcome {
    law: Law,
    /// Number of points.
    points: usize,
    /// Smallest and largest strain, without the slack.
    strain: [f64; 2],
    slack: f64,
    /// Shear modulus [Pa].
    shear_modulus: f64,
    /// Young's modulus [Pa].
    young: f64,
    poisson: f64,
    /// Constants of the Yeoh law.
    second: f64,
    third: f64,
    /// Standard errors of the shear modulus and of the constants of the Yeoh law; missing if the points do not determine
    /// them.
    standard_errors: Option<[f64; 3]>,
    /// Deviations from the points.
    deviations: Deviations,
    /// Text of the material in a scene.
    toml: String,
    /// What looks like a mistake in the curve or in the fit.
    notes: Vec<String>,
}

/// Fits a law to a curve and prints the result.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let path = &arguments.data;
    let name = path.display().to_string();
    if let Some(plot) = &arguments.plot {
        check_plot(plot, path)?;
    }
    let poisson = arguments.poisson;
    Elasticity::new(1.0, poisson).context("--poisson")?;
    let text = curve::read_text(path, 1 << 24)?;
    let Curve { points, mut notes } = Curve::parse(&name, &text)?;
    if arguments.slack != Slack::Given(0.0) {
        let lowest = points
            .iter()
            .map(|(stretch, _)| stretch - 1.0)
            .fold(0.0, f64::min);
        ensure!(
            lowest > -TOE,
            "{name}: --slack is for tensile curves: expected strains above {}, found {lowest}",
            -TOE
        );
    }
    let slack = match arguments.slack {
        Slack::Given(slack) => slack,
        Slack::Auto => find_slack(&points).with_context(|| name.clone())?,
    };
    let samples = samples_after(&points, slack, arguments.slack != Slack::Given(0.0));
    let law = arguments.law.unwrap_or_else(|| usual_law(&samples));
    let fit = Fit::to(law, &samples).with_context(|| name.clone())?;
    notes.extend(doubts(&fit, &samples, arguments.law.is_some()));
    notes
        .iter()
        .for_each(|note| output::warn(format_args!("note: {note}")));
    let outcome = Outcome {
        notes,
        ..outcome(&fit, &samples, slack, poisson)
    };
    if let Some(plot) = &arguments.plot {
        let svg = plot::svg_of_plots(&[picture(&fit, &samples)]);
        output::write(plot, svg.as_bytes()).with_context(|| plot.display().to_string())?;
    }
    if arguments.json {
        report::print_json(&outcome)?;
    } else {
        output::print(&format!("{}\n{}", table(&outcome), outcome.toml))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Checks that a plot is written to an SVG file other than the data.
fn check_plot(plot: &Path, data: &Path) -> Result<()> {
    let name = plot.display();
    let is_svg = plot
        .extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("svg"));
    ensure!(
        is_svg,
        "--plot: expected a name that ends in .svg, found {name}"
    );
    output::check_folder(plot).with_context(|| name.to_string())?;
    // A plot that does not exist yet is no file with data.
    let is_data = match (plot.canonicalize(), data.canonicalize()) {
        (Ok(plot), Ok(data)) => plot == data,
        _ => false,
    };
    ensure!(
        !is_data,
        "--plot: expected another file than the data, found {name}"
    );
    Ok(())
}

/// Returns the largest strain of points, in tension or in compression.
fn reach(samples: &[Sample]) -> f64 {
    let strains = samples.iter().map(|one| (one.stretch - 1.0).abs());
    strains.fold(0.0, f64::max)
}

/// Returns the law whose constants the points can determine.
fn usual_law(samples: &[Sample]) -> Law {
    match reach(samples) < LEAST_REACH {
        true => Law::NeoHookean,
        false => Law::Yeoh,
    }
}

/// Returns what looks like a mistake in a fit.
fn doubts(fit: &Fit, samples: &[Sample], is_law_given: bool) -> Vec<String> {
    let digits = report::digits;
    let mut doubts = Vec::new();
    let deviation = fit.deviations(samples).of_largest;
    if deviation > BAD {
        doubts.push(format!(
            "the law does not follow the curve: the rms error is {} % of the largest stress; does the file have points after \
             the break, or two curves?",
            digits(100.0 * deviation)
        ));
    }
    let reach = reach(samples);
    if reach < LEAST_REACH {
        let largest = format!(
            "the largest strain is {}, below {LEAST_REACH}",
            digits(reach)
        );
        match (fit.law, is_law_given) {
            (Law::Yeoh, _) => doubts.push(format!(
                "{largest}: it does not determine the constants of Yeoh; try --law neo-hookean"
            )),
            (Law::NeoHookean, false) => doubts.push(format!("{largest}: neo-Hookean law")),
            (Law::NeoHookean, true) => {}
        }
    }
    let [low, high] = USUAL_MODULI;
    if !(low..=high).contains(&fit.shear_modulus) {
        doubts.push(format!(
            "the shear modulus is {} Pa, soft materials have {low} to {high:e} Pa: is the unit of the stress right?",
            digits(fit.shear_modulus)
        ));
    }
    doubts
}

fn outcome(fit: &Fit, samples: &[Sample], slack: f64, poisson: f64) -> Outcome {
    let strains = || samples.iter().map(|sample| sample.stretch - 1.0);
    Outcome {
        law: fit.law,
        points: samples.len(),
        strain: [
            strains().fold(f64::INFINITY, f64::min),
            strains().fold(f64::NEG_INFINITY, f64::max),
        ],
        slack,
        shear_modulus: fit.shear_modulus,
        young: fit.young(poisson),
        poisson,
        second: fit.second,
        third: fit.third,
        standard_errors: fit.standard_errors(samples),
        deviations: fit.deviations(samples),
        toml: fit.toml(poisson),
        notes: Vec::new(),
    }
}

fn table(outcome: &Outcome) -> String {
    let digits = report::digits;
    let percent = |share: f64| format!("{} %", digits(100.0 * share));
    let [low, high] = outcome.strain.map(digits);
    let with_error = |value: f64, place: usize| {
        let error = outcome.standard_errors.map(|errors| errors[place]);
        let error = error.map_or(String::new(), |error| format!(" ± {}", digits(error)));
        digits(value) + &error
    };
    let law = match outcome.law {
        Law::NeoHookean => "neo-Hookean",
        Law::Yeoh => "Yeoh",
    };
    let mut rows = vec![
        ("law", law.into()),
        ("points", outcome.points.to_string()),
        ("strain", format!("{low} to {high}")),
        ("slack", digits(outcome.slack)),
        ("shear modulus [Pa]", with_error(outcome.shear_modulus, 0)),
        (
            "Young's modulus [Pa], from --poisson",
            digits(outcome.young),
        ),
    ];
    if outcome.law == Law::Yeoh {
        rows.push(("second, C₂ / C₁", with_error(outcome.second, 1)));
        rows.push(("third, C₃ / C₁", with_error(outcome.third, 2)));
    }
    let Deviations {
        of_largest,
        relative,
    } = outcome.deviations;
    rows.push(("rms error / largest stress", percent(of_largest)));
    rows.push(("rms relative error", percent(relative)));
    let rows: Vec<Vec<String>> = { rows.into_iter() }
        .map(|(name, value)| vec![name.to_owned(), value])
        .collect();
    report::table(&rows, &[false, false])
}

/// Draws the points and the fit.
fn picture(fit: &Fit, samples: &[Sample]) -> Plot {
    let stretches = || samples.iter().map(|sample| sample.stretch);
    let (low, high) = (
        stretches().fold(1.0, f64::min),
        stretches().fold(1.0, f64::max),
    );
    let stress = |strain: f64| 1e-3 * fit.stress(Mode::Uniaxial, 1.0 + strain);
    let measured = { samples.iter() }.map(|one| (one.stretch - 1.0, 1e-3 * one.stress));
    Plot {
        x: "engineering strain".into(),
        y: "engineering stress [kPa]".into(),
        curves: vec![plot::Curve::sampled(low - 1.0..=high - 1.0, stress).named("fit")],
        points: vec![Points::new("measured", measured)],
        ..Plot::default()
    }
}

#[cfg(test)]
mod tests;

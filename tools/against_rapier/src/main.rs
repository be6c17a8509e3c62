//! Prints the frame times of fuwafuwa and Rapier. Both engines run alternately in one process. `fuwafuwa
//! bench --against rapier` starts this program.

use std::process::ExitCode;

use against_rapier::{Drop, Effort, EngineResult, Result, compare_drop, compare_tear};
use clap::{Parser, ValueEnum};
use serde::Serialize;

/// Width of the pieces of the torn disc [voxels]. A disc 64 voxels across gets 390 pieces.
const PITCH: usize = 3;
/// Compare the frame times of fuwafuwa and Rapier.
#[derive(Parser)]
#[command(name = "against_rapier", version)]
struct Arguments {
    /// Number of dimensions.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u8).range(2..=3))]
    dim: u8,
    /// Voxels across; default 128 in 2D (64 in the torn scene) and 32 in 3D.
    #[arg(long, value_parser = clap::value_parser!(u16).range(8..=512))]
    n: Option<u16>,
    /// Run only this scene.
    #[arg(long, value_enum)]
    scene: Option<Scene>,
    /// Number of frames of 1/60 s; default 300, or 240 in the torn scene.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    frames: Option<u16>,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "snake_case")]
enum Scene {
    /// A body of 4e5 Pa falls 1 m at 9.81 m/s².
    Stiff,
    /// A body of 5000 Pa falls 0.15 m (in 3D 0.1 m) at 1 m/s².
    Soft,
    /// A disc of 5000 Pa in pieces of 3 x 3 voxels falls 0.2 m at 9.81 m/s²; 2D only.
    Torn,
}

/// Result of a scene in both engines.
#[derive(Serialize)]
struct Comparison {
    scene: Scene,
    dim: u8,
    n: usize,
    /// Frames per engine.
    frames: usize,
    /// Results of fuwafuwa and of Rapier.
    sides: [EngineResult; 2],
    /// Median frame time of each engine [ms].
    median: [f64; 2],
    /// Slowest frame time of each engine [ms].
    worst: [f64; 2],
    /// Median frame time of Rapier divided by that of fuwafuwa.
    ratio: f64,
    /// Whether the peak squash in both engines agrees within 2 percentage points; `None` for the torn scene.
    equal_squash: Option<bool>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let comparisons = match compare(&arguments) {
        Ok(comparisons) => comparisons,
        Err(error) => return fail(&error.to_string()),
    };
    if arguments.json {
        match serde_json::to_string_pretty(&comparisons) {
            Ok(text) => println!("{text}"),
            Err(error) => return fail(&error.to_string()),
        }
    } else {
        comparisons.iter().for_each(print);
    }
    ExitCode::SUCCESS
}

fn fail(reason: &str) -> ExitCode {
    eprintln!("error: {reason}");
    ExitCode::from(2)
}

fn compare(arguments: &Arguments) -> Result<Vec<Comparison>> {
    let scenes = match (arguments.scene, arguments.dim) {
        (Some(scene), _) => vec![scene],
        (None, 2) => vec![Scene::Stiff, Scene::Soft, Scene::Torn],
        (None, _) => vec![Scene::Stiff, Scene::Soft],
    };
    let compare = |scene: &Scene| compare_in(*scene, arguments);
    scenes.iter().map(compare).collect()
}

fn compare_in(scene: Scene, arguments: &Arguments) -> Result<Comparison> {
    let dim = arguments.dim;
    let usual = match (scene, dim) {
        (Scene::Torn, _) => 64,
        (_, 2) => 128,
        _ => 32,
    };
    let n = arguments.n.map_or(usual, usize::from);
    let mut drop = match scene {
        Scene::Stiff => Drop::stiff(dim, n),
        Scene::Soft => Drop::soft(dim, n),
        Scene::Torn => Drop {
            dim,
            ..Drop::diced(n)
        },
    };
    drop.frames = arguments.frames.map_or(drop.frames, usize::from);
    let sides = if scene == Scene::Torn {
        // Uses the default solver effort, because with it the small pieces are stiff enough.
        compare_tear(&drop, PITCH, Effort::default())?
    } else {
        compare_drop(&drop, |Effort { substeps, sweeps }| {
            eprintln!(
                "{dim}D n = {n}, {scene:?}: Rapier with {substeps} substeps, {sweeps} sweeps"
            );
        })?
    };
    let [ours, theirs] = &sides;
    Ok(Comparison {
        scene,
        dim,
        n,
        frames: ours.milliseconds.len(),
        median: [ours.median(), theirs.median()],
        worst: [ours.worst(), theirs.worst()],
        ratio: theirs.median() / ours.median(),
        equal_squash: (scene != Scene::Torn).then(|| ours.equals(theirs)),
        sides,
    })
}

fn print(comparison: &Comparison) {
    let Comparison { scene, dim, n, .. } = comparison;
    let what = scene.to_possible_value();
    let what = what.and_then(|value| value.get_help().map(ToString::to_string));
    println!("{dim}D n = {n}: {}", what.unwrap_or_default());
    println!(
        "{:<64}{:>9}{:>10}{:>8}{:>8}{:>11}{:>11}",
        "  alternating frames of 1/60 s, one thread",
        "substeps",
        "stiffness",
        "squash",
        "asleep",
        "median ms",
        "worst ms",
    );
    for side in &comparison.sides {
        let pieces = match side.pieces {
            1 => String::new(),
            pieces => format!(", {pieces} pieces"),
        };
        let lost = if side.finite { "" } else { ", not finite" };
        println!(
            "  {:<62}{:>9}{:>10.2}{:>6.1} %{:>6.0} %{:>11.2}{:>11.2}",
            format!("{}{pieces}{lost}", side.engine),
            side.substeps,
            side.stiffness_scale,
            100.0 * side.peak_squash,
            100.0 * side.asleep,
            side.median(),
            side.worst(),
        );
    }
    let remark = match comparison.equal_squash {
        Some(false) => "; NOT at equal squash",
        _ => "",
    };
    println!(
        "  Rapier: {:.1} times the frame time of fuwafuwa ({} frames){remark}\n",
        comparison.ratio, comparison.frames
    );
}

//! Runs a scene, films it, and records the inputs of its hands.

use crate::report::{self, Progress, print_json};
use anyhow::{Context, Result};
use fuwafuwa::{Dim, Dim2, Dim3, Event, StiffBodies, Vec3, World};
use fuwafuwa_painter::solid::{Camera, Scene3d};
use fuwafuwa_painter::worlds;
use fuwafuwa_painter::{Painter, Pixmap, film};
use fuwafuwa_scenes::disk::open_scene;
use fuwafuwa_scenes::{Recording, Scene};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Width of a frame [px].
const WIDTH: u32 = 420;
/// Number of frames in a strip.
const MOMENTS: usize = 12;
/// Ticks between two frames of a GIF.
const PACE: u64 = 3;
/// Display time of a frame of a GIF [1/100 s].
const HUNDREDTHS: u16 = 5;

/// Run a scene, given by name or TOML file.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Named scene (drop, drop-3d, squeeze, tear, tear-3d, diced, pile, pile-3d, stack, core, ring-3d, heap-3d) or
    /// file.
    scene: String,
    /// Number of ticks of 1/60 s; defaults to the duration in the scene.
    #[arg(long)]
    frames: Option<u64>,
    /// Film the scene: a strip of moments (.png) or an animation (.gif).
    #[arg(long)]
    film: Option<PathBuf>,
    /// Write the last moment of a 2D scene as SVG beside the film, or as SCENE.svg.
    #[arg(long)]
    svg: bool,
    /// Show elements by level instead of the skin.
    #[arg(long)]
    elements: bool,
    /// Replace a value of the scene, for example material.young=9000 or body.1.n=32; repeatable.
    #[arg(long = "set")]
    changes: Vec<String>,
    /// Write a recording for `fuwafuwa replay`.
    #[arg(long)]
    record: Option<PathBuf>,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Final state of a scene.
#[derive(Debug, Serialize)]
struct Summary {
    scene: String,
    ticks: u64,
    substeps: u32,
    released: u32,
    pieces: usize,
    crumbs: usize,
    asleep: usize,
    quarantined: usize,
    /// Impacts that were too fast for the substeps, one per piece and tick.
    slowed_impacts: usize,
    /// Soft bodies with scaled mass or stiffness in the last tick.
    scaled_bodies: u32,
    /// Largest scale of a soft body in the last tick; 1 if none is scaled.
    largest_scale: f64,
    hash: String,
}

/// Dimension with worlds that can be drawn as frames of a film.
trait Filmed: Dim {
    /// Paints the current state of a world, in the view of its scene.
    fn painted(world: &World<Self>, scene: &Scene, elements: bool) -> Result<Painter>;
}

impl Filmed for Dim2 {
    fn painted(world: &World<Self>, scene: &Scene, elements: bool) -> Result<Painter> {
        let view = scene.view.map(Vec3::from);
        let (mut painter, frame) = Painter::for_view(view, WIDTH);
        let draw = if elements {
            worlds::plane_elements
        } else {
            worlds::plane_skin
        };
        worlds::plane(&mut painter, frame, world, draw);
        Ok(painter)
    }
}

impl Filmed for Dim3 {
    fn painted(world: &World<Self>, scene: &Scene, elements: bool) -> Result<Painter> {
        let [low, high] = scene.view.map(Vec3::from);
        let middle = 0.5 * (low + high);
        let across = high.x - low.x;
        let mut solid = Scene3d::new(Camera {
            eye: middle + Vec3::new(1.4, 0.9, 2.0) * across,
            target: middle,
            across: 1.15 * across,
        });
        if elements {
            worlds::space(&mut solid, world, |solid, body| {
                worlds::space_elements(solid, body, |_| true);
            });
        } else {
            worlds::space(&mut solid, world, worlds::space_skin);
        }
        let mut painter = Painter::new(WIDTH, WIDTH);
        painter.image([0.0; 2], solid.pixels(WIDTH, WIDTH)?);
        Ok(painter)
    }
}

/// Runs the scene.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let mut scene = open_scene(&arguments.scene, &arguments.changes)?;
    if scene.game.is_none() {
        scene.stiff_bodies.get_or_insert(StiffBodies::Exact);
    }
    report::notes(&scene);
    match scene.dim {
        2 => run_in::<Dim2>(&scene, arguments),
        _ => run_in::<Dim3>(&scene, arguments),
    }
}

fn run_in<D: Filmed>(scene: &Scene, arguments: &Arguments) -> Result<ExitCode> {
    let ticks = arguments.frames.unwrap_or(scene.ticks());
    let is_gif = match &arguments.film {
        Some(path) => film_is_gif(path)?,
        None => false,
    };
    anyhow::ensure!(
        ticks > 0 || arguments.frames.is_none(),
        "--frames: expected at least 1, found 0"
    );
    anyhow::ensure!(
        ticks > 0,
        "{}: seconds: expected a tick (1/60 s) or more, found {}",
        arguments.scene,
        scene.seconds
    );
    let most = fuwafuwa_scenes::recording::MAX_TICKS as u64;
    anyhow::ensure!(
        arguments.record.is_none() || ticks <= most,
        "--frames: expected at most {most} ticks with --record, found {ticks}"
    );
    for path in arguments.film.iter().chain(&arguments.record) {
        check_folder(path)?;
    }
    let every = if is_gif {
        PACE.min(ticks)
    } else {
        (ticks / MOMENTS as u64).max(1)
    };
    let progress = Progress::new();
    progress.expect(ticks);
    let mut frames: Vec<Pixmap> = Vec::new();
    let mut failure = None;
    let mut last: Option<World<D>> = None;
    let (mut released, mut slowed_impacts, mut tick) = (0, 0, 0);
    let recording = Recording::of::<D>(scene, ticks, |world| {
        tick += 1;
        progress.step();
        for event in world.events() {
            released += usize::from(matches!(event, Event::NodeSplit { .. }));
            slowed_impacts += usize::from(matches!(event, Event::ImpactSlowed { .. }));
        }
        if arguments.film.is_some() && tick % every == 0 {
            let painted = D::painted(world, scene, arguments.elements);
            match painted.and_then(|painter| Ok(painter.pixels()?)) {
                Ok(pixels) => frames.push(pixels),
                Err(error) => failure = Some(error),
            }
        }
        if tick == ticks {
            last = Some(world.clone());
        }
    })?;
    if let Some(error) = failure {
        return Err(error);
    }
    let world = last.context("the scene ran no ticks")?;
    if let Some(path) = &arguments.film {
        let bytes = if is_gif {
            film::gif(&frames, HUNDREDTHS)?
        } else {
            film::strip(&frames, 4)?.png()?
        };
        write(path, &bytes)?;
    }
    if arguments.svg {
        let beside = arguments
            .film
            .clone()
            .unwrap_or(PathBuf::from(&arguments.scene));
        let painter = D::painted(&world, scene, arguments.elements)?;
        write(&beside.with_extension("svg"), painter.svg()?.as_bytes())?;
    }
    if let Some(path) = &arguments.record {
        let text = recording.text();
        let text = text.map_err(|reason| anyhow::anyhow!("{}: {reason}", path.display()))?;
        write(path, text.as_bytes())?;
    }
    let pieces = || {
        let bodies = world.soft_bodies();
        bodies.flat_map(|(_, body)| body.piece_views())
    };
    let (scaled_bodies, largest_scale) = report::scales(&world);
    let summary = Summary {
        scene: arguments.scene.clone(),
        ticks,
        substeps: world.substeps(),
        released: released as u32,
        pieces: pieces().count(),
        crumbs: pieces().filter(|piece| piece.element_count == 1).count(),
        asleep: pieces().filter(|piece| piece.asleep).count(),
        quarantined: pieces().filter(|piece| piece.quarantined).count(),
        slowed_impacts,
        scaled_bodies,
        largest_scale,
        hash: format!("{:016x}", world.hash()),
    };
    if slowed_impacts > 0 {
        output::warn(format!(
            "impacts too fast for the substeps, which were slowed: {slowed_impacts}"
        ));
    }
    report::warn_of_scales(&world);
    if arguments.json {
        print_json(&summary)?;
    } else {
        output::print(&format!(
            "{}: ticks: {}, substeps: {}, releases: {}, pieces: {} (crumbs: {}, asleep: {}), hash {}\n",
            summary.scene,
            summary.ticks,
            summary.substeps,
            summary.released,
            summary.pieces,
            summary.crumbs,
            summary.asleep,
            summary.hash
        ))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn film_is_gif(path: &Path) -> Result<bool> {
    match path.extension().and_then(|end| end.to_str()) {
        Some("png") => Ok(false),
        Some("gif") => Ok(true),
        _ => anyhow::bail!(
            "{}: expected a film name ending in .png or .gif",
            path.display()
        ),
    }
}

/// Checks that the folder of a file exists, so that a long run does not fail at its end.
pub fn check_folder(path: &Path) -> Result<()> {
    output::check_folder(path).with_context(|| path.display().to_string())
}

/// Writes a file and prints its name.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    output::write(path, bytes).with_context(|| path.display().to_string())?;
    output::warn(path.display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Arguments for filming a small disc to a file.
    fn filmed(frames: u64, film: PathBuf) -> Arguments {
        Arguments {
            scene: "drop".into(),
            frames: Some(frames),
            film: Some(film),
            svg: false,
            elements: false,
            changes: vec!["body.n=8".into()],
            record: None,
            json: false,
        }
    }

    #[test]
    fn run_of_one_tick_writes_a_film() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["film.gif", "film.png"] {
            let path = folder.path().join(name);
            run(&filmed(1, path.clone())).unwrap();
            assert!(std::fs::metadata(path).unwrap().len() > 100, "{name}");
        }
    }

    #[test]
    fn invalid_outputs_are_rejected_before_the_run() {
        let refused = |frames, film: &str| {
            let error = run(&filmed(frames, film.into())).unwrap_err();
            format!("{error:#}")
        };
        // Passes the largest number of ticks: if the run began before the check, the test would never end.
        assert!(refused(u64::MAX, "nowhere/film.gif").contains("the folder does not exist"));
        assert!(refused(u64::MAX, "film.mp4").contains(".png or .gif"));
        assert!(refused(0, "film.gif").contains("at least 1"));
    }
}

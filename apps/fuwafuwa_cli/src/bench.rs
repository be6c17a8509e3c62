//! Measures speed and memory. Other programs disturb the times, so cases that are compared alternate within
//! one run. Compare medians and ratios, not single times.

mod rapier;

use crate::report::{self, Progress, print_json, table};
use anyhow::Result;
use clap::ValueEnum;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Grading, Law, Material, RigidBody, Shape, SoftBody, Vec3,
    VoxelGrid, World, WorldConfig,
};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::disk::open_scene;
use serde::Serialize;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Measure speed and memory on this machine.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Scene to measure, by name or file, instead of the usual list. Ticks before and after the first tear
    /// are listed separately, and each tick counts with the shortest time of three runs. With --against
    /// rapier: run only `stiff`, `soft` or `torn`.
    #[arg(long)]
    scene: Option<String>,
    /// Replace a value of that scene, for example max_substeps=8 or body.1.n=64; repeatable.
    #[arg(long = "set", requires = "scene", conflicts_with = "against")]
    changes: Vec<String>,
    /// Number of space dimensions, with --n or --against.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u8).range(2..=3))]
    dim: u8,
    /// Measure a ball with N voxels across, instead of the usual list. With --against the default is 128 in
    /// 2D and 32 in 3D.
    #[arg(long, value_parser = clap::value_parser!(u16).range(8..=512))]
    n: Option<u16>,
    /// Number of threads for large bodies and many bodies. It does not change results. Each thread is pinned to a
    /// logical processor of its own, if there are enough of them.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=64))]
    threads: u8,
    /// With --against rapier: number of frames; default 300, or 240 for `torn`.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    frames: Option<u16>,
    /// Compare with a ball of single-voxel elements, or with Rapier.
    #[arg(long, value_enum)]
    against: Option<Rival>,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
enum Rival {
    /// Compare a graded ball with a ball of single-voxel elements, both oscillating freely.
    Uniform,
    /// Compare falling bodies, whole and in pieces, with Rapier. Whole bodies are compared at equal peak
    /// squash (largest relative loss of height). Builds Rapier from tools/against_rapier, which takes
    /// minutes.
    Rapier,
}

/// Result of a measurement.
#[derive(Clone, Debug, Serialize)]
struct Measure {
    what: String,
    unit: &'static str,
    median: f64,
    best: f64,
    worst: f64,
}

/// Runs the measurements and prints the results.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    if arguments.against == Some(Rival::Rapier) {
        return rapier::run(&for_rapier(arguments));
    }
    let measures = pinned(arguments.threads.into())?.install(|| measures(arguments))?;
    if arguments.json {
        print_json(&measures)?;
        return Ok(ExitCode::SUCCESS);
    }
    let head = ["", "median", "best", "worst", ""]
        .map(String::from)
        .to_vec();
    let mut rows = vec![head];
    for measure in &measures {
        rows.push(vec![
            measure.what.clone(),
            format!("{:.2}", measure.median),
            format!("{:.2}", measure.best),
            format!("{:.2}", measure.worst),
            measure.unit.into(),
        ]);
    }
    output::print(&table(&rows, &[false, true, true, true, false]))?;
    Ok(ExitCode::SUCCESS)
}

/// Creates a pool of threads. Several threads are each pinned to a logical processor of their own, because two threads on
/// one processor would be as slow as one. Prints whether they are pinned.
fn pinned(threads: usize) -> Result<rayon::ThreadPool> {
    let cores = core_affinity::get_core_ids().unwrap_or_default();
    let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
    if threads == 1 {
        return Ok(builder.build()?);
    }
    if cores.len() < threads {
        output::warn(format!(
            "threads are not pinned: {threads} threads on {} processors",
            cores.len()
        ));
        return Ok(builder.build()?);
    }
    let is_pinned = Arc::new(AtomicBool::new(true));
    let pinned = is_pinned.clone();
    let pool = builder.start_handler(move |index| {
        if !core_affinity::set_for_current(cores[index]) {
            pinned.store(false, Ordering::Relaxed);
        }
    });
    let pool = pool.build()?;
    // Each thread has started once it has run this.
    pool.broadcast(|_| ());
    output::warn(match is_pinned.load(Ordering::Relaxed) {
        true => format!("threads, each pinned to a logical processor: {threads}"),
        false => "threads are not pinned: the system does not allow it".to_string(),
    });
    Ok(pool)
}

/// Returns the arguments for the program that runs Rapier.
fn for_rapier(arguments: &Arguments) -> Vec<String> {
    let mut passed = vec![format!("--dim={}", arguments.dim)];
    passed.extend(arguments.n.map(|n| format!("--n={n}")));
    passed.extend(
        arguments
            .scene
            .as_ref()
            .map(|scene| format!("--scene={scene}")),
    );
    passed.extend(arguments.frames.map(|frames| format!("--frames={frames}")));
    passed.extend(arguments.json.then(|| "--json".into()));
    passed
}

fn measures(arguments: &Arguments) -> Result<Vec<Measure>> {
    let progress = Progress::new();
    match (&arguments.scene, arguments.against, arguments.n) {
        (Some(name), ..) => scene(name, &arguments.changes, &progress),
        (None, Some(_), _) => against_uniform(arguments, &progress),
        (None, None, Some(n)) if arguments.dim == 2 => ball::<Dim2>(n.into()),
        (None, None, Some(n)) => ball::<Dim3>(n.into()),
        (None, None, None) => usual(&progress),
    }
}

fn ball<D: Dim>(n: usize) -> Result<Vec<Measure>> {
    Ok(vec![element_time::<D>(n, 0)?, pushed_ball::<D>(n)?])
}

fn usual(progress: &Progress) -> Result<Vec<Measure>> {
    progress.expect(21);
    let mut measures = Vec::new();
    let mut add = |measured: Result<Vec<Measure>>| -> Result<()> {
        measures.extend(measured?);
        progress.step();
        Ok(())
    };
    add(one(element_time::<Dim2>(128, 0)))?;
    add(one(element_time::<Dim2>(128, 200)))?;
    for cracks in [0, 100, 600] {
        add(one(element_time::<Dim3>(32, cracks)))?;
    }
    for cracks in [0, 300] {
        add(one(element_time::<Dim3>(64, cracks)))?;
    }
    for n in [64, 128, 256, 512] {
        add(one(release_time::<Dim2>(n)))?;
    }
    add(one(release_time::<Dim3>(64)))?;
    for name in [
        "drop", "drop-3d", "tear", "diced", "pile", "tear-3d", "heap-3d",
    ] {
        add(scene(name, &[], &Progress::new()))?;
    }
    add(one(pushed_ball::<Dim3>(64)))?;
    add(one(memory()))?;
    Ok(measures)
}

fn one(measure: Result<Measure>) -> Result<Vec<Measure>> {
    Ok(vec![measure?])
}

/// Measures the time of a substep per element, on a freely oscillating ball with a number of cracks. A
/// substep consists of an element pass and a node pass.
fn element_time<D: Dim>(n: usize, cracks: usize) -> Result<Measure> {
    let mut body = torn::<D>(n, cracks)?;
    let elements = body.mesh().element_count() as f64;
    let times = timed(400, || body.advance(1.0 / 7680.0, D::Vector::ZERO));
    let torn = match cracks {
        0 => String::new(),
        _ => format!(", {cracks} cracks"),
    };
    let what = format!("{}D ball n = {n}{torn}, time per element and substep", D::N);
    Ok(measure(what, "ns", times, 1e9 / elements))
}

/// Measures releases (splits of a node, followed by remodelling) in a ball, each at another point near its
/// surface.
fn release_time<D: Dim>(n: usize) -> Result<Measure> {
    let grid = VoxelGrid::<D>::ball(n, 1.0)?;
    let mut body = SoftBody::new(grid, &[Material::default()])?;
    // Points where every third column of voxels enters the ball. Only columns in the middle half of the
    // ball's width are used.
    let columns = || (n / 4..3 * n / 4).step_by(3);
    let rows = if D::N == 3 {
        columns().collect()
    } else {
        vec![0]
    };
    let mut places = Vec::new();
    for (x, z) in columns().flat_map(|x| rows.iter().map(move |&z| (x as i32, z as i32))) {
        let lowest = (0..n as i32).find(|&y| body.grid().is_solid([x, y, z]));
        places.extend(lowest.map(|y| [x, y, z]));
    }
    let mut times = Vec::new();
    for at in places {
        let start = Instant::now();
        body.release(&[(at, 0b1010_1010)]);
        times.push(start.elapsed().as_secs_f64());
    }
    let what = format!("{}D ball n = {n}, one release and remodel", D::N);
    Ok(measure(what, "us", times, 1e6))
}

/// Measures the ticks of a scene. If it tears, separates the ticks before and after the first tear.
fn scene(name: &str, changes: &[String], progress: &Progress) -> Result<Vec<Measure>> {
    let scene = open_scene(name, changes)?;
    report::notes(&scene);
    let name = [&[name.to_string()], changes].concat().join(" ");
    match scene.dim {
        2 => scene_in::<Dim2>(&name, &scene, progress),
        _ => scene_in::<Dim3>(&name, &scene, progress),
    }
}

/// Measures a scene several times. All runs are identical, so the cost of a tick is its shortest time in any
/// run; longer times come from other programs.
fn scene_in<D: Dim>(name: &str, scene: &Scene, progress: &Progress) -> Result<Vec<Measure>> {
    const RUNS: u64 = 3;
    progress.expect(RUNS * scene.ticks());
    let mut times = vec![f64::INFINITY; scene.ticks() as usize];
    let (mut whole, mut pieces) = (times.len(), 0);
    for _ in 0..RUNS {
        let mut world = scene.build::<D>()?;
        for (tick, time) in times.iter_mut().enumerate() {
            scene.set_hand_targets(&mut world, tick as u64);
            let start = Instant::now();
            let report = world.step();
            *time = time.min(start.elapsed().as_secs_f64());
            if report.nodes_split > 0 {
                whole = whole.min(tick);
            }
            progress.step();
        }
        let counts = world
            .soft_bodies()
            .map(|(_, body)| body.pieces().list.len());
        pieces = counts.sum();
    }
    if whole == times.len() {
        let what = format!("scene {name}, time per tick; {pieces} pieces at the end");
        return Ok(vec![measure(what, "ms", times, 1e3)]);
    }
    let what =
        format!("scene {name}, time per tick from the first tear on; {pieces} pieces at the end");
    let torn = times.split_off(whole);
    let before = format!("scene {name}, time per tick before the first tear");
    let mut measures = vec![measure(what, "ms", torn, 1e3)];
    if !times.is_empty() {
        measures.insert(0, measure(before, "ms", times, 1e3));
    }
    Ok(measures)
}

/// Measures the ticks in which a hand squashes a soft ball, which lies on the floor, by about a third of its
/// height.
fn pushed_ball<D: Dim>(n: usize) -> Result<Measure> {
    const TICKS: u16 = 60;
    let mut world = World::<D>::new(WorldConfig::default())?;
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world.add_rigid_body(RigidBody::fixed(floor).with_friction(0.5))?;
    world.add_soft_body(SoftBody::new(
        VoxelGrid::ball(n, 1.0)?,
        &[Material::default()],
    )?)?;
    let above = |height: f32| D::Vector::from_vec3(Vec3::new(0.5, height, 0.5));
    let hand = world.add_rigid_body(RigidBody::coupled(Shape::ball(0.2)).at(above(1.2)))?;
    let mut times = Vec::new();
    for tick in 1..=TICKS {
        let down = 0.35 * f32::from(tick) / f32::from(TICKS);
        world.set_target_position(hand, above(1.2 - down))?;
        let start = Instant::now();
        world.step();
        times.push(start.elapsed().as_secs_f64());
    }
    let what = format!(
        "{}D ball n = {n} pushed onto the floor, time per tick",
        D::N
    );
    Ok(measure(what, "ms", times, 1e3))
}

/// Measures the peak memory of the process after it has created and advanced a ball 128 voxels across.
fn memory() -> Result<Measure> {
    let mut body = swinging::<Dim3>(128, Grading::Graded)?;
    body.advance(1e-4, Vec3::ZERO);
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok());
    let peak: f64 = kilobytes.unwrap_or(f64::NAN);
    let what = "3D ball n = 128, peak memory of this run".to_string();
    Ok(measure(what, "MB", vec![peak / 1024.0], 1.0))
}

/// Compares an oscillating graded ball with a uniform one. The balls alternate after every 16 substeps, the
/// substeps of a tick.
fn against_uniform(arguments: &Arguments, progress: &Progress) -> Result<Vec<Measure>> {
    let n = arguments.n.map(usize::from);
    match arguments.dim {
        2 => against_uniform_in::<Dim2>(n.unwrap_or(128), progress),
        _ => against_uniform_in::<Dim3>(n.unwrap_or(32), progress),
    }
}

fn against_uniform_in<D: Dim>(n: usize, progress: &Progress) -> Result<Vec<Measure>> {
    const ROUNDS: usize = 40;
    let mut graded = swinging::<D>(n, Grading::Graded)?;
    let mut uniform = swinging::<D>(n, Grading::Uniform)?;
    let duration = graded.longest_substep() as f32;
    let tick = |body: &mut SoftBody<D>| {
        let start = Instant::now();
        for _ in 0..16 {
            body.advance(duration, D::Vector::ZERO);
        }
        start.elapsed().as_secs_f64()
    };
    let (mut ours, mut theirs, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    progress.expect(ROUNDS as u64);
    for _ in 0..ROUNDS {
        let (own, other) = (tick(&mut graded), tick(&mut uniform));
        ours.push(own);
        theirs.push(other);
        ratios.push(other / own);
        progress.step();
    }
    let named = |what: &str, body: &SoftBody<D>| {
        let elements = body.mesh().element_count();
        format!(
            "{}D ball n = {n}, {what}, {elements} elements, 16 substeps",
            D::N
        )
    };
    Ok(vec![
        measure(named("graded", &graded), "ms", ours, 1e3),
        measure(named("uniform", &uniform), "ms", theirs, 1e3),
        measure("uniform / graded".into(), "times", ratios, 1.0),
    ])
}

/// Returns a ball 1 m across, stretched by 5 % so that it oscillates.
fn swinging<D: Dim>(n: usize, grading: Grading) -> Result<SoftBody<D>> {
    let grid = VoxelGrid::<D>::ball(n, 1.0)?;
    let mut body =
        SoftBody::with_options(grid, &[Material::default()], Law::CorotationalVem, grading)?;
    let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    for id in nodes {
        let (mut at, ..) = body.node_state(id);
        at[0] *= 1.05;
        body.set_node_state(id, at, D::Vector::ZERO)?;
    }
    Ok(body)
}

/// Returns an oscillating ball with `cracks` cracks, each perpendicular to an axis, a few voxels wide and
/// opened point by point.
fn torn<D: Dim>(n: usize, cracks: usize) -> Result<SoftBody<D>> {
    let mut body = swinging::<D>(n, Grading::Graded)?;
    let mut seed = 1u64;
    let mut random = |end: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        ((seed >> 33) % end as u64) as i32
    };
    for _ in 0..cracks {
        let axis = random(D::N) as usize;
        let middle = [0; 3].map(|_: i32| random(n + 1));
        let radius = 2 + random(n / 6);
        // Octants around a lattice point that lie on the lower side of the crack.
        let side = (0..D::CORNERS).filter(|octant| octant >> axis & 1 == 0);
        let side: u8 = side.map(|octant| 1 << octant).sum();
        let reach = |other: usize| {
            if other < D::N && other != axis {
                radius
            } else {
                0
            }
        };
        for dx in -reach(0)..=reach(0) {
            for dy in -reach(1)..=reach(1) {
                let line = -reach(2)..=reach(2);
                let points = line.map(|dz| [middle[0] + dx, middle[1] + dy, middle[2] + dz]);
                let points = points.map(|[x, y, z]| ([x, y, if D::N == 2 { 0 } else { z }], side));
                body.release(&points.collect::<Vec<_>>());
            }
        }
    }
    Ok(body)
}

fn timed(count: usize, mut run: impl FnMut()) -> Vec<f64> {
    (0..count)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed().as_secs_f64()
        })
        .collect()
}

fn measure(what: String, unit: &'static str, mut values: Vec<f64>, scale: f64) -> Measure {
    values.sort_by(f64::total_cmp);
    let at = |place: usize| values.get(place).map_or(f64::NAN, |value| value * scale);
    Measure {
        what,
        unit,
        median: output::quantile(&values, 0.5).map_or(f64::NAN, |value| value * scale),
        best: at(0),
        worst: at(values.len().saturating_sub(1)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        arguments: Arguments,
    }

    fn check(line: &str, expect: &[&str]) {
        let line = Line::parse_from(line.split(' '));
        assert_eq!(for_rapier(&line.arguments), expect);
    }

    #[test]
    fn for_rapier_passes_all_arguments() {
        check("bench --against rapier", &["--dim=2"]);
        check(
            "bench --against rapier --dim 3 --n 16 --scene soft --frames 9 --json",
            &["--dim=3", "--n=16", "--scene=soft", "--frames=9", "--json"],
        );
    }
}

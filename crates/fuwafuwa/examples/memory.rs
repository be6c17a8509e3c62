//! What a body costs: memory and time of its parts, and the time of a release.
//!
//! `cargo run --release -p fuwafuwa --example memory -- 128`
//!
//! The number is the extent of the ball in voxels. Memory is what the process keeps resident; it
//! is known on Linux only, and 0 elsewhere. A part made in memory that another has given back
//! seems smaller than it is: the most that was resident at any time is the figure to trust.
#![allow(clippy::disallowed_types, clippy::disallowed_methods)] // a benchmark needs the clock

use fuwafuwa::dim::neighbourhood;
use fuwafuwa::law::{Elasticity, Law};
use fuwafuwa::pyramid::Pyramid;
use fuwafuwa::sharing::Sharing;
use fuwafuwa::solve::Blocks;
use fuwafuwa::{Body, Dim2, Dim3, Material, Mesh, Point, VoxelGrid};
use std::error::Error;
use std::time::Instant;

/// A figure of the process's status in MB (10⁶ bytes).
fn status(name: &str) -> f64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(name));
    let kibibytes = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kibibytes.unwrap_or(0.0) * 1.024e-3
}

/// Makes one part and reports what it took.
fn part<T>(name: &str, make: impl FnOnce() -> T) -> T {
    let (before, start) = (status("VmRSS:"), Instant::now());
    let made = make();
    let (kept, seconds) = (status("VmRSS:") - before, start.elapsed().as_secs_f64());
    println!("  {name:8} {kept:7.1} MB {seconds:7.3} s");
    made
}

fn report_parts(n: usize, material: Material) -> Result<(), Box<dyn Error>> {
    println!("ball of {n} voxels across in 3D");
    let grid = part("grid", || VoxelGrid::<Dim3>::ball(n, 1.0))?;
    let sharing = part("sharing", || Sharing::new(&grid));
    let pyramid = part("pyramid", || Pyramid::new(&grid, &sharing));
    let mesh = part("mesh", || Mesh::grade(&grid, &sharing, &pyramid))?;
    let all: Vec<u32> = mesh.elements().map(|(id, _)| id).collect();
    let elasticities = vec![material.elasticity];
    let mut blocks = Blocks::new(Law::PatchExact, elasticities, grid.voxel_size());
    part("solve", || blocks.update(&mesh, &grid, &[], &all));
    println!(
        "  {} voxels, {} elements, {} nodes",
        grid.solid_count(),
        mesh.element_count(),
        mesh.node_count()
    );
    Ok(())
}

/// Cracks from all four sides of a square of `n` voxels, 16 points deep, one release each.
fn cracks(n: i32) -> impl Iterator<Item = (Point, u8)> {
    (1..8).flat_map(move |k| {
        let across = n * k / 8 + 3;
        (0..16).flat_map(move |depth| {
            let upright = [depth, n - depth].map(|along| ([across, along, 0], 0b1010));
            let lying = [depth, n - depth].map(|along| ([along, across, 0], 0b1100));
            upright.into_iter().chain(lying)
        })
    })
}

/// The median of times in microseconds.
fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn report_releases(n: usize, material: Material) -> Result<(), Box<dyn Error>> {
    let grid = VoxelGrid::<Dim2>::cube(n, 1.0)?;
    let mut sharing = Sharing::new(&grid);
    let mut pyramid = Pyramid::new(&grid, &sharing);
    let mut mesh = Mesh::grade(&grid, &sharing, &pyramid)?;
    let mut body = Body::new(grid.clone(), &[material], Law::PatchExact)?;
    let (mut connect, mut refine, mut remodel, mut whole) = (vec![], vec![], vec![], vec![]);
    for (at, side) in cracks(n as i32) {
        let start = Instant::now();
        if !sharing.release(at, side) {
            continue;
        }
        let mut changed = vec![at];
        changed.extend(sharing.normalise(neighbourhood::<Dim2>(at, 1).collect()));
        let connected = start.elapsed();
        let near = changed.iter().flat_map(|&at| neighbourhood::<Dim2>(at, 1));
        let born = pyramid.refine(&grid, &sharing, near);
        let refined = start.elapsed();
        mesh.remodel(&grid, &sharing, &pyramid, &changed, &born)?;
        let remodelled = start.elapsed();
        body.release(&[(at, side)])?;
        let done = start.elapsed();
        let microseconds = |from, to: std::time::Duration| (to - from).as_secs_f64() * 1e6;
        connect.push(microseconds(Default::default(), connected));
        refine.push(microseconds(connected, refined));
        remodel.push(microseconds(refined, remodelled));
        whole.push(microseconds(remodelled, done));
    }
    println!(
        "{n:4} voxels across: {} releases, sharing {:.1}, pyramid {:.1}, mesh {:.1}, whole body {:.1} µs",
        whole.len(),
        median(&mut connect),
        median(&mut refine),
        median(&mut remodel),
        median(&mut whole)
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let n = std::env::args().nth(1).map_or(Ok(64), |n| n.parse())?;
    let material = Material {
        elasticity: Elasticity::new(5000.0, 0.3)?,
        density: 100.0,
    };
    report_parts(n, material)?;
    let grid = VoxelGrid::<Dim3>::ball(n, 1.0)?;
    let body = part("body", || Body::new(grid, &[material], Law::PatchExact))?;
    println!("  most resident: {:.1} MB", status("VmHWM:"));
    drop(body);
    println!("one release, median, in a square in 2D");
    [64, 128, 256, 512]
        .into_iter()
        .try_for_each(|n| report_releases(n, material))
}

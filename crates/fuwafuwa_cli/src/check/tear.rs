//! Tearing: bars that are pulled apart break at the load their material bears, at any resolution.

use super::parallel;
use crate::report::{Outcome, Progress};
use anyhow::Result;
use fuwafuwa::{Blade, Body, Dim, Dim2, Dim3, Material, Settings, VoxelGrid, World};

/// Dimensions, voxels across the bar, and whether it has a notch.
const BARS: [(usize, usize, bool); 10] = [
    (2, 32, false),
    (2, 64, false),
    (2, 128, false),
    (2, 32, true),
    (2, 64, true),
    (2, 128, true),
    (3, 16, false),
    (3, 32, false),
    (3, 16, true),
    (3, 32, true),
];
/// How far loads may be from what they should be.
const TOLERANCE: f64 = 0.03;
/// Speed at which the end of a bar is pulled, unnotched and notched [m/s]: slow enough that
/// neither inertia nor damping carries a share of the load.
const SPEEDS: [f32; 2] = [0.03, 0.01];

/// Loads of unnotched bars against strength × area, of notched ones against each other.
pub fn check(progress: &Progress) -> Result<Vec<Outcome>> {
    let loads = parallel::each(&BARS, progress, |&(dim, n, notched)| match dim {
        2 => load::<Dim2>(n, notched),
        _ => load::<Dim3>(n, notched),
    })?;
    let mut outcomes = Vec::new();
    for (&(dim, n, notched), &load) in BARS.iter().zip(&loads) {
        let what = if notched { "notched" } else { "whole" };
        let case = format!("tear {dim}D, n = {n}, {what}, load / reference");
        // The ideal load of a whole bar 1 m across; a notched one has the mean of its sisters.
        let reference = if notched {
            let sisters = BARS
                .iter()
                .zip(&loads)
                .filter(|(bar, _)| bar.0 == dim && bar.2);
            let (count, sum) = sisters.fold((0.0, 0.0), |(count, sum), (_, load)| {
                (count + 1.0, sum + load)
            });
            sum / count
        } else {
            f64::from(Material::default().strength)
        };
        let range = 1.0 - TOLERANCE..=1.0 + TOLERANCE;
        outcomes.push(Outcome::within(case, load / reference, range));
    }
    Ok(outcomes)
}

/// The greatest load [N] on a bar 1 m across whose ends are pulled apart until it breaks.
fn load<D: Dim>(n: usize, notched: bool) -> Result<f64> {
    let length = if notched { 2 } else { 3 };
    let size = [length * n, n, if D::N == 3 { n } else { 1 }];
    let grid = VoxelGrid::<D>::from_fn(size, 1.0 / n as f32, |_| 1)?;
    let mut material = Material {
        damping: 0.3,
        ..Material::default()
    };
    if !notched {
        // Ends that are held cannot grow thin: without bulging, the strain is the same everywhere.
        material.elasticity.poisson = 0.0;
    }
    let mut body = Body::new(grid, &[material])?;
    if notched {
        let blade = Blade {
            from: [0.5 * length as f32 + 0.001, -0.1, -0.1],
            across: [0.0, 0.6, 0.0],
            along: [0.0, 0.0, 1.2],
        };
        body.cut(&blade)?;
    }
    let last = (length * n) as i32;
    let nodes = body.mesh().nodes();
    let ends = nodes.filter(|(_, node)| node.at[0] == 0 || node.at[0] == last);
    let ends: Vec<(u32, bool)> = ends.map(|(id, node)| (id, node.at[0] == last)).collect();
    for &(id, _) in &ends {
        body.hold(id);
    }
    let mut world = World::<D>::new(Settings {
        gravity: [0.0; 3],
        drag: 0.0,
        most_substeps: 256,
    })?;
    world.add_body(body);
    let speed = SPEEDS[usize::from(notched)];
    let mut peak = 0.0f64;
    for tick in 0..6000 {
        if tick <= 60 {
            let velocity = [speed * tick as f32 / 60.0, 0.0, 0.0];
            let body = world.body_mut(0);
            for &(id, _) in ends.iter().filter(|(_, is_pulled)| *is_pulled) {
                let place = body.node_state(id).0;
                body.set_node_state(id, place, velocity);
            }
        }
        world.step();
        let body = &world.bodies()[0];
        let held = ends.iter().filter(|(_, is_pulled)| !is_pulled);
        let load = held
            .map(|&(id, _)| f64::from(body.force_on(id)[0]))
            .sum::<f64>();
        peak = peak.max(load);
        if peak > 10.0 && load < 0.3 * peak {
            return Ok(peak);
        }
    }
    anyhow::bail!("the bar of {n} voxels did not break")
}

//! Tearing: bars pulled apart break at the load given by their material's strength, at any resolution.

use super::parallel;
use crate::plot::{Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::Result;
use fuwafuwa::{
    Blade, Damping, Dim, Dim2, Dim3, DimVector, Material, SoftBody, StiffBodies, Vec2, Vec3,
    VoxelGrid, World, WorldConfig,
};

/// Bars: number of dimensions, voxels across, and whether the bar has a notch.
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
/// Maximum relative deviation of a breaking load from its reference.
const TOLERANCE: f64 = 0.03;
/// Pulling speed of unnotched and of notched bars [m/s]. Both are so low that inertia and damping hardly
/// contribute to the load.
const SPEEDS: [f32; 2] = [0.03, 0.01];
/// Initial strain of unnotched and of notched bars, relative to strength / Young's modulus. An unnotched bar
/// starts in equilibrium. A notched bar starts with uniform strain, which then concentrates at the notch and
/// overshoots. Its initial strain is low so that the overshoot does not break it.
const STARTS: [f32; 2] = [0.85, 0.08];
/// Position of the notch along the bar [m], slightly beside the boundary between voxels at 1 m.
const NOTCH: f32 = 1.001;

/// Compares breaking loads. Unnotched bars must break at strength × area, notched bars at equal loads.
pub fn check(progress: &Progress) -> Result<Findings> {
    let loads = parallel::each(&BARS, progress, |&(dim, n, notched)| match dim {
        2 => load(n, notched.then(notch_line).as_ref()),
        _ => load(n, notched.then(notch_plane).as_ref()),
    })?;
    let mut outcomes = Vec::new();
    let mut series: Vec<Points> = Vec::new();
    for (&(dim, n, notched), &load) in BARS.iter().zip(&loads) {
        let what = if notched { "notched" } else { "whole" };
        let case = format!("tear {dim}D, n = {n}, {what}, load / reference");
        // Reference load [N]. Unnotched bars: load at which an ideal bar 1 m wide breaks. Notched bars: mean
        // load over all resolutions.
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
        let name = format!("{dim}D, {what}");
        let point = (n as f64, load / reference);
        match series.last_mut().filter(|series| series.name == name) {
            Some(series) => series.points.push(point),
            None => series.push(Points::new(name, [point])),
        }
    }
    let plot = Plot {
        x: "voxels across the bar".into(),
        y: "breaking load / reference".into(),
        points: series,
        band: Some(1.0 - TOLERANCE..=1.0 + TOLERANCE),
        is_log: [true, false],
        ..Plot::default()
    };
    Ok(Findings {
        outcomes,
        plots: vec![plot],
    })
}

/// Returns the blade that notches a 2D bar up to half its width.
fn notch_line() -> Blade<Dim2> {
    Blade::segment(Vec2::new(NOTCH, -0.1), Vec2::new(NOTCH, 0.5))
}

/// Returns the blade that notches a 3D bar up to half its width.
fn notch_plane() -> Blade<Dim3> {
    Blade::parallelogram(Vec3::new(NOTCH, -0.1, -0.1), 0.6 * Vec3::Y, 1.2 * Vec3::Z)
}

/// Pulls at both ends of a bar 1 m wide until it breaks, and returns the maximum load [N]. The blade `notch`
/// cuts the bar first. The load of a bar without a notch is that up to its first split: while it breaks, waves raise
/// the load at its end by up to 4 %.
fn load<D: Dim>(n: usize, notch: Option<&Blade<D>>) -> Result<f64> {
    let length = if notch.is_some() { 2 } else { 3 };
    let size = [length * n, n, D::depth(n)];
    let grid = VoxelGrid::<D>::from_fn(size, 1.0 / n as f32, |_| 1)?;
    let mut material = Material {
        damping: Damping::at(0.3, 4.0),
        ..Material::default()
    };
    if notch.is_none() {
        // An unnotched bar starts in equilibrium, and mass damping would add the drag of the moving voxels to the load.
        material.damping.mass = 0.0;
        // Poisson's ratio 0 keeps the strain uniform, although the fixed ends cannot contract sideways.
        material.elasticity.poisson = 0.0;
    }
    let mut body = SoftBody::new(grid, &[material])?;
    if let Some(notch) = notch {
        body.cut(notch);
    }
    let last = (length * n) as i32;
    let nodes: Vec<_> = body.mesh().nodes().collect();
    let kind = usize::from(notch.is_some());
    let (start, speed) = (STARTS[kind], SPEEDS[kind]);
    let strain = start * material.strength / material.elasticity.young as f32;
    for &(id, node) in &nodes {
        let (mut at, _, _) = body.node_state(id);
        at[0] *= 1.0 + strain;
        let share = node.at[0] as f32 / last as f32;
        body.set_node_state(id, at, D::Vector::X * (speed * share))?;
        if node.at[0] == 0 || node.at[0] == last {
            body.fix_node(id);
        }
    }
    let held: Vec<_> = nodes
        .iter()
        .filter(|(_, node)| node.at[0] == 0)
        .map(|&(id, _)| id)
        .collect();
    let mut world = World::<D>::new(WorldConfig {
        gravity: D::Vector::ZERO,
        drag: 0.0,
        stiff_bodies: StiffBodies::Exact,
        ..WorldConfig::default()
    })?;
    let bar = world.add_soft_body(body)?;
    let mut peak = 0.0f64;
    for _ in 0..6000 {
        let split = world.step().nodes_split;
        let forces = held.iter().map(|&id| world[bar].force_on(id));
        let load: f64 = forces.map(|force| f64::from(force[0])).sum();
        peak = peak.max(load);
        if notch.is_none() && split > 0 {
            return Ok(peak);
        }
        if peak > 10.0 && load < 0.3 * peak {
            return Ok(peak);
        }
    }
    anyhow::bail!("the bar with {n} voxels across did not break")
}

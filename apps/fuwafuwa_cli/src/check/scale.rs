//! Size: bodies from 1 m to 0.5 mm rest, tear and oscillate as theory or a similar larger body does.
//!
//! The size of a body at rest enters only through ρ g L / E: a body of width w and Young's modulus E rests like a
//! body 1 m wide with Young's modulus E · 1 m / w. That body needs few substeps and is the reference. A small body
//! needs many: up to 15,000 in 1/60 s. Under mass scaling it gets 64. Its shape at rest and the load at which it
//! tears must be the same; its period is √s times longer, which is shown only.

use super::parallel;
use crate::plot::{Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, bail};
use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimVector, Hooks, Material, RigidBody, Shape, SoftBody, StiffBodies,
    Vec2, Vec3, VoxelGrid, World, WorldConfig,
};
use std::sync::{Mutex, PoisonError};

/// Widths of the bodies [m].
const WIDTHS: [f32; 5] = [1.0, 0.1, 0.01, 0.002, 0.0005];
/// Discs and balls: dimensions, voxels across.
const BALLS: [(usize, usize); 2] = [(2, 24), (3, 8)];
/// Voxels across a bar, which is three times as long.
const BAR: usize = 8;
/// All treatments of stiff bodies.
pub const TREATMENTS: [StiffBodies; 3] = [
    StiffBodies::Exact,
    StiffBodies::MassScaled,
    StiffBodies::Softened,
];
/// Treatments that must agree.
const COMPARED: [StiffBodies; 2] = [StiffBodies::Exact, StiffBodies::MassScaled];
/// Maximum relative error of a height at rest, of the load of a tearing bar, and of a period.
const TOLERANCE: f64 = 0.01;
/// Maximum relative error of the load of a bar 1 m wide, compared with strength × section. It is that of the check
/// of tearing.
const LOAD_TOLERANCE: f64 = 0.03;
/// Lowest frequency of a ball 1 m wide of the default material [Hz].
const FREQUENCY: f32 = 4.0;
/// Rate of the strain of the bars [1/s]. An overloaded node takes a moment to fail, so a bar tears at a strain that
/// is 2 % beyond its strength.
const RATE: f32 = 0.01;
/// Number of periods of an oscillation.
const PERIODS: f32 = 8.0;
/// Time in which the vibration of a ball 1 m wide ends [s].
const REST: f32 = 3.0;
/// Time in which the hops of a body 1 m wide end [s].
const HOPS: f32 = 2.0;

/// Measurement of a body.
#[derive(Copy, Clone, Debug, PartialEq)]
enum Kind {
    /// Height at rest [widths].
    Height { dim: usize, n: usize },
    /// Load at which a bar tears, relative to its section and to that of a bar 1 m wide.
    Load,
    /// Period of a disc [s], relative to that of a disc 1 m wide of the same material times the width.
    Period,
}

/// One case: measurement, treatment, and width of the body [m].
type Case = (Kind, StiffBodies, f32);

impl Kind {
    /// Name in the legend of a plot.
    fn short(self) -> String {
        match self {
            Self::Height { dim, .. } => format!("height at rest, {dim}D"),
            Self::Load => "tearing load".into(),
            Self::Period => "period".into(),
        }
    }
}

/// Compares heights at rest, loads and periods.
pub fn check(progress: &Progress) -> Result<Findings> {
    let kinds = BALLS.map(|(dim, n)| Kind::Height { dim, n });
    let kinds = kinds.into_iter().chain([Kind::Load, Kind::Period]);
    let cases: Vec<Case> = kinds
        .flat_map(|kind| COMPARED.map(|treatment| (kind, treatment)))
        .flat_map(|(kind, treatment)| WIDTHS.map(|width| (kind, treatment, width)))
        .collect();
    let found = parallel::each(&cases, progress, |&(kind, treatment, width)| {
        measure(kind, treatment, width)
    })?;
    let outcome = |(&(kind, treatment, width), (ratio, scale)): (&_, (f64, f64))| {
        let what = match kind {
            Kind::Height { dim, n } => {
                format!("{dim}D, n = {n}, height at rest / that of a similar body")
            }
            Kind::Load => "2D bar, tearing load per section / that of a bar 1 m wide".into(),
            Kind::Period => "2D disc, period / that of a similar body".into(),
        };
        let case = format!(
            "scale {}, {} mm wide, {what}, scale {scale:.1}",
            name(treatment),
            1e3 * width
        );
        match kind == Kind::Period && scale > 1.0 {
            true => Outcome::shown(case, ratio),
            false => Outcome::near(case, ratio, 1.0, TOLERANCE),
        }
    };
    let outcomes = cases.iter().zip(found.iter().copied()).map(outcome);
    let mut outcomes: Vec<Outcome> = outcomes.collect();
    let (reference, _) = load(StiffBodies::Exact, 1.0)?;
    let case = "scale exact, 1000 mm wide, 2D bar, tearing load / (strength × section)";
    outcomes.push(Outcome::near(case.into(), reference, 1.0, LOAD_TOLERANCE));
    let plots = COMPARED.map(|treatment| {
        let rows = cases.chunks(WIDTHS.len()).zip(found.chunks(WIDTHS.len()));
        let rows = rows.filter(|(cases, _)| cases[0].1 == treatment);
        // The periods of scaled bodies are shown in the table only.
        let is_bounded = |kind, scale| kind != Kind::Period || scale == 1.0;
        let points = rows.map(|(cases, found)| {
            let points = cases.iter().zip(found);
            let points = points.filter(|((kind, ..), (_, scale))| is_bounded(*kind, *scale));
            let point =
                |(&(.., width), &(ratio, _)): (&Case, &(f64, f64))| (1e3 * f64::from(width), ratio);
            Points::new(cases[0].0.short(), points.map(point))
        });
        Plot {
            x: format!("width of the body [mm], {}", name(treatment)),
            y: "measured / reference".into(),
            points: points.collect(),
            band: Some(1.0 - TOLERANCE..=1.0 + TOLERANCE),
            is_log: [true, false],
            ..Plot::default()
        }
    });
    Ok(Findings {
        outcomes,
        plots: plots.into(),
    })
}

/// Name of a treatment in the outcomes.
pub fn name(treatment: StiffBodies) -> &'static str {
    match treatment {
        StiffBodies::Exact => "exact",
        StiffBodies::MassScaled => "mass-scaled",
        StiffBodies::Softened => "softened",
    }
}

/// Returns a measurement relative to its reference, and the mass scale of the body.
fn measure(kind: Kind, treatment: StiffBodies, width: f32) -> Result<(f64, f64)> {
    match kind {
        Kind::Height { dim: 2, n } => height_ratio::<Dim2>(n, treatment, width),
        Kind::Height { n, .. } => height_ratio::<Dim3>(n, treatment, width),
        Kind::Load => {
            let ((found, scale), (reference, _)) =
                (load(treatment, width)?, load(StiffBodies::Exact, 1.0)?);
            Ok((found / reference, scale))
        }
        Kind::Period => {
            let (found, scale) = period(treatment, width)?;
            let (reference, _) = period(StiffBodies::Exact, 1.0)?;
            Ok((found / (reference * f64::from(width)), scale))
        }
    }
}

fn height_ratio<D: Dim>(n: usize, treatment: StiffBodies, width: f32) -> Result<(f64, f64)> {
    let (found, scale) = height::<D>(n, treatment, width, 1.0)?;
    let (reference, _) = height::<D>(n, StiffBodies::Exact, 1.0, 1.0 / f64::from(width))?;
    Ok((found / reference, scale))
}

/// Returns a world without sleep.
fn world<D: Dim>(treatment: StiffBodies, gravity: bool) -> Result<World<D>> {
    let mut config = WorldConfig {
        stiff_bodies: treatment,
        sleep: false,
        ..WorldConfig::default()
    };
    if !gravity {
        config.gravity = D::Vector::ZERO;
    }
    Ok(World::new(config)?)
}

/// Returns damping with a ratio of 0.3 at the lowest frequency of a body of which vibrations are `slower` times
/// slower than those of a body 1 m wide.
fn damping(slower: f32) -> Damping {
    Damping {
        stiffness: Damping::default().stiffness,
        ..Damping::at(0.3, FREQUENCY / slower)
    }
}

/// Returns the number of ticks in which a body comes to rest, of which vibrations are `slower` times slower than
/// those of a body 1 m wide. It first hops, for times proportional to the root of its width. A few ticks are
/// added, because mass damping acts only four times in a tick.
fn ticks(slower: f32, width: f32) -> u32 {
    (60.0 * (REST * slower + HOPS * width.sqrt())).ceil() as u32 + 12
}

/// Returns the height at rest of a disc or cube on a floor [widths], and its mass scale. A ball would come to rest
/// with another side below at each size. Young's modulus is
/// `stiffer` times the default.
fn height<D: Dim>(
    n: usize,
    treatment: StiffBodies,
    width: f32,
    stiffer: f64,
) -> Result<(f64, f64)> {
    let slower = width / stiffer.sqrt() as f32;
    let mut material = Material {
        damping: damping(slower),
        strength: f32::INFINITY,
        ..Material::default()
    };
    material.elasticity.young *= stiffer;
    let mut world = world::<D>(treatment, true)?;
    world.add_rigid_body(RigidBody::fixed(floor()))?;
    let grid = match D::N {
        2 => VoxelGrid::ball(n, width)?,
        _ => VoxelGrid::cube(n, width)?,
    };
    let body = world.add_soft_body(SoftBody::new(grid, &[material])?)?;
    let scale = world[body].mass_scale();
    for _ in 0..ticks(slower * scale.sqrt() as f32, width) {
        world.step();
    }
    let top = world[body].piece_views()[0].high[1];
    Ok((f64::from(top) / f64::from(width), scale))
}

/// Returns the half-space below the origin.
pub fn floor<D: Dim>() -> Shape<D> {
    Shape::half_space(D::Vector::from_vec3(Vec3::Y), D::Vector::ZERO)
}

/// Pulls at both ends of a bar until it tears. Returns the largest load, relative to strength × section, and the
/// mass scale.
fn load(treatment: StiffBodies, width: f32) -> Result<(f64, f64)> {
    let grid = VoxelGrid::<Dim2>::from_fn([3 * BAR, BAR, 1], width / BAR as f32, |_| 1)?;
    let mut material = Material {
        damping: damping(width),
        ..Material::default()
    };
    // Poisson's ratio 0 keeps the strain uniform, although the fixed ends cannot contract sideways.
    material.elasticity.poisson = 0.0;
    let mut body = SoftBody::new(grid, &[material])?;
    let full = material.strength / material.elasticity.young as f32;
    let nodes: Vec<_> = body.mesh().nodes().collect();
    for &(id, node) in &nodes {
        let (mut at, _, _) = body.node_state(id);
        let speed = RATE * at.x;
        at.x *= 1.0 + 0.9 * full;
        body.set_node_state(id, at, Vec2::new(speed, 0.0))?;
        if node.at[0] == 0 || node.at[0] == 3 * BAR as i32 {
            body.fix_node(id);
        }
    }
    let end = |at: i32| {
        let held = nodes.iter().filter(move |(_, node)| node.at[0] == at);
        held.map(|&(id, _)| id).collect::<Vec<_>>()
    };
    let ends = [end(0), end(3 * BAR as i32)];
    let mut world = world::<Dim2>(treatment, false)?;
    let bar = world.add_soft_body(body)?;
    let scale = world[bar].mass_scale();
    let ideal = f64::from(material.strength * width);
    let mut peak = 0.0f64;
    for _ in 0..(60.0 * full / RATE).ceil() as u32 {
        let split = world.step().nodes_split;
        for end in &ends {
            let loads = end.iter().map(|&id| f64::from(world[bar].force_on(id).x));
            peak = peak.max(loads.sum::<f64>().abs());
        }
        if split > 0 {
            return Ok((peak / ideal, scale));
        }
    }
    bail!("the bar of {width} m did not tear")
}

/// Returns the period of a squeezed disc [s], and its mass scale.
fn period(treatment: StiffBodies, width: f32) -> Result<(f64, f64)> {
    let material = Material {
        damping: Damping::NONE,
        strength: f32::INFINITY,
        ..Material::default()
    };
    let mut body = SoftBody::new(VoxelGrid::ball(16, width)?, &[material])?;
    let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    let middle = Vec2::splat(0.5 * width);
    let mut rest = Vec::new();
    for &id in &nodes {
        let offset = body.node_state(id).0 - middle;
        let squeezed = middle + offset * Vec2::new(1.02, 0.98);
        body.set_node_state(id, squeezed, Vec2::ZERO)?;
        rest.push(offset / width);
    }
    let mut world = world::<Dim2>(treatment, false)?;
    let body = world.add_soft_body(body)?;
    let scale = world[body].mass_scale();
    // The field is evaluated at all nodes in each substep, in their order, because there is only one small body. This
    // gives the squeeze in each substep.
    let watched = Mutex::new((0, 0.0f64, Vec::new()));
    let watch = |at: Vec2| {
        let mut watched = watched.lock().unwrap_or_else(PoisonError::into_inner);
        let (count, sum, signal) = &mut *watched;
        let offset = (at - middle) / width;
        let own = rest[*count];
        *sum += f64::from(own.x * offset.x - own.y * offset.y);
        *count += 1;
        if *count == rest.len() {
            signal.push(*sum);
            (*count, *sum) = (0, 0.0);
        }
        Vec2::ZERO
    };
    let about = width * scale.sqrt() as f32 / FREQUENCY;
    let mut substep = 0.0;
    for _ in 0..(60.0 * PERIODS * about).ceil() as u32 {
        let report = world.step_with(&mut Hooks {
            field: Some(&watch),
            ..Hooks::default()
        });
        substep = f64::from(world.config().tick) / f64::from(report.substeps);
    }
    let (.., signal) = watched.into_inner().unwrap_or_else(PoisonError::into_inner);
    let crossings: Vec<f64> = signal
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] * pair[1] < 0.0)
        .map(|(k, pair)| k as f64 + pair[0] / (pair[0] - pair[1]))
        .collect();
    let [first, .., last] = crossings[..] else {
        bail!("the disc of {width} m does not oscillate")
    };
    Ok((
        2.0 * substep * (last - first) / (crossings.len() - 1) as f64,
        scale,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_disc_rests_like_a_similar_one() {
        let (ratio, scale) = height_ratio::<Dim2>(12, StiffBodies::MassScaled, 0.002).unwrap();
        assert!(scale > 100.0, "{scale}");
        assert!((ratio - 1.0).abs() < TOLERANCE, "{ratio}");
    }
}

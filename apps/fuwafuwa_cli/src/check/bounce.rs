//! Bounces: bodies of 1 m to 2 mm bounce off a floor under mass scaling almost as high as exact bodies do.
//!
//! Mass scaling makes a body stop sooner, and leaves more of the energy in vibrations.

use super::motion::throw;
use super::parallel;
use super::scale::floor;
use crate::plot::{Curve, Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, bail};
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Material, RigidBody, SoftBody, StiffBodies, Vec3, VoxelGrid, World,
    WorldConfig,
};

/// Bodies: dimensions, voxels across.
const BODIES: [(usize, usize); 2] = [(2, 32), (3, 12)];
/// Widths of the bodies [m].
const WIDTHS: [f32; 8] = [1.0, 0.1, 0.057, 0.05, 0.03, 0.02, 0.01, 0.002];
/// Speeds [m/s].
const SPEEDS: [f32; 3] = [1.0, 2.0, 4.0];
/// Largest mass scale at which the restitution is bounded. Beyond it, bounces die: the contact force grows with the
/// root of the mass scale, so a body stops sooner and keeps more of its energy in vibrations.
const BOUNDED: f64 = 4.2;
/// Maximum difference of the restitution from that of an exact body.
const TOLERANCE: f64 = 0.2;

/// Compares restitutions.
pub fn check(progress: &Progress) -> Result<Findings> {
    let cases: Vec<_> = { BODIES.iter() }
        .flat_map(|&body| SPEEDS.map(|speed| (body, speed)))
        .flat_map(|(body, speed)| WIDTHS.map(|width| (body, speed, width)))
        .collect();
    let found = parallel::each(&cases, progress, |&((dim, n), speed, width)| match dim {
        2 => both::<Dim2>(n, speed, width),
        _ => both::<Dim3>(n, speed, width),
    })?;
    let outcome = |(&((dim, n), speed, width), [(exact, _), (restitution, scale)]): (
        &_,
        [(f64, f64); 2],
    )| {
        let case = format!(
            "bounce {dim}D, n = {n}, {} mm wide, {speed} m/s, restitution minus exact {exact:.3}, scale {scale:.1}",
            1e3 * width
        );
        match scale <= BOUNDED {
            true => Outcome::near(case, restitution - exact, 0.0, TOLERANCE),
            false => Outcome::shown(case, restitution - exact),
        }
    };
    let outcomes = cases.iter().zip(found.iter().copied()).map(outcome);
    let outcomes = outcomes.collect();
    let points = found
        .iter()
        .map(|&[(exact, _), (restitution, scale)]| (scale, restitution - exact));
    let (bounded, others): (Vec<_>, Vec<_>) = points.partition(|&(scale, _)| scale <= BOUNDED);
    let limit = |at: f64| Curve::new([(1.0, at), (BOUNDED, at)]);
    let plot = Plot {
        x: "mass scale".into(),
        y: "restitution minus that of an exact body".into(),
        curves: vec![
            limit(TOLERANCE).named("bound"),
            limit(-TOLERANCE).named("bound"),
        ],
        points: vec![
            Points::new("measured", bounded),
            Points::new("for comparison", others),
        ],
        is_log: [true, false],
        ..Plot::default()
    };
    Ok(Findings {
        outcomes,
        plots: vec![plot],
    })
}

/// Returns the restitution and the mass scale of an exact and of a mass-scaled body.
fn both<D: Dim>(n: usize, speed: f32, width: f32) -> Result<[(f64, f64); 2]> {
    let of = |treatment| restitution::<D>(n, speed, treatment, width);
    Ok([of(StiffBodies::Exact)?, of(StiffBodies::MassScaled)?])
}

/// Throws a body at a floor. Returns the ratio of its speeds after and before the impact, and its mass scale.
fn restitution<D: Dim>(
    n: usize,
    speed: f32,
    treatment: StiffBodies,
    width: f32,
) -> Result<(f64, f64)> {
    let mut world = World::<D>::new(WorldConfig {
        gravity: D::Vector::ZERO,
        stiff_bodies: treatment,
        ..WorldConfig::default()
    })?;
    let material = Material {
        strength: f32::INFINITY,
        ..Material::default()
    };
    world.add_rigid_body(RigidBody::fixed(floor()))?;
    let body = world.add_soft_body(SoftBody::new(VoxelGrid::ball(n, width)?, &[material])?)?;
    throw(&mut world, body, D::Vector::from_vec3(-speed * Vec3::Y))?;
    let scale = world[body].mass_scale();
    let velocity = |world: &World<D>| world[body].momentum().linear.y / world[body].total_mass();
    let lowest = |world: &World<D>| {
        let nodes = world[body].mesh().nodes();
        let heights = nodes.map(|(id, _)| world[body].node_state(id).0[1]);
        heights.fold(f32::INFINITY, f32::min)
    };
    for _ in 0..MAX_TICKS {
        world.step();
        if velocity(&world) > 0.0 && lowest(&world) > 0.1 * width {
            return Ok((velocity(&world) / f64::from(speed), scale));
        }
    }
    bail!("the body of {width} m stays on the floor")
}

/// Maximum number of ticks until a body has left the floor.
const MAX_TICKS: u32 = 600;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slightly_scaled_disc_bounces_like_an_exact_one() {
        let [exact, scaled] = both::<Dim2>(32, 1.0, 0.06).unwrap();
        assert_eq!(exact.1, 1.0);
        assert!(scaled.1 > 2.0, "{scaled:?}");
        assert!(
            (exact.0 - scaled.0).abs() < TOLERANCE,
            "{exact:?} {scaled:?}"
        );
    }
}

//! Free fall: a body in flight moves as a point mass does, at every size and speed, and under every treatment of
//! stiff bodies.

use super::motion::{centre, throw};
use super::parallel;
use super::scale::{TREATMENTS, name};
use crate::plot::{Curve, Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, ensure};
use fuwafuwa::glam::DVec3;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Material, SoftBody, StiffBodies, Vec3, VoxelGrid, World,
    WorldConfig,
};

/// Bodies: dimensions, voxels across.
const BODIES: [(usize, usize); 2] = [(2, 32), (3, 12)];
/// Widths of the bodies [m].
const WIDTHS: [f32; 4] = [1.0, 0.1, 0.01, 0.0005];
/// Smallest width of a body that is exact; smaller ones would take minutes [m].
const EXACT: f32 = 0.01;
/// Horizontal speeds at the start [m/s].
const SPEEDS: [f32; 3] = [1.0, 60.0, 300.0];
/// Maximum simulated time [s].
const SECONDS: f32 = 3.0;
/// Maximum distance that a body flies, in widths. Beyond it, single precision is too coarse.
const DISTANCE: f32 = 1e5;
/// Maximum relative error of position and velocity, compared with a point mass.
const TOLERANCE: f64 = 0.001;

/// Compares position and velocity with v t + ½ g t² and v + g t.
pub fn check(progress: &Progress) -> Result<Findings> {
    let cases: Vec<_> = { BODIES.iter() }
        .flat_map(|&body| WIDTHS.map(|width| (body, width)))
        .flat_map(|(body, width)| SPEEDS.map(|speed| (body, width, speed)))
        .flat_map(|(body, width, speed)| {
            TREATMENTS.map(|treatment| (body, width, speed, treatment))
        })
        .filter(|&(_, width, _, treatment)| treatment != StiffBodies::Exact || width >= EXACT)
        .collect();
    let found = parallel::each(
        &cases,
        progress,
        |&((dim, n), width, speed, treatment)| match dim {
            2 => worst::<Dim2>(n, width, speed, treatment),
            _ => worst::<Dim3>(n, width, speed, treatment),
        },
    )?;
    let outcome = |(&((dim, n), width, speed, treatment), worst)| {
        let case = format!(
            "free fall {}, {dim}D, n = {n}, {} mm wide, {speed} m/s, worst difference",
            name(treatment),
            1e3 * width
        );
        Outcome::at_most(case, worst, TOLERANCE)
    };
    let outcomes = cases.iter().zip(found.iter().copied()).map(outcome);
    let outcomes = outcomes.collect();
    let series = |treatment| {
        let of = cases
            .iter()
            .zip(&found)
            .filter(move |(case, _)| case.3 == treatment);
        Points::new(
            name(treatment),
            of.map(|(&(_, width, ..), &worst)| (1e3 * f64::from(width), worst)),
        )
    };
    let [narrow, .., wide] =
        [WIDTHS[WIDTHS.len() - 1], 0.0, WIDTHS[0]].map(|width| 1e3 * f64::from(width));
    let plot = Plot {
        x: "width of the body [mm]".into(),
        y: "worst relative difference".into(),
        curves: vec![Curve::new([(narrow, TOLERANCE), (wide, TOLERANCE)]).named("bound")],
        points: TREATMENTS.map(series).into(),
        is_log: [true, true],
        ..Plot::default()
    };
    Ok(Findings {
        outcomes,
        plots: vec![plot],
    })
}

/// Returns the larger of the relative errors of position and velocity, compared with a point mass.
fn worst<D: Dim>(n: usize, width: f32, speed: f32, treatment: StiffBodies) -> Result<f64> {
    let config = WorldConfig::<D> {
        stiff_bodies: treatment,
        ..WorldConfig::default()
    };
    let (gravity, tick) = (config.gravity.to_vec3().as_dvec3(), config.tick);
    let ticks = (SECONDS.min(DISTANCE * width / speed) / tick).ceil();
    let mut world = World::<D>::new(config)?;
    // Far from the origin, rounding strains small bodies by up to a quarter of a voxel, which would tear them.
    let material = Material {
        strength: f32::INFINITY,
        ..Material::default()
    };
    let body = SoftBody::new(VoxelGrid::ball(n, width)?, &[material])?;
    let body = world.add_soft_body(body)?;
    let linear = D::Vector::from_vec3(Vec3::new(speed, 0.0, 0.0));
    throw(&mut world, body, linear)?;
    let start = centre(&world[body]);
    for _ in 0..ticks as u32 {
        world.step();
    }
    let seconds = f64::from(ticks * tick);
    let thrown = DVec3::X * f64::from(speed);
    let path = thrown * seconds + gravity * (0.5 * seconds * seconds);
    let wanted = thrown + gravity * seconds;
    let moved = centre(&world[body]) - start;
    let velocity = world[body].momentum().linear / world[body].total_mass();
    let [position, velocity] = [(moved, path), (velocity, wanted)]
        .map(|(found, wanted)| (found - wanted).length() / wanted.length());
    ensure!(
        position.is_finite() && velocity.is_finite(),
        "the body left the range"
    );
    Ok(position.max(velocity))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fast_small_ball_falls_like_a_point() {
        assert!(worst::<Dim3>(6, 0.003, 60.0, StiffBodies::MassScaled).unwrap() < TOLERANCE);
    }
}

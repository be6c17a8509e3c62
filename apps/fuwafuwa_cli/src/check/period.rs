//! Period and energy: a squashed ball oscillates freely. The period of a graded body must equal that of a
//! uniform body, and the energy must stay constant.

use super::motion::{arrange, at_rest, ball, material};
use super::{energy, parallel};
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, ensure};
use fuwafuwa::glam::DVec3;
use fuwafuwa::{Dim, Dim2, Dim3, DimVector, Grading, NodeId, SoftBody, Vec3};
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// Bodies that oscillate: number of dimensions and voxels across.
const BODIES: [(usize, usize); 5] = [(2, 16), (2, 64), (3, 16), (2, 128), (3, 32)];
/// Maximum relative difference between the periods of a graded and a uniform body.
const TOLERANCE: f64 = 0.03;
/// Allowed range of the energy at the end, relative to the initial energy.
const KEPT: RangeInclusive<f64> = 0.95..=1.02;
/// Initial squash of the body: relative reduction of its height.
const SQUASH: f32 = 0.08;
/// Simulated time [s].
const DURATION: f64 = 5.0;
/// Time span at the end of the simulation in which the energy is averaged [s]. The average removes
/// fluctuations between substeps.
const LAST: f64 = 0.5;

/// Compares periods of graded and uniform bodies, and checks the energy of both.
pub fn check(progress: &Progress) -> Result<Findings> {
    let found = parallel::each(&BODIES, progress, |&(dim, n)| match dim {
        2 => rings::<Dim2>(n, progress),
        _ => rings::<Dim3>(n, progress),
    })?;
    let mut outcomes = Vec::new();
    for ((dim, n), [graded, uniform]) in BODIES.iter().zip(found) {
        outcomes.push(Outcome::near(
            format!(
                "period {dim}D, n = {n}, graded / uniform ({:.1} ms)",
                1e3 * uniform.period
            ),
            graded.period / uniform.period,
            1.0,
            TOLERANCE,
        ));
        outcomes.push(Outcome::within(
            format!("energy {dim}D, n = {n}, kept after {DURATION} s"),
            graded.kept,
            KEPT,
        ));
    }
    Ok(outcomes.into())
}

/// Measurements of an oscillating body.
#[derive(Copy, Clone, Debug)]
struct Ring {
    /// Oscillation period [s].
    period: f64,
    /// Mean energy of the final time span, relative to the initial energy.
    kept: f64,
}

fn rings<D: Dim>(n: usize, progress: &Progress) -> Result<[Ring; 2]> {
    Ok([
        ring::<D>(n, Grading::Graded, progress)?,
        ring::<D>(n, Grading::Uniform, progress)?,
    ])
}

fn ring<D: Dim>(n: usize, grading: Grading, progress: &Progress) -> Result<Ring> {
    let mut body = ball::<D>(n, material(), grading)?;
    let bulge = 1.0 + SQUASH / (D::N - 1) as f32;
    let squash = Vec3::new(bulge, 1.0 - SQUASH, bulge);
    arrange(&mut body, |rest| (rest * squash, Vec3::ZERO))?;
    let steps = (DURATION / body.longest_substep()).ceil() as usize;
    let duration = DURATION / steps as f64;
    let last = steps - (LAST / duration) as usize;
    let (mut signal, mut crossings) = (vec![squash_of(&body)], Vec::new());
    let mut start = 0.0;
    let (mut sum, mut count) = (0.0, 0.0);
    for step in 0..steps {
        progress.show_if_slow();
        if step == 0 {
            start = advance_and_weigh(&mut body, duration);
        } else if step >= last && step % 8 == 0 {
            sum += advance_and_weigh(&mut body, duration);
            count += 1.0;
        } else {
            body.advance(duration as f32, D::Vector::ZERO);
        }
        let (before, now) = (signal[step], squash_of(&body));
        signal.push(now);
        if before * now < 0.0 {
            crossings.push((step as f64 + before / (before - now)) * duration);
        }
    }
    ensure!(
        crossings.len() > 4,
        "the body with {n} voxels across does not oscillate"
    );
    let halves = crossings.len() - 1;
    let about = 2.0 * (crossings[halves] - crossings[0]) / halves as f64;
    Ok(Ring {
        period: strongest_period(&signal, duration, about),
        kept: sum / count / start,
    })
}

/// Takes a step of `duration` [s] and returns the energy [J] before the step. Velocities are known half a
/// step before and half a step after the positions. Their mean is the velocity for the kinetic energy.
fn advance_and_weigh<D: Dim>(body: &mut SoftBody<D>, duration: f64) -> f64 {
    let stored = energy::of_body(body);
    let velocity = |body: &SoftBody<D>, id: NodeId| body.node_state(id).1.to_vec3().as_dvec3();
    let ids: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    let before: Vec<DVec3> = ids.iter().map(|&id| velocity(body, id)).collect();
    body.advance(duration as f32, D::Vector::ZERO);
    let moving = ids.iter().zip(before).map(|(&id, before)| {
        let mean = (before + velocity(body, id)) * 0.5;
        0.5 * f64::from(body.node_state(id).2) * mean.length_squared()
    });
    stored + moving.sum::<f64>()
}

/// Returns the strongest period in a signal sampled every `duration` [s]. Only periods within 10 % of `about`
/// [s] are tried.
///
/// The signal is weighted with the Hann window, which suppresses other modes of the body [Harris 1978].
fn strongest_period(signal: &[f64], duration: f64, about: f64) -> f64 {
    let count = signal.len() as f64;
    let strength = |period: f64| {
        let (mut real, mut imaginary) = (0.0, 0.0);
        for (k, value) in signal.iter().enumerate() {
            let window = 1.0 - (TAU * k as f64 / count).cos();
            let (sine, cosine) = (TAU * k as f64 * duration / period).sin_cos();
            real += window * value * cosine;
            imaginary += window * value * sine;
        }
        real * real + imaginary * imaginary
    };
    let (mut low, mut high) = (0.9 * about, 1.1 * about);
    // Ternary search: the strength has a single peak in the interval.
    for _ in 0..40 {
        let (a, b) = ((2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0);
        if strength(a) < strength(b) {
            low = a;
        } else {
            high = b;
        }
    }
    0.5 * (low + high)
}

/// Returns the squash of a body: relative reduction of its height, weighted by mass.
fn squash_of<D: Dim>(body: &SoftBody<D>) -> f64 {
    let (mut sum, mut whole) = (0.0, 0.0);
    for (id, _) in body.mesh().nodes() {
        let (rest, (at, _, mass)) = (f64::from(at_rest(body, id).y), body.node_state(id));
        sum += f64::from(mass) * rest * (rest - f64::from(at[1]));
        whole += f64::from(mass) * rest * rest;
    }
    sum / whole
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strongest_period_ignores_offset_and_second_mode() {
        let value = |k: usize| {
            let t = k as f64 * 0.002;
            (TAU * t / 0.3).cos() + 0.5 * (TAU * t / 0.17).sin() + 0.2
        };
        let signal: Vec<f64> = (0..2500).map(value).collect();
        assert!((strongest_period(&signal, 0.002, 0.295) - 0.3).abs() < 1e-4);
    }

    #[test]
    fn small_graded_ball_rings_like_a_uniform_one() {
        let [graded, uniform] = rings::<Dim3>(12, &Progress::new()).unwrap();
        assert!(
            (graded.period / uniform.period - 1.0).abs() < TOLERANCE,
            "{graded:?} {uniform:?}"
        );
        assert!(KEPT.contains(&graded.kept) && KEPT.contains(&uniform.kept));
    }
}

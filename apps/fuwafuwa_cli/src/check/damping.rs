//! Damping: the damping ratio of bars and balls against Rayleigh's law ζ = α / 2ω + β ω / 2.
//!
//! A body is deformed into the shape of a vibration mode and released in a world without gravity. Its modal
//! coordinate q(t) = Σ m φ u, with the mode shape φ and the displacement u, is sampled in every tick. The
//! decay and the frequency are those of the damped vibration that fits the samples best.
//!
//! All bodies move at a constant velocity, which must not be damped. The movement also keeps them awake.

use super::bar::fix_where;
use super::motion::{arrange, material};
use super::parallel;
use crate::plot::{Curve, Plot, Points};
use crate::report::{Findings, Outcome, Progress, digits};
use anyhow::Result;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    DEFAULT_TICK, Damping, Dim, Dim2, Dim3, DimVector, Material, SoftBody, SoftBodyHandle, Vec3,
    VoxelGrid, World, WorldConfig,
};
use std::f64::consts::{PI, TAU};

/// Maximum relative difference between the measured damping ratio and the law.
const TOLERANCE: f64 = 0.05;
/// Mass damping alone [1/s].
const MASS: Damping = Damping {
    mass: 0.8,
    stiffness: 0.0,
};
/// Mass damping alone [1/s] for the coarsest square, whose mesh passes energy to other modes within ten periods.
const MORE_MASS: Damping = Damping {
    mass: 4.0,
    stiffness: 0.0,
};
/// Stiffness damping alone [s] beyond the limit of every bar: the law then uses the damping that
/// `World::acting_damping` returns.
const TOO_STIFF: Damping = stiffness(0.1);
/// Bars: voxels along the length, voxels across, mode, and damping. All are 1 m long.
const BARS: [(usize, usize, Mode, Damping); 29] = [
    (16, 16, Mode::Square, MORE_MASS),
    (32, 32, Mode::Square, MASS),
    (64, 64, Mode::Square, MASS),
    (128, 128, Mode::Square, MASS),
    (16, 4, Mode::Longitudinal, MASS),
    (128, 32, Mode::Longitudinal, MASS),
    (16, 2, Mode::Longitudinal, MASS),
    (128, 16, Mode::Longitudinal, MASS),
    (16, 1, Mode::Longitudinal, MASS),
    (128, 8, Mode::Longitudinal, MASS),
    (16, 4, Mode::Bending, MASS),
    (128, 32, Mode::Bending, MASS),
    (32, 4, Mode::Bending, MASS),
    (64, 8, Mode::Bending, MASS),
    (128, 16, Mode::Bending, MASS),
    (32, 2, Mode::Bending, MASS),
    (64, 4, Mode::Bending, MASS),
    (128, 8, Mode::Bending, MASS),
    (16, 4, Mode::ClampedBending, MASS),
    (64, 16, Mode::ClampedBending, MASS),
    (16, 16, Mode::Square, stiffness(5e-3)),
    (16, 2, Mode::Longitudinal, stiffness(5e-3)),
    (32, 32, Mode::Square, stiffness(2e-3)),
    (32, 4, Mode::Longitudinal, stiffness(2e-3)),
    (64, 16, Mode::Longitudinal, stiffness(4e-4)),
    (16, 4, Mode::Bending, stiffness(5e-3)),
    (128, 32, Mode::Longitudinal, stiffness(2e-4)),
    (16, 4, Mode::Longitudinal, TOO_STIFF),
    (64, 16, Mode::Longitudinal, TOO_STIFF),
];
/// Damping of discs and balls: a quarter of the default mass damping, so that they vibrate long enough for
/// the best fit to separate their modes, and the default stiffness damping.
const OF_BALLS: Damping = Damping {
    mass: 1.0,
    stiffness: 2e-4,
};
/// Discs and balls that are squashed: number of dimensions and voxels across.
const BALLS: [(usize, usize); 4] = [(2, 24), (2, 64), (3, 12), (3, 24)];
/// Bars of two materials: voxels along the length and across. The middle half has [`MIDDLE`], the ends have
/// [`ENDS`].
const MIXED: [(usize, usize); 2] = [(16, 8), (32, 4)];
/// Damping of the middle half of a bar of two materials.
const MIDDLE: Damping = Damping {
    mass: 4.0,
    stiffness: 4e-4,
};
/// Damping of the ends of a bar of two materials.
const ENDS: Damping = stiffness(2e-3);
/// Amplitude of the displacement at the start [m].
const AMPLITUDE: f32 = 0.01;
/// Velocity of the body [m/s]: above the speed at which bodies fall asleep.
const SPEED: f32 = 0.1;
/// Logarithm of the factor by which the amplitude falls during the measurement, which lasts at least 2 and at
/// most 20 periods.
const DECAY: f64 = 1.5;

/// Returns stiffness damping alone [s].
const fn stiffness(stiffness: f32) -> Damping {
    Damping {
        mass: 0.0,
        stiffness,
    }
}

/// Lowest vibration mode of its kind.
#[derive(Copy, Clone, Debug)]
pub enum Mode {
    /// Free bar that is stretched and compressed. With a Poisson's ratio of 0, u = sin(πx / L) is exact at
    /// every shape.
    Longitudinal,
    /// Free square that is stretched along one axis while it is compressed along the other. Longitudinal
    /// vibrations along both axes have the same frequency, and a coarse mesh passes energy from one to the
    /// other; together they are a mode.
    Square,
    /// Free bar that bends, as an Euler–Bernoulli beam.
    Bending,
    /// Bar that bends, with all nodes of one end fixed.
    ClampedBending,
}

impl Mode {
    /// Returns the displacement along the bar at `x` from the middle of a bar of length 1, and `y` from its
    /// axis.
    pub fn shape(self, x: f64, y: f64) -> (f64, f64) {
        // Roots k of cos k cosh k = 1 and of cos k cosh k = −1, with the factor of the sines (cosh k ∓ cos k)
        // / (sinh k ∓ sin k).
        let along = x + 0.5;
        let beam = |k: f64, factor: f64, sign: f64| {
            let (sine, cosine) = (k * along).sin_cos();
            let (sinh, cosh) = ((k * along).sinh(), (k * along).cosh());
            let deflection = cosh + sign * cosine - factor * (sinh + sign * sine);
            let slope = k * (sinh - sign * sine - factor * (cosh + sign * cosine));
            (-0.5 * slope * y, 0.5 * deflection)
        };
        match self {
            Self::Longitudinal => ((PI * x).sin(), 0.0),
            Self::Square => ((PI * x).sin(), -(PI * y).sin()),
            Self::Bending => beam(4.730_041, 0.982_502, 1.0),
            Self::ClampedBending => beam(1.875_104, 0.734_096, -1.0),
        }
    }

    /// Returns the angular frequency [rad/s] of a bar of length 1 m and a thickness [m], with the bar wave
    /// speed [m/s].
    fn frequency(self, wave_speed: f64, thickness: f64) -> f64 {
        let bending = |k: f64| k * k * wave_speed * thickness / 12f64.sqrt();
        match self {
            Self::Longitudinal | Self::Square => PI * wave_speed,
            Self::Bending => bending(4.730_041),
            Self::ClampedBending => bending(1.875_104),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Longitudinal => "longitudinal",
            Self::Square => "square",
            Self::Bending => "bending",
            Self::ClampedBending => "bending, clamped",
        }
    }
}

/// Measured vibration.
#[derive(Copy, Clone, Debug)]
pub struct Vibration {
    /// Angular frequency without damping [rad/s].
    pub frequency: f64,
    /// Damping ratio.
    pub ratio: f64,
}

/// Compares measured damping ratios with the law.
pub fn check(progress: &Progress) -> Result<Findings> {
    let bars = parallel::each(&BARS, progress, |&(n, across, mode, damping)| {
        bar(n, across, mode, damping)
    })?;
    let mut outcomes = Vec::new();
    let plot = plot(&bars);
    for ((n, across, mode, damping), (found, law)) in BARS.iter().zip(bars) {
        let case = format!(
            "damping {}/s {:.2} ms, {}, {n} x {across} ({:.2} Hz, ratio {law:.4}), ratio / law",
            damping.mass,
            1e3 * f64::from(damping.stiffness),
            mode.name(),
            found.frequency / TAU
        );
        outcomes.push(Outcome::near(case, found.ratio / law, 1.0, TOLERANCE));
    }
    let balls = parallel::each(&BALLS, progress, |&(dim, n)| match dim {
        2 => ball::<Dim2>(n),
        _ => ball::<Dim3>(n),
    })?;
    for ((dim, n), (found, law)) in BALLS.iter().zip(balls) {
        let case = format!(
            "damping of a ball {dim}D, n = {n} ({:.2} Hz, ratio {law:.4}), ratio / law",
            found.frequency / TAU
        );
        outcomes.push(Outcome::near(case, found.ratio / law, 1.0, TOLERANCE));
    }
    let mixed = parallel::each(&MIXED, progress, |&(n, across)| mixed_bar(n, across))?;
    for ((n, across), (found, law)) in MIXED.iter().zip(mixed) {
        let case = format!("damping of two materials, {n} x {across}, ratio {law:.4}, ratio / law");
        outcomes.push(Outcome::near(case, found.ratio / law, 1.0, TOLERANCE));
    }
    Ok(Findings {
        outcomes,
        plots: vec![plot],
    })
}

/// Plots the damping ratios of bars over their frequency, with a curve of the law for each damping. Leaves out
/// [`TOO_STIFF`], which does not act in full.
fn plot(found: &[(Vibration, f64)]) -> Plot {
    let mut dampings: Vec<Damping> = Vec::new();
    for &(.., damping) in BARS.iter().filter(|(.., damping)| *damping != TOO_STIFF) {
        if !dampings.contains(&damping) {
            dampings.push(damping);
        }
    }
    let name = |damping: Damping| match damping.mass > 0.0 {
        true => format!("α = {} 1/s", damping.mass),
        false => format!("β = {} ms", digits(1e3 * f64::from(damping.stiffness))),
    };
    let mut plot = Plot {
        x: "frequency [Hz]".into(),
        y: "damping ratio".into(),
        is_log: [true, true],
        ..Plot::default()
    };
    for damping in dampings {
        let of = { BARS.iter().zip(found) }.filter(|((.., own), _)| *own == damping);
        let points: Vec<(f64, f64)> = of
            .map(|(_, (vibration, _))| (vibration.frequency / TAU, vibration.ratio))
            .collect();
        let low = points
            .iter()
            .fold(f64::INFINITY, |low, point| low.min(point.0));
        let high = points.iter().fold(0.0f64, |high, point| high.max(point.0));
        // The law is a straight line on logarithmic axes.
        let law = |frequency: f64| (frequency, f64::from(damping.ratio(frequency as f32)));
        plot.curves
            .push(Curve::new([law(0.8 * low), law(1.25 * high)]).named(name(damping)));
        plot.points.push(Points::new(name(damping), points));
    }
    plot
}

/// Returns the vibration of a 2D bar, and the ratio of the law.
fn bar(n: usize, across: usize, mode: Mode, damping: Damping) -> Result<(Vibration, f64)> {
    let grid = VoxelGrid::<Dim2>::from_fn([n, across, 1], 1.0 / n as f32, |_| 1)?;
    vibration_of_bar(grid, &[damping], mode, |acting| acting[0])
}

/// Returns the vibration of a 2D bar of two materials, and the ratio of the law. Each material damps its
/// share of the kinetic energy by its mass damping and its share of the strain energy by its stiffness
/// damping. With u = sin(πx / L), the middle half has the share ½ − 1/π of the kinetic energy and ½ + 1/π of
/// the strain energy.
fn mixed_bar(n: usize, across: usize) -> Result<(Vibration, f64)> {
    let grid = VoxelGrid::<Dim2>::from_fn([n, across, 1], 1.0 / n as f32, |at| {
        let along = at[0] as usize;
        if (n / 4..n - n / 4).contains(&along) {
            1
        } else {
            2
        }
    })?;
    let (kinetic, strain) = (0.5 - 1.0 / PI as f32, 0.5 + 1.0 / PI as f32);
    vibration_of_bar(grid, &[MIDDLE, ENDS], Mode::Longitudinal, |acting| {
        Damping {
            mass: kinetic * acting[0].mass + (1.0 - kinetic) * acting[1].mass,
            stiffness: strain * acting[0].stiffness + (1.0 - strain) * acting[1].stiffness,
        }
    })
}

/// Returns the vibration of a bar with the dampings of its materials, and the ratio of the law for the
/// damping that `law` makes of the acting ones.
fn vibration_of_bar(
    grid: VoxelGrid<Dim2>,
    dampings: &[Damping],
    mode: Mode,
    law: impl Fn(&[Damping]) -> Damping,
) -> Result<(Vibration, f64)> {
    let usual = material();
    let of_damping = |&damping: &Damping| Material {
        elasticity: Elasticity {
            poisson: 0.0,
            ..usual.elasticity
        },
        damping,
        ..usual
    };
    let materials: Vec<Material> = dampings.iter().map(of_damping).collect();
    let thickness = grid.size()[1] as f32 * grid.voxel_size();
    let mut body = SoftBody::new(grid, &materials)?;
    // Longitudinal vibrations move across the bar, and bending along it, so that the movement does not change
    // the modal coordinate.
    let velocity = match mode {
        Mode::Longitudinal | Mode::Square => Vec3::Y * SPEED,
        Mode::Bending | Mode::ClampedBending => Vec3::X * SPEED,
    };
    let shape = |rest: Vec3| {
        let y = f64::from(rest.y + 0.5) - 0.5 * f64::from(thickness);
        let (along, across) = mode.shape(f64::from(rest.x), y);
        Vec3::new(along as f32, across as f32, 0.0)
    };
    arrange(&mut body, |rest| (rest + shape(rest) * AMPLITUDE, velocity))?;
    if let Mode::ClampedBending = mode {
        fix_where(&mut body, |at| at[0] == 0);
    }
    let wave_speed = (usual.elasticity.young / f64::from(usual.density)).sqrt();
    let frequency = mode.frequency(wave_speed, f64::from(thickness));
    // The modal coordinate is that of the displacement along the bar, or of the deflection.
    let axis = match mode {
        Mode::Longitudinal | Mode::Square => 0,
        Mode::Bending | Mode::ClampedBending => 1,
    };
    let weight = |rest: Vec3| {
        let mut weight = Vec3::ZERO;
        weight[axis] = shape(rest)[axis];
        weight
    };
    vibration(body, frequency, weight, law)
}

/// Returns the vibration of a ball 1 m across that is squashed along one axis, and the ratio of the law.
fn ball<D: Dim>(n: usize) -> Result<(Vibration, f64)> {
    let material = Material {
        damping: OF_BALLS,
        ..material()
    };
    let mut body = SoftBody::new(VoxelGrid::<D>::ball(n, 1.0)?, &[material])?;
    let bulge = 1.0 / (D::N - 1) as f32;
    let squash = Vec3::new(bulge, -1.0, bulge);
    arrange(&mut body, |rest| {
        let start = rest + rest * squash * (4.0 * AMPLITUDE);
        (start, Vec3::X * SPEED)
    })?;
    vibration(body, 22.0, |rest| rest * squash, |acting| acting[0])
}

/// Lets a body vibrate, and returns its vibration and the ratio of the law. `frequency` is the expected
/// angular frequency [rad/s]. `weight` returns the factors of the displacement of a node in the modal
/// coordinate. `law` combines the acting dampings of the materials.
fn vibration<D: Dim>(
    body: SoftBody<D>,
    frequency: f64,
    weight: impl Fn(Vec3) -> Vec3,
    law: impl Fn(&[Damping]) -> Damping,
) -> Result<(Vibration, f64)> {
    let mut world = World::<D>::new(WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    })?;
    let id = world.add_soft_body(body)?;
    let acting = law(&world.acting_damping(id)?);
    let ratio = |frequency: f64| f64::from(acting.ratio((frequency / TAU) as f32));
    let tick = f64::from(DEFAULT_TICK);
    let periods = (DECAY / (TAU * ratio(frequency))).clamp(2.0, 20.0);
    let count = (periods * TAU / frequency / tick).ceil() as usize;
    let rows: Vec<_> = { world[id].mesh().nodes() }
        .map(|(node, _)| (node, super::motion::at_rest(&world[id], node)))
        .map(|(node, rest)| (node, rest, weight(rest)))
        .collect();
    let coordinate = |world: &World<D>, id: SoftBodyHandle| {
        let displaced = rows.iter().map(|&(node, rest, weight)| {
            let (at, _, mass) = world[id].node_state(node);
            let along = weight.dot(at.to_vec3() - rest);
            f64::from(mass) * f64::from(along)
        });
        displaced.sum::<f64>()
    };
    let mut samples = vec![coordinate(&world, id)];
    for _ in 0..count {
        world.step();
        samples.push(coordinate(&world, id));
    }
    let expected = Vibration {
        frequency,
        ratio: ratio(frequency),
    };
    let found = vibration_in(&samples, tick, expected);
    Ok((found, ratio(found.frequency)))
}

/// Returns the damped vibration that fits samples at equal intervals [s] best, by least squares. Other modes
/// of the body hardly affect it, because their frequencies differ. `expected` is the expected vibration; the
/// frequency may differ from it by up to 30 %.
pub fn vibration_in(samples: &[f64], interval: f64, expected: Vibration) -> Vibration {
    let error = |decay: f64, damped: f64| fit_error(samples, interval, decay, damped);
    let guess = expected.ratio * expected.frequency;
    let scan = (0..=120).map(|k| expected.frequency * (0.7 + 0.005 * f64::from(k)));
    let closest = scan.min_by(|&a, &b| error(guess, a).total_cmp(&error(guess, b)));
    let (mut decay, mut damped) = (guess, closest.unwrap_or(expected.frequency));
    for _ in 0..10 {
        damped = minimum(0.98 * damped, 1.02 * damped, |damped| error(decay, damped));
        decay = minimum(0.2 * decay, 3.0 * decay, |decay| error(decay, damped));
    }
    let frequency = (decay * decay + damped * damped).sqrt();
    Vibration {
        frequency,
        ratio: decay / frequency,
    }
}

/// Returns the sum of the squared differences between samples at equal intervals [s] and the vibration
/// exp(−`decay` t) (A cos `damped` t + B sin `damped` t) with the best A and B.
fn fit_error(samples: &[f64], interval: f64, decay: f64, damped: f64) -> f64 {
    let (mut uu, mut uv, mut vv, mut uw, mut vw, mut ww) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (k, w) in samples.iter().enumerate() {
        let time = k as f64 * interval;
        let (sine, cosine) = (damped * time).sin_cos();
        let kept = (-decay * time).exp();
        let (u, v) = (kept * cosine, kept * sine);
        uu += u * u;
        uv += u * v;
        vv += v * v;
        uw += u * w;
        vw += v * w;
        ww += w * w;
    }
    let determinant = uu * vv - uv * uv;
    let a = (uw * vv - vw * uv) / determinant;
    let b = (vw * uu - uw * uv) / determinant;
    ww - a * uw - b * vw
}

/// Returns where a function with a single minimum between `low` and `high` is smallest.
fn minimum(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..40 {
        let (a, b) = ((2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0);
        if of(a) < of(b) {
            high = b;
        } else {
            low = a;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vibration_in_samples_has_their_frequency_and_ratio() {
        let (frequency, ratio) = (5.0f64, 0.1f64);
        let damped = frequency * (1.0 - ratio * ratio).sqrt();
        let sample = |k: i32| {
            let time = 0.1 * f64::from(k);
            (-ratio * frequency * time).exp() * (damped * time).cos()
        };
        let samples: Vec<f64> = (0..30).map(sample).collect();
        let expected = Vibration {
            frequency: 6.0,
            ratio: 0.06,
        };
        let found = vibration_in(&samples, 0.1, expected);
        assert!((found.frequency - frequency).abs() < 1e-6, "{found:?}");
        assert!((found.ratio - ratio).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn small_bars_have_the_damping_of_the_law() {
        for (n, across, mode, damping) in [
            (16, 4, Mode::Bending, MASS),
            (16, 4, Mode::ClampedBending, MASS),
            (16, 4, Mode::Longitudinal, stiffness(5e-3)),
        ] {
            let (found, law) = bar(n, across, mode, damping).unwrap();
            assert!(
                (found.ratio / law - 1.0).abs() < TOLERANCE,
                "{mode:?} {found:?} {law}"
            );
        }
        let (found, law) = mixed_bar(16, 8).unwrap();
        assert!(
            (found.ratio / law - 1.0).abs() < TOLERANCE,
            "{found:?} {law}"
        );
    }
}

//! Paths of cracks: at any direction of the voxels, a crack must run where the load drives it.
//!
//! The two wings are the nodes that split to the left and to the right of a crack in the centre of a plate. The direction of
//! a wing is that of the line of least squared distances through its nodes (total least squares). A crack square to the
//! pull stays square to it. An oblique crack kinks and then turns; the direction of its wings is compared with that of
//! the path in a continuum over the same range, see [`crack_path`].

use super::crack_path;
use super::parallel;
use super::plate::{Plate, PlateDim, Pull, Setting, Specimen, TOUGHNESS, WIDTH};
use super::{Extent, lefm::Pose};
use crate::plot::{Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::Result;
use fuwafuwa::{Dim2, Dim3};
use std::f64::consts::PI;

/// Half length of the cracks [m].
const HALF: f64 = 0.08;
/// Distance from the centre up to which a wing counts [m]. Beyond it, the ligament is so narrow that the plate bends.
const END: f64 = 0.23;
/// Maximum deviation of a wing's direction [°], for straight cracks in 2D, and for oblique cracks and those in 3D.
const TOLERANCES: [f64; 2] = [4.0, 6.0];
/// Maximum deviation of the first kink of the reference from that in an infinite plane [°].
const KINK: f64 = 2.0;
/// Growth of the opening of the grips [1/s], relative to that at failure.
const RATE: f64 = 0.3;

/// Parameters of one measurement.
#[derive(Copy, Clone, Debug)]
struct Case {
    /// Number of dimensions.
    dim: usize,
    /// Angle of the crack to the line square to the pull [°].
    oblique: f64,
    voxels: usize,
    turned: f64,
    is_near: bool,
    pose: Pose,
}

/// Compares the directions of wings.
pub fn check(progress: &Progress, extent: Extent) -> Result<Findings> {
    let mut outcomes = Vec::new();
    let angles = [15.0, 30.0, 45.0f64];
    let paths = parallel::each(&angles, progress, |&angle| {
        crack_path::path(HALF, angle, WIDTH, END)
    })?;
    for (angle, path) in angles.iter().zip(&paths) {
        let [from, to] = [path[0], path[1]];
        let first = (to[1] - from[1]).atan2(to[0] - from[0]).to_degrees();
        let wanted = angle + crack_path::kink(angle.to_radians().tan()).to_degrees();
        let row = format!("path reference, oblique {angle}°, direction of the first kink [°]");
        outcomes.push(Outcome::near(row, first, wanted, KINK));
        let row = format!("path reference, oblique {angle}°, direction of the wing [°]");
        outcomes.push(Outcome::shown(row, direction(path)));
    }
    let reference = |oblique: f64| {
        let place = angles.iter().position(|angle| *angle == oblique);
        place.map_or(0.0, |place| direction(&paths[place]))
    };
    let cases = cases(extent);
    let found = parallel::each(&cases, progress, |case| match case.dim {
        2 => wings::<Dim2>(case, progress),
        _ => wings::<Dim3>(case, progress),
    })?;
    let mut series = Vec::new();
    for (case, wings) in cases.iter().zip(found) {
        let Case {
            dim,
            oblique,
            voxels,
            turned,
            ..
        } = case;
        let strength = if case.is_near { "near" } else { "far" };
        let (wanted, pose) = (reference(*oblique), case.pose.suffix());
        let name = match oblique {
            0.0 => "straight".to_string(),
            _ => format!("oblique {oblique}°"),
        };
        for (side, direction) in ["left", "right"].into_iter().zip(wings) {
            let row = format!(
                "path {dim}D, {name}, n = {voxels}, {strength}{pose}, {turned}°, {side} wing [°]"
            );
            let tolerance = TOLERANCES[usize::from(*oblique != 0.0 || *dim == 3)];
            outcomes.push(Outcome::near(row, direction, wanted, tolerance));
            if *dim == 2 {
                series.push((name.clone(), (*turned, direction - wanted)));
            }
        }
    }
    let mut points: Vec<Points> = Vec::new();
    for (name, point) in series.into_iter().filter(|(_, point)| point.1.is_finite()) {
        Points::add(&mut points, name, point);
    }
    let plot = Plot {
        x: "angle of the lattice [°]".into(),
        y: "deviation of a wing [°]".into(),
        points,
        band: Some(-TOLERANCES[0]..=TOLERANCES[0]),
        ..Plot::default()
    };
    Ok(Findings {
        outcomes,
        plots: vec![plot],
    })
}

/// Returns the measurements.
fn cases(extent: Extent) -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |dim, oblique, voxels, is_near, pose, angles: &[f64]| {
        cases.extend(angles.iter().map(|&turned| Case {
            dim,
            oblique,
            voxels,
            turned,
            is_near,
            pose,
        }));
    };
    let (straight, few) = ([10.0, 22.5, 35.0, 45.0], [0.0, 22.5, 45.0]);
    let numbers: &[usize] = match extent {
        Extent::Usual => &[64],
        Extent::Full => &[32, 64, 128],
    };
    for (&voxels, is_near) in numbers.iter().flat_map(|n| [(n, false), (n, true)]) {
        add(2, 0.0, voxels, is_near, Pose::Upright, &straight);
        for oblique in [15.0, 30.0, 45.0] {
            add(2, oblique, voxels, is_near, Pose::Upright, &few);
        }
    }
    for pose in [Pose::Lying, Pose::Turned, Pose::Spinning] {
        add(2, 0.0, 64, false, pose, &[22.5]);
        add(2, 30.0, 64, false, pose, &[22.5]);
    }
    let all = [0.0, 10.0, 22.5, 35.0, 45.0];
    add(3, 0.0, 32, false, Pose::Upright, &all);
    cases
}

/// Tears a plate, and returns the directions of its left and its right wing [°].
fn wings<D: PlateDim>(case: &Case, progress: &Progress) -> Result<[f64; 2]> {
    let specimen = Specimen::Centre {
        half: HALF,
        angle: case.oblique,
    };
    let setting = Setting {
        turned: case.turned,
        strength: super::lefm::STRENGTHS[usize::from(case.is_near)],
        damping: if case.pose == Pose::Spinning {
            0.0
        } else {
            4.0
        },
        ..Setting::new(case.voxels, 0.3)
    };
    let mut pull = Pull {
        until_first: false,
        start: 0.5,
        rate: RATE,
        most: 2.5,
        ..Pull::slow(TOUGHNESS * WIDTH / (PI * HALF).sqrt())
    };
    case.pose.apply::<D>(&mut pull);
    let course = Plate::<D>::new(specimen, setting)?.pull(&pull, progress)?;
    let tip = HALF * case.oblique.to_radians().cos();
    Ok([-1.0, 1.0].map(|side| {
        let beyond = |at: &&[f64; 2]| (tip..END).contains(&(side * at[0]));
        let wing: Vec<[f64; 2]> = course.splits.iter().filter(beyond).copied().collect();
        direction(&wing)
    }))
}

/// Returns the direction of the line of least squared distances through points [°], from −90° to 90°. NaN if there are
/// less than three.
fn direction(points: &[[f64; 2]]) -> f64 {
    if points.len() < 3 {
        return f64::NAN;
    }
    let count = points.len() as f64;
    let mean = [0, 1].map(|axis| points.iter().map(|at| at[axis]).sum::<f64>() / count);
    let [mut squares, mut products] = [0.0; 2];
    for at in points {
        let [x, y] = [at[0] - mean[0], at[1] - mean[1]];
        squares += x * x - y * y;
        products += x * y;
    }
    (0.5 * (2.0 * products).atan2(squares)).to_degrees()
}

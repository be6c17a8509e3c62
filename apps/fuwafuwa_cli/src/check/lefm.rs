//! Linear elastic fracture mechanics: at any direction and size of the voxels, a crack must begin to grow when its stress
//! intensity reaches the toughness. Its growth must dissipate toughness² (1 − ν²) / E per area.
//!
//! 2D is plane strain, and `toughness` is K_Ic in plane strain. Stress intensities come from measured loads, see
//! [`plate`](super::plate). That reference is itself compared with published factors for ends that can turn freely: the
//! centre crack of Feddersen, as corrected by Tada, and Tada's edge crack (Tada, Paris and Irwin, The Stress Analysis of
//! Cracks Handbook), and with the energy of a strip in pure shear in closed form.

use super::Extent;
use super::bar::{POISSON, plane_strain};
use super::parallel;
use super::plate::{
    Intensity, Plate, PlateDim, Pull, Setting, Specimen, TOUGHNESS, WIDTH, around_one,
};
use crate::plot::{Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Context, Result};
use fuwafuwa::{Dim2, Dim3, Grading, Rotation, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Maximum relative deviation of K at the first growth from the toughness, in 2D and in 3D.
const INTENSITY: [f64; 2] = [0.07, 0.12];
/// Maximum spread of K over the angles of the lattice, relative to their mean, in 2D and in 3D.
const ANISOTROPY: [f64; 2] = [0.05, 0.1];
/// Maximum relative deviation of the dissipated energy.
const ENERGY: f64 = 0.1;
/// Maximum relative deviation of the reference from published factors.
const REFERENCE: f64 = 0.01;
/// Maximum relative change of K at half the speed.
const SLOWNESS: f64 = 0.01;
/// Strength [Pa]: far above the stress near a crack, and 5 times the toughness in SI units.
pub const STRENGTHS: [f64; 2] = [1e5, 5.0 * TOUGHNESS];
/// Thickness of plates in 3D [m].
const THICKNESS: f64 = 0.125;
/// Growth of the opening in the test of steady growth [1/s], relative to the opening at which growth begins.
const STEADY_RATE: f64 = 0.15;
/// Range of u in which the crack of the cantilevers grows steadily [m].
const STEADY: [f64; 2] = [0.0, 0.17];

/// Plates with a crack of a quarter and of half of their width from an edge.
const EDGES: [Specimen; 2] = [
    Specimen::Edge {
        length: 0.25 * WIDTH,
    },
    Specimen::Edge {
        length: 0.5 * WIDTH,
    },
];

/// Orientation and motion of a plate in the world.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Pose {
    /// Pulled along the second axis of the world.
    Upright,
    /// Pulled along the first axis of the world, and in 3D along the third.
    Lying,
    /// Turned by 30° as a whole.
    Turned,
    /// Spinning with its grips by 0.2 rad/s.
    Spinning,
}

impl Pose {
    /// Returns the end of the name of a case.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Upright => "",
            Self::Lying => ", lying",
            Self::Turned => ", turned",
            Self::Spinning => ", spinning",
        }
    }

    /// Orients the plate of a pull.
    pub fn apply<D: PlateDim>(self, pull: &mut Pull) {
        let quarter = FRAC_PI_2 as f32;
        match (self, D::N) {
            (Self::Upright, _) => {}
            (Self::Lying, 2) => pull.orientation = Rotation::in_plane(-quarter),
            (Self::Lying, _) => pull.orientation = Rotation::about(Vec3::X, quarter),
            (Self::Turned, _) => pull.orientation = Rotation::in_plane(30f32.to_radians()),
            (Self::Spinning, _) => pull.spin = 0.2,
        }
    }
}

/// Parameters of one measurement.
#[derive(Copy, Clone, Debug)]
struct Case {
    dim: usize,
    specimen: Specimen,
    voxels: usize,
    turned: f64,
    poisson: f64,
    is_near: bool,
    pose: Pose,
}

impl Case {
    /// Name of all cases that differ in the angle of the lattice only.
    fn group(&self) -> String {
        let strength = if self.is_near { "near" } else { "far" };
        let pose = self.pose.suffix();
        let Self {
            dim,
            voxels,
            poisson,
            ..
        } = self;
        let name = self.specimen.name();
        format!("lefm {dim}D, {name}, n = {voxels}, ν = {poisson}, {strength}{pose}")
    }
}

/// Compares K at the first growth of cracks, and the energy of their growth, with the toughness.
pub fn check(progress: &Progress, extent: Extent) -> Result<Findings> {
    let mut outcomes = references(progress)?;
    let cases = cases(extent);
    let mut pairs: Vec<(Specimen, f64)> = Vec::new();
    for case in &cases {
        let pair = (case.specimen, case.poisson);
        if !pairs.contains(&pair) {
            pairs.push(pair);
        }
    }
    let intensities = parallel::each(&pairs, progress, |&(specimen, poisson)| {
        Intensity::of(specimen, poisson, progress)
    })?;
    let measured = |case: &Case, speed: f64| {
        let pair = (case.specimen, case.poisson);
        let place = pairs.iter().position(|one| *one == pair);
        let intensity = &intensities[place.context("every case has a reference")?];
        match case.dim {
            2 => measure::<Dim2>(case, intensity, speed, progress),
            _ => measure::<Dim3>(case, intensity, speed, progress),
        }
    };
    let found = parallel::each(&cases, progress, |case| measured(case, 1.0))?;
    // The first case that is turned shows that the pull is slow enough.
    let turned = cases.iter().position(|case| case.turned > 20.0);
    let turned = turned.context("some cases are turned")?;
    let ratio = measured(&cases[turned], 0.5)?.0 / found[turned].0;
    let row = "lefm speed, K at half the speed / K";
    outcomes.push(Outcome::within(row.into(), ratio, around_one(SLOWNESS)));
    let mut series: Vec<Points> = Vec::new();
    let mut start = 0;
    for group in cases.chunk_by(|a, b| a.group() == b.group()) {
        let values = &found[start..start + group.len()];
        start += group.len();
        let (name, solid) = (group[0].group(), group[0].dim - 2);
        for (case, (intensity, energy)) in group.iter().zip(values) {
            let turned = case.turned;
            let row = format!("{name}, {turned}°, K / toughness");
            let range = around_one(INTENSITY[solid]);
            outcomes.push(Outcome::within(row, *intensity, range));
            if let Some(energy) = energy {
                let row = format!("{name}, {turned}°, energy / (toughness² (1 − ν²) / E)");
                outcomes.push(Outcome::within(row, *energy, around_one(ENERGY)));
            }
            let point = (turned, *intensity);
            let label = format!("{}D, {}", case.dim, case.specimen.name());
            Points::add(&mut series, label, point);
        }
        if group.len() > 2 {
            let sum: f64 = values.iter().map(|value| value.0).sum();
            let mean = sum / values.len() as f64;
            let most = values
                .iter()
                .map(|value| value.0)
                .fold(f64::NEG_INFINITY, f64::max);
            let least = values
                .iter()
                .map(|value| value.0)
                .fold(f64::INFINITY, f64::min);
            let row = format!("{name}, spread of K over angles");
            outcomes.push(Outcome::at_most(
                row,
                (most - least) / mean,
                ANISOTROPY[solid],
            ));
        }
    }
    let plot = Plot {
        x: "angle of the lattice [°]".into(),
        y: "K at first growth / toughness".into(),
        points: series,
        band: Some(around_one(INTENSITY[0])),
        ..Plot::default()
    };
    Ok(Findings {
        outcomes,
        plots: vec![plot],
    })
}

/// Returns the measurements.
fn cases(extent: Extent) -> Vec<Case> {
    let (all, few): (&[f64], &[f64]) = (&[0.0, 10.0, 22.5, 35.0, 45.0], &[0.0, 22.5, 45.0]);
    let others = [EDGES[0], EDGES[1], Specimen::Strip, Specimen::Cantilever];
    let mut cases = Vec::new();
    let mut add = |dim, specimen, voxels, poisson, is_near, pose, angles: &[f64]| {
        cases.extend(angles.iter().map(|&turned| Case {
            dim,
            specimen,
            voxels,
            turned,
            poisson,
            is_near,
            pose,
        }));
    };
    let (centre, upright) = (Specimen::CENTRE, Pose::Upright);
    if extent == Extent::Full {
        for specimen in [centre].into_iter().chain(others) {
            for (voxels, poisson) in [32, 64, 128].into_iter().flat_map(|n| [(n, 0.0), (n, 0.3)]) {
                add(2, specimen, voxels, poisson, false, upright, all);
                // Cantilevers of low strength break at the ends of their grips.
                if specimen != Specimen::Cantilever {
                    add(2, specimen, voxels, poisson, true, upright, all);
                }
            }
        }
        for (voxels, poisson) in [(24, 0.0), (24, 0.3), (32, 0.0), (32, 0.3)] {
            add(3, centre, voxels, poisson, false, upright, few);
            add(3, centre, voxels, poisson, true, upright, few);
        }
    } else {
        add(2, centre, 32, 0.0, false, upright, all);
        add(2, centre, 32, 0.3, true, upright, all);
        add(2, centre, 64, 0.3, false, upright, all);
        add(2, centre, 64, 0.0, true, upright, all);
        add(2, centre, 128, 0.3, false, upright, &[22.5]);
        add(2, centre, 128, 0.3, true, upright, few);
        for specimen in others {
            add(2, specimen, 64, 0.3, false, upright, few);
        }
        add(3, centre, 24, 0.0, false, upright, few);
        add(3, centre, 24, 0.3, true, upright, &[22.5]);
        add(3, centre, 32, 0.0, false, upright, &[22.5]);
    }
    for pose in [Pose::Lying, Pose::Turned, Pose::Spinning] {
        add(2, centre, 32, 0.3, false, pose, &[22.5]);
    }
    add(3, centre, 24, 0.0, false, Pose::Lying, &[22.5]);
    cases
}

/// Returns K at the first growth over the toughness, and for cantilevers the dissipated energy per area over the
/// fracture energy. `speed` multiplies the usual speed of the pull.
fn measure<D: PlateDim>(
    case: &Case,
    intensity: &Intensity,
    speed: f64,
    progress: &Progress,
) -> Result<(f64, Option<f64>)> {
    let is_steady = case.specimen == Specimen::Cantilever;
    let setting = Setting {
        damping: if is_steady { 4.0 } else { 0.0 },
        turned: case.turned,
        strength: STRENGTHS[usize::from(case.is_near)],
        thickness: THICKNESS,
        ..Setting::new(case.voxels, case.poisson)
    };
    let plate = Plate::<D>::new(case.specimen, setting)?;
    let factor = intensity.at(plate.length);
    let mut pull = Pull::slow(TOUGHNESS / factor);
    pull.rate *= speed;
    case.pose.apply::<D>(&mut pull);
    if is_steady {
        pull.until_first = false;
        pull.rate = STEADY_RATE * speed;
        pull.most = 4.0;
        pull.reach = STEADY[1];
    }
    let course = plate.pull(&pull, progress)?;
    let energy = is_steady.then(|| {
        let at = |reach: f64| { course.states.iter() }.find(|state| state.reach >= reach);
        let (Some(from), Some(to)) = (at(STEADY[0]), at(STEADY[1])) else {
            return f64::NAN;
        };
        let spent = (to.dissipated - from.dissipated) / (to.reach - from.reach);
        spent / setting.fracture_energy()
    });
    Ok((course.first * factor / TOUGHNESS, energy))
}

/// Compares the reference with published factors, and shows how far graded meshes deviate from it.
fn references(progress: &Progress) -> Result<Vec<Outcome>> {
    let centre = |length: f64| {
        let share = 2.0 * length / WIDTH;
        let corrected = 1.0 - 0.025 * share.powi(2) + 0.06 * share.powi(4);
        corrected * (1.0 / (FRAC_PI_2 * share).cos()).sqrt()
    };
    let edge = |length: f64| {
        let x = length / WIDTH;
        1.122 - 0.231 * x + 10.55 * x * x - 21.71 * x.powi(3) + 30.382 * x.powi(4)
    };
    let specimens = [
        Specimen::CENTRE,
        EDGES[0],
        EDGES[1],
        Specimen::Strip,
        Specimen::Cantilever,
    ];
    let found = parallel::each(&specimens, progress, |&specimen| {
        let length = specimen.length();
        let name = specimen.name();
        let intensity = Intensity::of(specimen, POISSON, progress)?.at(length);
        let published = |shape: f64| -> Result<Option<f64>> {
            let published = shape * (PI * length).sqrt() / WIDTH;
            let free = Intensity::with_free_ends(specimen, progress)?;
            Ok(Some(free.at(length) / published))
        };
        let ratio = match specimen {
            Specimen::Strip => {
                // Energy per area of the strip, ½ (λ + 2 µ) / height, at an opening of 1 m.
                let setting = Setting {
                    grading: Grading::Uniform,
                    ..Setting::new(128, POISSON)
                };
                let elasticity = setting.elasticity();
                let modulus = elasticity.lame() + 2.0 * elasticity.shear_modulus();
                let release = 0.5 * modulus / Specimen::STRIP_HEIGHT;
                let load = Plate::<Dim2>::new(specimen, setting)?.stretched(progress)?;
                Some(intensity * load.stiffness / (release * plane_strain(elasticity)).sqrt())
            }
            Specimen::Centre { .. } => published(centre(length))?,
            Specimen::Edge { .. } => published(edge(length))?,
            _ => None,
        };
        let mut rows = Vec::new();
        if let Some(ratio) = ratio {
            let row = format!("lefm reference, {name}, K / published");
            rows.push(Outcome::within(row, ratio, around_one(REFERENCE)));
        }
        for voxels in [32, 64, 128] {
            let graded = Intensity::on_graded_mesh(specimen, voxels, progress)?;
            let row = format!("lefm reference, {name}, graded n = {voxels}, K of load / uniform");
            rows.push(Outcome::shown(row, graded.at(length) / intensity));
        }
        Ok(rows)
    })?;
    Ok(found.concat())
}

//! Cracks in stretched strips must run slower than Rayleigh waves.
//!
//! ```text
//!   ▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓      strip 6 m × 1 m, clamped along both long sides and stretched so far that it stores
//!   │──── →             │     a multiple of the fracture energy per area of crack
//!   ▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓
//! ```
//!
//! No crack runs faster than a Rayleigh wave along its faces (Freund, Dynamic Fracture Mechanics, 1990): 0.9274 times the
//! speed of shear waves for a Poisson's ratio of 0.3. In experiments, straight cracks in gels reach 0.87 times the speed of
//! shear waves (Livne, Ben-David, Fineberg 2007, Physical Review Letters 98, 124301). The engine tests for fracture 240
//! times a second, which also limits the speed: to a few voxels in each test.

use super::pull::still_world;
use super::{Bound, Record, Role, Row, Setup};
use crate::check::parallel;
use crate::report::Progress;
use anyhow::{Result, bail};
use fuwafuwa::{Blade, Damping, Dim2, Elasticity, Event, Material, SoftBody, Vec2, VoxelGrid};
use std::time::Instant;

/// Voxels across the strip, and stored energy relative to the fracture energy.
const CASES: [(usize, f64); 4] = [(8, 4.0), (16, 4.0), (32, 4.0), (32, 16.0)];
/// Speed of Rayleigh waves divided by that of shear waves at a Poisson's ratio of 0.3.
const RAYLEIGH: f64 = 0.9274;
/// Strain across the strip.
const STRAIN: f64 = 0.05;
/// Length of the first crack and range in which the speed is measured [m].
const CRACK: f32 = 1.0;
const RANGE: [f32; 2] = [2.0, 4.5];

/// Measures the speeds of cracks.
pub fn run(progress: &Progress) -> Result<Record> {
    let found = parallel::each(&CASES, progress, |&(n, energy)| speed(n, energy))?;
    let row = |(&(_, energy), &(computed, setup)): (&(usize, f64), &(f64, Setup))| Row {
        case: format!("crack in a strip with {energy} times its energy, speed / Rayleigh wave"),
        role: Role::Verification,
        reference: Some(1.0),
        spread: None,
        computed,
        bound: Bound::Within(f64::NEG_INFINITY, 1.0),
        setup,
    };
    Ok(Record {
        rows: CASES.iter().zip(&found).map(row).collect(),
        plots: Vec::new(),
    })
}

/// Returns the speed of a crack, relative to that of Rayleigh waves.
fn speed(n: usize, surplus: f64) -> Result<(f64, Setup)> {
    let start = Instant::now();
    let elasticity = Elasticity {
        young: 5000.0,
        poisson: 0.3,
    };
    let stiffness = elasticity.lame() + 2.0 * elasticity.shear_modulus();
    let energy = 0.5 * stiffness * STRAIN * STRAIN / surplus;
    let Elasticity { young, poisson } = elasticity;
    let material = Material {
        elasticity,
        damping: Damping::NONE,
        strength: 1e6,
        toughness: (energy * young / (1.0 - poisson * poisson)).sqrt() as f32,
        ..Material::default()
    };
    let voxel = 1.0 / n as f32;
    let grid = VoxelGrid::from_fn([6 * n, n, 1], voxel, |_| 1)?;
    let mut body = SoftBody::<Dim2>::new(grid, &[material])?;
    let middle = 0.5 + 0.01 * voxel;
    let tip = CRACK - 0.01 * voxel;
    body.cut(&Blade::segment(
        Vec2::new(-0.1, middle),
        Vec2::new(tip, middle),
    ));
    let nodes: Vec<_> = body.mesh().nodes().collect();
    for (id, node) in nodes {
        let (mut at, ..) = body.node_state(id);
        at.y *= 1.0 + STRAIN as f32;
        body.set_node_state(id, at, Vec2::ZERO)?;
        if node.at[1] == 0 || node.at[1] == n as i32 {
            body.fix_node(id);
        }
    }
    let mut world = still_world::<Dim2>()?;
    world.add_soft_body(body)?;
    let tick = world.config().tick;
    let (mut reach, mut passed, mut time) = (CRACK, [None, None], 0.0);
    let mut substeps = 0;
    while passed[1].is_none() && time < 20.0 {
        substeps = world.step().substeps;
        time += tick;
        for event in world.events() {
            if let Event::NodeSplit { point, .. } = event {
                reach = reach.max(point.x);
            }
        }
        for (passed, end) in passed.iter_mut().zip(RANGE) {
            if passed.is_none() && reach >= end {
                *passed = Some((time, reach));
            }
        }
    }
    let [Some((begin, first)), Some((end, last))] = passed else {
        bail!("the crack stopped at {reach} m")
    };
    let wave = (elasticity.shear_modulus() / f64::from(material.density)).sqrt();
    let speed = f64::from((last - first) / (end - begin));
    let setup = Setup {
        n,
        substeps: Some(substeps),
        seconds: start.elapsed().as_secs_f64(),
    };
    Ok((speed / (RAYLEIGH * wave), setup))
}

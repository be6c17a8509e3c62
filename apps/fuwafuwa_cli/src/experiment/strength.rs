//! Cracks that start by strength under stress in several directions, of the "nine circles" of fracture (Kamarei, Zeng,
//! Dolbow, Lopez-Pamies 2026, Computer Methods in Applied Mechanics and Engineering 448, 118449, arXiv 2507.00266).
//!
//! - **Poker chip**: a disc of polyurethane, 10 mm across, between two plates whose gap is 1 mm in the middle and 1.70 mm
//!   at the rim (a sphere of 18.2 mm). Nearly incompressible, it is under tension in all directions in the middle, so
//!   cracks start inside, in the plane of the disc. Strength 0.3 MPa in tension and 1 MPa in all directions.
//! - **Torsion**: a tube of glass, 5 mm long, with an outer radius of 3 mm and a wall of 0.15 mm. Shear stress is pure, so
//!   a crack starts at the shear strength that follows from the criterion of Drucker and Prager, 44.4 MPa, and runs at
//!   45° to the axis. Here the wall is 0.3 mm thick, four voxels on average. The clamped quarters at both ends do not
//!   fail. For the angle, a small part of the wall has three quarters of the strength, so that one crack starts there.
//! - **Blocks**: cubes of both materials with uniform tension along one, two or three axes, or uniform shear, held at all
//!   their faces. Each must fail at the strength that the criterion of Drucker and Prager has under this load.
//!
//! The engine is given the tensile and the hydrostatic strength and this criterion. The references follow from them: no measured
//! failure is compared.
//!
//! The engine allows a Poisson's ratio of 0.49 in place of the 0.497 of polyurethane.

use super::pull::{calm, still_world};
use super::{Bound, Record, Role, Row, Setup};
use crate::check::parallel;
use crate::report::Progress;
use anyhow::{Context, Result, bail};
use fuwafuwa::{
    Damping, Dim3, DimVector, Elasticity, Event, Material, NodeId, SoftBody, StrengthCriterion,
    StressLaw, Vec3, VoxelGrid,
};
use std::time::Instant;

/// Voxels across the disc of the poker chip. It is 1 m wide, 10 mm in the experiment.
const CHIP: usize = 48;
/// Voxels across the tube. It is 1 m wide, 6 mm in the experiment.
const TUBE: usize = 80;
/// Wall of the tube [outer radii].
const WALL: f32 = 0.1;
/// Half width of the weak part of the tube [voxels].
const SEED: i32 = 3;
/// Young's modulus [Pa].
const YOUNG: f64 = 5000.0;
/// Greatest deviation of the shear strength.
const BOUND: f64 = 0.07;

/// Case of the experiment.
#[derive(Copy, Clone, Debug)]
enum Case {
    Chip,
    /// Whether a small part of the wall is weaker, so that one crack starts there.
    Tube(bool),
    Block(Block),
}

/// Uniform load of a block.
#[derive(Copy, Clone, Debug)]
struct Block {
    material: &'static Constants,
    load: Load,
}

#[derive(Copy, Clone, Debug, PartialEq)]
enum Load {
    Biaxial,
    Hydrostatic,
    Shear,
}

/// Constants of a material.
#[derive(Debug)]
struct Constants {
    name: &'static str,
    /// Tensile, biaxial, hydrostatic and shear strength [MPa].
    strengths: [f64; 4],
    poisson: f64,
}

/// Constants of the challenge set. Biaxial and shear strength follow from the other two by the criterion. The engine allows a Poisson's ratio of 0.49 in place of 0.497.
const MATERIALS: [Constants; 2] = [
    Constants {
        name: "polyurethane",
        strengths: [0.3, 0.27, 1.0, 0.19],
        poisson: 0.49,
    },
    Constants {
        name: "glass",
        strengths: [40.0, 27.0, 27.8, 44.4],
        poisson: 0.22,
    },
];

/// Compares places, planes and loads of the first cracks.
pub fn run(progress: &Progress) -> Result<Record> {
    let mut cases = vec![Case::Chip, Case::Tube(false), Case::Tube(true)];
    for material in &MATERIALS {
        let loads = [Load::Biaxial, Load::Hydrostatic, Load::Shear];
        cases.extend(loads.map(|load| Case::Block(Block { material, load })));
    }
    let rows = parallel::each(&cases, progress, |case| match case {
        Case::Chip => chip(),
        Case::Tube(has_seed) => tube(*has_seed),
        Case::Block(block) => block.fail(),
    })?;
    Ok(Record {
        rows: rows.concat(),
        plots: Vec::new(),
    })
}

/// First cracks of a body.
#[derive(Debug)]
struct Start {
    /// Places of the first split nodes, relative to the middle of the body [m].
    places: Vec<Vec3>,
    /// Time until the first split [s].
    time: f32,
    setup: Setup,
}

impl Start {
    /// Returns a verification.
    fn row(&self, case: impl Into<String>, reference: f64, computed: f64, bound: Bound) -> Row {
        Row {
            case: case.into(),
            role: Role::Verification,
            reference: Some(reference),
            spread: None,
            computed,
            bound,
            setup: self.setup,
        }
    }
}

/// Returns a material with the criterion of Drucker and Prager. `ratio` is Young's modulus divided by the strength,
/// `hydrostatic` the hydrostatic strength divided by the strength, and `toughness` the toughness divided by the strength
/// [√m].
fn material(poisson: f64, ratio: f64, hydrostatic: f64, toughness: f64) -> Material {
    let strength = YOUNG / ratio;
    Material {
        elasticity: Elasticity {
            young: YOUNG,
            poisson,
        },
        stress_law: StressLaw::NeoHookean,
        damping: calm(3.0),
        strength: strength as f32,
        strength_criterion: StrengthCriterion::DruckerPrager {
            hydrostatic: (hydrostatic * strength) as f32,
        },
        strength_scatter: 0.0,
        toughness: (toughness * strength) as f32,
        ..Material::default()
    }
}

/// Moves the held nodes of a body at constant velocities until `count` nodes are split.
fn until_split(
    mut body: SoftBody<Dim3>,
    middle: Vec3,
    velocity: impl Fn(Vec3, Vec3) -> Vec3,
    is_held: impl Fn(Vec3) -> bool,
    (n, count): (usize, usize),
) -> Result<Start> {
    let start = Instant::now();
    let size = body.grid().voxel_size();
    let nodes: Vec<_> = body.mesh().nodes().collect();
    for (id, node) in nodes {
        let rest = Vec3::from(node.at.map(|k| k as f32 * size)) - middle;
        let (at, ..) = body.node_state(id);
        body.set_node_state(id, at, velocity(rest, at))?;
        if is_held(rest) {
            body.fix_node(id);
        }
    }
    let mut world = still_world::<Dim3>()?;
    world.add_soft_body(body)?;
    let (mut time, mut first, mut all) = (0.0, 0.0, Vec::new());
    while time < 60.0 {
        let report = world.step();
        time += world.config().tick;
        let splits = world.events().iter().filter_map(|event| match event {
            Event::NodeSplit { point, .. } => Some(point.to_vec3() - middle),
            _ => None,
        });
        all.extend(splits);
        if all.is_empty() {
            first = time;
        }
        if all.len() >= count {
            let setup = Setup {
                n,
                substeps: Some(report.substeps),
                seconds: start.elapsed().as_secs_f64(),
            };
            return Ok(Start {
                places: all,
                time: first,
                setup,
            });
        }
    }
    bail!("no crack started")
}

/// Pulls a poker chip apart.
fn chip() -> Result<Vec<Row>> {
    // 10 mm are 1 m.
    let voxel = 1.0 / CHIP as f32;
    let gap = |radius: f32| {
        let sphere = 1.82f32;
        0.1 + sphere - (sphere * sphere - radius * radius).sqrt()
    };
    let tall = (gap(0.5) / voxel).ceil() as usize + 1;
    // The lower plate is flat, the upper one is the sphere.
    let plate = |x: f32, z: f32| {
        let radius = ((x - 0.5) * (x - 0.5) + (z - 0.5) * (z - 0.5)).sqrt();
        (radius <= 0.5).then(|| gap(radius))
    };
    let centre = |k: i32| (k as f32 + 0.5) * voxel;
    let grid = VoxelGrid::from_fn([CHIP, tall, CHIP], voxel, |[x, y, z]| {
        u8::from(plate(centre(x), centre(z)).is_some_and(|gap| centre(y) < gap))
    })?;
    // Strength 0.3 MPa, E = 1.56 MPa, toughness √(E G / (1 − ν²)) = 9.23 kPa √m; lengths are 100 times as large.
    let material = material(0.49, 1.56 / 0.3, 1.0 / 0.3, 9.23e3 / 0.3e6 * 10.0);
    let body = SoftBody::<Dim3>::new(grid, &[material])?;
    let middle = Vec3::new(0.5, 0.0, 0.5);
    let is_top = |rest: Vec3| {
        let gap = plate(rest.x + 0.5, rest.z + 0.5).unwrap_or_else(|| gap(0.5));
        rest.y > gap - 1.1 * voxel
    };
    let speed = 0.002;
    let start = until_split(
        body,
        middle,
        |rest, _| match rest.y > 0.0 {
            true => Vec3::Y * (speed * (rest.y / 0.1).min(1.0)),
            false => Vec3::ZERO,
        },
        |rest| rest.y < 0.1 * voxel || is_top(rest),
        (CHIP / 10, 1),
    )?;
    let far = |place: &Vec3| (place.x * place.x + place.z * place.z).sqrt() / 0.5;
    let farthest = start.places.iter().map(far).fold(0.0, f32::max);
    Ok(vec![start.row(
        "poker chip, place of the first cracks, radius / radius of the chip",
        0.0,
        f64::from(farthest),
        Bound::Within(0.0, 0.5),
    )])
}

/// Twists a tube.
fn tube(has_seed: bool) -> Result<Vec<Row>> {
    let voxel = 1.0 / TUBE as f32;
    let long = TUBE * 5 / 6;
    let radius = |x: f32, y: f32| (x * x + y * y).sqrt();
    let centre = |k: i32| (k as f32 + 0.5) * voxel - 0.5;
    let grid = VoxelGrid::from_fn([TUBE, TUBE, long], voxel, |[x, y, z]| {
        let radius = radius(centre(x), centre(y));
        let is_end = !(long as i32 / 4..3 * long as i32 / 4).contains(&z);
        let apart = (y - TUBE as i32 / 2).abs().max((z - long as i32 / 2).abs());
        let is_seed = has_seed && x < TUBE as i32 / 2 && apart < SEED;
        match (0.5 * (1.0 - WALL)..=0.5).contains(&radius) {
            true if is_seed => 3,
            true => 1 + u8::from(is_end),
            false => 0,
        }
    })?;
    // Glass, with a stiffness that makes the strain at failure some percent.
    let material = material(0.22, 40.0, 27.8 / 40.0, 0.836_66 / 40.0 / 6e-3f64.sqrt());
    let strength = f64::from(material.strength);
    // The clamped ends do not fail.
    let ends = Material {
        strength: 10.0 * material.strength,
        strength_criterion: StrengthCriterion::GreatestTension,
        ..material
    };
    let seed = Material {
        strength: 0.75 * material.strength,
        ..material
    };
    let body = SoftBody::<Dim3>::new(grid, &[material, ends, seed])?;
    let length = long as f32 * voxel;
    let middle = Vec3::new(0.5, 0.5, 0.0);
    // Time until failure [s].
    let duration = 2.0;
    let shear = material.elasticity.shear_modulus();
    let ratio = 44.4 / 40.0;
    let rate = (ratio * strength / shear / duration) as f32 * length / 0.5;
    let start = until_split(
        body,
        middle,
        |rest, _| Vec3::new(-rest.y, rest.x, 0.0) * (rate * rest.z / length),
        |rest| rest.z < 0.1 * voxel || rest.z > length - 0.1 * voxel,
        (TUBE, if has_seed { 300 } else { 1 }),
    )?;
    let stress = shear * f64::from(rate * start.time * 0.5 * (1.0 - 0.5 * WALL) / length);
    Ok(vec![match has_seed {
        false => start.row(
            "torsion of a tube of glass, shear stress at the first crack [MPa]",
            44.4,
            40.0 * stress / strength,
            Bound::Relative(BOUND),
        ),
        true => start.row(
            "torsion of a tube of glass, angle of the crack to the axis [°]",
            45.0,
            spiral(&start.places),
            Bound::Within(35.0, 55.0),
        ),
    }])
}

/// Returns the angle to the axis [°] of a crack in the wall of a tube, from the places of its nodes near the first one.
fn spiral(places: &[Vec3]) -> f64 {
    let [first, ..] = places else { return f64::NAN };
    let along = |place: &Vec3| {
        let turn = f64::from(place.y).atan2(f64::from(place.x))
            - f64::from(first.y).atan2(f64::from(first.x));
        let turn = turn - (turn / std::f64::consts::TAU).round() * std::f64::consts::TAU;
        [0.5 * turn, f64::from(place.z - first.z)]
    };
    let near: Vec<[f64; 2]> = places
        .iter()
        .map(along)
        .filter(|[x, z]| x.hypot(*z) < 0.5)
        .collect();
    let mean = |of: &dyn Fn(&[f64; 2]) -> f64| near.iter().map(of).sum::<f64>() / near.len() as f64;
    let [x, z] = [mean(&|p| p[0]), mean(&|p| p[1])];
    let [xx, zz, xz] = [
        mean(&|p| (p[0] - x) * (p[0] - x)),
        mean(&|p| (p[1] - z) * (p[1] - z)),
        mean(&|p| (p[0] - x) * (p[1] - z)),
    ];
    // Direction of the greatest scatter.
    let angle = 0.5 * (2.0 * xz).atan2(zz - xx);
    angle.to_degrees().abs()
}

impl Block {
    /// Loads a cube at all its faces until it fails, and compares the stress with the strength by the criterion.
    fn fail(self) -> Result<Vec<Row>> {
        let n = 6;
        let [tensile, biaxial, hydrostatic, shear] = self.material.strengths;
        // Small strains, and a strength radius of 1.5 voxels.
        let material = Material {
            stress_law: StressLaw::Corotational,
            damping: Damping::NONE,
            ..material(self.material.poisson, 50.0, hydrostatic / tensile, 0.7)
        };
        let body = SoftBody::<Dim3>::new(VoxelGrid::cube(n, 1.0)?, &[material])?;
        let (name, reference) = match self.load {
            Load::Biaxial => ("tension along two axes", biaxial),
            Load::Hydrostatic => ("tension along all axes", hydrostatic),
            Load::Shear => ("shear", shear),
        };
        // Strains at failure by Hooke's law.
        let strength = reference / tensile * f64::from(material.strength);
        let Elasticity { young, poisson } = material.elasticity;
        let strain = match self.load {
            Load::Biaxial => [strength * (1.0 - poisson), -2.0 * poisson * strength],
            Load::Hydrostatic => [strength * (1.0 - 2.0 * poisson); 2],
            Load::Shear => [strength * (1.0 + poisson), 0.0],
        };
        let duration = 2.0;
        let [one, other] = strain.map(|strain| (strain / young / duration) as f32);
        let load = self.load;
        let velocity = move |rest: Vec3| match load {
            Load::Biaxial => rest * Vec3::new(one, one, other),
            Load::Hydrostatic => rest * one,
            Load::Shear => Vec3::new(rest.y, rest.x, 0.0) * one,
        };
        let middle = Vec3::splat(0.5);
        let is_held = |rest: Vec3| rest.abs().max_element() > 0.5 - 1e-3;
        let start = until_split(body, middle, |rest, _| velocity(rest), is_held, (n, 1))?;
        let stress = uniform_stress(&material, |rest| velocity(rest) * start.time)?;
        let computed = match self.load {
            Load::Biaxial | Load::Hydrostatic => stress[0][0],
            Load::Shear => stress[0][1],
        };
        let case = format!(
            "block of {}, {name}, stress at failure [MPa]",
            self.material.name
        );
        let computed = computed / f64::from(material.strength) * tensile;
        Ok(vec![start.row(
            case,
            reference,
            computed,
            Bound::Relative(BOUND),
        )])
    }
}

/// Returns the Cauchy stress [Pa] of a voxel with displaced nodes.
fn uniform_stress(material: &Material, moved: impl Fn(Vec3) -> Vec3) -> Result<[[f64; 3]; 3]> {
    let mut body = SoftBody::<Dim3>::new(VoxelGrid::cube(1, 1.0)?, &[*material])?;
    let nodes: Vec<NodeId> = body.mesh().nodes().map(|(id, _)| id).collect();
    for id in nodes {
        let at = body.node_state(id).0;
        body.set_node_state(id, at + moved(at - Vec3::splat(0.5)), Vec3::ZERO)?;
    }
    let element = body.mesh().elements().next().map(|(id, _)| id);
    let state = element.and_then(|id| body.element_state(id));
    let stress = state.map(|state| state.stress.map(|row| row.to_array()));
    stress.context("a cube has an element")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn biaxial_and_shear_strength_follow_from_the_criterion() {
        // √J₂ + B I₁ = A has I₁ = σ, √J₂ = σ / √3 for one axis; 2σ, σ / √3 for two; 3σ, 0 for all; 0, τ for shear.
        for Constants {
            name, strengths, ..
        } in &MATERIALS
        {
            let [tensile, biaxial, hydrostatic, shear] = *strengths;
            let root = 3f64.sqrt();
            let slope = tensile / root / (3.0 * hydrostatic - tensile);
            let limit = 3.0 * slope * hydrostatic;
            let expected = [limit / (1.0 / root + 2.0 * slope), limit];
            for (found, expected) in [biaxial, shear].into_iter().zip(expected) {
                assert!(
                    (found / expected - 1.0).abs() < 0.02,
                    "{name} {found} {expected}"
                );
            }
        }
    }
}

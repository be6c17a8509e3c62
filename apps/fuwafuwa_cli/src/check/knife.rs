//! Energy of a knife: a cut must spend the fracture energy of the material per area, and a dull edge the work of the strip
//! in front of it as well.
//!
//! ```text
//!        ▼ knife, moves down slowly      energy per area = force × way / area
//!   ░░░░░░░░░░░░░
//!   ░░░░░░░░░░░░░  weightless bar
//!   ▀▀▀▀▀▀▀▀▀▀▀▀▀  fixed
//! ```
//!
//! The force on the knife is summed over its way through the middle of the bar. The area is that of the way, so the areas
//! and the work that the engine reports do not enter. The reported work is shown for comparison: it is that of the edge
//! slipping through the material, and the vibrations after each slip take the rest. The reference is the energy
//! toughness² (1 − ν²) / E of a crack in plane strain [Irwin 1957], plus 2 r σ for an edge of radius r in a material of
//! strength σ [Atkins 2009, ch. 9]. The ratio to toughness² / E, that of plane stress, is shown for comparison.

use super::Extent;
use super::parallel;
use super::plate::around_one;
use crate::report::{Findings, Outcome, Progress};
use anyhow::Result;
use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimVector, Event, Knife, Material, RigidBody, Shape, SoftBody, Vec3,
    VoxelGrid, World, WorldConfig,
};

/// Maximum relative deviation from the reference.
const TOLERANCE: f64 = 0.1;
/// Radius of the dull edge [m]. Its strip takes half as much energy as the crack.
const RADIUS: f32 = 0.002;
/// Speed of the knife [m/s].
const SPEED: f64 = 0.1;
/// Height of the bar [m].
const HEIGHT: f64 = 0.5;
/// Range of depths over which the force is summed [m].
const RANGE: [f64; 2] = [0.15, 0.4];
/// Thickness of the bar in 3D [m].
const THICKNESS: f64 = 0.25;

/// Parameters of one measurement.
#[derive(Copy, Clone, Debug)]
struct Case {
    dim: usize,
    voxels: usize,
    is_dull: bool,
    /// Angle between the way of the knife and the vertical [°].
    oblique: f64,
}

/// Energies per area [J/m²].
struct Spent {
    /// Force × way / area.
    measured: f64,
    /// Work over area, as the engine reports them.
    reported: f64,
}

/// Compares the energy per area of cuts with the reference.
pub fn check(progress: &Progress, extent: Extent) -> Result<Findings> {
    let numbers: &[(usize, usize)] = match extent {
        Extent::Usual => &[(2, 32), (2, 64), (3, 16)],
        Extent::Full => &[
            (2, 16),
            (2, 32),
            (2, 64),
            (2, 128),
            (3, 16),
            (3, 24),
            (3, 32),
        ],
    };
    let mut cases = Vec::new();
    for &(dim, voxels) in numbers {
        for (is_dull, oblique) in [(false, 0.0), (true, 0.0), (false, 25.0), (true, 25.0)] {
            cases.push(Case {
                dim,
                voxels,
                is_dull,
                oblique,
            });
        }
    }
    let found = parallel::each(&cases, progress, |case| match case.dim {
        2 => cut::<Dim2>(case),
        _ => cut::<Dim3>(case),
    })?;
    let material = material();
    let poisson = material.elasticity.poisson;
    let plane_stress = f64::from(material.toughness).powi(2) / material.elasticity.young;
    let crack = plane_stress * (1.0 - poisson * poisson);
    let mut outcomes = Vec::new();
    for (case, spent) in cases.iter().zip(found) {
        let (edge, strip) = match case.is_dull {
            true => (
                "dull",
                2.0 * f64::from(RADIUS) * f64::from(material.strength),
            ),
            false => ("sharp", 0.0),
        };
        let Case {
            dim,
            voxels,
            oblique,
            ..
        } = case;
        let name = format!("knife {dim}D, n = {voxels}, {edge}, {oblique}°");
        let reference = match case.is_dull {
            true => "(toughness² (1 − ν²) / E + 2 r σ)",
            false => "(toughness² (1 − ν²) / E)",
        };
        let ratio = spent.measured / (crack + strip);
        let row = format!("{name}, force × way per area / {reference}");
        outcomes.push(Outcome::within(row, ratio, around_one(TOLERANCE)));
        let ratio = spent.reported / (crack + strip);
        let row = format!("{name}, reported work per area / {reference}");
        outcomes.push(Outcome::shown(row, ratio));
        if !case.is_dull {
            let ratio = spent.measured / plane_stress;
            let row = format!("{name}, force × way per area / (toughness² / E)");
            outcomes.push(Outcome::shown(row, ratio));
        }
    }
    Ok(outcomes.into())
}

fn material() -> Material {
    Material {
        damping: Damping {
            mass: 4.0,
            ..Damping::default()
        },
        ..Material::default()
    }
}

/// Cuts a bar 1 m wide.
fn cut<D: Dim>(case: &Case) -> Result<Spent> {
    let voxel = 1.0 / case.voxels as f64;
    let depth = D::depth((THICKNESS / voxel).round() as usize);
    let size = [case.voxels, (HEIGHT / voxel).round() as usize, depth];
    let grid = VoxelGrid::<D>::from_fn(size, voxel as f32, |_| 1)?;
    let mut body = SoftBody::new(grid, &[material()])?;
    let lowest: Vec<_> = { body.mesh().nodes() }
        .filter(|(_, node)| node.at[1] == 0)
        .map(|(id, _)| id)
        .collect();
    for id in lowest {
        body.fix_node(id);
    }
    let mut world = World::<D>::new(WorldConfig {
        gravity: D::Vector::ZERO,
        sleep: false,
        ..WorldConfig::default()
    })?;
    world.add_soft_body(body)?;
    let vector =
        |x: f64, y: f64, z: f64| D::Vector::from_vec3(Vec3::new(x as f32, y as f32, z as f32));
    let thickness = if D::N == 3 { THICKNESS } else { 0.0 };
    let (sine, cosine) = case.oblique.to_radians().sin_cos();
    let tip = |height: f64| {
        let beside = (HEIGHT - height) * sine / cosine;
        vector(0.4 + 0.3 * voxel + beside, height, 0.5 * thickness)
    };
    let top = HEIGHT + 0.02;
    let holder = RigidBody::kinematic(Shape::ball(0.01)).at(tip(top));
    let holder = world.add_rigid_body(holder.with_sensor(true))?;
    // Ends beside the bar put the samples of the edge, half a voxel apart, evenly into the bar.
    let reach = 0.5 * thickness + 0.75 * voxel;
    let edge = [vector(0.0, 0.0, -reach), vector(0.0, 0.0, reach)];
    let knife = world.add_knife(Knife {
        radius: if case.is_dull { RADIUS } else { 0.0 },
        ..Knife::new(holder, edge, vector(sine, -cosine, 0.0))
    })?;
    let tick = f64::from(world.config().tick);
    let (mut energy, mut way) = (0.0, 0.0);
    let (mut work, mut area) = (0.0, 0.0);
    for count in 1.. {
        let height = top - SPEED * cosine * tick * f64::from(count);
        let below = HEIGHT - height;
        if below > RANGE[1] {
            break;
        }
        world.set_target_position(holder, tip(height))?;
        world.step();
        if below > RANGE[0] {
            let force = world.knife(knife)?.force();
            let against = force.dot(vector(-sine, cosine, 0.0));
            energy += f64::from(against) * SPEED * tick;
            way += SPEED * tick;
            for event in world.events() {
                if let Event::Cut {
                    area: cut,
                    work: spent,
                    ..
                } = event
                {
                    area += f64::from(*cut);
                    work += f64::from(*spent);
                }
            }
        }
    }
    let across = if D::N == 3 { thickness } else { 1.0 };
    Ok(Spent {
        measured: energy / (way * across),
        reported: work / area,
    })
}

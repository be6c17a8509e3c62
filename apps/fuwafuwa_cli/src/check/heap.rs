//! Heaps: balls and cubes fall into a pen, come to rest, fall asleep and stay asleep.

use super::parallel;
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, ensure};
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimVector, Event, Material, RigidBody, Shape, SoftBody, Vec3, VoxelGrid,
    World, WorldConfig,
};

/// Number of bodies in a heap: every second one is a ball, the others are cubes.
const BODIES: usize = 30;
/// Width of a body [m].
const WIDTH: f32 = 0.25;
/// Maximum time until all bodies of a heap must be asleep [s].
const PATIENCE: f64 = 10.0;
/// Simulated time [s].
const DURATION: f64 = 60.0;

/// Measurements of a heap.
#[derive(Copy, Clone, Debug)]
struct Heap {
    /// Time at which all bodies were asleep for the first time [s]; infinite if that never happened.
    asleep: f64,
    /// Number of times that a body woke after that.
    woken: usize,
}

/// A material with a name for the table.
type Named = (&'static str, f64, f32);

/// Names, Young's moduli [Pa] and friction coefficients of the materials. The first one is the default
/// material. The others are stiffer, one rough and one slippery.
const MATERIALS: [Named; 3] = [
    ("default", 5000.0, 0.4),
    ("rough", 5e4, 0.8),
    ("slippery", 2e4, 0.1),
];

/// Drops heaps of three materials in 2D and in 3D.
pub fn check(progress: &Progress) -> Result<Findings> {
    let cases: Vec<(usize, Named)> = [2, 3]
        .into_iter()
        .flat_map(|dim| MATERIALS.map(|named| (dim, named)))
        .collect();
    let found = parallel::each(&cases, progress, |&(dim, named)| match dim {
        2 => fall::<Dim2>(16, named, BODIES, DURATION),
        _ => fall::<Dim3>(8, named, BODIES, DURATION),
    })?;
    let mut outcomes = Vec::new();
    for ((dim, (name, ..)), heap) in cases.iter().zip(found) {
        let case = |what: &str| format!("heap {dim}D, {BODIES} bodies, {name}, {what}");
        let asleep = case("seconds until asleep");
        outcomes.push(Outcome::at_most(asleep, heap.asleep, PATIENCE));
        let woken = case("bodies that woke later");
        outcomes.push(Outcome::at_most(woken, heap.woken as f64, 0.0));
    }
    Ok(outcomes.into())
}

/// Drops bodies with `n` voxels across into a pen that is four bodies wide, in 3D three by two bodies.
fn fall<D: Dim>(
    n: usize,
    (_, young, friction): Named,
    bodies: usize,
    duration: f64,
) -> Result<Heap> {
    let mut world = World::<D>::new(WorldConfig::default())?;
    let pitch = 1.1 * WIDTH;
    let wide = if D::N == 2 { [4, 1] } else { [3, 2] };
    let size = wide.map(|count| count as f32 * pitch);
    let planes = [
        (Vec3::Y, Vec3::ZERO),
        (Vec3::X, Vec3::ZERO),
        (-Vec3::X, Vec3::X * size[0]),
        (Vec3::Z, Vec3::ZERO),
        (-Vec3::Z, Vec3::Z * size[1]),
    ];
    for (normal, point) in planes.into_iter().take(if D::N == 2 { 3 } else { 5 }) {
        let wall = Shape::half_space(D::Vector::from_vec3(normal), D::Vector::from_vec3(point));
        world.add_rigid_body(RigidBody::fixed(wall).with_friction(friction))?;
    }
    let material = Material {
        elasticity: Elasticity::new(young, 0.3)?,
        friction,
        strength: f32::INFINITY,
        ..Material::default()
    };
    for place in 0..bodies {
        let grid = match place % 2 {
            0 => VoxelGrid::ball(n, WIDTH)?,
            _ => VoxelGrid::cube(n, WIDTH)?,
        };
        let (x, z) = (place % wide[0], place / wide[0] % wide[1]);
        let layer = place / (wide[0] * wide[1]);
        // Each body is shifted by another amount, so that no body stands exactly on another.
        let shift = 0.008 * WIDTH * ((1 + layer * 7 + place * 3) % 11) as f32;
        let at = [x as f32, layer as f32 + 0.05, z as f32].map(|k| k * pitch + shift);
        let body = SoftBody::new(grid, &[material])?;
        world.add_soft_body(body.translated(D::Vector::from_vec3(Vec3::from(at))))?;
    }
    let mut heap = Heap {
        asleep: f64::INFINITY,
        woken: 0,
    };
    for tick in 0..(60.0 * duration) as usize {
        let report = world.step();
        ensure!(report.quarantined == 0, "a body was quarantined");
        let time = (tick + 1) as f64 / 60.0;
        if heap.asleep.is_finite() {
            let woke = |event: &&Event<D>| matches!(event, Event::WokeUp { .. });
            heap.woken += world.events().iter().filter(woke).count();
        } else if time > PATIENCE {
            break;
        }
        let mut all = world.soft_bodies().flat_map(|(_, body)| body.piece_views());
        if heap.asleep.is_infinite() && all.all(|piece| piece.asleep) {
            heap.asleep = time;
        }
    }
    Ok(heap)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heap_of_six_bodies_falls_asleep_and_stays_asleep() {
        let heap = fall::<Dim2>(8, MATERIALS[0], 6, PATIENCE + 1.0).unwrap();
        assert!(heap.asleep <= PATIENCE && heap.woken == 0, "{heap:?}");
    }
}

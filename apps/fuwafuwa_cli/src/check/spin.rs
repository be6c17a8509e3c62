//! Spin: a rotating free body keeps its angular momentum, and so does each half of a body that was cut.

use super::motion::{arrange, ball, material};
use super::parallel;
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, ensure};
use fuwafuwa::glam::DVec3;
use fuwafuwa::{
    Blade, DEFAULT_TICK, Damping, Dim, Dim2, Dim3, DimVector, Grading, Material, PieceId, SoftBody,
    SoftBodyHandle, Vec2, Vec3, World, WorldConfig,
};

/// Damping of half of the bodies that spin uncut: that of the default material.
const DAMPED: Damping = Damping {
    mass: 4.0,
    stiffness: 2e-4,
};
/// Bodies that spin uncut: number of dimensions, voxels across, and damping of the material.
const BODIES: [(usize, usize, Damping); 4] = [
    (2, 32, Damping::NONE),
    (2, 32, DAMPED),
    (3, 24, Damping::NONE),
    (3, 24, DAMPED),
];
/// Minimum angular momentum at the end, as a fraction of the initial one.
const KEPT: f64 = 0.999;
/// Simulated time [s].
const DURATION: f32 = 5.0;
/// Bodies that are cut in two while they spin: number of dimensions and voxels across.
const TORN: [(usize, usize); 2] = [(2, 32), (3, 16)];
/// Time after the cut at which the halves are separate and their measurement begins [s].
const APART: f32 = 1.0;

/// Measures the fraction of angular momentum, along its initial direction, that bodies keep. They start at 5
/// rad/s.
pub fn check(progress: &Progress) -> Result<Findings> {
    let found = parallel::each(&BODIES, progress, |&(dim, n, damping)| match dim {
        2 => kept::<Dim2>(n, damping),
        _ => kept::<Dim3>(n, damping),
    })?;
    let outcome = |(&(dim, n, damping), kept): (&(usize, usize, Damping), f64)| {
        let case = format!(
            "spin {dim}D, n = {n}, damping {}/s, kept after {DURATION} s",
            damping.mass
        );
        Outcome::within(case, kept, KEPT..=2.0 - KEPT)
    };
    let mut outcomes: Vec<Outcome> = BODIES.iter().zip(found).map(outcome).collect();
    let found = parallel::each(&TORN, progress, |&(dim, n)| match dim {
        2 => halves(n, &middle_line()),
        _ => halves(n, &middle_plane()),
    })?;
    for ((dim, n), halves) in TORN.iter().zip(found) {
        let case = |what: &str| format!("{what} {dim}D, n = {n}, kept after {DURATION} s");
        let kept = KEPT..=2.0 - KEPT;
        let spin = |what, value| Outcome::within(case(what), value, kept.clone());
        outcomes.push(spin("spin of a torn half", halves.spin));
        outcomes.push(spin("momentum of a torn half", halves.momentum));
        outcomes.push(spin("spin of both halves", halves.both));
    }
    Ok(outcomes.into())
}

/// Fractions of momentum and angular momentum that the halves of a cut body keep. Each value is that of the
/// half that keeps less.
struct Halves {
    spin: f64,
    momentum: f64,
    both: f64,
}

/// Returns the blade that cuts a disc in two.
fn middle_line() -> Blade<Dim2> {
    Blade::segment(Vec2::new(0.0, -1.5), Vec2::new(0.0, 1.5))
}

/// Returns the blade that cuts a ball in two.
fn middle_plane() -> Blade<Dim3> {
    Blade::parallelogram(Vec3::new(0.0, -1.5, -1.5), 3.0 * Vec3::Y, 3.0 * Vec3::Z)
}

/// Cuts a spinning body in two along a blade, and measures what the separating halves keep.
fn halves<D: Dim>(n: usize, blade: &Blade<D>) -> Result<Halves> {
    let (mut world, id) = spinning::<D>(n, material())?;
    let whole = world[id].momentum().angular;
    let cut = world.cut(id, blade)?;
    let step = |world: &mut World<D>, duration: f32| {
        for _ in 0..(duration / DEFAULT_TICK).round() as usize {
            world.step();
        }
    };
    step(&mut world, APART);
    let pieces = world[id].pieces().list.len();
    ensure!(
        pieces == 2,
        "expected 2 pieces after cutting {cut} nodes, found {pieces}"
    );
    let motions = |world: &World<D>| [0, 1].map(|piece| motion(&world[id], PieceId(piece)));
    let before = motions(&world);
    step(&mut world, DURATION);
    let after = motions(&world);
    let worst = |kept: [f64; 2]| match (kept[0] - 1.0).abs() > (kept[1] - 1.0).abs() {
        true => kept[0],
        false => kept[1],
    };
    Ok(Halves {
        spin: worst([0, 1].map(|piece| along_first(before[piece].1, after[piece].1))),
        momentum: worst([0, 1].map(|piece| along_first(before[piece].0, after[piece].0))),
        both: along_first(whole, world[id].momentum().angular),
    })
}

/// Returns the momentum of a piece, and its angular momentum about its centre of mass.
fn motion<D: Dim>(body: &SoftBody<D>, piece: PieceId) -> (DVec3, DVec3) {
    let nodes = body.mesh().nodes().map(|(id, _)| id);
    let nodes = nodes.filter(|&id| body.pieces().of_node(id) == piece);
    let states = nodes.map(|id| body.node_state(id));
    let states: Vec<(Vec3, Vec3, f32)> = states
        .map(|(at, velocity, mass)| (at.to_vec3(), velocity.to_vec3(), mass))
        .collect();
    let (mut mass, mut centre, mut linear) = (0.0, DVec3::ZERO, DVec3::ZERO);
    for &(at, velocity, node) in &states {
        mass += f64::from(node);
        centre += (node * at).as_dvec3();
        linear += (node * velocity).as_dvec3();
    }
    let mut angular = DVec3::ZERO;
    for &(at, velocity, node) in &states {
        let reach = at.as_dvec3() - centre / mass;
        angular += reach.cross((node * velocity).as_dvec3());
    }
    (linear, angular)
}

/// Returns the component of `after` along `before`, relative to the length of `before`.
fn along_first(before: DVec3, after: DVec3) -> f64 {
    before.dot(after) / (before.length() * before.length())
}

fn kept<D: Dim>(n: usize, damping: Damping) -> Result<f64> {
    let material = Material {
        damping,
        ..material()
    };
    let (mut world, id) = spinning::<D>(n, material)?;
    let before = world[id].momentum().angular;
    for _ in 0..(DURATION / DEFAULT_TICK).round() as usize {
        world.step();
    }
    let after = world[id].momentum().angular;
    Ok(along_first(before, after))
}

/// Returns a world with one freely spinning body.
fn spinning<D: Dim>(n: usize, material: Material) -> Result<(World<D>, SoftBodyHandle)> {
    let mut body = ball::<D>(n, material, Grading::Graded)?;
    // Initial angular velocity: 5 rad/s about (0, 4, 3) / 5; in 2D about z.
    let spin = match D::N {
        2 => Vec3::new(0.0, 0.0, 5.0),
        _ => Vec3::new(0.0, 4.0, 3.0),
    };
    arrange(&mut body, |rest| (rest, spin.cross(rest)))?;
    let mut world = World::<D>::new(WorldConfig {
        gravity: D::Vector::ZERO,
        drag: 0.0,
        max_substeps: 1024,
        ..WorldConfig::default()
    })?;
    let id = world.add_soft_body(body)?;
    Ok((world, id))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_ball_keeps_its_angular_momentum() {
        let kept = kept::<Dim3>(12, Damping::NONE).unwrap();
        assert!((kept - 1.0).abs() < 1.0 - KEPT, "{kept}");
    }

    #[test]
    fn halves_of_a_small_disc_keep_their_angular_momentum() {
        let halves = halves(8, &middle_line()).unwrap();
        for kept in [halves.spin, halves.momentum, halves.both] {
            assert!((kept - 1.0).abs() < 1.0 - KEPT, "{kept}");
        }
    }
}

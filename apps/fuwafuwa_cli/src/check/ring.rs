//! Pinched ring: force and bulge of a ring that is pressed together at two opposite points, against the elastica.
//!
//! ```text
//!       ↓ P
//!     ┌────┐        ψ'' = p/2 cos ψ,   p = P R² / E' I
//!    │      │ →     ψ = π/2 at the side and π at the top
//!     └────┘
//!       ↑ P
//! ```
//!
//! `ψ` is the direction of the ring and `R` the radius of its middle line. The distance of the two points is
//! prescribed, because a ring between two forces that keep their direction would turn away. The engine is in plane
//! strain in 2D, so the ring bends with E' = E / (1 − ν²).
//!
//! The surface of a ring of voxels is a staircase, whose steps carry little load. A ring 8 voxels thick is therefore
//! 10 % too soft, one of 16 voxels 4 %. The stiffness under a small force, solved exactly, is extrapolated to fine
//! voxels and compared with the theory of thick rings, including stretching and shear. The force at large deflections
//! is compared relative to the stiffness of the same ring under a small force. With 16 voxels the large deflections
//! would take minutes, and thinner rings lose the force in the rounding of single precision.

use super::bar::{POISSON, fix_where, place, plane_strain, still, unbreakable};
use super::parallel;
use super::shooting::{integrate, root};
use super::statics::Statics;
use crate::plot::{Curve, Plot, Points};
use crate::report::{Findings, Outcome, Progress};
use anyhow::{Result, ensure};
use fuwafuwa::inspect::{CellHierarchy, Connectivity, Elasticity, Mesh};
use fuwafuwa::{
    Damping, Dim2, Grading, Grip, Material, RigidBody, Shape, SoftBody, Vec2, VoxelGrid, World,
};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// Radius of the middle line of the ring, and its thickness [voxels]. The ring has a radius of 1 m.
const SIZE: [usize; 2] = [80, 8];
/// Radius and thickness [voxels] of a finer ring, of which only the stiffness under a small force is computed.
const FINE: [usize; 2] = [160, 16];
/// Forces p = P R² / E' I at which the ring is measured.
const FORCES: [f64; 5] = [0.5, 1.0, 2.0, 3.0, 5.0];
/// Diameter loss and side growth, relative to the diameter, with the digits of an independent solution of the same
/// equation with a tolerance of 1e-9. For small forces they are p (π/8 − 1/π) and p (1/π − 1/4); S. Timoshenko,
/// *Strength of Materials*.
const KNOWN: [(f64, [f64; 2]); 5] = [
    (0.5, [0.0394, 0.0348]),
    (1.0, [0.0835, 0.0706]),
    (2.0, [0.1868, 0.1433]),
    (3.0, [0.3101, 0.2122]),
    (5.0, [0.5959, 0.3116]),
];
/// Maximum difference from the known numbers: a unit of their last digit.
const LAST_DIGIT: f64 = 1e-4;
/// Maximum relative deviation from the elastica.
const TOLERANCE: f64 = 0.02;
/// Lowest frequency of the ring [Hz]. It sets Young's modulus. Vibrations are damped critically.
const FREQUENCY: f64 = 1.0;
/// Time in which the two points approach each other [s].
const PRESSING: f32 = 1.0;
/// Time in which the ring then comes to rest [s].
const SETTLING: f32 = 1.0;
/// Number of ticks over which the force is averaged. Rounding of positions makes the force of a single substep
/// uncertain by 1 %.
const MEAN: u32 = 60;

/// Shape of a pinched ring.
#[derive(Copy, Clone, Debug, PartialEq)]
struct Pinched {
    /// Force p = P R² / E' I.
    force: f64,
    /// Loss of the diameter between the two points, relative to the diameter.
    loss: f64,
    /// Growth of the diameter across, relative to the diameter.
    growth: f64,
}

/// Compares pinched rings with the elastica.
pub fn check(progress: &Progress) -> Result<Findings> {
    compare_with_known()?;
    let [thin, thick] = small_losses(SIZE[0] as f64 / SIZE[1] as f64);
    let losses = parallel::each(&[SIZE, FINE], progress, |&size| small_loss(size, progress))?;
    let mut findings = Findings::default();
    for (size, loss) in [SIZE, FINE].iter().zip(&losses) {
        let case = format!(
            "ring, {} voxels thick, small force, stiffness / theory",
            size[1]
        );
        findings.outcomes.push(Outcome {
            reference: Some(1.0),
            ..Outcome::shown(case, thick / loss)
        });
    }
    // The error is inversely proportional to the number of voxels.
    let limit = 2.0 * thick / losses[1] - thick / losses[0];
    let case = "ring, extrapolated to fine voxels, small force, stiffness / theory".into();
    findings
        .outcomes
        .push(Outcome::near(case, limit, 1.0, TOLERANCE));
    let found = parallel::each(&FORCES, progress, |&force| {
        let found = pinch(elastica(force).loss)?;
        Ok(Pinched {
            force: found.force * losses[0] / thin,
            ..found
        })
    })?;
    for (&force, found) in FORCES.iter().zip(&found) {
        let exact = elastica(force);
        let name = format!("ring, diameter loss {:.4}", exact.loss);
        for (what, value, reference) in [
            (
                "force P R² / E'I, relative to its stiffness",
                found.force,
                exact.force,
            ),
            ("side growth / diameter", found.growth, exact.growth),
        ] {
            let case = format!("{name}, {what}");
            findings
                .outcomes
                .push(Outcome::relative(case, value, reference, TOLERANCE));
        }
    }
    let of = |value: fn(Pinched) -> f64| found.iter().map(move |&ring| (ring.force, value(ring)));
    findings.plots.push(Plot {
        x: "force P R² / E'I".into(),
        y: "change / diameter".into(),
        curves: vec![
            Curve::sampled(0.0..=5.5, |force| elastica(force).loss).named("diameter loss"),
            Curve::sampled(0.0..=5.5, |force| elastica(force).growth).named("side growth"),
        ],
        points: vec![
            Points::new("diameter loss", of(|ring| ring.loss)),
            Points::new("side growth", of(|ring| ring.growth)),
        ],
        ..Plot::default()
    });
    Ok(findings)
}

/// Returns the elastica of a ring under a force p = P R² / E' I.
fn elastica(force: f64) -> Pinched {
    // State: direction ψ, curvature, and the place relative to the side. The curvature at the side is searched at
    // which the direction is horizontal at the top, a quarter of the circumference further.
    let quarter = |curvature: f64| {
        let start = [FRAC_PI_2, curvature, 0.0, 0.0];
        integrate(start, FRAC_PI_2, |_, [psi, curvature, ..]| {
            [curvature, 0.5 * force * psi.cos(), psi.cos(), psi.sin()]
        })
    };
    let curvature = root(0.5, 5.0, |curvature| quarter(curvature)[0] - PI);
    let [_, _, across, height] = quarter(curvature);
    Pinched {
        force,
        loss: 1.0 - height,
        growth: -across - 1.0,
    }
}

/// Compares [`elastica`] with the known solutions.
fn compare_with_known() -> Result<()> {
    for (force, [loss, growth]) in KNOWN {
        let found = elastica(force);
        ensure!(
            (found.loss - loss).abs() <= LAST_DIGIT && (found.growth - growth).abs() <= LAST_DIGIT,
            "ring under the force {force}: expected {loss} and {growth}, computed {found:?}"
        );
    }
    Ok(())
}

/// Presses a ring of the engine together by a share of its diameter.
fn pinch(loss: f64) -> Result<Pinched> {
    let [radius, thickness] = SIZE;
    let (voxel, across) = (1.0 / radius as f32, 2 * radius + thickness);
    let grid = grid(SIZE, voxel)?;
    let usual = Material::default();
    // ω = 6/√5 √(E' I / ρ A R⁴), with R = 1 m.
    let depth = thickness as f64 / radius as f64;
    let wave_speed = TAU * FREQUENCY * 5f64.sqrt() / 6.0 * 12f64.sqrt() / depth;
    let modulus = f64::from(usual.density) * wave_speed * wave_speed;
    let material = unbreakable(modulus, Damping::at(1.0, FREQUENCY as f32));
    let mut body = SoftBody::new(grid, &[material])?;
    let middle = across as i32 / 2;
    fix_where(&mut body, |at| at[0] == middle && at[1] < middle);
    // Around the origin, single precision is finest.
    let centre = 0.5 * across as f32 * voxel;
    let body = body.translated(-Vec2::splat(centre));
    let mut world = World::new(still(Vec2::ZERO))?;
    let body = world.add_soft_body(body)?;
    let hand = RigidBody::kinematic(Shape::ball(0.01)).with_sensor(true);
    let hand = world.add_rigid_body(hand)?;
    let top = Vec2::Y;
    let section = Shape::cuboid(Vec2::new(0.25, 0.6 * thickness as f32) * voxel).translated(top);
    let grip = world.add_grip(Grip::carried(body, section, hand))?;
    let ticks = (60.0 * PRESSING) as u32;
    for tick in 1..=ticks {
        let pressed = 2.0 * loss as f32 * tick as f32 / ticks as f32;
        world.set_target_position(hand, -Vec2::Y * pressed)?;
        world.step();
    }
    for _ in 0..(60.0 * SETTLING) as u32 {
        world.step();
    }
    let mut sum = 0.0;
    for _ in 0..MEAN {
        world.step();
        sum -= f64::from(world.grip(grip)?.reaction().force.y);
    }
    let force = sum / f64::from(MEAN);
    let inertia = depth * depth * depth / 12.0;
    let sides = [0, across].map(|x| place(&world[body], [x, across / 2]));
    let [left, right] = sides;
    let outer = 2.0 + depth;
    Ok(Pinched {
        force: force / (modulus * inertia),
        loss,
        growth: 0.5 * (f64::from(right?.x - left?.x) - outer),
    })
}

/// Returns a ring whose middle line has a radius, with a thickness [voxels].
fn grid([radius, thickness]: [usize; 2], voxel: f32) -> Result<VoxelGrid<Dim2>> {
    let across = 2 * radius + thickness;
    Ok(VoxelGrid::from_fn([across, across, 1], voxel, |at| {
        let [x, y] = [at[0], at[1]].map(|k| f64::from(k) + 0.5 - 0.5 * across as f64);
        let distance = (x * x + y * y).sqrt() - radius as f64;
        u8::from(distance.abs() <= 0.5 * thickness as f64)
    })?)
}

/// Returns the diameter loss of a ring under a small force P, divided by P R³ / E' I: that of bending alone, and that
/// of bending, stretching and shear of a curved bar with the given ratio of radius and thickness.
fn small_losses(slenderness: f64) -> [f64; 2] {
    // Castigliano's theorem for the energy of a curved bar, ∫ (M²/2EI + N²/2EA − MN/EAR + V²/2κGA) ds. With the
    // angle φ from the side, N = −P/2 cos φ, V = P/2 sin φ and M = M0 + P R/2 (1 − cos φ). The moment M0 at the side
    // minimises the energy.
    let of = |section: f64, shear: f64| {
        let moment = -0.5 * (1.0 - 2.0 / PI + section * 2.0 / PI);
        let bending = 0.5 * (moment * (FRAC_PI_2 - 1.0) + 0.5 * (0.75 * PI - 2.0));
        let both = 0.25 * (1.0 - FRAC_PI_4) + 0.5 * (moment + 0.5 * (1.0 - FRAC_PI_4));
        4.0 * (bending + section * (PI / 16.0 * (1.0 + shear) + both))
    };
    // I / A R² of a rectangular section, and E' / κ G with κ = 5/6.
    let section = 1.0 / (12.0 * slenderness * slenderness);
    [of(0.0, 0.0), of(section, 2.0 / (1.0 - POISSON) * 1.2)]
}

/// Returns the diameter loss of a ring of voxels under a small force P, divided by P R³ / E' I. The size is as for
/// [`grid`].
fn small_loss(size: [usize; 2], progress: &Progress) -> Result<f64> {
    let grid = grid(size, 1.0)?;
    let sharing = Connectivity::new(&grid);
    let hierarchy = CellHierarchy::new(&grid, &sharing, Grading::Graded);
    let mesh = Mesh::grade(&grid, &sharing, &hierarchy)?;
    let elasticity = Elasticity::new(1.0, POISSON)?;
    let middle = (size[0] + size[1] / 2) as i32;
    let statics = Statics::new(&mesh, elasticity, |node, axis| {
        node.at[0] == middle && (axis == 0 || node.at[1] < middle)
    });
    let mut load = vec![0.0; mesh.node_capacity() * 2];
    let top = { mesh.nodes() }.filter(|(_, node)| node.at[0] == middle && node.at[1] > middle);
    let top: Vec<usize> = top.map(|(id, _)| id.index() * 2 + 1).collect();
    top.iter()
        .for_each(|&place| load[place] = -1.0 / top.len() as f64);
    let moved = statics.solve(&load, vec![0.0; load.len()], progress)?;
    // The work of a force of 1 is the displacement in its direction.
    let loss: f64 = moved
        .iter()
        .zip(&load)
        .map(|(moved, load)| moved * load)
        .sum();
    let slenderness = size[0] as f64 / size[1] as f64;
    Ok(loss * plane_strain(elasticity) / (12.0 * slenderness * slenderness * slenderness))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elastica_has_the_known_shapes() {
        compare_with_known().unwrap();
        let small = elastica(1e-3);
        assert!(
            (small.loss / 1e-3 - (PI / 8.0 - 1.0 / PI)).abs() < 1e-3,
            "{small:?}"
        );
        assert!((small.loss / 1e-3 - small_losses(10.0)[0] / 2.0).abs() < 1e-3);
        assert!(
            (small.growth / 1e-3 - (1.0 / PI - 0.25)).abs() < 1e-3,
            "{small:?}"
        );
    }
}

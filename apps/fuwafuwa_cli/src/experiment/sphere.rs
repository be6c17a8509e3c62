//! Contact of spheres: a soft ball between plates, a rigid ball pressed into a soft half-space, and the impact of a soft
//! ball on a rigid floor.
//!
//! ```text
//!      ○  rigid, radius R                    ●  soft, radius R
//!   ───╰╯───  surface     depth d            ↓  V
//!     soft                              ▔▔▔▔▔▔▔▔▔▔▔  floor
//! ```
//!
//! Ball between plates: see `fuwafuwa check sphere`.
//!
//! Half-space: I. N. Sneddon, *The relation between load and penetration in the axisymmetric Boussinesq problem for a punch
//! of arbitrary profile*, International Journal of Engineering Science 3 (1965),
//! [doi:10.1016/0020-7225(65)90019-4](https://doi.org/10.1016/0020-7225(65)90019-4). With E* = E / (1 − ν²) and the radius a
//! of the contact,
//!
//! ```text
//! F = E* ((R² + a²)/2 ln((R + a)/(R − a)) − a R)       d = a/2 ln((R + a)/(R − a))
//! ```
//!
//! The soft body is a block; the nodes of its sides and its bottom are held where a point load displaces a half-space
//! [Boussinesq 1885], so that the block responds as a part of a half-space. The load is the force of the engine itself, found
//! by iteration: the first round holds the nodes at rest, and each further round takes the force of the one before.
//!
//! Impact: H. Hertz, *Über die Berührung fester elastischer Körper*, Journal für die reine und angewandte Mathematik 92
//! (1882). A ball of the mass m is pressed against the floor by d, and leaves it after the time t:
//!
//! ```text
//! d = (15 m V² / 16 E* √R)^(2/5)       t = 2.9433 d / V
//! ```
//!
//! Hertz takes the ball for a half-space, which holds for small d/R: between plates, finite elements give forces that
//! are higher by 10 % at d/R = 0.08 and by 18 % at 0.2. For d/R = 0.2 and 0.3, the engine gives 11 and 15 % less compression
//! than Hertz, and the same with 48 and 64 voxels across; these rows have no bound. A second reference therefore takes the
//! work of the forces between plates, as for a slow impact: m V²/2 = ∫ F dd, and t = 2 ∫ dd / speed. Its rows have a bound up
//! to the end of the finite elements, d/R = 0.2.
//!
//! A real gel ball of R = 10 mm, E = 20 kPa and 1000 kg/m³ has d/R = 0.1 at
//! 0.14 m/s. The ball of the engine is 1 m across with E = 5 kPa and 100 kg/m³; d/R and t V/R depend on m V² / E* R³ only.

use super::half_space::boussinesq;
use super::{Bound, Record, Role, Row, Setup, of_check};
use crate::check::bar::still;
use crate::check::motion::{centre, material};
use crate::check::{self, parallel};
use crate::plot::{Curve, Plot, Points};
use crate::report::Progress;
use anyhow::Result;
use fuwafuwa::{
    Damping, Dim3, Elasticity, Material, RigidBody, Shape, SoftBody, Vec3, VoxelGrid, World,
    WorldConfig,
};
use std::time::Instant;

/// Voxels across the balls.
const ACROSS: usize = 32;
/// Size of the block [voxels]; it is 1 m wide.
const BLOCK: [usize; 3] = [48, 24, 48];
/// Radius of the rigid ball [m], and depths as shares of it.
const RADIUS: f64 = 0.4;
const DEPTHS: [f64; 3] = [0.05, 0.1, 0.25];
/// Number of rounds of the iteration. The change of the force falls to a fifth per round at the smallest depth, and to
/// half at the largest.
const ROUNDS: u32 = 10;
/// Time in which the ball is pressed in, and time in which the block settles [s].
const PRESSING: f64 = 0.3;
const SETTLING: f64 = 0.7;
/// Mass damping of the block [1/s].
const DAMPING: f32 = 30.0;
/// Number of ticks over which the force is averaged.
const MEAN: u32 = 12;
/// Largest compressions of the impacts by Hertz, d/R.
const IMPACTS: [f64; 4] = [0.05, 0.1, 0.2, 0.3];
/// Largest relative deviation.
const TOLERANCE: f64 = 0.1;
/// Tick of the impacts [s].
const TICK: f32 = 1.0 / 240.0;
/// Largest d/R at which the rows of Hertz, and those of a slow impact, have a bound. The finite elements end at 0.2.
const HERTZ_REACH: f64 = 0.1;
const PLATES_REACH: f64 = 0.2;
/// Number of halvings of an interval, and number of steps of an integral.
const HALVINGS: u32 = 60;
const STEPS: u32 = 200;

/// Returns E* [Pa].
fn contact_modulus(material: &Material) -> f64 {
    let elasticity = material.elasticity;
    elasticity.young / (1.0 - elasticity.poisson * elasticity.poisson)
}

/// Returns F / E* R² of a rigid sphere at the depth d/R in a half-space [Sneddon 1965].
fn sneddon(depth: f64) -> f64 {
    let log = |a: f64| ((1.0 + a) / (1.0 - a)).ln();
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let a = 0.5 * (low + high);
        match 0.5 * a * log(a) < depth {
            true => low = a,
            false => high = a,
        }
    }
    let a = 0.5 * (low + high);
    0.5 * (1.0 + a * a) * log(a) - a
}

/// Returns the displacement [m] of a half-space below y = 0 at a place [m] under the point load `force` at the origin, along
/// −y.
fn under_point_load(force: f64, material: &Material, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let Elasticity { poisson, .. } = material.elasticity;
    let factor = force / material.elasticity.shear_modulus();
    let [x, z, down] = boussinesq(poisson, [x, z, -y]).map(|moved| factor * moved);
    [x, -down, z]
}

/// Presses balls between plates, a rigid ball into a block, and throws balls at a floor.
pub fn experiment(progress: &Progress) -> Result<Record> {
    let mut record = of_check(check::sphere::check, ACROSS, progress)?;
    // The check presses balls of two sizes.
    record.set_voxels("n = 16", 16);
    let forces = parallel::each(&DEPTHS, progress, |&depth| {
        let start = Instant::now();
        let (mut force, mut substeps) = (0.0, 0);
        for _ in 0..ROUNDS {
            (force, substeps) = press(depth, force)?;
        }
        let setup = Setup {
            n: BLOCK[1],
            substeps: Some(substeps),
            seconds: start.elapsed().as_secs_f64(),
        };
        Ok((force, setup))
    })?;
    for (&depth, &(force, setup)) in DEPTHS.iter().zip(&forces) {
        record.rows.push(Row {
            case: format!("rigid ball in a half-space, depth {depth} R, force / E* R²"),
            role: Role::Verification,
            reference: Some(sneddon(depth)),
            spread: None,
            computed: force,
            bound: Bound::Relative(TOLERANCE),
            setup,
        });
    }
    let points = DEPTHS
        .iter()
        .zip(&forces)
        .map(|(&depth, &(force, _))| (depth, force));
    record.plots.push(Plot {
        x: "depth / R".into(),
        y: "force / E* R²".into(),
        curves: vec![
            Curve::sampled(0.02..=0.3, sneddon).named("Sneddon"),
            Curve::sampled(0.02..=0.3, |depth| 4.0 / 3.0 * depth.powf(1.5)).named("Hertz"),
        ],
        points: vec![Points::new("computed", points)],
        is_log: [true; 2],
        ..Plot::default()
    });
    let impacts = parallel::each(&IMPACTS, progress, |&depth| throw(depth))?;
    add_impacts(&impacts, &mut record);
    Ok(record)
}

/// Adds the rows and the plot of the impacts.
fn add_impacts(impacts: &[Impact], record: &mut Record) {
    let names = ["compression / R", "contact time × V / R"];
    let mut points = [const { Vec::new() }; 2];
    for (&depth, impact) in IMPACTS.iter().zip(impacts) {
        let computed = [impact.depth, impact.time];
        let slow = slow_impact(energy_of(depth), force_between_plates);
        let hertz_bound = match depth <= HERTZ_REACH {
            true => Bound::Relative(TOLERANCE),
            false => Bound::None,
        };
        let hertz = [depth, HERTZ_TIME * depth];
        let slow_bound = match slow[0] <= PLATES_REACH {
            true => Bound::Relative(TOLERANCE),
            false => Bound::None,
        };
        for (theory, reference, bound) in [
            ("Hertz", hertz, hertz_bound),
            ("slow impact", slow, slow_bound),
        ] {
            for index in 0..2 {
                record.rows.push(Row {
                    case: format!("impact, Hertz d/R {depth}, {}, {theory}", names[index]),
                    role: Role::Verification,
                    reference: Some(reference[index]),
                    spread: None,
                    computed: computed[index],
                    bound,
                    setup: impact.setup,
                });
            }
        }
        (0..2).for_each(|index| points[index].push((depth, computed[index])));
    }
    let hertz = |factor: f64| Curve::sampled(0.02..=0.32, move |depth| factor * depth);
    let slow = |index: usize| {
        let of = move |depth| slow_impact(energy_of(depth), force_between_plates)[index];
        Curve::sampled(0.02..=0.32, of)
    };
    let [depths, times] = points;
    record.plots.push(Plot {
        x: "compression / R by Hertz".into(),
        y: "impact".into(),
        curves: vec![
            slow(0).named(names[0]),
            slow(1).named(names[1]),
            hertz(1.0).named("Hertz, compression / R"),
            hertz(HERTZ_TIME).named("Hertz, contact time × V / R"),
        ],
        points: vec![Points::new(names[0], depths), Points::new(names[1], times)],
        ..Plot::default()
    });
}

/// Returns the kinetic energy m V²/2 / E* R³ for which Hertz predicts a compression d/R.
fn energy_of(depth: f64) -> f64 {
    8.0 / 15.0 * depth.powf(2.5)
}

/// Returns F / E* R² of a ball between plates that are pressed in by d/R each, by finite elements.
fn force_between_plates(depth: f64) -> f64 {
    let poisson = material().elasticity.poisson;
    check::sphere::reference(0.5 * depth) * (1.0 - poisson * poisson)
}

/// Returns the compression d/R and the contact time × V / R of an impact with the kinetic energy m V²/2 / E* R³, under a
/// force F / E* R² that depends on d/R only.
fn slow_impact(energy: f64, force: impl Fn(f64) -> f64) -> [f64; 2] {
    let work = |depth: f64| {
        let step = depth / f64::from(STEPS);
        let middles = (0..STEPS).map(|k| step * (f64::from(k) + 0.5));
        middles.map(|at| step * force(at)).sum::<f64>()
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match work(middle) < energy {
            true => low = middle,
            false => high = middle,
        }
    }
    let most = 0.5 * (low + high);
    // With d = most (1 − s²), the integrand stays finite at the turning point.
    let step = 1.0 / f64::from(STEPS);
    let slices = (0..STEPS).map(|k| {
        let s = step * (f64::from(k) + 0.5);
        let speed = (1.0 - work(most * (1.0 - s * s)) / energy).sqrt();
        step * 2.0 * most * s / speed
    });
    [most, 2.0 * slices.sum::<f64>()]
}

/// Contact time × V / d of Hertz: 2 ∫ dx / √(1 − x^(5/2)) from 0 to 1.
const HERTZ_TIME: f64 = 2.9433;

/// Presses a rigid ball into a block whose held nodes are displaced by the point load `load`, F / E* R². Returns F / E* R²
/// and the number of substeps in 1/60 s.
fn press(depth: f64, load: f64) -> Result<(f64, u32)> {
    let material = Material {
        damping: Damping {
            mass: DAMPING,
            stiffness: 0.0,
        },
        friction: 0.0,
        toughness: f32::INFINITY,
        ..material()
    };
    let unit = contact_modulus(&material) * RADIUS * RADIUS;
    let voxel = 1.0 / BLOCK[0] as f64;
    let grid = VoxelGrid::<Dim3>::from_fn(BLOCK, voxel as f32, |_| 1)?;
    let mut body = SoftBody::new(grid, &[material])?;
    let nodes: Vec<_> = body.mesh().nodes().collect();
    let last = BLOCK.map(|count| count as i32);
    for (id, node) in nodes {
        let [x, y, z] = node.at;
        // The low corner of the block is at the origin; the middle of its top is the origin of the half-space.
        let corner = [0.5, voxel * BLOCK[1] as f64, 0.5];
        let at = [0, 1, 2].map(|k: usize| voxel * f64::from(node.at[k]) - corner[k]);
        let is_held = x == 0 || z == 0 || y == 0 || x == last[0] || z == last[2];
        let mut place = at;
        if is_held {
            let moved = under_point_load(unit * load, &material, at);
            place = [0, 1, 2].map(|k: usize| at[k] + moved[k]);
            body.fix_node(id);
        }
        let place = Vec3::from(place.map(|coordinate| coordinate as f32));
        body.set_node_state(id, place, Vec3::ZERO)?;
    }
    let config: WorldConfig<Dim3> = still(Vec3::ZERO);
    let tick = f64::from(config.tick);
    let mut world = World::new(config)?;
    world.add_soft_body(body)?;
    let ball = RigidBody::kinematic(Shape::ball(RADIUS as f32)).with_friction(0.0);
    let ball = world.add_rigid_body(ball.at(RADIUS as f32 * Vec3::Y))?;
    let (pressing, settling) = ((PRESSING / tick) as u32, (SETTLING / tick) as u32);
    let mut force = 0.0;
    for count in 1..=pressing + settling {
        let share = (f64::from(count) / f64::from(pressing)).min(1.0);
        let at = (RADIUS * (1.0 - depth * share)) as f32 * Vec3::Y;
        world.set_target_position(ball, at)?;
        world.step();
        if count + MEAN > pressing + settling {
            let reactions = world.rigid_body(ball)?.reactions();
            let substeps = reactions.len().max(1) as f64;
            let sum: f64 = reactions.map(|one| f64::from(one.contact.y)).sum();
            force += sum / substeps / f64::from(MEAN);
        }
    }
    Ok((force / unit, world.substeps()))
}

/// Measured impact.
#[derive(Copy, Clone, Debug)]
struct Impact {
    /// Largest compression / R.
    depth: f64,
    /// Contact time × V / R.
    time: f64,
    setup: Setup,
}

/// Throws a ball at a floor, with the speed for which Hertz predicts a compression d/R.
fn throw(depth: f64) -> Result<Impact> {
    let start = Instant::now();
    let material = Material {
        friction: 0.0,
        toughness: f32::INFINITY,
        ..material()
    };
    let body = SoftBody::new(VoxelGrid::<Dim3>::ball(ACROSS, 1.0)?, &[material])?;
    let radius = 0.5 * (1.0 - 1.0 / ACROSS as f64);
    let mass = body.total_mass();
    let modulus = contact_modulus(&material);
    let speed =
        ((depth * radius).powf(2.5) * 16.0 * modulus * radius.sqrt() / (15.0 * mass)).sqrt();
    let gap = 0.01;
    let at = Vec3::Y * (radius + gap) as f32;
    let by = at - centre(&body).as_vec3();
    let body = body.translated(by);
    let mut world = World::<Dim3>::new(WorldConfig {
        tick: TICK,
        ..still(Vec3::ZERO)
    })?;
    // A kinematic floor, unlike a fixed one, reports its reactions.
    let floor = RigidBody::kinematic(Shape::cuboid(Vec3::new(2.0, 0.5, 2.0)));
    let floor = world.add_rigid_body(floor.with_friction(0.0).at(-0.5 * Vec3::Y))?;
    let body = world.add_soft_body(body)?;
    world.set_velocity(body, speed as f32 * Vec3::NEG_Y)?;
    let end = (gap / speed + 2.0 * HERTZ_TIME * depth * radius / speed) / f64::from(TICK);
    let (mut lowest, mut touching, mut substeps) = (f64::INFINITY, Vec::new(), 0.0);
    for _ in 0..end as u32 {
        world.step();
        let reactions = world.rigid_body(floor)?.reactions();
        let duration = f64::from(TICK) / reactions.len().max(1) as f64;
        for reaction in reactions {
            substeps += duration;
            if reaction.contact.y != 0.0 {
                touching.push(substeps);
            }
        }
        lowest = lowest.min(centre(&world[body]).y);
    }
    let time = match touching[..] {
        [first, .., last] => last - first,
        _ => f64::NAN,
    };
    Ok(Impact {
        depth: (radius - lowest) / radius,
        time: time * speed / radius,
        setup: Setup {
            n: ACROSS,
            substeps: Some(world.substeps() * 4),
            seconds: start.elapsed().as_secs_f64(),
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn sneddon_forces_are_those_of_an_independent_calculation() {
        for (depth, force) in [
            (0.05, 0.01483),
            (0.1, 0.04174),
            (0.25, 0.16249),
            (0.5, 0.44774),
            (1.0, 1.19968),
        ] {
            assert!(
                (sneddon(depth) / force - 1.0).abs() < 4e-4,
                "{}",
                sneddon(depth)
            );
        }
    }

    #[test]
    fn slow_impact_under_the_force_of_hertz_is_the_impact_of_hertz() {
        let [depth, time] = slow_impact(energy_of(0.2), |depth| 4.0 / 3.0 * depth.powf(1.5));
        assert!((depth / 0.2 - 1.0).abs() < 1e-4, "{depth}");
        assert!((time / (HERTZ_TIME * 0.2) - 1.0).abs() < 1e-3, "{time}");
    }

    #[test]
    fn point_load_strains_the_half_space_as_hooke_says() {
        // Force through a plane at some depth, by the stress that follows from the displacement.
        let material = material();
        let elasticity = material.elasticity;
        let step = 1e-4;
        let stress = |at: [f64; 3]| {
            let slope = |i: usize, axis: usize| {
                let place = |by: f64| {
                    let mut moved = at;
                    moved[axis] += by;
                    under_point_load(1.0, &material, moved)[i]
                };
                (place(step) - place(-step)) / (2.0 * step)
            };
            let trace = slope(0, 0) + slope(1, 1) + slope(2, 2);
            elasticity.lame() * trace + 2.0 * elasticity.shear_modulus() * slope(1, 1)
        };
        // σ = −3 F depth³ / 2π r⁵
        let exact = -3.0 * 0.3f64.powi(3) / (2.0 * PI * 0.34f64.sqrt().powi(5));
        let found = stress([0.4, -0.3, 0.3]);
        assert!((found / exact - 1.0).abs() < 1e-4, "{found} {exact}");
    }
}

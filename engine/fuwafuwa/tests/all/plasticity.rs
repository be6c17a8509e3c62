//! Materials with permanent deformation.

use crate::blades::Blades;
use crate::vectors::vector;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::inspect::Plasticity;
use fuwafuwa::inspect::{elastic_part, flow, forces_after};
use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimVector, Material, RigidBody, Shape, SoftBody, SoftBodyHandle,
    Vec3, VoxelGrid, World, WorldConfig,
};
use glam::DVec3;

fn rubber() -> Material {
    Material {
        yield_strain: f32::INFINITY,
        ..Material::clay()
    }
}

fn weightless<D: Dim>() -> WorldConfig<D> {
    WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    }
}

/// Presses a block between two plates to the fraction `share` of its height, and lifts the upper plate.
/// Returns the height, width and volume of the block afterwards, relative to the initial ones, with the world
/// and the body.
fn pressed<D: Dim>(material: Material, share: f32) -> ([f32; 3], World<D>, SoftBodyHandle) {
    let mut world = World::<D>::new(weightless()).unwrap();
    let body = SoftBody::new(VoxelGrid::<D>::cube(8, 1.0).unwrap(), &[material]).unwrap();
    let id = world.add_soft_body(body).unwrap();
    let plate = |y: f32| {
        let plate = RigidBody::kinematic(Shape::cuboid(vector(3.0, 0.25, 3.0)));
        plate.at(vector(0.5, y, 0.0)).with_friction(0.0)
    };
    world.add_rigid_body(plate(-0.25)).unwrap();
    let high = world.add_rigid_body(plate(1.25)).unwrap();
    let go = |world: &mut World<D>, from: f32, to: f32, ticks: u32| {
        for tick in 1..=ticks {
            let y = from + (to - from) * tick as f32 / ticks as f32;
            world
                .set_target_position(high, vector(0.5, 0.25 + y, 0.0))
                .unwrap();
            let report = world.step();
            assert_eq!(report.quarantined, 0);
        }
    };
    go(&mut world, 1.0, share, 60);
    go(&mut world, share, share, 20);
    go(&mut world, share, 2.0, 60);
    go(&mut world, 2.0, 2.0, 120);
    let view = world[id].piece_views()[0];
    let [width, height, _] = (view.high - view.low).to_array();
    let volume = volume(&world[id]);
    ([height, width, volume], world, id)
}

/// Returns the volume of a body [m³], summed over its deformed elements.
fn volume<D: Dim>(body: &SoftBody<D>) -> f32 {
    let width = f64::from(body.grid().voxel_size());
    let parts = body.mesh().elements().map(|(id, element)| {
        let f = body.element_state(id).unwrap().deformation;
        let det = f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1])
            - f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0])
            + f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
        det * body.mesh().voxels(element).count() as f64
    });
    let voxel = (0..D::N).fold(1.0, |volume, _| volume * width);
    (parts.sum::<f64>() * voxel) as f32
}

fn check_dent<D: Dim>() {
    let ([height, width, volume], world, clay) = pressed::<D>(Material::clay(), 0.65);
    assert!((0.6..0.8).contains(&height), "clay: height {height} m");
    assert!(width > 1.05, "clay: width {width} m");
    assert!((volume - 1.0).abs() < 0.05, "clay: volume {volume}");
    let body = &world[clay];
    let plastic_strains = body
        .mesh()
        .elements()
        .filter_map(|(id, _)| body.plastic_strain(id));
    assert!(plastic_strains.fold(0.0, f32::max) > 0.2);
    let ([height, width, volume], world, rubber) = pressed::<D>(rubber(), 0.65);
    assert!((height - 1.0).abs() < 0.01, "rubber: height {height} m");
    assert!((width - 1.0).abs() < 0.01 && (volume - 1.0).abs() < 0.01);
    let body = &world[rubber];
    assert!({ body.mesh().elements() }.all(|(id, _)| body.plastic_strain(id) == Some(0.0)));
}

#[test]
fn pressed_clay_stays_deformed_and_rubber_recovers() {
    check_dent::<Dim2>();
    check_dent::<Dim3>();
}

/// Returns the positions, velocities and masses of all nodes, so that worlds with different materials can be
/// compared.
fn node_states<D: Dim>(world: &World<D>) -> Vec<(D::Vector, D::Vector, f32)> {
    let states = |body: &SoftBody<D>| -> Vec<_> {
        let nodes = body.mesh().nodes();
        nodes.map(|(id, _)| body.node_state(id)).collect()
    };
    let bodies = world.soft_bodies();
    bodies.flat_map(|(_, body)| states(body)).collect()
}

/// Checks that a yield strain that is never reached gives results bit-identical to those of an infinite yield
/// strain.
fn check_same_bits<D: Dim>() {
    let run = |material: Material| {
        let mut world = World::<D>::new(WorldConfig::default()).unwrap();
        let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
        world
            .add_rigid_body(RigidBody::fixed(floor).with_friction(0.4))
            .unwrap();
        let body = SoftBody::new(VoxelGrid::<D>::ball(10, 1.0).unwrap(), &[material]).unwrap();
        world
            .add_soft_body(body.translated(vector(0.0, 0.2, 0.0)))
            .unwrap();
        (0..60).for_each(|_| _ = world.step());
        node_states(&world)
    };
    let strong = |yield_strain| Material {
        strength: f32::INFINITY,
        toughness: f32::INFINITY,
        yield_strain,
        ..Material::default()
    };
    let rubber = run(strong(f32::INFINITY));
    assert_eq!(
        run(strong(1e30)),
        rubber,
        "a yield strain of 1e30 must be elastic"
    );
    assert_ne!(
        run(strong(0.01)),
        rubber,
        "a yield strain of 0.01 must flow"
    );
}

#[test]
fn unreached_yield_strain_gives_same_bits_as_infinite() {
    check_same_bits::<Dim2>();
    check_same_bits::<Dim3>();
}

/// Moves the nodes of a cube at random. The forces and the plastic flow of the element batches must agree
/// with the reference implementation in double precision.
fn check_reference<D: Dim>(seed: u32) -> f32 {
    let mut state = seed.wrapping_mul(2_654_435_761).wrapping_add(9);
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32 - 0.5
    };
    let clay = Material::clay();
    let grid = VoxelGrid::<D>::cube(1, 1.0).unwrap();
    let mut body = SoftBody::new(grid, &[clay]).unwrap();
    let (id, element) = body.mesh().elements().next().unwrap();
    let element = element.clone();
    let element_class = body.mesh().element_class(&element).clone();
    let mut plastic_inverse = DVec3::AXES;
    let plasticity = Plasticity {
        yield_strain: f64::from(clay.yield_strain),
        limit: f64::from(clay.plastic_limit),
    };
    let elasticity: Elasticity = clay.elasticity;
    for _ in 0..30 {
        for &node in &element.nodes {
            let rest = body.mesh().node(node).at.map(|k| k as f32);
            let [x, y, z] = rest.map(|k| k + 0.35 * random());
            body.set_node_state(node, vector(x, y, z), D::Vector::ZERO)
                .unwrap();
        }
        let place = |&node: &_| body.node_state(node).0.to_vec3().as_dvec3();
        let positions: Vec<DVec3> = element.nodes.iter().map(place).collect();
        let expected = forces_after(
            elasticity,
            &plastic_inverse,
            &element_class,
            1.0,
            &positions,
        );
        let deformation = body.element_state(id).unwrap().deformation;
        let before = body.element_state(id).unwrap().energy;
        plastic_inverse = flow::<D>(plasticity, elasticity, &deformation, &plastic_inverse);
        // A substep of zero length updates forces and plastic flow without moving nodes.
        body.advance(0.0, D::Vector::ZERO);
        let after = body.element_state(id).unwrap().energy;
        assert!(after <= before * (1.0 + 1e-5), "energy {before} to {after}");
        for (&node, expected) in element.nodes.iter().zip(&expected) {
            let found = body.force_on(node);
            for axis in 0..D::N {
                let apart = (f64::from(found[axis]) - expected[axis]).abs();
                assert!(
                    apart < 2e-3 * elasticity.young,
                    "{found:?} for {expected:?}"
                );
            }
        }
        let strain = body.plastic_strain(id).unwrap();
        let other = fuwafuwa::inspect::plastic_stiffness_factor::<D>(&plastic_inverse);
        let expected = (1.0 / other).sqrt() - 1.0;
        assert!(
            (f64::from(strain) - expected).abs() < 2e-3,
            "{strain} for {expected}"
        );
        let left = elastic_part(&deformation, &plastic_inverse);
        assert!(left.iter().all(|row| row.is_finite()));
    }
    body.plastic_strain(id).unwrap()
}

#[test]
fn fast_path_matches_reference_plasticity() {
    for check in [check_reference::<Dim2>, check_reference::<Dim3>] {
        let most = (0..20).map(check).fold(0.0, f32::max);
        assert!(most > 0.1, "the material must flow");
    }
}

/// Checks a clay ball that expands, spins and deforms plastically: its momentum and angular momentum are
/// preserved, and its energy never grows.
fn check_kept<D: Dim>() {
    let clay = Material {
        damping: Damping::NONE,
        ..Material::clay()
    };
    let mut world = World::<D>::new(weightless()).unwrap();
    let body = SoftBody::new(VoxelGrid::<D>::ball(8, 1.0).unwrap(), &[clay]).unwrap();
    let id = world.add_soft_body(body).unwrap();
    let body = world.soft_body_mut(id).unwrap();
    let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    for node in nodes {
        let (at, _, _) = body.node_state(node);
        let [x, y] = [at[0] - 0.5, at[1] - 0.5];
        let velocity = vector(2.5 * x - 3.0 * y, -2.0 * y + 1.0 * x, 1.5 * x);
        body.set_node_state(node, at, velocity).unwrap();
    }
    let energy = |world: &World<D>| {
        let energies = world[id].energies(D::Vector::ZERO);
        energies.iter().map(|energy| energy.total()).sum::<f64>()
    };
    let momentum = world[id].momentum();
    let mut before = energy(&world);
    let first = before;
    for tick in 0..90 {
        world.step();
        let now = energy(&world);
        assert!(
            now < before + 0.005 * first,
            "tick {tick}: {before} to {now} J"
        );
        before = before.min(now).max(now);
        let other = world[id].momentum();
        for axis in 0..3 {
            let linear = other.linear[axis] - momentum.linear[axis];
            let spin = other.angular[axis] - momentum.angular[axis];
            assert!(linear.abs() < 1e-2, "tick {tick}: {linear} N s");
            assert!(
                spin.abs() < 2e-2 * momentum.angular[2].abs().max(1.0),
                "tick {tick}: {spin}"
            );
        }
    }
    let body = &world[id];
    let plastic_strains = body
        .mesh()
        .elements()
        .filter_map(|(id, _)| body.plastic_strain(id));
    assert!(
        plastic_strains.fold(0.0, f32::max) > 0.05,
        "the material must flow"
    );
    assert!(
        before < 0.99 * first,
        "flow must dissipate energy: {first} to {before} J"
    );
}

#[test]
fn plastic_flow_preserves_momentum_and_dissipates_energy() {
    check_kept::<Dim2>();
    check_kept::<Dim3>();
}

/// Checks that new elements inherit the plastic strain of the elements that they replace when a deformed body
/// is cut. A snapshot must preserve the plastic strain, too.
fn check_inherited<D: Blades>() {
    let (_, mut world, id) = pressed::<D>(Material::clay(), 0.6);
    let mean = |world: &World<D>| {
        let body = &world[id];
        let plastic_strains = body.mesh().elements().map(|(own, element)| {
            let voxels = body.mesh().voxels(element).count() as f32;
            (voxels * body.plastic_strain(own).unwrap(), voxels)
        });
        let (sum, voxels) = plastic_strains.fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
        sum / voxels
    };
    let (plastic_strain, elements) = (mean(&world), world[id].mesh().element_count());
    assert!(plastic_strain > 0.1);
    let centre = world[id].centre_of_mass();
    let corner = Vec3::new(centre[0] - 0.03, centre[1] - 2.0, -3.0);
    let blade = D::blade(corner, Vec3::new(0.05, 4.0, 0.0), Vec3::Z * 6.0);
    world.cut(id, &blade).unwrap();
    let body = &world[id];
    assert!(body.pieces().count() == 2 && body.mesh().element_count() >= elements);
    assert!(
        (mean(&world) - plastic_strain).abs() < 1e-4,
        "{} for {plastic_strain}",
        mean(&world)
    );
    body.mesh()
        .validate(body.grid(), body.connectivity())
        .unwrap();
    #[cfg(feature = "serde")]
    {
        use fuwafuwa::snapshot::{load, save};
        let mut loaded = load::<D>(&save(&world)).unwrap();
        assert_eq!(mean(&loaded), mean(&world));
        for _ in 0..20 {
            world.step();
            loaded.step();
        }
        assert_eq!(loaded.hash(), world.hash());
    }
    (0..60).for_each(|_| _ = world.step());
    assert!(
        (mean(&world) - plastic_strain).abs() < 0.05,
        "the deformation must be permanent"
    );
}

#[test]
fn plastic_strain_survives_cut_and_snapshot() {
    check_inherited::<Dim2>();
    check_inherited::<Dim3>();
}

/// Strikes a clay ball with a hand from random directions, and checks that the state stays bounded.
fn check_abuse<D: Dim>(seed: u32) {
    let mut state = seed.wrapping_mul(2_654_435_761).wrapping_add(5);
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let clay = Material {
        yield_strain: 0.005 + 0.3 * random() * random(),
        plastic_limit: 1.0 + 3.0 * random(),
        elasticity: Elasticity::new(
            500.0 + 20_000.0 * f64::from(random()),
            0.4 * f64::from(random()),
        )
        .unwrap(),
        strength: if random() < 0.5 { 800.0 } else { f32::INFINITY },
        ..Material::clay()
    };
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.4))
        .unwrap();
    let body = SoftBody::new(VoxelGrid::<D>::ball(8, 1.0).unwrap(), &[clay]).unwrap();
    let id = world.add_soft_body(body).unwrap();
    let hand = world
        .add_rigid_body(RigidBody::coupled(Shape::ball(0.2)).at(vector(0.5, 2.0, 0.5)))
        .unwrap();
    let limit = f64::from(clay.plastic_limit);
    let (mut goal, mut target) = (Vec3::new(0.5, 2.0, 0.5), Vec3::splat(0.5));
    for tick in 0..120 {
        if tick % 8 == 0 {
            target = Vec3::new(random() * 2.0 - 0.5, random() * 1.2, random());
        }
        // Limits the speed of the hand to some metres per second. A faster hand would hurl away any body,
        // even an elastic one.
        goal += (target - goal).clamp(Vec3::splat(-0.08), Vec3::splat(0.08));
        let position = D::Vector::from_vec3(goal);
        world.set_target_position(hand, position).unwrap();
        let report = world.step();
        assert_eq!(report.quarantined, 0, "{}D, seed {seed}, tick {tick}", D::N);
    }
    let body = &world[id];
    for (own, _) in body.mesh().elements() {
        let plastic_strain = f64::from(body.plastic_strain(own).unwrap());
        assert!(
            plastic_strain < limit * 1.05 + 0.05,
            "{plastic_strain} of {limit}"
        );
    }
    let energy = body.kinetic_energy();
    assert!(
        energy < 1e4,
        "{}D, seed {seed}: {energy} J of {clay:?}",
        D::N
    );
}

#[test]
fn clay_stays_bounded_under_random_blows() {
    (0..20).for_each(check_abuse::<Dim2>);
    (0..20).for_each(check_abuse::<Dim3>);
}

#[test]
fn body_rejects_invalid_plasticity() {
    for (yield_strain, limit, expected) in [
        (
            0.0,
            2.0,
            "material 1: yield_strain must be positive, given 0.0",
        ),
        (
            f32::NAN,
            2.0,
            "material 1: yield_strain must be positive, given NaN",
        ),
        (
            0.1,
            0.5,
            "material 1: plastic_limit must be 1 to 4, given 0.5",
        ),
        (
            0.1,
            5.0,
            "material 1: plastic_limit must be 1 to 4, given 5.0",
        ),
    ] {
        let material = Material {
            yield_strain,
            plastic_limit: limit,
            ..Material::default()
        };
        let grid = VoxelGrid::<Dim2>::cube(2, 1.0).unwrap();
        let error = SoftBody::new(grid, &[material]).unwrap_err();
        assert_eq!(error.to_string(), expected);
    }
}

//! Soft bodies that require more substeps than the world allows.

use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimVector, Elasticity, Event, Hooks, Impulse, Joint, JointAnchor,
    Material, Momentum, RigidBody, Shape, SoftBody, SoftBodyHandle, StiffBodies, StressLaw, Vec2,
    Vec3, Velocity, VoxelGrid, World, WorldConfig,
};

/// Width of the bodies [m]. Discs of 24 voxels and balls of 10 voxels require more than 64 substeps.
const WIDTH: f32 = 0.005;

fn world<D: Dim>(stiff_bodies: StiffBodies) -> World<D> {
    World::new(WorldConfig {
        gravity: D::Vector::ZERO,
        stiff_bodies,
        sleep: false,
        ..WorldConfig::default()
    })
    .unwrap()
}

fn vector<D: Dim>(x: f32, y: f32, z: f32) -> D::Vector {
    D::Vector::from_vec3(Vec3::new(x, y, if D::N == 3 { z } else { 0.0 }))
}

fn ball<D: Dim>(material: Material) -> SoftBody<D> {
    let n = if D::N == 2 { 24 } else { 10 };
    SoftBody::new(VoxelGrid::ball(n, WIDTH).unwrap(), &[material]).unwrap()
}

fn unbreakable() -> Material {
    Material {
        strength: f32::INFINITY,
        ..Material::default()
    }
}

/// Returns the sum of the momenta of all soft bodies.
fn momentum<D: Dim>(world: &World<D>) -> Momentum {
    let mut sum = Momentum::default();
    for (_, body) in world.soft_bodies() {
        let own = body.momentum();
        sum.linear += own.linear;
        sum.angular += own.angular;
    }
    sum
}

/// Checks that the momentum has changed by at most `share` of `linear` [kg m/s], and the angular momentum by at
/// most 20 times that at a lever arm of the width: friction acts at the centres of contact spheres.
fn check_momentum<D: Dim>(what: &str, world: &World<D>, before: Momentum, linear: f64, share: f64) {
    let now = momentum(world);
    let lost = (now.linear - before.linear).length();
    assert!(lost <= share * linear, "{what}: lost {lost} of {linear}");
    let lost = (now.angular - before.angular).length();
    let angular = linear * f64::from(WIDTH);
    assert!(
        lost <= 20.0 * share * angular,
        "{what}: lost {lost} of {angular}"
    );
}

/// Throws two bodies at each other, a little off centre; returns the world and the bodies.
fn collision<D: Dim>(stiff_bodies: StiffBodies) -> (World<D>, [SoftBodyHandle; 2]) {
    let mut world = world::<D>(stiff_bodies);
    let both = [-1.0f32, 1.0].map(|side| {
        let at = vector::<D>(side * 0.6 * WIDTH, side * 0.1 * WIDTH, 0.0);
        let body = world
            .add_soft_body(ball::<D>(unbreakable()).translated(at))
            .unwrap();
        let velocity = Velocity::linear(vector::<D>(-0.5 * side, 0.0, 0.0));
        world.set_velocity(body, velocity).unwrap();
        body
    });
    (world, both)
}

fn check_collision<D: Dim>() {
    let (mut world, [first, second]) = collision::<D>(StiffBodies::MassScaled);
    assert!(
        world[first].mass_scale() > 20.0,
        "{}",
        world[first].mass_scale()
    );
    let before = momentum(&world);
    let mass = world[first].total_mass();
    for _ in 0..6 {
        assert_eq!(world.step().quarantined, 0);
    }
    let [left, right] = [first, second].map(|body| world[body].momentum().linear.x / mass);
    assert!(
        left < 0.0 && right > 0.0,
        "the bodies did not bounce: {left} {right}"
    );
    check_momentum("collision", &world, before, 0.5 * mass, 0.002);
}

#[test]
fn collision_of_mass_scaled_bodies_preserves_momentum_in_2d() {
    check_collision::<Dim2>();
}

#[test]
fn collision_of_mass_scaled_bodies_preserves_momentum_in_3d() {
    check_collision::<Dim3>();
}

fn check_joint<D: Dim>() {
    let (mut world, both) = collision::<D>(StiffBodies::MassScaled);
    let ends = both.map(|body| {
        let at = world[body].piece_views()[0];
        let middle = (at.low + at.high) * 0.5;
        JointAnchor::on(body, D::Vector::from_vec3(middle)).within(0.2 * WIDTH)
    });
    // The rope stops the bodies after they have bounced off each other.
    let [first, second] = ends;
    world
        .add_joint(Joint::rope(first, second, 1.25 * WIDTH))
        .unwrap();
    let before = momentum(&world);
    let mass = world[both[0]].total_mass();
    for _ in 0..6 {
        assert_eq!(world.step().quarantined, 0);
    }
    check_momentum("joint", &world, before, 0.5 * mass, 0.002);
}

#[test]
fn joint_between_mass_scaled_bodies_preserves_momentum() {
    check_joint::<Dim2>();
    check_joint::<Dim3>();
}

fn check_impulse_and_field<D: Dim>() {
    let mut world = world::<D>(StiffBodies::MassScaled);
    let body = world.add_soft_body(ball::<D>(unbreakable())).unwrap();
    let mass = world[body].total_mass();
    let impulse = 0.1 * mass as f32;
    let point = vector::<D>(0.5 * WIDTH, WIDTH, 0.5 * WIDTH);
    let pushed = Impulse::at(point, vector::<D>(impulse, 0.0, 0.0));
    world.apply_impulse(body, pushed).unwrap();
    let mut wanted = Momentum::default();
    wanted.linear.x = f64::from(impulse);
    // The nearest node, at which the impulse acts, is close to the top.
    wanted.angular = world[body].momentum().angular;
    assert!(
        wanted.angular.z < -0.4 * f64::from(impulse * WIDTH),
        "{wanted:?}"
    );
    check_momentum("impulse", &world, wanted, f64::from(impulse), 1e-4);
    for _ in 0..6 {
        world.step();
    }
    check_momentum("flight", &world, wanted, f64::from(impulse), 1e-3);
    // A field that grows along the second axis has the resultant of its value at the centre.
    let before = world[body].momentum().linear.x;
    let centre = |world: &World<D>| {
        let view = world[body].piece_views()[0];
        0.5 * (view.low.y + view.high.y)
    };
    let (gradient, at) = (100.0, centre(&world));
    let field = |point: D::Vector| vector::<D>(gradient * (point[1] - at + 0.01), 0.0, 0.0);
    world.step_with(&mut Hooks {
        field: Some(&field),
        ..Hooks::default()
    });
    let gained = (world[body].momentum().linear.x - before) / mass;
    let ideal = f64::from(gradient * 0.01 * world.config().tick);
    assert!((gained / ideal - 1.0).abs() < 0.05, "{gained} {ideal}");
}

#[test]
fn impulses_and_fields_act_on_the_true_mass() {
    check_impulse_and_field::<Dim2>();
    check_impulse_and_field::<Dim3>();
}

/// A pendulum of a pinned bar at rest carries its weight, and its fixed nodes feel the weight.
#[test]
fn fixed_nodes_carry_the_true_weight() {
    let mut world = World::<Dim2>::new(WorldConfig {
        sleep: false,
        ..WorldConfig::default()
    })
    .unwrap();
    let grid = VoxelGrid::from_fn([8, 24, 1], WIDTH / 24.0, |_| 1).unwrap();
    let mut body = SoftBody::new(grid, &[unbreakable()]).unwrap();
    let nodes: Vec<_> = body.mesh().nodes().collect();
    let held: Vec<_> = { nodes.iter() }
        .filter(|(_, node)| node.at[1] == 24)
        .map(|&(id, _)| id)
        .collect();
    held.iter().for_each(|&id| body.fix_node(id));
    let bar = world.add_soft_body(body).unwrap();
    assert!(world[bar].mass_scale() > 20.0);
    for _ in 0..600 {
        world.step();
    }
    let load: f32 = held.iter().map(|&id| world[bar].force_on(id).y).sum();
    let masses: f32 = held.iter().map(|&id| world[bar].node_state(id).2).sum();
    let weight = (world[bar].total_mass() as f32 - masses) * 9.81;
    assert!((load / weight + 1.0).abs() < 0.01, "{load} {weight}");
}

#[test]
fn treatments_of_stiff_bodies_differ() {
    let scales = [
        StiffBodies::Exact,
        StiffBodies::MassScaled,
        StiffBodies::Softened,
    ]
    .map(|treatment| {
        let mut world = world::<Dim2>(treatment);
        let body = world.add_soft_body(ball(unbreakable())).unwrap();
        let report = world.step();
        (
            world[body].mass_scale(),
            world[body].stiffness_scale(),
            report,
        )
    });
    let [exact, scaled, softened] = scales;
    assert_eq!(
        (
            exact.0,
            exact.1,
            exact.2.scaled_bodies,
            exact.2.largest_scale
        ),
        (1.0, 1.0, 0, 1.0)
    );
    assert!(exact.2.substeps > 300, "{:?}", exact.2);
    assert_eq!(
        (scaled.1, scaled.2.substeps, scaled.2.scaled_bodies),
        (1.0, 64, 1)
    );
    assert_eq!(
        (softened.0, softened.2.substeps, softened.2.scaled_bodies),
        (1.0, 64, 1)
    );
    assert!(
        (scaled.0 * softened.1 - 1.0).abs() < 1e-9,
        "{scaled:?} {softened:?}"
    );
    assert_eq!(scaled.2.largest_scale, scaled.0 as f32);
    let ratio = f64::from(exact.2.substeps) / 64.0;
    assert!(
        (scaled.0 / (ratio * ratio) - 1.0).abs() < 0.02,
        "{scaled:?} {exact:?}"
    );
}

#[test]
fn event_tells_once_when_a_scale_begins_and_ends() {
    let told = |world: &World<Dim2>| {
        let events = world.events().iter();
        let scales = events.filter_map(|event| match *event {
            Event::StiffBodyScaled { mass_scale, .. } => Some(mass_scale),
            _ => None,
        });
        scales.collect::<Vec<f32>>()
    };
    let mut world = world::<Dim2>(StiffBodies::MassScaled);
    let body = world.add_soft_body(ball(unbreakable())).unwrap();
    let scale = world[body].mass_scale() as f32;
    world.step();
    assert_eq!(told(&world), [scale]);
    world.step();
    assert!(told(&world).is_empty());
    let exact = WorldConfig {
        stiff_bodies: StiffBodies::Exact,
        ..*world.config()
    };
    world.set_config(exact).unwrap();
    world.step();
    assert_eq!(told(&world), [1.0]);
    world.step();
    assert!(told(&world).is_empty());
}

/// Vibrations of a mass-scaled body are slower, and their damping acts with the same damping ratio.
#[test]
fn acting_damping_keeps_its_ratio_under_mass_scaling() {
    let mut world = world::<Dim2>(StiffBodies::MassScaled);
    let body = world.add_soft_body(ball(unbreakable())).unwrap();
    let slower = world[body].mass_scale().sqrt() as f32;
    let [acting] = world.acting_damping(body).unwrap()[..] else {
        panic!("the body has one material")
    };
    assert!(
        (acting.mass * slower / Material::default().damping.mass - 1.0).abs() < 1e-5,
        "{acting:?}"
    );
    let substep = world.config().tick / world.substeps() as f32;
    assert!(acting.stiffness >= 0.1 * substep, "{acting:?}");
}

/// A body of rubber that stiffens at large strains is thrown at the floor. Its mass scale follows the stiffening from tick
/// to tick, without giving it energy.
fn check_thrown_rubber<D: Dim>(speed: f32) {
    let mut world = World::<D>::new(WorldConfig {
        gravity: vector::<D>(0.0, -10.0, 0.0),
        sleep: false,
        ..WorldConfig::default()
    })
    .unwrap();
    let floor = Shape::half_space(vector::<D>(0.0, 1.0, 0.0), D::Vector::ZERO);
    world.add_rigid_body(RigidBody::fixed(floor)).unwrap();
    let rubber = Material {
        elasticity: Elasticity::new(7000.0, 0.4).unwrap(),
        stress_law: StressLaw::Yeoh {
            second: 0.07429,
            third: 0.006489,
        },
        damping: Damping {
            mass: 1.0,
            ..Damping::default()
        },
        ..unbreakable()
    };
    let n = if D::N == 2 { 32 } else { 20 };
    let ball = SoftBody::new(VoxelGrid::ball(n, 0.5).unwrap(), &[rubber]).unwrap();
    let ball = ball.translated(vector::<D>(0.0, 0.3, 0.0));
    let thrown = ball.with_velocity(Velocity::linear(vector::<D>(0.0, -speed, 0.0)));
    let body = world.add_soft_body(thrown).unwrap();
    let energy = |world: &World<D>| {
        let pieces = world[body].energies(world.config().gravity);
        pieces.iter().map(|piece| piece.total()).sum::<f64>()
    };
    let mut least = energy(&world);
    let mut is_scaled = false;
    for tick in 0..240 {
        let report = world.step();
        is_scaled |= report.scaled_bodies > 0;
        let now = energy(&world);
        assert!(
            now < 1.1 * least,
            "{speed} m/s, tick {tick}: {now} J after {least} J"
        );
        least = least.min(now);
    }
    assert!(is_scaled, "{speed} m/s");
    let report = world.step();
    assert_eq!(report.inverted, 0, "{speed} m/s");
}

#[test]
fn changing_mass_scale_gives_a_stiffening_body_no_energy() {
    for speed in [4.5, 6.0, 8.0] {
        check_thrown_rubber::<Dim2>(speed);
    }
    for speed in [9.0, 13.0] {
        check_thrown_rubber::<Dim3>(speed);
    }
}

/// A disc that rests on the floor does not move, and is flattened only a little.
#[test]
fn mass_scaled_disc_without_damping_rests() {
    let mut world = World::<Dim2>::new(WorldConfig {
        sleep: false,
        ..WorldConfig::default()
    })
    .unwrap();
    let floor = Shape::half_space(Vec2::Y, Vec2::ZERO);
    world.add_rigid_body(RigidBody::fixed(floor)).unwrap();
    let material = Material {
        damping: Damping::NONE,
        ..unbreakable()
    };
    let body = world.add_soft_body(ball(material)).unwrap();
    for _ in 0..300 {
        world.step();
    }
    let speed = world[body].momentum().linear.length() / world[body].total_mass();
    assert!(speed < 1e-3, "{speed}");
    let view = world[body].piece_views()[0];
    assert!(view.low.y.abs() < 0.01 * WIDTH, "{view:?}");
    // At this size the weight flattens the disc by less than a hundredth. Its diameter is one voxel less than the grid.
    let sag = 23.0 / 24.0 - view.high.y / WIDTH;
    assert!((0.0..0.01).contains(&sag), "{sag}");
}

//! Reactions, grips, sums over regions, the range of positions, and objects placed inside each other.

use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimAngular, DimVector, Event, Grip, Joint, JointAnchor, Material,
    MotionType, NodeId, ObjectRef, ObjectSelector, RigidBody, Shape, SoftBody, SoftBodyHandle,
    Vec2, Vec3, VoxelGrid, World, WorldConfig,
};

const GRAVITY: f32 = 9.81;

fn vector<D: Dim>(x: f32, y: f32, z: f32) -> D::Vector {
    D::Vector::from_vec3(Vec3::new(x, y, z))
}

fn weightless<D: Dim>() -> World<D> {
    let gravity = D::Vector::ZERO;
    World::new(WorldConfig {
        gravity,
        ..WorldConfig::default()
    })
    .unwrap()
}

fn on_floor<D: Dim>() -> (World<D>, fuwafuwa::RigidBodyHandle) {
    let mut world = World::new(WorldConfig::default()).unwrap();
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    let floor = world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.5))
        .unwrap();
    (world, floor)
}

/// Material without transverse contraction, so that bars and beams follow the simplest theory.
fn rubber(young: f64) -> Material {
    Material {
        elasticity: Elasticity {
            young,
            poisson: 0.0,
        },
        strength: f32::INFINITY,
        damping: Damping {
            mass: 40.0,
            ..Damping::default()
        },
        ..Material::default()
    }
}

/// Relative tolerance of forces on a sleeping body: it was slower than the speed after 4 ms of free fall for half a
/// second, so the mean force in this time differs from the weight by at most 2 · 4 ms / 0.5 s.
const SLEEPING: f32 = 0.016;

fn ball<D: Dim>(n: usize, width: f32, at: D::Vector) -> SoftBody<D> {
    let grid = VoxelGrid::ball(n, width).unwrap();
    SoftBody::new(grid, &[rubber(5000.0)])
        .unwrap()
        .translated(at)
}

/// Bar along the first axis, 16 × 4 (× 4) voxels of 0.05 m.
fn bar<D: Dim>(young: f64) -> SoftBody<D> {
    let depth = if D::N == 3 { 4 } else { 1 };
    let grid = VoxelGrid::from_fn([16, 4, depth], 0.05, |_| 1).unwrap();
    SoftBody::new(grid, &[rubber(young)]).unwrap()
}

/// Cross-section of the bar [m²]; in 2D 1 m deep.
fn section<D: Dim>() -> f32 {
    if D::N == 3 { 0.2 * 0.2 } else { 0.2 }
}

fn left_end<D: Dim>() -> Shape<D> {
    Shape::half_space(D::Vector::X, D::Vector::X * 0.01)
}

fn right_end<D: Dim>() -> Shape<D> {
    Shape::half_space(-D::Vector::X, D::Vector::X * 0.79)
}

fn sleeps<D: Dim>(world: &World<D>, body: SoftBodyHandle) -> bool {
    world[body].pieces().list.iter().all(|piece| piece.asleep)
}

fn step_until_asleep<D: Dim>(world: &mut World<D>, body: SoftBodyHandle) {
    for _ in 0..1800 {
        world.step();
        if sleeps(world, body) {
            return;
        }
    }
    panic!("the body does not fall asleep");
}

fn assert_near(found: f32, expected: f32, share: f32, what: &str) {
    let is_near = (found - expected).abs() <= share * expected.abs();
    assert!(is_near, "{what}: {found}, expected {expected}");
}

fn check_weight<D: Dim>() {
    let (mut world, floor) = on_floor::<D>();
    let soft = world.add_soft_body(ball(12, 0.5, D::Vector::ZERO)).unwrap();
    let weight = GRAVITY * world[soft].total_mass() as f32;
    step_until_asleep(&mut world, soft);
    for _ in 0..30 {
        world.step();
    }
    assert_near(
        -world.reaction(floor).unwrap().force[1],
        weight,
        SLEEPING,
        "floor under a sleeper",
    );
    assert_near(
        world.reaction(soft).unwrap().force[1],
        weight,
        SLEEPING,
        "sleeper on a floor",
    );
    // The floor is pushed below the centre of the body.
    let reaction = world.reaction(floor).unwrap();
    let centre = world[soft].centre_of_mass();
    let arm = reaction.about(centre).torque.to_vec3();
    assert!(arm.length() < 0.01 * weight * 0.5, "{arm}");
    let other = vector::<D>(1.0, 0.0, 0.0);
    let about_other = reaction.about(centre + other).torque.to_vec3().z - arm.z;
    assert_near(about_other, weight, 0.02, "torque about a point 1 m aside");
}

#[test]
fn floor_carries_weight_of_sleeping_soft_body() {
    check_weight::<Dim2>();
    check_weight::<Dim3>();
}

/// A rigid plank on two supports carries a load off its middle: the lever rule gives both reactions.
fn check_lever<D: Dim>() {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let support = |x: f32| {
        let shape = Shape::cuboid(vector::<D>(0.02, 0.1, 0.2));
        RigidBody::fixed(shape).at(vector::<D>(x, -0.1, 0.0))
    };
    let left = world.add_rigid_body(support(-0.5)).unwrap();
    let right = world.add_rigid_body(support(0.5)).unwrap();
    let plank = Shape::cuboid(vector::<D>(0.6, 0.05, 0.2));
    let plank = RigidBody::dynamic(plank, 2.0).at(vector::<D>(0.0, 0.05, 0.0));
    let plank = world.add_rigid_body(plank).unwrap();
    let load = Shape::cuboid(D::Vector::splat(0.05));
    let load = RigidBody::dynamic(load, 1.0).at(vector::<D>(0.3, 0.15, 0.0));
    let load = world.add_rigid_body(load).unwrap();
    for _ in 0..300 {
        world.step();
    }
    assert!(world.rigid_body(plank).unwrap().is_asleep());
    // Each support takes half of the plank; the load is 0.8 m from the left one and 0.2 m from the right one.
    let force = |body| world.reaction(body).unwrap().force[1];
    assert_near(-force(left), GRAVITY * (1.0 + 0.2), 0.03, "left support");
    assert_near(-force(right), GRAVITY * (1.0 + 0.8), 0.03, "right support");
    assert_near(
        force(left) + force(right),
        -GRAVITY * 3.0,
        0.01,
        "both supports",
    );
    assert_near(force(load), GRAVITY, 0.01, "load");
    assert_near(force(plank), GRAVITY * 2.0, 0.02, "plank");
}

#[test]
fn supports_of_a_plank_follow_the_lever_rule() {
    check_lever::<Dim2>();
    check_lever::<Dim3>();
}

fn check_joint<D: Dim>() {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let top = RigidBody::fixed(Shape::cuboid(D::Vector::splat(0.1)));
    let top = world.add_rigid_body(top).unwrap();
    let weight = RigidBody::dynamic(Shape::ball(0.1), 3.0).at(vector::<D>(0.0, -1.0, 0.0));
    let weight = world.add_rigid_body(weight).unwrap();
    let anchors = [(top, 0.0), (weight, -1.0)];
    let [first, second] = anchors.map(|(body, y)| JointAnchor::on(body, vector::<D>(0.0, y, 0.0)));
    let rope = world.add_joint(Joint::rope(first, second, 1.0)).unwrap();
    for _ in 0..300 {
        world.step();
    }
    assert!(world.rigid_body(weight).unwrap().is_asleep());
    assert_near(
        -world.joint(rope).unwrap().reaction()[1],
        GRAVITY * 3.0,
        0.01,
        "rope",
    );
    assert_near(
        -world.reaction(top).unwrap().force[1],
        GRAVITY * 3.0,
        0.01,
        "hook",
    );
    assert_near(
        world.reaction(weight).unwrap().force[1],
        GRAVITY * 3.0,
        0.01,
        "weight",
    );
}

#[test]
fn rope_of_sleeping_weight_pulls_both_ends() {
    check_joint::<Dim2>();
    check_joint::<Dim3>();
}

/// A beam fixed at one end carries its weight there: force m g, moment m g L / 2.
fn check_cantilever<D: Dim>() {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let mut beam = bar::<D>(4e5);
    let nodes: Vec<NodeId> = beam.nodes_in(&left_end()).collect();
    nodes.iter().for_each(|&node| beam.fix_node(node));
    let beam = world.add_soft_body(beam).unwrap();
    let weight = GRAVITY * world[beam].total_mass() as f32;
    step_until_asleep(&mut world, beam);
    world.step();
    let root = vector::<D>(0.0, 0.1, 0.1);
    let reaction = world
        .fixed_node_reaction(beam, &left_end())
        .unwrap()
        .about(root);
    assert_near(reaction.force[1], weight, 0.03, "force");
    let centre = world[beam].centre_of_mass()[0];
    assert_near(reaction.torque.to_vec3().z, weight * centre, 0.03, "moment");
    assert!((centre - 0.4).abs() < 0.01);
    assert!(world.fixed_node_reaction(beam, &right_end()).is_err());
    // The same held by a grip.
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let beam = world.add_soft_body(bar::<D>(4e5)).unwrap();
    let grip = world.add_grip(Grip::still(beam, left_end())).unwrap();
    step_until_asleep(&mut world, beam);
    let reaction = world.grip(grip).unwrap().reaction().about(root);
    assert_near(reaction.force[1], weight, 0.01, "force of the grip");
    assert_near(
        reaction.torque.to_vec3().z,
        weight * 0.4,
        0.02,
        "moment of the grip",
    );
    assert_near(world.reaction(beam).unwrap().force[1], weight, 0.01, "beam");
    // Without the grip the beam falls.
    world.remove(grip).unwrap();
    assert!(world.grip(grip).is_err());
    for _ in 0..30 {
        world.step();
    }
    assert!(world[beam].centre_of_mass()[1] < -0.5);
}

#[test]
fn cantilever_is_held_by_its_weight_and_moment() {
    check_cantilever::<Dim2>();
    check_cantilever::<Dim3>();
}

/// A bar is stretched by a carrier: the force is E A ε, and it is the same at both ends and in between.
fn check_stretch<D: Dim>() {
    let (young, strain) = (2e4, 0.02);
    let mut world = weightless::<D>();
    let body = world.add_soft_body(bar::<D>(young)).unwrap();
    let clamp = RigidBody::kinematic(Shape::ball(0.01)).with_sensor(true);
    let clamp = world.add_rigid_body(clamp.at(D::Vector::X * 0.8)).unwrap();
    let held = world.add_grip(Grip::still(body, left_end())).unwrap();
    let pulled = world
        .add_grip(Grip::carried(body, right_end(), clamp))
        .unwrap();
    for tick in 1..=120 {
        let stretch = 0.8 * strain * tick as f32 / 120.0;
        world
            .set_target_position(clamp, D::Vector::X * (0.8 + stretch))
            .unwrap();
        world.step();
    }
    step_until_asleep(&mut world, body);
    let force = young as f32 * section::<D>() * strain;
    let of = |grip| world.grip(grip).unwrap().reaction().force[0];
    assert_near(of(pulled), force, 0.01, "pulled end");
    assert_near(of(held), -force, 0.01, "held end");
    assert_near(
        world.reaction(clamp).unwrap().force[0],
        -force,
        0.01,
        "carrier",
    );
    let middle = Shape::half_space(D::Vector::X, D::Vector::X * 0.42);
    let sums = world[body].sums_inside(&middle).unwrap();
    assert_near(sums.elastic_force[0], force, 0.02, "force in the middle");
    let all = Shape::half_space(D::Vector::X, D::Vector::X * 2.0);
    let energy = world[body].sums_inside(&all).unwrap().elastic_energy as f32;
    assert_near(energy, 0.5 * force * strain * 0.8, 0.02, "energy");
    // A sleeping bar wakes when the carrier moves on.
    world
        .set_target_position(clamp, D::Vector::X * 0.85)
        .unwrap();
    world.step();
    world.step();
    assert!(!sleeps(&world, body));
}

#[test]
fn stretched_bar_pulls_back_with_young_times_area_times_strain() {
    check_stretch::<Dim2>();
    check_stretch::<Dim3>();
}

/// A bar held at one end and pulled by a force at the other one gets longer by F L / (E A).
fn check_pull<D: Dim>() {
    let (young, force) = (2e4, 4.0 * section::<D>() / 0.2 * 20.0);
    let mut world = weightless::<D>();
    let body = world.add_soft_body(bar::<D>(young)).unwrap();
    let held = world.add_grip(Grip::still(body, left_end())).unwrap();
    let pull = Grip::force(body, right_end(), D::Vector::X * force);
    let pulled = world.add_grip(pull).unwrap();
    let end: Vec<NodeId> = world[body].nodes_in(&right_end()).collect();
    // Awake, because a body may fall asleep while it vibrates by some per cent.
    for _ in 0..600 {
        world.wake_up(body).unwrap();
        world.step();
    }
    let moved: f32 = end
        .iter()
        .map(|&node| world[body].node_state(node).0[0] - 0.8)
        .sum();
    let moved = moved / end.len() as f32;
    let expected = force * 0.8 / (young as f32 * section::<D>());
    assert_near(moved, expected, 0.01, "elongation");
    assert_near(
        world.grip(held).unwrap().reaction().force[0],
        -force,
        0.01,
        "held end",
    );
    assert_near(
        world.grip(pulled).unwrap().reaction().force[0],
        force,
        0.001,
        "force",
    );
    step_until_asleep(&mut world, body);
    assert_near(
        world.grip(held).unwrap().reaction().force[0],
        -force,
        0.01,
        "held sleeper",
    );
    world.set_grip_force(pulled, D::Vector::ZERO).unwrap();
    assert!(!sleeps(&world, body));
    assert!(world.set_grip_force(held, D::Vector::ZERO).is_err());
    let huge = D::Vector::X * 2e9;
    assert!(world.set_grip_force(pulled, huge).is_err());
}

#[test]
fn pulled_bar_gets_longer_by_force_over_stiffness() {
    check_pull::<Dim2>();
    check_pull::<Dim3>();
}

#[test]
fn grip_ends_with_its_carrier() {
    let mut world = weightless::<Dim3>();
    let body = world.add_soft_body(bar::<Dim3>(2e4)).unwrap();
    let clamp = RigidBody::kinematic(Shape::ball(0.01)).with_sensor(true);
    let clamp = world.add_rigid_body(clamp).unwrap();
    let grip = world
        .add_grip(Grip::carried(body, right_end(), clamp))
        .unwrap();
    let node = world[body].nodes_in(&right_end()).next().unwrap();
    assert!(world[body].is_fixed(node));
    world.remove(clamp).unwrap();
    world.step();
    assert!(world.events().contains(&Event::GripEnded { grip }));
    assert!(world.grip(grip).is_err() && !world[body].is_fixed(node));
    let free = RigidBody::dynamic(Shape::ball(0.1), 1.0);
    let free = world.add_rigid_body(free).unwrap();
    assert!(
        world
            .add_grip(Grip::carried(body, right_end(), free))
            .is_err()
    );
    let nowhere = Shape::ball(0.1).translated(9.0 * Vec3::X);
    let error = world.add_grip(Grip::still(body, nowhere)).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("region must be a region with nodes"),
        "{error}"
    );
}

/// A carrier that turns by a quarter turn takes a whole body along without strain.
fn check_turn<D: Dim>() {
    let mut world = weightless::<D>();
    let body = world.add_soft_body(bar::<D>(2e4)).unwrap();
    let clamp = RigidBody::kinematic(Shape::ball(0.01)).with_sensor(true);
    let clamp = world.add_rigid_body(clamp).unwrap();
    world
        .add_grip(Grip::carried(body, left_end(), clamp))
        .unwrap();
    for tick in 1..=240 {
        let angle = std::f32::consts::FRAC_PI_2 * (tick.min(180) as f32 / 180.0);
        world
            .set_target_rotation(clamp, fuwafuwa::Rotation::in_plane(angle))
            .unwrap();
        world.step();
    }
    let [x, y] = [0, 1].map(|axis: usize| world[body].centre_of_mass()[axis]);
    assert!((x + 0.1).abs() < 0.02 && (y - 0.4).abs() < 0.02, "{x} {y}");
}

#[test]
fn turning_carrier_turns_the_body() {
    check_turn::<Dim2>();
    check_turn::<Dim3>();
}

/// Returns the positions of all nodes of a cube at rest on a floor without friction, relative to its centre of mass.
/// A ball could come to rest with another side below, and with friction the shape at rest would not be unique.
fn at_rest<D: Dim>(n: usize, far: D::Vector) -> Vec<[f64; 3]> {
    let mut world = World::<D>::new(WorldConfig {
        drag: 5.0,
        sleep: false,
        ..WorldConfig::default()
    })
    .unwrap();
    let floor = Shape::half_space(D::Vector::Y, far);
    let floor = RigidBody::fixed(floor).with_friction(0.0);
    world.add_rigid_body(floor).unwrap();
    let cube = SoftBody::new(VoxelGrid::cube(n, 0.1).unwrap(), &[rubber(5000.0)]).unwrap();
    let body = world.add_soft_body(cube.translated(far)).unwrap();
    for _ in 0..300 {
        world.step();
    }
    let body = &world[body];
    let states = body.mesh().nodes().map(|(id, _)| body.node_state(id));
    let moment =
        |(at, _, mass): (D::Vector, D::Vector, f32)| at.to_vec3().as_dvec3() * f64::from(mass);
    let centre = states
        .map(moment)
        .fold(Vec3::ZERO.as_dvec3(), |sum, part| sum + part)
        / body.total_mass();
    let nodes = body.mesh().nodes();
    nodes
        .map(|(id, _)| (body.node_state(id).0.to_vec3().as_dvec3() - centre).to_array())
        .collect()
}

fn check_far<D: Dim>(n: usize) {
    let size = 0.1 / n as f32;
    let range = ball::<D>(n, 0.1, D::Vector::ZERO).range();
    assert_eq!(range, 8192.0 * size);
    let near = at_rest::<D>(n, D::Vector::ZERO);
    let far = at_rest::<D>(n, vector::<D>(range - 0.2, 0.0, 0.0));
    let apart = near
        .iter()
        .zip(&far)
        .flat_map(|(a, b)| (0..3).map(|axis| (a[axis] - b[axis]).abs()));
    let most = apart.fold(0.0, f64::max) / f64::from(size);
    assert!(most < 0.015, "off by {most} voxels");
    // Beyond the range the body is refused.
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let beyond = ball(n, 0.1, D::Vector::X * range);
    let error = world.add_soft_body(beyond).unwrap_err().to_string();
    assert!(error.starts_with("position must be within"), "{error}");
    assert!(
        world
            .add_soft_body(ball(n, 0.1, D::Vector::X * f32::NAN))
            .is_err()
    );
    let body = world.add_soft_body(ball(n, 0.1, D::Vector::ZERO)).unwrap();
    assert!(world.translate(body, D::Vector::Y * range).is_err());
    assert!(world.translate(body, D::Vector::Y * (0.5 * range)).is_ok());
    // A body that leaves the range by itself is reported once.
    world.translate(body, D::Vector::X * (range - 0.2)).unwrap();
    world
        .set_velocity(body, fuwafuwa::Velocity::linear(D::Vector::X * 3.0))
        .unwrap();
    let left = |event: &&Event<D>| matches!(event, Event::LeftRange { .. });
    let mut reports = 0;
    for _ in 0..30 {
        world.step();
        reports += world.events().iter().filter(left).count();
    }
    assert_eq!(reports, 1);
}

#[test]
fn bodies_keep_their_shape_within_the_range() {
    check_far::<Dim2>(16);
    check_far::<Dim3>(10);
}

/// Places two objects inside each other, and checks that they are reported once, come apart without being
/// thrown, and do not sleep before.
fn check_apart<D: Dim>(
    world: &mut World<D>,
    bodies: &[SoftBodyHandle],
    is_apart: impl Fn(&World<D>) -> bool,
) {
    let mut reports = 0;
    let mut top = 0.0f64;
    for tick in 0..600 {
        world.step();
        let overlapped = |event: &&Event<D>| matches!(event, Event::Overlapped { .. });
        reports += world.events().iter().filter(overlapped).count();
        for &body in bodies {
            let speed = 2.0 * world[body].kinetic_energy() / world[body].total_mass();
            top = top.max(speed.sqrt());
            assert!(
                !sleeps(world, body) || is_apart(world),
                "asleep in tick {tick}"
            );
        }
    }
    assert_eq!(reports, 1);
    assert!(is_apart(world));
    assert!(top < 0.5, "{top} m/s");
}

fn check_balls<D: Dim>(offset: f32) {
    let mut world = weightless::<D>();
    let bodies = [0.0, offset].map(|x| {
        world
            .add_soft_body(ball(12, 0.5, D::Vector::X * x))
            .unwrap()
    });
    // Width of the ball without the empty margin of its grid.
    let width = world[bodies[0]].piece_views()[0];
    let width = width.high.x - width.low.x;
    check_apart(&mut world, &bodies, |world| {
        let [a, b] = bodies.map(|body| world[body].centre_of_mass());
        (a - b).length() > 0.9 * width
    });
}

#[test]
fn soft_bodies_inside_each_other_are_pushed_apart() {
    for offset in [0.22, 0.05, 0.0] {
        check_balls::<Dim2>(offset);
        check_balls::<Dim3>(offset);
    }
}

fn check_in_rigid<D: Dim>(shape: Shape<D>, at: D::Vector) {
    let mut world = weightless::<D>();
    let rigid = world
        .add_rigid_body(RigidBody::fixed(shape).at(at))
        .unwrap();
    let soft = world.add_soft_body(ball(12, 0.5, D::Vector::ZERO)).unwrap();
    check_apart(&mut world, &[soft], |world| {
        let shape = world.rigid_body(rigid).unwrap().shape();
        let body = &world[soft];
        let depth = body
            .mesh()
            .nodes()
            .map(|(id, _)| -shape.distance(body.node_state(id).0).0);
        depth.fold(0.0, f32::max) < 0.75 * body.grid().voxel_size()
    });
    let object = ObjectSelector::Object(ObjectRef::RigidBody(rigid));
    assert!(world.reaction(object).unwrap().force.is_finite());
}

#[test]
fn soft_body_leaves_rigid_bodies_in_which_it_was_placed() {
    fn check<D: Dim>() {
        let middle = vector::<D>(0.25, 0.25, 0.25);
        check_in_rigid::<D>(Shape::half_space(D::Vector::Y, D::Vector::ZERO), middle);
        check_in_rigid::<D>(Shape::cuboid(D::Vector::splat(0.06)), middle);
        check_in_rigid::<D>(Shape::cuboid(vector::<D>(0.05, 0.6, 0.6)), middle);
    }
    check::<Dim2>();
    check::<Dim3>();
}

/// A bar that is so stiff that its mass is scaled stretches by F L / E A, and is held by the force that pulls it.
fn stiff_bar_is_pulled<D: Dim>() {
    let mut world = weightless::<D>();
    let (young, strain) = (4e7, 0.01);
    let bar = world.add_soft_body(bar::<D>(young)).unwrap();
    assert!(world[bar].mass_scale() > 10.0);
    let left = Shape::half_space(D::Vector::X, D::Vector::X * 0.01);
    let right = Shape::half_space(-D::Vector::X, D::Vector::X * 0.79);
    let held = world.add_grip(Grip::still(bar, left)).unwrap();
    let area = if D::N == 3 { 0.04 } else { 0.2 };
    let force = D::Vector::X * (young as f32 * area * strain);
    world.add_grip(Grip::force(bar, right, force)).unwrap();
    for _ in 0..300 {
        world.step();
    }
    let ends = world[bar]
        .nodes_in(&right)
        .map(|node| world[bar].node_state(node).0[0]);
    let end = ends.fold(0.0, f32::max);
    let stretched = (end - 0.8) / (0.8 * strain);
    assert!((stretched - 1.0).abs() < 0.02, "{stretched}");
    let reaction = world.grip(held).unwrap().reaction().force[0] / -force[0];
    assert!((reaction - 1.0).abs() < 0.02, "{reaction}");
}

#[test]
fn grip_force_stretches_bar_of_scaled_mass() {
    stiff_bar_is_pulled::<Dim2>();
    stiff_bar_is_pulled::<Dim3>();
}

/// Two grips of which the lattice boxes overlap keep their own nodes, and a node that was fixed before stays fixed.
#[test]
fn grips_leave_foreign_nodes_alone() {
    let mut world = weightless::<Dim2>();
    let body = world.add_soft_body(bar::<Dim2>(4e5)).unwrap();
    let fixed = world[body].nodes_in(&Shape::ball(0.01)).next().unwrap();
    world.soft_body_mut(body).unwrap().fix_node(fixed);
    let near = |x: f32| Shape::ball(0.12).translated(vector::<Dim2>(x, 0.1, 0.0));
    let grips = [0.3, 0.45].map(|x| world.add_grip(Grip::still(body, near(x))).unwrap());
    let counts = |world: &World<Dim2>| grips.map(|grip| world.grip(grip).unwrap().node_count());
    let before = counts(&world);
    (0..5).for_each(|_| _ = world.step());
    assert_eq!(counts(&world), before);
    let shared = world[body].nodes_in(&near(0.3));
    let shared: Vec<NodeId> = shared.filter(|&id| world[body].is_fixed(id)).collect();
    world.remove(grips[1]).unwrap();
    assert!(shared.iter().all(|&id| world[body].is_fixed(id)));
    world.remove(grips[0]).unwrap();
    assert!(shared.iter().all(|&id| !world[body].is_fixed(id)));
    assert!(world[body].is_fixed(fixed));
}

/// A body that carries a grip stays fixed or kinematic.
#[test]
fn carrier_of_grip_cannot_become_dynamic() {
    let mut world = weightless::<Dim2>();
    let body = world.add_soft_body(bar::<Dim2>(4e5)).unwrap();
    let clamp = RigidBody::kinematic(Shape::ball(0.01)).with_sensor(true);
    let clamp = world.add_rigid_body(clamp).unwrap();
    let left = Shape::half_space(Vec2::X, Vec2::X * 0.01);
    world.add_grip(Grip::carried(body, left, clamp)).unwrap();
    let refused = world.set_motion_type(clamp, MotionType::Dynamic { mass: 1.0 });
    assert!(refused.unwrap_err().to_string().contains("carries a grip"));
    world.set_motion_type(clamp, MotionType::Fixed).unwrap();
}

/// A clamped bar with so much damping that it creeps falls asleep only where it would come to rest.
#[test]
fn creeping_cantilever_sleeps_at_its_full_deflection() {
    let deflection = |sleep: bool| {
        let mut world = World::<Dim2>::new(WorldConfig {
            sleep,
            ..WorldConfig::default()
        })
        .unwrap();
        let mut material = rubber(2e4);
        material.damping.mass = 60.0;
        let grid = VoxelGrid::from_fn([16, 2, 1], 0.05, |_| 1).unwrap();
        let bar = SoftBody::new(grid, &[material]).unwrap();
        let bar = world.add_soft_body(bar).unwrap();
        let left = Shape::half_space(Vec2::X, Vec2::X * 0.01);
        world.add_grip(Grip::still(bar, left)).unwrap();
        (0..3000).for_each(|_| _ = world.step());
        world[bar].centre_of_mass().y - 0.05
    };
    let (slept, whole) = (deflection(true), deflection(false));
    assert!(
        whole < -0.02 && (slept / whole - 1.0).abs() < 0.05,
        "{slept} {whole}"
    );
}

//! Sleep: slow bodies that nothing stops go on, and sleepers wake under slow pressure.

use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimVector, Event, Material, RigidBody, Shape, SoftBody, Vec3,
    Velocity, VoxelGrid, World, WorldConfig,
};

fn vector<V: DimVector>(x: f32, y: f32, z: f32) -> V {
    V::from_vec3(Vec3::new(x, y, z))
}

fn config<D: Dim>(gravity: f32) -> WorldConfig<D> {
    WorldConfig {
        gravity: vector(0.0, -gravity, 0.0),
        ..WorldConfig::default()
    }
}

fn damped() -> Material {
    Material {
        damping: Damping::at(0.5, 8.0),
        strength: f32::INFINITY,
        ..Material::default()
    }
}

fn cube<D: Dim>() -> SoftBody<D> {
    SoftBody::new(VoxelGrid::cube(8, 0.5).unwrap(), &[damped()]).unwrap()
}

fn add_floor<D: Dim>(world: &mut World<D>, friction: f32) {
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    let floor = RigidBody::fixed(floor).with_friction(friction);
    world.add_rigid_body(floor).unwrap();
}

/// Checks that a soft and a rigid body keep a speed of 2 cm/s in empty space, and on a floor without friction.
fn slow_bodies_go_on<D: Dim>(gravity: f32) {
    let mut world = World::<D>::new(config(gravity)).unwrap();
    add_floor(&mut world, 0.0);
    let along = Velocity::linear(vector(0.02, 0.0, 0.0));
    let soft = world.add_soft_body(cube().with_velocity(along)).unwrap();
    let block = Shape::cuboid(D::Vector::splat(0.25));
    let block = RigidBody::dynamic(block, 1.0).at(vector(5.0, 0.25, 0.25));
    let rigid = world.add_rigid_body(block.with_velocity(along)).unwrap();
    let places = |world: &World<D>| {
        let soft = world[soft].centre_of_mass()[0];
        [soft, world.rigid_body(rigid).unwrap().position()[0]]
    };
    let before = places(&world);
    (0..600).for_each(|_| _ = world.step());
    for (now, before) in places(&world).into_iter().zip(before) {
        let ratio = (now - before) / 0.2;
        assert!((ratio - 1.0).abs() < 0.02, "gravity {gravity}: {ratio}");
    }
}

#[test]
fn slow_body_keeps_its_speed_without_friction() {
    for gravity in [0.0, 0.05, 9.81] {
        slow_bodies_go_on::<Dim2>(gravity);
        slow_bodies_go_on::<Dim3>(gravity);
    }
}

/// Returns whether a cube and a rigid box on a floor are asleep after some seconds.
fn sleepers<D: Dim>(sleep: bool) -> [bool; 2] {
    let mut world = World::<D>::new(WorldConfig {
        sleep,
        ..config(9.81)
    })
    .unwrap();
    add_floor(&mut world, 0.5);
    let soft = world.add_soft_body(cube()).unwrap();
    let block = Shape::cuboid(D::Vector::splat(0.25));
    let block = RigidBody::dynamic(block, 1.0).at(vector(5.0, 0.25, 0.25));
    let rigid = world.add_rigid_body(block).unwrap();
    (0..300).for_each(|_| _ = world.step());
    let is_asleep = world[soft].piece_views()[0].asleep;
    [is_asleep, world.rigid_body(rigid).unwrap().is_asleep()]
}

#[test]
fn setting_turns_sleep_off() {
    assert_eq!(sleepers::<Dim2>(true), [true; 2]);
    assert_eq!(sleepers::<Dim3>(true), [true; 2]);
    assert_eq!(sleepers::<Dim2>(false), [false; 2]);
    assert_eq!(sleepers::<Dim3>(false), [false; 2]);
}

/// Presses a cube down on a sleeping one at 5 cm/s, a third of the speed at which a hit wakes. Checks that the
/// lower cube wakes before the upper one is compressed by a tenth of its height.
fn slow_press_wakes<D: Dim>() {
    let mut world = World::<D>::new(config(9.81)).unwrap();
    add_floor(&mut world, 0.5);
    let low = world.add_soft_body(cube()).unwrap();
    world
        .add_soft_body(cube().translated(vector(0.0, 0.5, 0.0)))
        .unwrap();
    (0..600).for_each(|_| _ = world.step());
    let is_asleep = |world: &World<D>| world[low].piece_views()[0].asleep;
    assert!(is_asleep(&world));
    let plate = Shape::cuboid(vector(0.5, 0.1, 0.5));
    let top = world
        .soft_bodies()
        .map(|(_, body)| body.piece_views()[0].high[1]);
    let top = top.fold(0.0, f32::max) + 0.1;
    let plate = RigidBody::kinematic(plate).at(vector(0.25, top, 0.25));
    let plate = world.add_rigid_body(plate).unwrap();
    let mut woke = None;
    for tick in 1..=60 {
        let down = 0.05 * tick as f32 / 60.0;
        let target = vector(0.25, top - down, 0.25);
        world.set_target_position(plate, target).unwrap();
        world.step();
        let is_it = |event: &Event<D>| matches!(event, Event::WokeUp { body, .. } if *body == low);
        if woke.is_none() && world.events().iter().any(is_it) {
            woke = Some(down);
        }
    }
    assert!(woke.is_some_and(|down| down < 0.05), "{woke:?}");
}

#[test]
fn slow_press_wakes_sleeper() {
    slow_press_wakes::<Dim2>();
    slow_press_wakes::<Dim3>();
}

/// Checks that a rigid box slides down a steep slope as Coulomb's law says, far from the origin, too, where
/// rounding makes contacts overlap.
#[test]
fn rigid_box_slides_as_coulomb_says() {
    let mut world = World::<Dim3>::new(config(9.81)).unwrap();
    let (sine, cosine) = (0.6f32, 0.8f32);
    let plane = Shape::half_space(Vec3::new(sine, cosine, 0.0), Vec3::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(plane).with_friction(0.6))
        .unwrap();
    let turn = fuwafuwa::Rotation::from_quaternion([0.0, 0.0, -0.316_227_77, 0.948_683_3]);
    let block = RigidBody::dynamic(Shape::cuboid(Vec3::new(0.5, 0.25, 0.5)), 50.0);
    let block = block.at(Vec3::new(sine, cosine, 0.0) * 0.25).rotated(turn);
    let block = world.add_rigid_body(block).unwrap();
    (0..600).for_each(|_| _ = world.step());
    let Velocity { linear, .. } = world.rigid_body(block).unwrap().velocity();
    let ratio = linear.length() / (10.0 * 9.81 * (sine - 0.6 * cosine));
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}

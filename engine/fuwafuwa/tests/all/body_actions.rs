//! Methods that act alike on soft and rigid bodies, in 2D and 3D.

use crate::vectors::vector;
use fuwafuwa::{
    BodyHandle, Dim, Dim2, Dim3, DimAngular, DimVector, Impulse, Layers, Material, MotionType,
    RigidBody, Rotation, Shape, SoftBody, Vec3, Velocity, VoxelGrid, World, WorldConfig,
};
use std::f32::consts::FRAC_PI_2;

/// Returns an angular velocity about the third axis [rad/s].
fn spin<D: Dim>(speed: f32) -> D::Angular {
    D::Angular::from_vec3(Vec3::Z * speed)
}

/// Returns a world with a soft and a rigid cube of 1 m, both centred on the origin, in layers that do not
/// collide.
fn cubes<D: Dim>() -> (World<D>, [BodyHandle; 2]) {
    let config = WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    };
    let mut world = World::<D>::new(config).unwrap();
    let apart = Layers {
        memberships: 2,
        filters: 2,
    };
    let grid = VoxelGrid::<D>::cube(4, 1.0).unwrap();
    let soft = SoftBody::new(grid, &[Material::default()]).unwrap();
    let middle = -soft.centre_of_mass();
    let soft = world
        .add_soft_body(soft.translated(middle).with_layers(apart))
        .unwrap();
    let cube = Shape::cuboid(D::Vector::splat(0.5));
    let rigid = RigidBody::dynamic(cube, 100.0).with_friction(0.3);
    let rigid = world.add_rigid_body(rigid).unwrap();
    (world, [soft.into(), rigid.into()])
}

fn centre<D: Dim>(world: &World<D>, body: BodyHandle) -> D::Vector {
    match body {
        BodyHandle::Soft(body) => world[body].centre_of_mass(),
        BodyHandle::Rigid(rigid) => world.rigid_body(rigid).unwrap().position(),
    }
}

#[track_caller]
fn assert_near<V: DimVector>(found: V, expected: V, tolerance: f32) {
    let apart = (found - expected).to_vec3();
    let is_near = (0..3).all(|axis| apart[axis].abs() <= tolerance);
    assert!(is_near, "{found:?}, expected {expected:?}");
}

fn check_velocity<D: Dim>() {
    let (mut world, bodies) = cubes::<D>();
    let linear = vector(1.0, -2.0, 0.0);
    let angular = spin::<D>(0.5);
    for body in bodies {
        world
            .add_velocity(body, Velocity::linear(vector(9.0, 9.0, 0.0)))
            .unwrap();
        world
            .set_velocity(body, Velocity { linear, angular })
            .unwrap();
        let found = world.velocity(body).unwrap();
        assert_near(found.linear, linear, 1e-4);
        assert_near(found.angular.to_vec3(), Vec3::Z * 0.5, 1e-4);
        world
            .add_velocity(body, Velocity::angular(angular))
            .unwrap();
        let found = world.velocity(body).unwrap();
        assert_near(found.linear, linear, 1e-4);
        assert_near(found.angular.to_vec3(), Vec3::Z, 1e-4);
    }
    for _ in 0..30 {
        world.step();
    }
    for body in bodies {
        assert_near(centre(&world, body), vector(0.5, -1.0, 0.0), 1e-3);
    }
}

#[test]
fn set_velocity_moves_soft_and_rigid_bodies_alike() {
    check_velocity::<Dim2>();
    check_velocity::<Dim3>();
}

fn check_impulse<D: Dim>() {
    let (mut world, bodies) = cubes::<D>();
    for body in bodies {
        // Both cubes have a mass m = 100 kg, so 50 N s give 0.5 m/s. Their moment of inertia about the centre
        // is m · (1 m)² / 6 = 16.7 kg m².
        let impulse = Impulse::at(D::Vector::ZERO, vector(50.0, 0.0, 0.0)).within(2.0);
        world.apply_impulse(body, impulse).unwrap();
        assert_near(
            world.velocity(body).unwrap().linear,
            vector(0.5, 0.0, 0.0),
            1e-4,
        );
    }
    let [soft, rigid] = bodies;
    world.set_velocity(rigid, Velocity::default()).unwrap();
    let impulse = Impulse::at(vector(0.5, 0.0, 0.0), vector(0.0, 10.0, 0.0));
    world.apply_impulse(rigid, impulse).unwrap();
    let found = world.velocity(rigid).unwrap();
    assert_near(found.linear, vector(0.0, 0.1, 0.0), 1e-5);
    assert_near(found.angular.to_vec3(), Vec3::Z * 0.3, 1e-5);
    let before = world.velocity(soft).unwrap();
    world.apply_impulse(soft, impulse).unwrap();
    let gained = world.velocity(soft).unwrap();
    assert_near(gained.linear, vector(0.5, 0.1, 0.0), 1e-4);
    let [before, after] = [before, gained].map(|velocity| velocity.angular.to_vec3().z);
    assert!(after > before + 0.1, "{gained:?}");
}

#[test]
fn apply_impulse_changes_momentum_by_impulse() {
    check_impulse::<Dim2>();
    check_impulse::<Dim3>();
}

fn check_pose<D: Dim>() {
    let (mut world, bodies) = cubes::<D>();
    let quarter = Rotation::in_plane(FRAC_PI_2);
    for body in bodies {
        world
            .set_velocity(body, Velocity::linear(D::Vector::X))
            .unwrap();
        world.translate(body, vector(2.0, 1.0, 0.0)).unwrap();
        assert_near(centre(&world, body), vector(2.0, 1.0, 0.0), 1e-5);
        assert_near(world.velocity(body).unwrap().linear, D::Vector::X, 1e-4);
        world
            .rotate_about(body, quarter, vector(1.0, 1.0, 0.0))
            .unwrap();
        assert_near(centre(&world, body), vector(1.0, 2.0, 0.0), 1e-5);
        assert_near(world.velocity(body).unwrap().linear, D::Vector::Y, 1e-4);
        assert!(world.translate(body, D::Vector::splat(f32::NAN)).is_err());
        assert!(
            world
                .rotate_about(body, quarter, D::Vector::splat(2e6))
                .is_err()
        );
    }
    let lift = RigidBody::kinematic(Shape::ball(0.1));
    let lift = world.add_rigid_body(lift).unwrap();
    world.translate(lift, vector(5.0, 0.0, 0.0)).unwrap();
    world.step();
    assert_near(centre(&world, lift.into()), vector(5.0, 0.0, 0.0), 1e-5);
}

#[test]
fn translate_and_rotate_keep_velocity_in_body_axes() {
    check_pose::<Dim2>();
    check_pose::<Dim3>();
}

fn check_sleep<D: Dim>() {
    let (mut world, bodies) = cubes::<D>();
    let sleeps = |world: &World<D>, body| match body {
        BodyHandle::Soft(body) => world[body].piece_views()[0].asleep,
        BodyHandle::Rigid(rigid) => world.rigid_body(rigid).unwrap().is_asleep(),
    };
    for body in bodies {
        world
            .set_velocity(body, Velocity::linear(D::Vector::X))
            .unwrap();
        world.put_to_sleep(body).unwrap();
        assert!(sleeps(&world, body));
        assert_eq!(world.velocity(body).unwrap().linear, D::Vector::ZERO);
        world.step();
        assert!(sleeps(&world, body));
        world.wake_up(body).unwrap();
        assert!(!sleeps(&world, body));
        world.set_user_data(body, 7).unwrap();
    }
    let [BodyHandle::Soft(soft), BodyHandle::Rigid(rigid)] = bodies else {
        unreachable!("the handles are those of a soft and a rigid body");
    };
    assert_eq!(world[soft].user_data(), 7);
    assert_eq!(world.rigid_body(rigid).unwrap().user_data(), 7);
    world.set_motion_type(rigid, MotionType::Fixed).unwrap();
    assert!(world.put_to_sleep(rigid).is_err());
    assert_eq!(world.remove(rigid).unwrap().friction, 0.3);
    assert!((world.remove(soft).unwrap().total_mass() - 100.0).abs() < 1e-3);
    assert!(world.soft_bodies().next().is_none() && world.rigid_bodies().next().is_none());
}

#[test]
fn put_to_sleep_stops_soft_and_dynamic_bodies() {
    check_sleep::<Dim2>();
    check_sleep::<Dim3>();
}

fn check_builders<D: Dim>() {
    let (mut world, [soft, rigid]) = cubes::<D>();
    let BodyHandle::Soft(soft) = soft else {
        unreachable!("the first handle is that of a soft body")
    };
    let BodyHandle::Rigid(rigid) = rigid else {
        unreachable!("the second handle is that of a rigid body")
    };
    let (linear, angular) = (vector(1.0, 2.0, 0.0), spin::<D>(0.5));
    let velocity = Velocity { linear, angular };
    let quarter = Rotation::in_plane(FRAC_PI_2);
    let body = world.remove(soft).unwrap();
    let body = body.translated(D::Vector::X).rotated(quarter);
    let body = body
        .rotated_about(quarter, D::Vector::ZERO)
        .with_velocity(velocity);
    let soft = world.add_soft_body(body.with_user_data(3)).unwrap().into();
    let body = world.remove(rigid).unwrap();
    let body = body.translated(D::Vector::X).rotated(quarter);
    let body = body
        .rotated_about(quarter, D::Vector::ZERO)
        .with_velocity(velocity);
    let body = body
        .with_restitution(0.5)
        .with_sensor(true)
        .with_user_data(3);
    let rigid = world.add_rigid_body(body).unwrap().into();
    for body in [soft, rigid] {
        assert_near(centre(&world, body), D::Vector::Y, 1e-5);
        let found = world.velocity(body).unwrap();
        assert_near(found.linear, linear, 1e-4);
        assert_near(found.angular.to_vec3(), Vec3::Z * 0.5, 1e-4);
    }
}

#[test]
fn builders_set_pose_and_velocity_of_both_kinds() {
    check_builders::<Dim2>();
    check_builders::<Dim3>();
}

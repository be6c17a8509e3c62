//! Rigid bodies that fall, rotate, stack, bounce, and lie on soft bodies.

use crate::vectors::vector;
use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    Dim, Dim2, Dim3, DimAngular, DimVector, Impulse, Material, MotionType, RigidBody,
    RigidBodyHandle, RigidBodyRef, Rotation, Shape, SoftBody, Vec2, Vec3, Velocity, VoxelGrid,
    World, WorldConfig,
};
use std::f32::consts::{FRAC_PI_4, PI};

fn world<D: Dim>(gravity: f32) -> World<D> {
    let settings = WorldConfig {
        gravity: vector(0.0, gravity, 0.0),
        ..WorldConfig::default()
    };
    World::new(settings).unwrap()
}

fn floored<D: Dim>() -> World<D> {
    let mut world = world::<D>(-9.81);
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.5))
        .unwrap();
    world
}

fn cube<D: Dim>(centre: D::Vector, half: f32) -> Shape<D> {
    Shape::cuboid(D::Vector::splat(half)).translated(centre)
}

fn bar<D: Dim>(centre: D::Vector) -> Shape<D> {
    let ends = [-0.4, 0.4].map(|x| vector(x, 0.0, 0.0));
    Shape::capsule(ends[0], ends[1], 0.2).translated(centre)
}

fn ball<D: Dim>(centre: D::Vector) -> Shape<D> {
    Shape::ball(0.3).translated(centre)
}

/// Returns the upward unit normal of a slope that descends to the right at an angle [rad].
fn upright<V: DimVector>(angle: f32) -> V {
    Rotation::in_plane(-angle).apply(V::Y)
}

fn speed<D: Dim>(rigid: RigidBodyRef<'_, D>) -> f32 {
    rigid.velocity().linear.length()
}

/// Checks that each shape, dropped in a tilted pose, comes to rest on the floor with its centre at the lowest
/// possible height.
fn all_come_to_rest<D: Dim>() {
    let turned = match D::N {
        2 => Rotation::in_plane(0.5),
        _ => Rotation::about(Vec3::new(1.0, 0.3, 0.7), 0.6),
    };
    for (shape, height) in [
        (cube(D::Vector::Y, 0.3), 0.3),
        (bar(D::Vector::Y), 0.2),
        (ball(D::Vector::Y), 0.3),
    ] {
        let mut world = floored::<D>();
        let id = world
            .add_rigid_body(RigidBody::dynamic(shape, 5.0).rotated(turned))
            .unwrap();
        for _ in 0..300 {
            world.step();
        }
        let rigid = world.rigid_body(id).unwrap();
        assert!(
            (rigid.position()[1] - height).abs() < 0.01,
            "{shape:?} {:?}",
            rigid.position()
        );
        assert!(
            rigid.is_asleep() || matches!(shape, Shape::Ball { .. } | Shape::Capsule { .. }),
            "{rigid:?}"
        );
    }
}

#[test]
fn dynamic_body_comes_to_rest_with_each_shape() {
    all_come_to_rest::<Dim2>();
    all_come_to_rest::<Dim3>();
}

fn a_tower_stands<D: Dim>() {
    let mut world = floored::<D>();
    let ids: Vec<RigidBodyHandle> = (0..10)
        .map(|n| {
            let (x, y) = (0.01 * (n % 3) as f32, 0.25 + 0.5 * n as f32);
            let shape = cube(vector(x, y, 0.0), 0.25);
            world
                .add_rigid_body(RigidBody::dynamic(shape, 2.0))
                .unwrap()
        })
        .collect();
    for _ in 0..600 {
        world.step();
    }
    for (n, &id) in ids.iter().enumerate() {
        let rigid = world.rigid_body(id).unwrap();
        let [x, y, z] = rigid.position().to_vec3().to_array();
        assert!(x.abs() < 0.03 && z.abs() < 0.03, "{n}: {x} {z}");
        assert!((y - 0.25 - 0.5 * n as f32).abs() < 0.02, "{n}: {y}");
        assert!(rigid.is_asleep(), "{n} {:?}", rigid.velocity());
    }
}

#[test]
fn tower_of_ten_stands_and_sleeps() {
    a_tower_stands::<Dim2>();
    a_tower_stands::<Dim3>();
}

/// Checks that of two sleeping towers, only the one whose foot is removed falls. Each tower is a fixed foot,
/// a box, a soft body and another box.
fn one_of_two_towers_falls<D: Dim>() {
    let mut world = floored::<D>();
    let mut material = Material::default();
    (material.elasticity.young, material.strength) = (2e5, f32::INFINITY);
    let mut tower = |x: f32| {
        let mut add = |rigid: RigidBody<D>| world.add_rigid_body(rigid).unwrap();
        let foot = add(RigidBody::fixed(cube(vector(x, 0.25, 0.0), 0.25)).with_friction(0.5));
        let boxes =
            [0.75, 1.65].map(|y| add(RigidBody::dynamic(cube(vector(x, y, 0.0), 0.25), 0.5)));
        let grid = VoxelGrid::<D>::cube(4, 0.4).unwrap();
        let soft = SoftBody::new(grid, std::slice::from_ref(&material)).unwrap();
        let z = if D::N == 2 { 0.0 } else { -0.2 };
        (
            foot,
            boxes,
            world
                .add_soft_body(soft.translated(vector(x - 0.2, 1.0, z)))
                .unwrap(),
        )
    };
    let (falling, standing) = (tower(0.0), tower(3.0));
    let sleep = |world: &World<D>,
                 &(_, boxes, soft): &(RigidBodyHandle, [RigidBodyHandle; 2], _)| {
        let pieces = &world[soft].pieces().list;
        let boxes = boxes.map(|id| world.rigid_body(id).unwrap().is_asleep());
        [boxes[0], pieces.iter().all(|piece| piece.asleep), boxes[1]]
    };
    for _ in 0..600 {
        world.step();
    }
    assert_eq!(sleep(&world, &falling), [true; 3]);
    assert_eq!(sleep(&world, &standing), [true; 3]);
    world.remove(falling.0).unwrap();
    assert_eq!(sleep(&world, &falling), [false; 3]);
    for _ in 0..120 {
        world.step();
        assert_eq!(sleep(&world, &standing), [true; 3]);
    }
    let height = world.rigid_body(falling.1[0]).unwrap().position()[1];
    assert!((height - 0.25).abs() < 0.01, "{height}");
}

#[test]
fn removal_of_foot_wakes_only_its_tower() {
    one_of_two_towers_falls::<Dim2>();
    one_of_two_towers_falls::<Dim3>();
}

fn it_rolls<D: Dim>() {
    let mut world = world::<D>(-9.81);
    let normal: D::Vector = upright(0.3);
    let slope = Shape::half_space(normal, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(slope).with_friction(0.9))
        .unwrap();
    let start = normal * 0.3;
    let id = world
        .add_rigid_body(RigidBody::dynamic(ball(start), 2.0))
        .unwrap();
    for _ in 0..60 {
        world.step();
    }
    let share = if D::N == 2 { 2.0 / 3.0 } else { 5.0 / 7.0 };
    let expected = share * 9.81 * normal[0];
    let rigid = world.rigid_body(id).unwrap();
    assert!(
        (speed(rigid) / expected - 1.0).abs() < 0.03,
        "{} {expected}",
        speed(rigid)
    );
    let spin = rigid.velocity().angular.to_vec3().z;
    assert!((spin * 0.3 + speed(rigid)).abs() < 0.05);
}

#[test]
fn ball_rolls_down_slope_with_expected_acceleration() {
    it_rolls::<Dim2>();
    it_rolls::<Dim3>();
}

#[test]
fn friction_holds_box_only_below_friction_angle() {
    for (angle, holds) in [(0.3f32, true), (0.6, false)] {
        let mut world = world::<Dim3>(-9.81);
        let normal: Vec3 = upright(angle);
        // A box rests if the tangent of the slope angle is below the friction coefficient 0.5, and slides if
        // it is above. The angles 0.3 rad and 0.6 rad have the tangents 0.31 and 0.68.
        let slope = Shape::half_space(normal, Vec3::ZERO);
        world
            .add_rigid_body(RigidBody::fixed(slope).with_friction(0.5))
            .unwrap();
        let shape = cube(Vec3::ZERO, 0.3).rotated(Rotation::in_plane(-angle));
        let shape = shape.translated(normal * 0.3);
        let id = world
            .add_rigid_body(RigidBody::dynamic(shape, 2.0))
            .unwrap();
        let start = world.rigid_body(id).unwrap().position();
        for _ in 0..120 {
            world.step();
        }
        let rigid = world.rigid_body(id).unwrap();
        let way = rigid.position()[0] - start[0];
        // Horizontal distance that a sliding box covers in t = 2 s. It slides along the slope with the
        // acceleration g (sin α − 0.5 cos α).
        let along = 9.81 * (normal[0] - 0.5 * normal[1]) * 2.0 * normal[1];
        let expected = if holds { 0.0 } else { along };
        assert!(
            (way - expected).abs() < 0.01 + 0.05 * along.abs() * f32::from(!holds),
            "{angle}: {way} {expected}"
        );
    }
}

#[test]
fn ball_bounces_to_height_given_by_restitution() {
    for restitution in [0.0f32, 0.5, 0.8] {
        let mut world = floored::<Dim3>();
        let rigid = RigidBody::dynamic(ball(Vec3::new(0.0, 2.3, 0.0)), 1.0);
        let rigid = rigid.with_restitution(restitution);
        let id = world.add_rigid_body(rigid).unwrap();
        let (mut hit, mut highest) = (false, 0.0f32);
        for _ in 0..100 {
            let before = world.rigid_body(id).unwrap().velocity().linear.y;
            world.step();
            let rigid = world.rigid_body(id).unwrap();
            hit |= before < 0.0 && rigid.velocity().linear.y >= 0.0;
            if hit {
                highest = highest.max(rigid.position()[1] - 0.3);
            }
        }
        let expected = 2.0 * restitution * restitution;
        assert!(
            (highest - expected).abs() < 0.06,
            "{restitution}: {highest} {expected}"
        );
    }
}

/// Returns the total linear momentum of dynamic boxes of equal mass.
fn momentum<D: Dim>(world: &World<D>, ids: &[RigidBodyHandle], mass: f32) -> D::Vector {
    ids.iter().fold(D::Vector::ZERO, |sum, &id| {
        sum + world.rigid_body(id).unwrap().velocity().linear * mass
    })
}

#[test]
fn collision_preserves_linear_momentum() {
    let mut world = world::<Dim3>(0.0);
    let ids = [Vec3::ZERO, Vec3::new(2.0, 0.2, 0.1)].map(|at| {
        world
            .add_rigid_body(RigidBody::dynamic(cube(at, 0.3), 2.0))
            .unwrap()
    });
    world
        .set_velocity(
            ids[0],
            Velocity {
                linear: Vec3::new(5.0, 0.0, 0.0),
                angular: Vec3::new(0.0, 1.0, 2.0),
            },
        )
        .unwrap();
    let before = momentum(&world, &ids, 2.0);
    for _ in 0..60 {
        world.step();
    }
    let after = momentum(&world, &ids, 2.0);
    for axis in 0..3 {
        assert!(
            (before[axis] - after[axis]).abs() < 1e-3,
            "{before:?} {after:?}"
        );
    }
    assert!(world.rigid_body(ids[1]).unwrap().velocity().linear.x > 2.0);
    assert!(world.rigid_body(ids[1]).unwrap().velocity().angular != Vec3::ZERO);
}

/// Checks that a rigid box on a soft body sinks in a little and comes to rest, and that neither body is
/// pushed away.
fn it_lies_on_a_soft_body<D: Dim>(mass: f32) {
    let mut world = floored::<D>();
    let grid = VoxelGrid::<D>::cube(12, 1.0).unwrap();
    let material = Material {
        elasticity: Elasticity {
            young: 2e5,
            ..Material::default().elasticity
        },
        strength: f32::INFINITY,
        toughness: f32::INFINITY,
        ..Material::default()
    };
    world
        .add_soft_body(SoftBody::new(grid, &[material]).unwrap())
        .unwrap();
    for _ in 0..240 {
        world.step();
    }
    let shape = Shape::Box {
        centre: vector(0.5, 1.11, if D::N == 2 { 0.0 } else { 0.5 }),
        half: vector(0.4, 0.1, 0.4),
    };
    let id = world
        .add_rigid_body(RigidBody::dynamic(shape, mass))
        .unwrap();
    for _ in 0..480 {
        world.step();
    }
    let rigid = world.rigid_body(id).unwrap();
    let y = rigid.position()[1];
    assert!((0.5..1.12).contains(&y), "{mass}: {:?}", rigid.position());
    let tilt = rigid.rotation().apply(D::Vector::Y)[1];
    assert!(tilt > 0.97, "{mass}: tilted, {tilt}");
    assert!(speed(rigid) < 0.1, "{mass}: {:?}", rigid.velocity());
}

#[test]
fn box_rests_on_soft_body_at_any_mass() {
    for mass in [0.5, 20.0, 200.0] {
        it_lies_on_a_soft_body::<Dim2>(mass);
        it_lies_on_a_soft_body::<Dim3>(mass);
    }
}

#[test]
fn soft_ball_pushes_and_rolls_rigid_ball() {
    let mut world = floored::<Dim3>();
    let id = world
        .add_rigid_body(RigidBody::dynamic(ball(Vec3::new(1.6, 0.3, 0.5)), 1.0))
        .unwrap();
    let grid = VoxelGrid::<Dim3>::ball(12, 1.0).unwrap();
    let soft = world
        .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
        .unwrap();
    for _ in 0..60 {
        world.step();
    }
    world
        .add_velocity(soft, Velocity::linear(Vec3::new(3.0, 0.0, 0.0)))
        .unwrap();
    for _ in 0..60 {
        world.step();
    }
    let rigid = world.rigid_body(id).unwrap();
    assert!(rigid.velocity().linear.x > 0.5, "{:?}", rigid.velocity());
    let angular = rigid.velocity().angular;
    assert!(angular.z < -1.0, "{angular:?}");
}

#[test]
fn kinematic_table_rotates_and_carries_box() {
    let mut world = world::<Dim3>(-9.81);
    let disc = Shape::cuboid(Vec3::new(2.0, 0.1, 2.0));
    let table = RigidBody::kinematic(disc);
    let table = world.add_rigid_body(table).unwrap();
    let id = world
        .add_rigid_body(RigidBody::dynamic(
            cube(Vec3::new(1.0, 0.31, 0.0), 0.2),
            1.0,
        ))
        .unwrap();
    for tick in 1..=120 {
        // The table starts and stops rotating gently, so that the box on it does not slip.
        let share = tick as f32 / 120.0;
        let angle = 0.5 * PI * share * share * (3.0 - 2.0 * share);
        world
            .set_target_rotation(table, Rotation::about(Vec3::Y, angle))
            .unwrap();
        world.step();
    }
    let [x, _, z] = world.rigid_body(id).unwrap().position().to_array();
    assert!(x.abs() < 0.05 && (z + 1.0).abs() < 0.05, "{x} {z}");
    let turned = world.rigid_body(table).unwrap().rotation().apply(Vec3::X);
    assert!((turned[2] + 1.0).abs() < 1e-4, "{turned:?}");
}

#[test]
fn rotated_box_collides() {
    let mut world = world::<Dim2>(-9.81);
    let ramp = RigidBody::fixed(cube(Vec2::ZERO, 1.0))
        .with_friction(0.0)
        .rotated(Rotation::in_plane(FRAC_PI_4));
    world.add_rigid_body(ramp).unwrap();
    let id = world
        .add_rigid_body(RigidBody::dynamic(ball(Vec2::new(0.3, 2.5)), 1.0))
        .unwrap();
    for _ in 0..60 {
        world.step();
    }
    let [x, y] = world.rigid_body(id).unwrap().position().to_array();
    assert!(x > 1.0 && y < 1.2, "{x} {y}");
}

#[test]
fn add_rigid_body_names_invalid_field() {
    let mut world = floored::<Dim3>();
    let tiny = RigidBody::dynamic(Shape::ball(1e-20), 1e-6);
    let endless = RigidBody::dynamic(Shape::half_space(Vec3::Y, Vec3::ZERO), 1.0);
    let heavy = RigidBody::dynamic(cube(Vec3::ZERO, 1.0), f32::NAN);
    let off = RigidBody::new(cube(Vec3::Y, 1.0), MotionType::Dynamic { mass: 1.0 });
    let bouncy = RigidBody::dynamic(cube(Vec3::ZERO, 1.0), 1.0).with_restitution(2.0);
    for (rigid, word) in [
        (endless, "shape"),
        (heavy, "mass"),
        (tiny, "shape"),
        (off, "shape"),
        (bouncy, "restitution"),
    ] {
        let error = world.add_rigid_body(rigid).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{word} must be")), "{error}");
    }
    let id = world
        .add_rigid_body(RigidBody::dynamic(cube(Vec3::ZERO, 1.0), 1.0))
        .unwrap();
    assert!(
        world
            .set_velocity(id, Velocity::linear(Vec3::splat(f32::NAN)))
            .is_err()
    );
    assert!(
        world
            .apply_impulse(id, Impulse::at(Vec3::ZERO, Vec3::splat(f32::INFINITY)))
            .is_err()
    );
    assert!(world.set_target_position(id, Vec3::ZERO).is_err());
    assert!(
        world
            .set_pose(id, Vec3::new(2e6, 0.0, 0.0), Rotation::NONE)
            .is_err()
    );
    let (floor, _) = world.rigid_bodies().next().unwrap();
    assert!(
        world
            .set_velocity(floor, Velocity::linear(Vec3::ZERO))
            .is_err()
    );
    world.remove(id).unwrap();
    assert!(
        world
            .set_velocity(id, Velocity::linear(Vec3::ZERO))
            .is_err()
    );
}

/// Checks that a sleeping soft body stops a rigid body that approaches at only 0.1 m/s.
fn sleepers_hold<D: Dim>() {
    let mut world = world::<D>(0.0);
    let grid = VoxelGrid::<D>::cube(8, 1.0).unwrap();
    let soft = world
        .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
        .unwrap();
    world.put_to_sleep(soft).unwrap();
    let depth = if D::N == 2 { 0.0 } else { 0.5 };
    let slow = world
        .add_rigid_body(RigidBody::dynamic(cube(vector(-0.4, 0.5, depth), 0.2), 1.0))
        .unwrap();
    world
        .set_velocity(slow, Velocity::linear(vector(0.1, 0.0, 0.0)))
        .unwrap();
    for _ in 0..300 {
        world.step();
        assert!(world.rigid_body(slow).unwrap().position()[0] < -0.17);
    }
}

#[test]
fn sleeping_body_stops_slow_rigid_body() {
    sleepers_hold::<Dim2>();
    sleepers_hold::<Dim3>();
}

#[test]
fn slow_kinematic_lift_moves_sleeping_load() {
    let mut world = world::<Dim3>(-9.81);
    let lift = RigidBody::kinematic(cube(Vec3::ZERO, 0.5));
    let lift = world.add_rigid_body(lift).unwrap();
    let load = world
        .add_rigid_body(RigidBody::dynamic(
            cube(Vec3::new(0.0, 0.75, 0.0), 0.25),
            1.0,
        ))
        .unwrap();
    for _ in 0..120 {
        world.step();
    }
    assert!(world.rigid_body(load).unwrap().is_asleep());
    for tick in 1..=240 {
        world
            .set_target_position(lift, Vec3::new(0.0, 0.05 * tick as f32 / 60.0, 0.0))
            .unwrap();
        world.step();
    }
    let height = world.rigid_body(load).unwrap().position()[1];
    assert!((height - 0.95).abs() < 0.01, "{height}");
}

#[test]
fn set_motion_type_stops_falling_body() {
    let mut world = world::<Dim3>(-9.81);
    let id = world
        .add_rigid_body(RigidBody::dynamic(cube(Vec3::ZERO, 0.2), 1.0))
        .unwrap();
    world
        .set_velocity(id, Velocity::angular(Vec3::new(0.0, 3.0, 0.0)))
        .unwrap();
    for _ in 0..60 {
        world.step();
    }
    for drive in [MotionType::Kinematic, MotionType::default()] {
        let before = world.rigid_body(id).unwrap().position();
        world.set_motion_type(id, drive).unwrap();
        for _ in 0..10 {
            world.step();
        }
        let it = world.rigid_body(id).unwrap();
        assert!((it.position()[1] - before[1]).abs() < 0.5, "{drive:?}");
        assert_eq!(it.velocity().angular, Vec3::ZERO);
    }
}

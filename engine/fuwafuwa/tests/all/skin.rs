//! Contacts and queries at the smooth surface of a body.

use fuwafuwa::{
    Dim, Dim2, Dim3, DimAngular, DimVector, Material, QueryFilter, Ray, RigidBody, Shape, SoftBody,
    SoftBodyHandle, Vec3, Velocity, VoxelGrid, World, WorldConfig,
};

const FLOOR: f32 = 0.0;

/// Returns a world with a frictionless floor, and a ball 1 m wide that falls onto it at 1 m/s from a gap of `gap` [m].
fn falling_ball<D: Dim>(n: usize, gap: f32) -> (World<D>, SoftBodyHandle) {
    let mut world = World::<D>::new(WorldConfig {
        gravity: D::Vector::ZERO,
        ..WorldConfig::default()
    })
    .unwrap();
    let floor = Shape::half_space(D::Vector::Y, D::Vector::Y * FLOOR);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.0))
        .unwrap();
    let material = Material {
        strength: f32::INFINITY,
        ..Material::default()
    };
    let body = SoftBody::new(VoxelGrid::<D>::ball(n, 1.0).unwrap(), &[material]).unwrap();
    // The grid leaves half a voxel empty below the ball.
    let lowest = 0.5 / n as f32;
    let body = body
        .translated(D::Vector::Y * (gap - lowest))
        .with_velocity(Velocity::linear(-D::Vector::Y));
    let body = world.add_soft_body(body).unwrap();
    (world, body)
}

fn check_bounce<D: Dim>(n: usize) {
    // A tick moves the ball by 1/60 m, less than a third of a voxel.
    let (mut world, ball) = falling_ball::<D>(n, 0.051);
    let slow = |world: &World<D>| world.velocity(ball).unwrap().linear[1] > -0.999;
    let mut ticks = 0;
    while !slow(&world) {
        world.step();
        ticks += 1;
        assert!(ticks < 10, "the ball falls through the floor");
    }
    // At 1 m/s, the lowest point of the smooth surface is 1 mm above the floor after three ticks.
    assert_eq!(ticks, 4, "n = {n}");
    for _ in 0..60 {
        world.step();
    }
    let velocity = world.velocity(ball).unwrap();
    assert!(velocity.linear[1] > 0.5, "{velocity:?}");
    let spin = velocity.angular.to_vec3().length();
    assert!(spin < 0.03, "n = {n}: {spin} rad/s");
}

#[test]
fn ball_bounces_at_its_smooth_surface_without_spin() {
    check_bounce::<Dim2>(24);
    check_bounce::<Dim3>(16);
}

#[test]
fn rays_hit_the_smooth_surface() {
    for n in [12, 17, 32] {
        let mut world = World::<Dim3>::new(WorldConfig::default()).unwrap();
        let grid = VoxelGrid::<Dim3>::ball(n, 1.0).unwrap();
        world
            .add_soft_body(SoftBody::new(grid, &[Material::default()]).unwrap())
            .unwrap();
        let (centre, radius) = (Vec3::splat(0.5), 0.5 - 0.5 / n as f32);
        for k in 0..40u8 {
            let [x, y, z] = [(7, 13), (5, 11), (3, 17)]
                .map(|(step, count)| f32::from(u16::from(k) * step % count));
            let out = Vec3::new(x - 6.0, y - 5.2, z - 8.1).normalize();
            let ray = Ray::new(centre + out * 2.0, -out);
            let hit = world.ray_cast(ray, 5.0, QueryFilter::default()).unwrap();
            let error = (hit.point.distance(centre) - radius) * n as f32;
            // A flat facet of a ball lies below it by its squared half diagonal over 2 R: 0.05 voxels at n = 12.
            assert!((-0.12..0.03).contains(&error), "n = {n}: {error} voxels");
            assert!(
                hit.normal.dot(out) > 0.95,
                "n = {n}: {}",
                hit.normal.dot(out)
            );
        }
    }
}

#[test]
fn with_materials_keeps_the_surface_of_the_same_shape() {
    let ball = VoxelGrid::<Dim2>::ball(16, 1.0).unwrap();
    let painted = ball
        .clone()
        .with_materials(|[x, ..], number| number * (1 + u8::from(x > 7)));
    assert_eq!(painted.unwrap().surface_offsets(), ball.surface_offsets());
    let halved = ball
        .clone()
        .with_materials(|[x, ..], number| number * u8::from(x > 7));
    assert!(!halved.unwrap().has_surface());
    assert!(ball.with_surface_offsets(vec![0; 3]).is_err());
}

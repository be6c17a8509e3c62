//! Invalid arguments and invalid states: nothing panics, all state stays finite, and calls with invalid
//! arguments return an error.

mod changed;
mod quarantine;

use fuwafuwa::{
    Blade, Damping, Dim, Dim2, Dim3, DimVector, Event, Grading, Law, Material, MotionType,
    ObjectRef, PieceId, RigidBody, Rotation, Shape, SoftBody, Vec2, Vec3, VoxelGrid, World,
    WorldConfig,
};

fn floor<D: Dim>() -> Shape<D> {
    Shape::half_space(D::Vector::Y, D::Vector::ZERO)
}

fn world<D: Dim>() -> World<D> {
    let mut world = World::new(WorldConfig::default()).unwrap();
    world
        .add_rigid_body(RigidBody::fixed(floor()).with_friction(0.5))
        .unwrap();
    world
}

fn ball<D: Dim>(n: usize) -> SoftBody<D> {
    SoftBody::new(VoxelGrid::ball(n, 1.0).unwrap(), &[Material::default()]).unwrap()
}

fn step<D: Dim>(world: &mut World<D>, ticks: usize) {
    for _ in 0..ticks {
        world.step();
    }
}

fn assert_finite<D: Dim>(world: &World<D>) {
    for (_, body) in world.soft_bodies() {
        body.mesh()
            .validate(body.grid(), body.connectivity())
            .unwrap();
        for (id, _) in body.mesh().nodes() {
            let (at, velocity, mass) = body.node_state(id);
            let is_finite = at.is_finite() && velocity.is_finite() && mass.is_finite();
            assert!(is_finite, "{at:?} {velocity:?} {mass}");
            let place = body.positions()[id];
            assert!(D::N == 3 || place[2] == 0.0, "{place:?}");
        }
        for view in body.piece_views() {
            assert!(D::N == 3 || view.velocity.z == 0.0, "{view:?}");
        }
    }
    let bodies = world.rigid_bodies().map(|(_, body)| body);
    for hand in bodies.filter(|body| body.follows_target()) {
        let (at, velocity) = (hand.position(), hand.velocity().linear);
        let is_finite = at.is_finite() && velocity.is_finite();
        assert!(is_finite, "{at:?} {velocity:?}");
    }
}

fn bar(size: [usize; 2]) -> SoftBody<Dim2> {
    let grid = VoxelGrid::from_fn([size[0], size[1], 1], 0.03, |_| 1).unwrap();
    SoftBody::new(grid, &[Material::default()]).unwrap()
}

/// Returns a world without gravity that contains only two bars, which fly towards each other.
fn about_to_meet() -> World<Dim2> {
    let settings = WorldConfig {
        gravity: Vec2::ZERO,
        ..WorldConfig::default()
    };
    let mut world = World::new(settings).unwrap();
    world
        .add_soft_body(bar([6, 6]).with_velocity(Vec2::X))
        .unwrap();
    let other = bar([6, 6]).translated(Vec2::new(0.4, 0.0));
    world
        .add_soft_body(other.with_velocity(Vec2::NEG_X))
        .unwrap();
    world
}

fn assert_they_meet(mut world: World<Dim2>) {
    step(&mut world, 40);
    let [left, right] = [0, 1].map(|n| {
        let body = world.nth_soft_body(n).unwrap();
        world[body].piece_views()[0].centre.x
    });
    assert!(
        left < right,
        "the bars passed through each other: {left}, {right}"
    );
}

/// Checks that a body with `Grading::Coarse`, whose surface elements cannot be split, stays whole.
fn check_coarse<D: Dim>(blade: Blade<D>) {
    let grid = VoxelGrid::<D>::ball(12, 1.0).unwrap();
    let coarse = SoftBody::with_options(
        grid,
        &[Material::default()],
        Law::CorotationalVem,
        Grading::Coarse,
    );
    let mut world = world::<D>();
    let id = world.add_soft_body(coarse.unwrap()).unwrap();
    let above = |height: f32| D::Vector::from_vec3(Vec3::new(0.5, height, 0.5));
    let hand = RigidBody::kinematic(Shape::ball(0.1)).at(above(1.2));
    let hand = world.add_rigid_body(hand).unwrap();
    for tick in 0..60u16 {
        let goal = above(1.2 - 0.02 * f32::from(tick));
        world.set_target_position(hand, goal).unwrap();
        assert_eq!(world.step().nodes_split, 0);
    }
    assert_eq!(world.cut(id, &blade).unwrap(), 0);
    assert!(world.soft_body_mut(id).unwrap().crumble().is_empty());
    step(&mut world, 5);
    assert_finite(&world);
}

#[test]
fn coarse_body_neither_tears_nor_is_cut() {
    let blade = Blade::segment(Vec2::new(0.5, -0.1), Vec2::new(0.5, 1.1));
    check_coarse::<Dim2>(blade);
    let corner = Vec3::new(0.5, -0.1, -0.1);
    let blade = Blade::parallelogram(corner, Vec3::Y * 1.2, Vec3::Z * 1.2);
    check_coarse::<Dim3>(blade);
}

#[test]
fn add_rigid_rejects_out_of_range_hand() {
    let mut world = world::<Dim2>();
    let usual = || RigidBody::coupled(Shape::ball(0.1)).at(Vec2::new(0.0, 3.0));
    let MotionType::Coupled {
        mass,
        stiffness,
        damping,
        max_force,
    } = MotionType::default()
    else {
        panic!("the default motion type is coupled");
    };
    let coupled = |mass, stiffness, damping, max_force| {
        usual().with_motion_type(MotionType::Coupled {
            mass,
            stiffness,
            damping,
            max_force,
        })
    };
    let infinite = f32::INFINITY;
    let bad = [
        (usual().at(Vec2::new(0.0, 1e30)), "position"),
        (RigidBody::coupled(Shape::ball(infinite)), "radius"),
        (RigidBody::coupled(Shape::ball(-1.0)), "radius"),
        (usual().with_friction(infinite), "friction"),
        (coupled(infinite, stiffness, damping, max_force), "mass"),
        (coupled(1e-30, stiffness, damping, max_force), "mass"),
        (coupled(mass, infinite, damping, max_force), "stiffness"),
        (coupled(mass, stiffness, infinite, max_force), "damping"),
        (coupled(mass, stiffness, damping, f32::NAN), "max_force"),
    ];
    for (hand, field) in bad {
        let message = world.add_rigid_body(hand).unwrap_err().to_string();
        assert!(message.contains(field), "{message}");
    }
    let slippery = RigidBody::fixed(floor()).with_friction(infinite);
    assert!(world.add_rigid_body(slippery).is_err());
    let nowhere = floor().translated(Vec2::new(0.0, infinite));
    assert!(world.add_rigid_body(RigidBody::fixed(nowhere)).is_err());
    world
        .add_rigid_body(coupled(mass, stiffness, damping, infinite))
        .unwrap();
    world
        .add_rigid_body(usual().with_motion_type(MotionType::Kinematic))
        .unwrap();
    for hand in 0..2 {
        let hand = world.nth_target_follower(hand).unwrap();
        for nowhere in [1e38, f32::NAN] {
            let nowhere = Vec2::new(nowhere, 0.0);
            assert!(world.set_target_position(hand, nowhere).is_err());
        }
        let far = Vec2::new(1e6, -1e6);
        assert!(world.set_target_position(hand, far).is_ok());
    }
    world.step();
    assert_finite(&world);
}

/// Runs a 2D world in which a rigid shape, a soft body and a hand are rotated by `tilt`, and returns the hash
/// of the world.
fn hash_of_tilted(shape: Shape<Dim2>, tilt: Rotation) -> u64 {
    let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
    let below = RigidBody::fixed(shape).with_friction(0.5);
    world.add_rigid_body(below.rotated(tilt)).unwrap();
    let body = ball(12).translated(Vec2::new(0.0, 0.02));
    let id = world.add_soft_body(body.rotated(tilt)).unwrap();
    let hand = RigidBody::coupled(Shape::ball(0.1)).at(Vec2::new(0.5, 0.9));
    let hand = world.add_rigid_body(hand.rotated(tilt)).unwrap();
    for _ in 0..30 {
        world.set_target_rotation(hand, tilt).unwrap();
        world.step();
    }
    assert_finite(&world);
    let low = world[id].piece_views()[0].low.y;
    assert!(low > -0.03, "{shape:?}: {low}");
    world.hash()
}

/// In 2D, rotations out of the plane are ignored, and no contact moves a body out of the plane.
#[test]
fn plane_world_ignores_rotations_out_of_plane() {
    let tilt = Rotation::about(Vec3::new(1.0, 0.5, 0.0), 0.7);
    let slab = Shape::cuboid(Vec2::new(2.0, 0.5)).translated(Vec2::new(0.5, -0.5));
    let shapes = [
        floor(),
        slab,
        slab.rotated(tilt),
        Shape::capsule(Vec2::new(-1.0, -0.5), Vec2::new(2.0, -0.5), 0.5),
    ];
    for shape in shapes {
        let upright = hash_of_tilted(shape, Rotation::NONE);
        assert_eq!(hash_of_tilted(shape, tilt), upright, "{shape:?}");
    }
    let nowhere = Shape::half_space(Vec2::ZERO, Vec2::ZERO);
    let nowhere = RigidBody::fixed(nowhere).with_friction(0.5);
    assert!(world::<Dim2>().add_rigid_body(nowhere).is_err());
    let body = ball::<Dim2>(12);
    let region = Shape::cuboid(Vec2::ONE).translated(Vec2::splat(0.5));
    for region in [region, region.rotated(tilt)] {
        let share = f64::from(body.mass_inside(&region)) / body.total_mass();
        assert!((share - 1.0).abs() < 1e-5, "{share}");
    }
}

/// Returns the positions, velocities and masses of all nodes of a body.
fn node_states<D: Dim>(body: &SoftBody<D>) -> Vec<(D::Vector, D::Vector, f32)> {
    let nodes = body.mesh().nodes();
    nodes.map(|(id, _)| body.node_state(id)).collect()
}

#[test]
fn unused_material_has_no_effect() {
    let stiff = Material {
        elasticity: fuwafuwa::inspect::Elasticity {
            young: 1e9,
            poisson: 0.3,
        },
        friction: 2.0,
        damping: Damping::between(0.9, 10.0, 50.0),
        ..Material::default()
    };
    let states_with = |materials: &[Material]| {
        let mut world = world::<Dim2>();
        let id = world
            .add_soft_body(SoftBody::new(VoxelGrid::ball(16, 1.0).unwrap(), materials).unwrap())
            .unwrap();
        assert_eq!(world[id].stiffness_scale(), 1.0);
        let hand = RigidBody::kinematic(Shape::ball(0.1)).at(Vec2::new(0.5, 1.1));
        let hand = world.add_rigid_body(hand).unwrap();
        let mut released = 0;
        for tick in 0..40u8 {
            let goal = Vec2::new(0.5, 1.1 - 0.03 * f32::from(tick));
            world.set_target_position(hand, goal).unwrap();
            released += world.step().nodes_split;
        }
        assert!(released > 10, "the body must tear");
        node_states(&world[id])
    };
    let usual = Material::default();
    assert_eq!(states_with(&[usual, stiff]), states_with(&[usual]));
}

/// Checks that a cut reports the positions of the split nodes, as a tear does, but no released energy.
#[test]
fn cut_reports_positions_of_released_nodes() {
    let mut world = world::<Dim2>();
    let id = world
        .add_soft_body(ball(16).translated(Vec2::new(3.0, 0.0)))
        .unwrap();
    let blade = Blade::segment(Vec2::new(3.5, -0.1), Vec2::new(3.5, 1.1));
    let count = world.cut(id, &blade).unwrap();
    let mut places = 0;
    for event in world.events() {
        if let Event::NodeSplit { point, energy, .. } = event {
            assert!(
                (point.x - 3.5).abs() < 0.07 && (0.0..=1.0).contains(&point.y),
                "{point:?}"
            );
            assert_eq!(*energy, 0.0);
            places += 1;
        }
    }
    assert_eq!(places, count);
    let parted = |event: &&Event<Dim2>| matches!(event, Event::PieceDetached { .. });
    assert_eq!(world.events().iter().filter(parted).count(), 1);
}

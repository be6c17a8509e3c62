//! Invalid arguments and invalid states: nothing panics, all state stays finite, and the caller gets an
//! error.

mod changed;
mod quarantine;

use fuwafuwa::{
    Blade, Dim, Dim2, Dim3, Event, Grading, Law, Material, MotionType, ObjectRef, PieceId,
    RigidBody, Shape, SoftBody, VoxelGrid, World, WorldConfig,
};

const FLOOR: Shape = Shape::HalfSpace {
    normal: Vector::Y,
    offset: 0.0,
};

fn world<D: Dim>() -> World<D> {
    let mut world = World::new(WorldConfig::default()).unwrap();
    world
        .add_rigid_body(RigidBody::fixed(FLOOR).with_friction(0.5))
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
    for body in world.soft_bodies() {
        body.mesh()
            .validate(body.grid(), body.connectivity())
            .unwrap();
        for (id, _) in body.mesh().nodes() {
            let (at, velocity, mass) = body.node_state(id);
            let is_finite = at.is_finite() && velocity.is_finite() && mass.is_finite();
            assert!(is_finite, "{at:?} {velocity:?} {mass}");
            assert!(D::N == 3 || (at[2] == 0.0 && velocity[2] == 0.0), "{at:?}");
        }
    }
    for (_, hand) in world.target_followers() {
        let (at, velocity) = (hand.position(), hand.velocity());
        let is_finite = at.is_finite() && velocity.is_finite();
        assert!(is_finite, "{at:?} {velocity:?}");
    }
}

fn bar(size: [usize; 2]) -> SoftBody<Dim2> {
    let grid = VoxelGrid::from_fn([size[0], size[1], 1], 0.03, |_| 1).unwrap();
    SoftBody::new(grid, &[Material::default()]).unwrap()
}

/// A weightless world with only two bars that fly towards each other.
fn about_to_meet() -> World<Dim2> {
    let settings = WorldConfig {
        gravity: Vector::ZERO,
        ..WorldConfig::default()
    };
    let mut world = World::new(settings).unwrap();
    world.add_soft_body(bar([6, 6]).with_velocity(Vector::X));
    let other = bar([6, 6]).translated(Vector::new(0.4, 0.0, 0.0));
    world.add_soft_body(other.with_velocity(Vector::NEG_X));
    world
}

fn assert_they_meet(mut world: World<Dim2>) {
    step(&mut world, 40);
    let [left, right] = [0, 1].map(|n| {
        let body = world.nth_soft_body(n).unwrap();
        world[body].piece_views()[0].centre[0]
    });
    assert!(
        left < right,
        "the bars passed through each other: {left}, {right}"
    );
}

/// `Grading::Coarse` is meant for counting: its surface elements cannot be split.
fn check_coarse<D: Dim>(blade: Blade) {
    let grid = VoxelGrid::<D>::ball(12, 1.0).unwrap();
    let coarse = SoftBody::with_options(
        grid,
        &[Material::default()],
        Law::CorotationalVem,
        Grading::Coarse,
    );
    let mut world = world::<D>();
    let id = world.add_soft_body(coarse.unwrap());
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let hand = RigidBody::coupled(Shape::ball(0.1))
        .at([0.5, 1.2, depth])
        .with_motion_type(MotionType::Kinematic);
    let hand = world.add_rigid_body(hand).unwrap();
    for tick in 0..60u16 {
        world
            .set_target_position(hand, [0.5, 1.2 - 0.02 * f32::from(tick), depth])
            .unwrap();
        assert_eq!(world.step().nodes_split, 0);
    }
    assert_eq!(world.cut(id, &blade).unwrap(), 0);
    assert!(world.soft_body_mut(id).unwrap().crumble().is_empty());
    step(&mut world, 5);
    assert_finite(&world);
}

#[test]
fn coarse_body_neither_tears_nor_is_cut() {
    check_coarse::<Dim2>(Blade::segment([0.5, -0.1], [0.5, 1.1]));
    check_coarse::<Dim3>(Blade {
        from: Vector::new(0.5, -0.1, -0.1),
        across: Vector::new(0.0, 1.2, 0.0),
        along: Vector::new(0.0, 0.0, 1.2),
    });
}

#[test]
fn add_rigid_rejects_out_of_range_hand() {
    let mut world = world::<Dim2>();
    let usual = || RigidBody::coupled(Shape::ball(0.1)).at(Vector::new(0.0, 3.0, 0.0));
    let MotionType::Coupled {
        mass,
        stiffness,
        damping,
        limit,
    } = MotionType::default()
    else {
        panic!("the default drive is coupled");
    };
    let drive = |mass, stiffness, damping, limit| {
        usual().with_motion_type(MotionType::Coupled {
            mass,
            stiffness,
            damping,
            limit,
        })
    };
    let infinite = f32::INFINITY;
    let mut slippery = usual();
    slippery.friction = infinite;
    let bad = [
        (
            RigidBody::coupled(Shape::ball(0.1)).at([0.0, 1e30, 0.0]),
            "position",
        ),
        (
            RigidBody::coupled(Shape::ball(infinite)).at([0.0; 3]),
            "radius",
        ),
        (RigidBody::coupled(Shape::ball(-1.0)).at([0.0; 3]), "radius"),
        (slippery, "friction"),
        (drive(infinite, stiffness, damping, limit), "mass"),
        (drive(1e-30, stiffness, damping, limit), "mass"),
        (drive(mass, infinite, damping, limit), "stiffness"),
        (drive(mass, stiffness, infinite, limit), "damping"),
        (drive(mass, stiffness, damping, f32::NAN), "limit"),
    ];
    for (hand, field) in bad {
        let message = world.add_rigid_body(hand).unwrap_err().to_string();
        assert!(message.contains(field), "{message}");
    }
    assert!(
        world
            .add_rigid_body(RigidBody::fixed(FLOOR).with_friction(infinite))
            .is_err()
    );
    let nowhere = FLOOR.translated([0.0, infinite, 0.0]);
    assert!(
        world
            .add_rigid_body(RigidBody::fixed(nowhere).with_friction(0.1))
            .is_err()
    );
    world
        .add_rigid_body(drive(mass, stiffness, damping, infinite))
        .unwrap();
    world
        .add_rigid_body(usual().with_motion_type(MotionType::Kinematic))
        .unwrap();
    for hand in 0..2 {
        let hand = world.nth_target_follower(hand).unwrap();
        for nowhere in [1e38, f32::NAN] {
            assert!(
                world
                    .set_target_position(hand, [nowhere, 0.0, 0.0])
                    .is_err()
            );
        }
        assert!(world.set_target_position(hand, [1e6, -1e6, 0.0]).is_ok());
    }
    world.step();
    assert_finite(&world);
}

/// In 2D, third coordinates are ignored, and no contact moves a body out of the plane.
#[test]
fn plane_world_ignores_third_coordinates() {
    let shapes = [
        Shape::half_space(Vector::new(0.0, 1.0, 1.0), Vector::ZERO),
        Shape::Box {
            centre: Vector::new(0.5, -0.5, 7.0),
            half: Vector::new(2.0, 0.5, 0.0),
        },
        Shape::Capsule {
            from: Vector::new(-1.0, -0.5, 0.2),
            to: Vector::new(2.0, -0.5, -0.1),
            radius: 0.5,
        },
    ];
    for shape in shapes {
        let mut world = World::<Dim2>::new(WorldConfig::default()).unwrap();
        world
            .add_rigid_body(RigidBody::fixed(shape).with_friction(0.5))
            .unwrap();
        let id = world.add_soft_body(ball(12).translated([0.0, 0.02, 0.0]));
        let hand = RigidBody::coupled(Shape::ball(0.1)).at([0.5, 0.9, 0.05]);
        world.add_rigid_body(hand).unwrap();
        step(&mut world, 30);
        assert_finite(&world);
        let low = world[id].piece_views()[0].low[1];
        assert!(low > -0.03, "{shape:?}: {low}");
    }
    let edge_on = Shape::half_space(Vector::Z, Vector::ZERO);
    assert!(
        world::<Dim2>()
            .add_rigid_body(RigidBody::fixed(edge_on).with_friction(0.5))
            .is_err()
    );
    let body = ball::<Dim2>(12);
    let region = Shape::Box {
        centre: Vector::new(0.5, 0.5, 3.0),
        half: Vector::new(1.0, 1.0, 0.0),
    };
    let share = f64::from(body.mass_inside(&region)) / body.total_mass();
    assert!((share - 1.0).abs() < 1e-5, "{share}");
}

/// Positions and velocities of all nodes, for worlds that differ in other respects.
fn node_states<D: Dim>(world: &World<D>) -> Vec<([f32; 3], [f32; 3], f32)> {
    let states = |body: &SoftBody<D>| -> Vec<_> {
        let nodes = body.mesh().nodes();
        nodes.map(|(id, _)| body.node_state(id)).collect()
    };
    world
        .soft_bodies()
        .map(|(_, body)| body)
        .flat_map(states)
        .collect()
}

#[test]
fn unused_material_has_no_effect() {
    let stiff = Material {
        elasticity: fuwafuwa::inspect::Elasticity {
            young: 1e9,
            poisson: 0.3,
        },
        friction: 2.0,
        ..Material::default()
    };
    let states_with = |materials: &[Material]| {
        let mut world = world::<Dim2>();
        let id = world
            .add_soft_body(SoftBody::new(VoxelGrid::ball(16, 1.0).unwrap(), materials).unwrap());
        assert_eq!(world[id].stiffness_scale(), 1.0);
        let hand = RigidBody::coupled(Shape::ball(0.1))
            .at([0.5, 1.1, 0.0])
            .with_motion_type(MotionType::Kinematic);
        let hand = world.add_rigid_body(hand).unwrap();
        let mut released = 0;
        for tick in 0..40u8 {
            let goal = [0.5, 1.1 - 0.03 * f32::from(tick), 0.0];
            world.set_target_position(hand, goal.into()).unwrap();
            released += world.step().nodes_split;
        }
        assert!(released > 10, "the body must tear");
        node_states(&world)
    };
    let usual = Material::default();
    assert_eq!(states_with(&[usual, stiff]), states_with(&[usual]));
}

/// An intentional cut is reported like a tear, with its position, but releases no energy.
#[test]
fn cut_reports_positions_of_released_nodes() {
    let mut world = world::<Dim2>();
    let id = world.add_soft_body(ball(16).translated([3.0, 0.0, 0.0]));
    let count = world
        .cut(id, &Blade::segment([3.5, -0.1], [3.5, 1.1]))
        .unwrap();
    let mut places = 0;
    for event in world.events() {
        if let Event::NodeSplit { point, energy, .. } = event {
            assert!(
                (point[0] - 3.5).abs() < 0.07 && (0.0..=1.0).contains(&point[1]),
                "{point:?}"
            );
            assert_eq!(*energy, 0.0);
            places += 1;
        }
    }
    assert_eq!(places, count);
    let parted = |event: &&Event| matches!(event, Event::PieceDetached { .. });
    assert_eq!(world.events().iter().filter(parted).count(), 1);
}

//! Scenes with results that must be the same, bit by bit, on every platform.
//!
//! [`SCENES`] is the only table. The tests of this crate run it natively, on one thread and, with the feature
//! `parallel`, on several. `cargo xtask wasm` runs it under Node, through the [`exports`](crate::exports). A
//! changed hash means a changed simulation: give the reason in the commit.
use fuwafuwa::{
    Blade, Contact, Dim, Dim2, Dim3, DimVector, Event, Grading, Law, MIN_SUBSTEPS, Material,
    ObjectRef, RigidBody, RigidBodyHandle, Shape, SoftBody, Vec3, Velocity, VoxelGrid, World,
    WorldConfig,
};

/// Golden scene: a simulation without input, and its expected hash.
pub struct Scene {
    /// Short description, for messages.
    pub name: &'static str,
    /// Runs the scene from the start and hashes the final state.
    pub run: fn() -> u64,
    /// Expected hash on every platform.
    pub golden: u64,
}

/// All golden scenes. For the hash of a new scene, run the tests, which print the hash that they found. The
/// table is a static, because a constant would be compiled, engine included, into each crate that uses it.
pub static SCENES: [Scene; 7] = [
    Scene {
        name: "torn disc",
        run: || hash_of_torn_world::<Dim2>(32, 70),
        golden: 0xd1e4_37c1_c33f_1bc2,
    },
    Scene {
        name: "torn ball",
        run: || hash_of_torn_world::<Dim3>(16, 70),
        golden: 0x9796_c291_232b_82f6,
    },
    Scene {
        name: "ball large enough for several threads",
        run: || hash_of_torn_world::<Dim3>(44, 40),
        golden: 0x8b6d_0145_1b7d_d8c4,
    },
    Scene {
        name: "balls that are together large enough for several threads",
        run: hash_of_balls,
        golden: 0x7eeb_d873_9cab_d08e,
    },
    Scene {
        name: "ball in pieces that lie on each other, few substeps",
        run: hash_of_heap,
        golden: 0x0c05_e677_4bc1_34ef,
    },
    Scene {
        name: "disc, law of the paper",
        run: || hash_of_paper_law::<Dim2>(16),
        golden: 0x4261_0701_6af8_0787,
    },
    Scene {
        name: "ball, law of the paper",
        run: || hash_of_paper_law::<Dim3>(8),
        golden: 0x365e_866f_6b14_1b2d,
    },
];

/// Returns a vector of `D`; in 2D without its third component.
fn vector<D: Dim>(x: f32, y: f32, z: f32) -> D::Vector {
    D::Vector::from_vec3(Vec3::new(x, y, z))
}

/// Creates a world with only a floor.
fn floor<D: Dim>(settings: WorldConfig<D>) -> World<D> {
    let mut world = World::<D>::new(settings).expect("the scene is valid");
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.4))
        .expect("the scene is valid");
    world
}

/// Creates a ball above a floor, a wall, and a hand. The caller moves the hand so that it presses the ball
/// against the wall until the ball tears.
fn torn_world<D: Dim>(n: usize) -> (World<D>, RigidBodyHandle) {
    let mut world = floor(WorldConfig::default());
    let wall = Shape::half_space(vector::<D>(-1.0, 0.0, 0.0), vector::<D>(1.1, 0.0, 0.0));
    world
        .add_rigid_body(RigidBody::fixed(wall).with_friction(0.2))
        .expect("the scene is valid");
    let ball = VoxelGrid::ball(n, 1.0).expect("the scene is valid");
    let body = SoftBody::new(ball, &[Material::default()]).expect("the scene is valid");
    world
        .add_soft_body(body.translated(vector::<D>(0.0, 0.05, 0.0)))
        .unwrap();
    let hand = RigidBody::coupled(Shape::ball(0.08)).at(vector::<D>(-0.3, 0.5, 0.5));
    let hand = world.add_rigid_body(hand).expect("the scene is valid");
    (world, hand)
}

fn hash_of_torn_world<D: Dim>(n: usize, ticks: u32) -> u64 {
    let (mut world, hand) = torn_world::<D>(n);
    let mut released = 0;
    for tick in 0..ticks {
        world
            .set_target_position(hand, vector::<D>(-0.3 + tick as f32 * 0.03, 0.5, 0.5))
            .expect("the scene is valid");
        released += world.step().nodes_split;
    }
    assert!(released > 10, "{released} releases: the body must tear");
    world.hash()
}

/// Returns the hash of a stack of soft balls that fall on each other.
fn hash_of_balls() -> u64 {
    const PITCH: f32 = 1.05;
    let mut world = floor(WorldConfig {
        max_substeps: MIN_SUBSTEPS,
        ..WorldConfig::default()
    });
    let ball = VoxelGrid::ball(20, 1.0).expect("the scene is valid");
    let ball = SoftBody::new(ball, &[Material::default()]).expect("the scene is valid");
    for place in 0..8u8 {
        let [x, y, z] = [0, 1, 2].map(|axis: u8| f32::from(place >> axis & 1));
        // The balls of the upper layer fall onto those of the lower one.
        let fall = Vec3::NEG_Y * 4.0 * y;
        let ball = ball.clone().translated(PITCH * Vec3::new(x, y, z));
        let body = world.add_soft_body(ball).expect("the scene is valid");
        world
            .set_velocity(body, Velocity::linear(fall))
            .expect("the scene is valid");
    }
    for _ in 0..8 {
        world.step();
    }
    let bodies = world.soft_bodies();
    let nodes: usize = bodies.map(|(_, body)| body.mesh().node_count()).sum();
    let is_large = nodes > 16_384;
    assert!(is_large, "{nodes} nodes are too few for several threads");
    let touch = |event: &Event<Dim3>| {
        use ObjectRef::Piece;
        matches!(event, Event::ContactForce(contact) if matches!(contact.pair, [Piece { .. }, Piece { .. }]))
    };
    assert!(world.events().iter().any(touch), "the balls must press");
    world.hash()
}

/// Returns the hash of a soft ball, as in the game, that was cut into pieces. The pieces fall while a hand
/// tears more pieces off.
fn hash_of_heap() -> u64 {
    let settings = WorldConfig {
        max_substeps: MIN_SUBSTEPS,
        ..WorldConfig::default()
    };
    let mut world = floor(settings);
    let ball = VoxelGrid::ball(12, 1.0).expect("the scene is valid");
    let body = SoftBody::new(ball, &[Material::default()]).expect("the scene is valid");
    let ball = world.add_soft_body(body).unwrap();
    for (height, slant) in [(0.3, 0.2), (0.6, -0.3)] {
        let corner = Vec3::new(-1.0, height - slant, -1.0);
        let along = Vec3::new(3.0, 3.0 * slant, 0.0);
        let blade = Blade::parallelogram(corner, along, Vec3::Z * 3.0);
        world.cut(ball, &blade).expect("the scene is valid");
    }
    let hand = RigidBody::coupled(Shape::ball(0.12)).at(Vec3::new(0.4, 1.2, 0.5));
    let hand = world.add_rigid_body(hand).expect("the scene is valid");
    let (mut released, mut touched) = (0, 0.0);
    for tick in 0..50 {
        world
            .set_target_position(hand, Vec3::new(0.4, 1.2 - tick as f32 * 0.03, 0.5))
            .expect("the scene is valid");
        let report = world.step();
        assert_eq!(report.substeps, MIN_SUBSTEPS);
        released += report.nodes_split;
        for event in world.events() {
            if let Event::ContactForce(Contact {
                pair: [_, ObjectRef::Piece { .. }],
                impulse,
                ..
            }) = event
            {
                touched += impulse;
            }
        }
    }
    assert!(released > 10, "{released} releases: the body must tear");
    assert!(touched > 10.0, "{touched} N s: the pieces must press");
    world.hash()
}

/// Returns the hash of a ball with the elastic force of the paper (Endo 2004), without tearing.
fn hash_of_paper_law<D: Dim>(n: usize) -> u64 {
    let mut world: World<D> = floor(WorldConfig::default());
    let ball = VoxelGrid::ball(n, 1.0).expect("the scene is valid");
    let materials = [Material::default()];
    let body = SoftBody::with_options(ball, &materials, Law::Endo2004, Grading::Graded)
        .expect("the scene is valid");
    world
        .add_soft_body(body.translated(vector::<D>(0.0, 0.05, 0.0)))
        .unwrap();
    for _ in 0..30 {
        world.step();
    }
    world.hash()
}

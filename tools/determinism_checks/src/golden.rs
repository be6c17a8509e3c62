//! Scenes whose outcome must be the same, to the last bit, on every platform.
//!
//! [`SCENES`] is the one table. The tests of this crate run it natively, on one thread and, with
//! the feature `parallel`, on several; `cargo xtask wasm` runs it under Node, through the [`exports`].
//! A changed hash is a changed simulation: say why in the commit.
use fuwafuwa::law::Law;
use fuwafuwa::world::FEWEST_SUBSTEPS;
use fuwafuwa::{
    Blade, Dim, Dim2, Dim3, Event, Material, RigidBody, RigidBodyHandle, Shape, SoftBody,
    VoxelGrid, With, World, WorldConfig,
};

/// A simulation without input, and the bits it must end in.
pub struct Scene {
    /// What it shows, for messages.
    pub name: &'static str,
    /// Runs it from the start and hashes how it ends.
    pub run: fn() -> u64,
    /// The hash on every platform.
    pub golden: u64,
}

/// All scenes. For a new one, run the tests: they print the hash that they found. Static, because
/// a constant would be compiled, engine included, into whatever names it.
pub static SCENES: [Scene; 6] = [
    Scene {
        name: "torn disc",
        run: || hash_of_torn_world::<Dim2>(32, 70),
        golden: 0x8c0a_4137_6d87_1fb3,
    },
    Scene {
        name: "torn ball",
        run: || hash_of_torn_world::<Dim3>(16, 70),
        golden: 0x8b09_89b3_e417_5db4,
    },
    Scene {
        name: "ball large enough for several threads",
        run: || hash_of_torn_world::<Dim3>(44, 40),
        golden: 0xe6c4_77f1_dae5_f328,
    },
    Scene {
        name: "ball in pieces that lie on each other, few substeps",
        run: hash_of_heap,
        golden: 0x0962_756d_754b_a83c,
    },
    Scene {
        name: "disc, law of the paper",
        run: || hash_of_paper_law::<Dim2>(16),
        golden: 0xbaac_2f96_3ab3_61ca,
    },
    Scene {
        name: "ball, law of the paper",
        run: || hash_of_paper_law::<Dim3>(8),
        golden: 0xd10e_eec9_d1d8_aeb1,
    },
];

/// A floor, and nothing on it.
fn floor<D: Dim>(settings: WorldConfig) -> World<D> {
    let mut world = World::new(settings).expect("the scenes are sound");
    let floor = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
    world
        .add_rigid_body(RigidBody::fixed(floor, 0.4))
        .expect("the scenes are sound");
    world
}

/// A ball that falls on a floor while a hand pushes it against a wall and through.
fn torn_world<D: Dim>(n: usize) -> (World<D>, RigidBodyHandle) {
    let mut world = floor::<D>(WorldConfig::default());
    let wall = Shape::half_space([-1.0, 0.0, 0.0], [1.1, 0.0, 0.0]);
    world
        .add_rigid_body(RigidBody::fixed(wall, 0.2))
        .expect("the scenes are sound");
    let ball = VoxelGrid::ball(n, 1.0).expect("the scenes are sound");
    let body = SoftBody::new(ball, &[Material::default()]).expect("the scenes are sound");
    world.add_soft_body(body.translated([0.0, 0.05, 0.0]));
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let hand = RigidBody::coupled_ball([-0.3, 0.5, depth], 0.08);
    let hand = world.add_rigid_body(hand).expect("the scenes are sound");
    (world, hand)
}

fn hash_of_torn_world<D: Dim>(n: usize, ticks: u32) -> u64 {
    let (mut world, hand) = torn_world::<D>(n);
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let mut released = 0;
    for tick in 0..ticks {
        world
            .set_target_position(hand, [-0.3 + tick as f32 * 0.03, 0.5, depth])
            .expect("the scenes are sound");
        released += world.step().nodes_split;
    }
    assert!(released > 10, "{released} releases: the body must tear");
    world.hash()
}

/// A ball as soft as those of the game, which comes down in pieces while a hand tears more off.
fn hash_of_heap() -> u64 {
    let settings = WorldConfig {
        most_substeps: FEWEST_SUBSTEPS,
        ..WorldConfig::default()
    };
    let mut world = floor::<Dim3>(settings);
    let ball = VoxelGrid::ball(12, 1.0).expect("the scenes are sound");
    let body = SoftBody::new(ball, &[Material::default()]).expect("the scenes are sound");
    let ball = world.add_soft_body(body);
    for (height, slant) in [(0.3, 0.2), (0.6, -0.3)] {
        let blade = Blade {
            from: [-1.0, height - slant, -1.0],
            across: [3.0, 3.0 * slant, 0.0],
            along: [0.0, 0.0, 3.0],
        };
        world.cut(ball, &blade).expect("the scenes are sound");
    }
    let hand = RigidBody::coupled_ball([0.4, 1.2, 0.5], 0.12);
    let hand = world.add_rigid_body(hand).expect("the scenes are sound");
    let (mut released, mut touched) = (0, 0.0);
    for tick in 0..50 {
        world
            .set_target_position(hand, [0.4, 1.2 - tick as f32 * 0.03, 0.5])
            .expect("the scenes are sound");
        let report = world.step();
        assert_eq!(report.substeps, FEWEST_SUBSTEPS);
        released += report.nodes_split;
        for event in world.events() {
            if let Event::Pressed {
                with: With::Piece { .. },
                impulse,
                ..
            } = event
            {
                touched += impulse;
            }
        }
    }
    assert!(released > 10, "{released} releases: the body must tear");
    assert!(touched > 10.0, "{touched} N s: the pieces must press");
    world.hash()
}

/// The elastic force of the paper, without tearing.
fn hash_of_paper_law<D: Dim>(n: usize) -> u64 {
    let mut world = floor::<D>(WorldConfig::default());
    let ball = VoxelGrid::ball(n, 1.0).expect("the scenes are sound");
    let grading = fuwafuwa::pyramid::Grading::Graded;
    let body = SoftBody::with_options(ball, &[Material::default()], Law::Endo2004, grading)
        .expect("the scenes are sound");
    world.add_soft_body(body.translated([0.0, 0.05, 0.0]));
    for _ in 0..30 {
        world.step();
    }
    world.hash()
}

//! Scenes whose outcome must be the same, to the last bit, on every platform.
//!
//! [`SCENES`] is the one table. The tests of this crate run it natively, on one thread and, with
//! the feature `parallel`, on several; `cargo xtask wasm` runs it under Node, through the [`exports`].
//! A changed hash is a changed simulation: say why in the commit.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod exports;

use fuwafuwa::law::Law;
use fuwafuwa::{Body, Dim, Dim2, Dim3, Manipulator, Material, Settings, Shape, VoxelGrid, World};

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
pub static SCENES: [Scene; 5] = [
    Scene {
        name: "torn disc",
        run: || hash_of_torn_world::<Dim2>(32, 70),
        golden: 0xa133_7dff_8fdc_bcf4,
    },
    Scene {
        name: "torn ball",
        run: || hash_of_torn_world::<Dim3>(16, 70),
        golden: 0xa7e9_917c_19c4_95f6,
    },
    Scene {
        name: "ball large enough for several threads",
        run: || hash_of_torn_world::<Dim3>(28, 40),
        golden: 0xff76_4f2b_aeb2_ebe9,
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

/// A ball that falls on a floor while a hand pushes it against a wall and through.
fn torn_world<D: Dim>(n: usize) -> World<D> {
    let mut world = World::<D>::new(Settings::default()).expect("the scenes are sound");
    let floor = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
    world
        .add_obstacle(floor, 0.4)
        .expect("the scenes are sound");
    let wall = Shape::half_space([-1.0, 0.0, 0.0], [1.1, 0.0, 0.0]);
    world.add_obstacle(wall, 0.2).expect("the scenes are sound");
    let ball = VoxelGrid::ball(n, 1.0).expect("the scenes are sound");
    let body = Body::new(ball, &[Material::default()]).expect("the scenes are sound");
    world.add_body(body.moved([0.0, 0.05, 0.0]));
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let hand = Manipulator::new([-0.3, 0.5, depth], 0.08);
    world.add_manipulator(hand).expect("the scenes are sound");
    world
}

fn hash_of_torn_world<D: Dim>(n: usize, ticks: u32) -> u64 {
    let mut world = torn_world::<D>(n);
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let mut released = 0;
    for tick in 0..ticks {
        world.set_goal(0, [-0.3 + tick as f32 * 0.03, 0.5, depth]);
        released += world.step().released;
    }
    assert!(released > 10, "{released} releases: the body must tear");
    world.hash()
}

/// The elastic force of the paper, without tearing.
fn hash_of_paper_law<D: Dim>(n: usize) -> u64 {
    let mut world = World::<D>::new(Settings::default()).expect("the scenes are sound");
    let floor = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
    world
        .add_obstacle(floor, 0.4)
        .expect("the scenes are sound");
    let ball = VoxelGrid::ball(n, 1.0).expect("the scenes are sound");
    let grading = fuwafuwa::pyramid::Grading::Graded;
    let body = Body::with(ball, &[Material::default()], Law::Endo2004, grading)
        .expect("the scenes are sound");
    world.add_body(body.moved([0.0, 0.05, 0.0]));
    for _ in 0..30 {
        world.step();
    }
    world.hash()
}

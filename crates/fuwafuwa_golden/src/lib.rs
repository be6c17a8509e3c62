//! Scenes whose outcome must be the same, to the last bit, on every platform.
//!
//! A changed hash is a changed simulation: say why in the commit. Built for wasm32, the scenes run
//! under Node (`cargo xtask wasm`); natively they are a test.
#![deny(unsafe_code)]
#![warn(missing_docs)]

use fuwafuwa::law::Law;
use fuwafuwa::{Body, Dim, Dim2, Dim3, Manipulator, Material, Settings, Shape, VoxelGrid, World};

/// A scene: its name, how it is run, and the hash that comes out.
pub type Scene = (&'static str, fn() -> u64, u64);

/// All scenes.
pub const SCENES: [Scene; 4] = [
    (
        "torn disc",
        || hash_of_torn_world::<Dim2>(32),
        0x0236_465c_edff_27e7,
    ),
    (
        "torn ball",
        || hash_of_torn_world::<Dim3>(16),
        0x1d6c_feef_aa1e_61e1,
    ),
    (
        "disc, law of the paper",
        || hash_of_paper_law::<Dim2>(16),
        0xbaac_2f96_3ab3_61ca,
    ),
    (
        "ball, law of the paper",
        || hash_of_paper_law::<Dim3>(8),
        0x6ffc_f29b_6b4d_c134,
    ),
];

/// How many scenes there are: for Node.
#[allow(unsafe_code)] // a name without mangling is all that is unsafe here
#[unsafe(no_mangle)]
pub extern "C" fn golden_count() -> u32 {
    SCENES.len() as u32
}

/// Runs a scene; 1 when its hash is the golden one, 0 when it is not or there is no such scene.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn golden_holds(scene: u32) -> u32 {
    let scene = SCENES.get(scene as usize);
    u32::from(scene.is_some_and(|&(_, run, golden)| run() == golden))
}

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

fn push<D: Dim>(world: &mut World<D>, ticks: std::ops::Range<u32>) -> u32 {
    let depth = if D::N == 3 { 0.5 } else { 0.0 };
    let mut released = 0;
    for tick in ticks {
        world.set_goal(0, [-0.3 + tick as f32 * 0.03, 0.5, depth]);
        released += world.step().released;
    }
    released
}

fn hash_of_torn_world<D: Dim>(n: usize) -> u64 {
    let mut world = torn_world::<D>(n);
    let released = push(&mut world, 0..70);
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

//! Durations of steps in Rust, with which `benches/overhead.py` compares those in Python. Each line of the input
//! names a scene; the answer is a line of durations [ns].

use fuwafuwa::{
    Dim2, Dim3, Material, RigidBody, Shape, SoftBody, Vec2, VoxelGrid, World, WorldConfig,
};
use fuwafuwa_scenes::Scene;
use std::error::Error;
use std::io::{self, BufRead, Write};
use std::time::Instant;

/// Steps over which the duration of a step of a disc is averaged.
const STEPS: u32 = 1000;
/// Ticks after which the disc rests.
const TICKS_TO_REST: u32 = 900;

fn main() -> Result<(), Box<dyn Error>> {
    for line in io::stdin().lock().lines() {
        let durations = match line?.as_str() {
            "tear-3d" => tear()?,
            "resting disc" => disc(true)?,
            "disc that may not sleep" => disc(false)?,
            name => return Err(format!("unknown scene {name:?}").into()),
        };
        let words: Vec<String> = durations.iter().map(u128::to_string).collect();
        println!("{}", words.join(" "));
        io::stdout().flush()?;
    }
    Ok(())
}

/// Returns the duration of each tick of the scene.
fn tear() -> Result<Vec<u128>, Box<dyn Error>> {
    let scene = Scene::open("tear-3d", &[])?;
    let mut world: World<Dim3> = scene.build()?;
    let mut durations = Vec::new();
    for tick in 0..scene.ticks() {
        scene.set_hand_targets(&mut world, tick);
        let start = Instant::now();
        world.step();
        durations.push(start.elapsed().as_nanos());
    }
    Ok(durations)
}

/// Returns the mean duration of a step of a disc on a floor.
fn disc(sleep: bool) -> Result<Vec<u128>, Box<dyn Error>> {
    let mut world = World::<Dim2>::new(WorldConfig {
        sleep,
        ..WorldConfig::default()
    })?;
    world.add_rigid_body(RigidBody::fixed(Shape::half_space(Vec2::Y, Vec2::ZERO)))?;
    world.add_soft_body(SoftBody::new(
        VoxelGrid::ball(32, 1.0)?,
        &[Material::default()],
    )?)?;
    for _ in 0..TICKS_TO_REST {
        world.step();
    }
    let start = Instant::now();
    for _ in 0..STEPS {
        world.step();
    }
    Ok(vec![start.elapsed().as_nanos() / u128::from(STEPS)])
}

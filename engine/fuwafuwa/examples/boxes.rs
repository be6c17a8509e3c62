//! Twenty rigid boxes fall onto a soft, unbreakable ball of 32 voxels across until all sleep. Prints the
//! time per tick.
//!
//! ```text
//! cargo run --release -p fuwafuwa --example boxes
//! ```

#![allow(clippy::disallowed_types)] // a benchmark needs the clock

use fuwafuwa::{
    Dim3, Material, RigidBody, Rotation, Shape, SoftBody, Vector, VoxelGrid, World, WorldConfig,
};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let mut world = World::<Dim3>::new(WorldConfig::default())?;
    let floor = Shape::half_space(Vector::Y, Vector::ZERO);
    world.add_rigid_body(RigidBody::fixed(floor, 0.5))?;
    let rubber = Material {
        strength: f32::INFINITY,
        toughness: f32::INFINITY,
        ..Material::default()
    };
    let ball = SoftBody::new(VoxelGrid::ball(32, 1.0)?, &[rubber])?;
    world.add_soft_body(ball);
    let boxes = (0..20).map(|k| {
        let half = [0.12, 0.08, 0.1];
        let centre = [
            0.35 + 0.3 * (k % 2) as f32,
            1.2 + 0.25 * k as f32,
            0.45 + 0.03 * (k % 4) as f32,
        ];
        let turned = Rotation::about(Vector::new(1.0, k as f32, 0.5), 0.3 * k as f32);
        world.add_rigid_body(
            RigidBody::dynamic(
                Shape::Box {
                    centre: centre.into(),
                    half: half.into(),
                },
                1.0,
            )
            .rotated(turned),
        )
    });
    let boxes = boxes.collect::<Result<Vec<_>, _>>()?;
    let (mut ticks, mut times) = (0, Vec::new());
    while ticks < 1200 && !boxes.iter().all(|&id| world.rigid_bodies()[id].is_asleep()) {
        let began = Instant::now();
        world.step();
        times.push(1000.0 * began.elapsed().as_secs_f64());
        ticks += 1;
    }
    times.sort_by(f64::total_cmp);
    let asleep = boxes
        .iter()
        .filter(|&&id| world.rigid_bodies()[id].is_asleep());
    println!(
        "{} of {} boxes asleep after {:.1} s; time per tick: median {:.1} ms, maximum {:.1} ms",
        asleep.count(),
        boxes.len(),
        f64::from(ticks) / 60.0,
        times[times.len() / 2],
        times[times.len() - 1]
    );
    Ok(())
}

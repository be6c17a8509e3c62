//! Drops a soft ball onto a floor and prints how it squashes and bounces.
//!
//! `cargo run --release -p fuwafuwa --example drop`

use fuwafuwa::{
    Dim, Dim2, Dim3, Material, RigidBody, Shape, SoftBody, Vector, VoxelGrid, World, WorldConfig,
};

fn drop<D: Dim>(n: usize) -> Result<(), Box<dyn std::error::Error>> {
    let mut world = World::<D>::new(WorldConfig::default())?;
    let floor = Shape::half_space(Vector::Y, Vector::ZERO);
    world.add_rigid_body(RigidBody::fixed(floor, 0.5))?;
    let ball = VoxelGrid::ball(n, 1.0)?;
    let stiff = Material {
        strength: f32::INFINITY,
        ..Material::default()
    };
    let ball =
        world.add_soft_body(SoftBody::new(ball, &[stiff])?.translated(Vector::new(0.0, 0.5, 0.0)));
    println!("{}D ball, {n} voxels across:", D::N);
    for tick in 0..180 {
        let report = world.step();
        let nodes = world.soft_bodies()[ball].mesh().nodes();
        let heights = nodes.map(|(id, _)| world.soft_bodies()[ball].node_state(id).0[1]);
        let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), y| {
            (low.min(y), high.max(y))
        });
        if tick % 10 == 9 {
            let seconds = (tick + 1) as f32 / 60.0;
            println!(
                "{seconds:5.2} s  bottom {low:6.3} m  top {high:6.3} m  {} substeps",
                report.substeps
            );
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    drop::<Dim2>(64)?;
    drop::<Dim3>(24)
}

//! Makes a body of a PNG silhouette and drops it.
//!
//! `cargo run --release -p fuwafuwa_scenes --example from_png -- drawing.png`

use fuwafuwa::{Dim2, Material, RigidBody, Shape, SoftBody, World, WorldConfig};
use fuwafuwa_scenes::disk::read_bytes;
use fuwafuwa_scenes::import;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1);
    let file = file.ok_or("name a PNG file: a drawing on white, or a sprite with alpha")?;
    let bytes = read_bytes(file.as_ref(), import::MAX_FILE_BYTES)?;
    let grid = import::png(&file, &bytes, 64, 1.0 / 64.0);
    let grid = grid.map_err(|error| error.to_string())?;
    println!(
        "{} solid voxels in a grid of {:?}",
        grid.solid_count(),
        grid.size()
    );
    let mut world = World::<Dim2>::new(WorldConfig::default())?;
    world.add_rigid_body(RigidBody::fixed(
        Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]),
        0.5,
    ))?;
    let body = world
        .add_soft_body(SoftBody::new(grid, &[Material::default()])?.translated([0.0, 0.3, 0.0]));
    for tick in 1..=120 {
        world.step();
        if tick % 20 == 0 {
            for piece in world.soft_bodies()[body].piece_views().iter().take(4) {
                println!("{tick:3}: piece {} at {:.2?}", piece.number, piece.centre);
            }
        }
    }
    Ok(())
}

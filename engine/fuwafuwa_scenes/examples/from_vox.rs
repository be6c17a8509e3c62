//! Makes a body of a MagicaVoxel model and drops it.
//!
//! `cargo run --release -p fuwafuwa_scenes --example from_vox -- model.vox`

use fuwafuwa::{Dim3, Material, RigidBody, Shape, SoftBody, World, WorldConfig};
use fuwafuwa_scenes::disk::read_bytes;
use fuwafuwa_scenes::import;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1);
    let file = file.ok_or("name a .vox file")?;
    let bytes = read_bytes(file.as_ref(), import::MAX_FILE_BYTES)?;
    let grid = import::vox(&file, &bytes, 1.0 / 32.0);
    let grid = grid.map_err(|error| error.to_string())?;
    println!(
        "{} solid voxels in a grid of {:?}",
        grid.solid_count(),
        grid.size()
    );
    let mut world = World::<Dim3>::new(WorldConfig::default())?;
    world.add_rigid_body(RigidBody::fixed(
        Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]),
        0.5,
    ))?;
    // Each colour of the palette is a material of its own; here all of them are alike.
    let materials = [Material::default(); 255];
    let body = world.add_soft_body(SoftBody::new(grid, &materials)?.translated([0.0, 0.3, 0.0]));
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

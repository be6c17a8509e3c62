//! Ticks of untrusted worlds.

use fuwafuwa::{Dim, World};
use fuwafuwa_scenes::Scene;

/// Maximum number of voxels of a world that a door builds. Larger worlds would take too long.
pub const FEW_VOXELS: usize = 1 << 12;

/// Builds a scene and plays a tick. Returns whether the scene could be built.
pub fn play<D: Dim>(scene: &Scene) -> bool {
    let world = scene.build_within::<D>(FEW_VOXELS);
    world.map(|mut world| step(&mut world)).is_ok()
}

/// Plays a tick, and checks that every mesh is consistent afterwards.
pub fn step<D: Dim>(world: &mut World<D>) {
    world.step();
    for (_, body) in world.soft_bodies() {
        let checked = body.mesh().validate(body.grid(), body.connectivity());
        checked.expect("a tick keeps every mesh consistent");
    }
}

//! A tick of a world that a stranger described.

use fuwafuwa::{Dim, World};
use fuwafuwa_scenes::Scene;

/// More voxels than so many take a while to be placed: that they can be is tested elsewhere.
pub const FEW_VOXELS: usize = 1 << 12;

/// Builds a scene and plays a tick; whether it can be built.
pub fn play<D: Dim>(scene: &Scene) -> bool {
    let world = scene.build_within::<D>(FEW_VOXELS);
    world.map(|mut world| step(&mut world)).is_ok()
}

/// Plays a tick, after which no mesh may contradict itself.
pub fn step<D: Dim>(world: &mut World<D>) {
    world.step();
    for body in world.soft_bodies() {
        let checked = body.mesh().validate(body.grid(), body.connectivity());
        checked.expect("a tick keeps every mesh consistent");
    }
}

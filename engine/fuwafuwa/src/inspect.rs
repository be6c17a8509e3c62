//! Internals for figures, renderers and checks: lattice arithmetic, mesh, element classes and elastic force
//! laws.
//!
//! Simulations do not need this module. Its items follow the implementation and may change with any release.

pub use crate::foundation::dim::{
    add, beyond, corner, face_corners, neighbourhood, points_in, scale, voxel_around,
};
pub use crate::foundation::hash::Hash;
pub use crate::math::row::Row;
pub use crate::soft_body::element_law::{ElasticLaw, Elasticity, Matrix, forces};
pub use crate::soft_body::plasticity::{
    Plasticity, elastic_part, flow, forces_after, plastic_stiffness_factor,
};
pub use crate::soft_body::view::{ElementFace, blocks, faces, outline_slots};
pub use crate::topology::cell_hierarchy::{Cell, CellHierarchy};
pub use crate::topology::connectivity::{Connectivity, Groups};
pub use crate::topology::element_class::{
    ElementClass, MissingCorner, cell_corners, closure, slot_at, slot_index,
};
pub use crate::topology::mesh::{Element, InvariantViolation, Mesh, Node, Remodelled};

use crate::foundation::dim::Dim;
use crate::rigid_body::RigidBodyRef;
use crate::world::World;

/// User data of a rigid body that follows a target but is a moving part of the room, such as a door. All other rigid
/// bodies that follow a target are hands.
pub const MOVING_PART: u64 = u64::MAX;

/// Returns whether a rigid body is a hand: it follows a target and is no [`MOVING_PART`].
pub fn is_hand<D: Dim>(body: RigidBodyRef<'_, D>) -> bool {
    body.follows_target() && body.user_data() != MOVING_PART
}

/// User data of a hand that moves with another one, plus the index of the player.
pub const FOLLOWING_HAND: u64 = 1 << 63;

/// Returns the hands of a world with the index of their player: in the order of the world, except for a
/// [`FOLLOWING_HAND`].
pub fn hands<D: Dim>(world: &World<D>) -> impl Iterator<Item = (usize, RigidBodyRef<'_, D>)> {
    let bodies = world.rigid_bodies().map(|(_, body)| body);
    let mut players = 0..;
    let hands = bodies.filter(|&body| is_hand(body));
    hands.map(
        move |body| match body.user_data().checked_sub(FOLLOWING_HAND) {
            Some(player) => (player as usize, body),
            None => (players.next().unwrap_or(0), body),
        },
    )
}

/// Returns the rigid bodies of a world except hands and sensors.
pub fn obstacles<D: Dim>(world: &World<D>) -> impl Iterator<Item = RigidBodyRef<'_, D>> {
    let bodies = world.rigid_bodies().map(|(_, body)| body);
    bodies.filter(|&body| !is_hand(body) && !body.is_sensor())
}

/// Returns the obstacles of a world that move: those that are dynamic, or follow a target.
pub fn moving_obstacles<D: Dim>(world: &World<D>) -> impl Iterator<Item = RigidBodyRef<'_, D>> {
    obstacles(world).filter(|body| body.is_dynamic() || body.follows_target())
}

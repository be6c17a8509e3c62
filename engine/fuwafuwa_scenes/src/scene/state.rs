//! Complete states of soft and rigid bodies: base64 snapshots of worlds that contain only the one body.

use super::error::FieldError;
use base64::Engine;
use base64::prelude::BASE64_STANDARD as BASE64;
use fuwafuwa::{Dim, RigidBody, SoftBody, World, WorldConfig, snapshot};

/// Encodes a soft body.
pub(super) fn of_body<D: Dim>(body: &SoftBody<D>, settings: WorldConfig) -> Option<String> {
    let mut world = World::new(settings).ok()?;
    world.add_soft_body(body.clone());
    Some(BASE64.encode(snapshot::save(&world)))
}

/// Encodes a rigid body.
pub(super) fn of_rigid<D: Dim>(rigid: &RigidBody) -> Option<String> {
    let mut world = World::<D>::new(WorldConfig::default()).ok()?;
    world.add_rigid_body(rigid.clone()).ok()?;
    Some(BASE64.encode(snapshot::save(&world)))
}

/// Decodes a soft body.
pub(super) fn body<D: Dim>(text: &str) -> Result<SoftBody<D>, FieldError> {
    let mut world = world::<D>(text)?;
    let id = world
        .nth_soft_body(0)
        .filter(|_| world.soft_bodies().count() == 1);
    let body = id.and_then(|id| world.remove(id).ok());
    body.ok_or_else(|| FieldError::new("state", "expected the snapshot of a world with one body"))
}

/// Decodes a rigid body.
pub(super) fn rigid<D: Dim>(text: &str) -> Result<RigidBody, FieldError> {
    let mut world = world::<D>(text)?;
    let id = world.rigid_bodies().map(|(id, _)| id).next();
    let id = id.filter(|_| world.rigid_bodies().count() == 1);
    let rigid = id.and_then(|id| world.remove(id).ok());
    rigid.ok_or_else(|| {
        FieldError::new(
            "state",
            "expected the snapshot of a world with one rigid body",
        )
    })
}

fn world<D: Dim>(text: &str) -> Result<World<D>, FieldError> {
    let bytes = BASE64.decode(text);
    let bytes =
        bytes.map_err(|error| FieldError::new("state", format!("expected base64: {error}")))?;
    snapshot::load(&bytes).map_err(|bad| FieldError::new("state", bad))
}

//! Complete states of soft and rigid bodies, each encoded in base64 as the snapshot of a world with one body.

use super::error::FieldError;
use base64::Engine;
use base64::prelude::BASE64_STANDARD as BASE64;
use fuwafuwa::{Dim, RigidBodyHandle, RigidBodyRef, SoftBody, World, WorldConfig, snapshot};

/// Encodes a soft body.
pub(super) fn of_body<D: Dim>(body: &SoftBody<D>, settings: WorldConfig<D>) -> Option<String> {
    let mut world = World::new(settings).ok()?;
    world.add_soft_body(body.clone()).ok()?;
    Some(BASE64.encode(snapshot::save(&world)))
}

/// Encodes a rigid body.
pub(super) fn of_rigid_body<D: Dim>(body: RigidBodyRef<'_, D>) -> Option<String> {
    let mut world = World::new(WorldConfig::default()).ok()?;
    world.add_rigid_body(body.definition()).ok()?;
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

/// Decodes a rigid body and adds it to `world`.
pub(super) fn add_rigid_body<D: Dim>(
    text: &str,
    world: &mut World<D>,
) -> Result<RigidBodyHandle, FieldError> {
    let stored = self::world::<D>(text)?;
    let mut bodies = stored.rigid_bodies().map(|(_, body)| body);
    let (Some(body), None) = (bodies.next(), bodies.next()) else {
        let expected = "expected the snapshot of a world with one rigid body";
        return Err(FieldError::new("state", expected));
    };
    let added = world.add_rigid_body(body.definition());
    added.map_err(|error| FieldError::new("state", error))
}

fn world<D: Dim>(text: &str) -> Result<World<D>, FieldError> {
    let bytes = BASE64.decode(text);
    let bytes =
        bytes.map_err(|error| FieldError::new("state", format!("expected base64: {error}")))?;
    snapshot::load(&bytes).map_err(|bad| FieldError::new("state", bad))
}

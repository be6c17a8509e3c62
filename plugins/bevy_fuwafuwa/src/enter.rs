//! Adds bodies of entities to the world and removes them, in the order of the requests.

use crate::asset::Voxels;
use crate::component::{
    GravityScale, RigidBody, RigidBodyId, SoftBody, SoftBodyId, SoftColours, SoftMaterials, Source,
    Velocity, WithoutMesh,
};
use crate::convert::{bevy_vector, engine_rotation, engine_vector, engine_velocity};
use crate::dimension::Dimension;
use crate::drawn::{BodyMesh, empty_mesh};
use crate::message::Rejection;
use crate::pose::Pose;
use crate::problem::{Problem, Rejected};
use crate::queue::{Queue, Request};
use crate::world::SoftWorld;
use crate::write::LastWritten;
use bevy_asset::{AssetServer, Assets, Handle, LoadState};
use bevy_ecs::entity::Entity;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::world::World;
use bevy_mesh::Mesh;
use bevy_transform::components::Transform;
use fuwafuwa::{DimVector, Material, MotionType, Shape, VoxelGrid};

/// Outcome of a request to enter the world.
enum Entry {
    Entered,
    /// The asset is still loading.
    Waits,
    /// The body was removed, or was not added because its component or its entity no longer exists.
    Left,
}

/// Handles all requests to enter or leave since the last tick.
pub fn enter_and_leave<D: Dimension>(world: &mut World) {
    let Some(mut queue) = world.get_resource_mut::<Queue<D>>() else {
        return;
    };
    let requests = queue.take();
    let mut waiting = Vec::new();
    for (entity, request) in requests {
        let entry = match request {
            Request::AddBody => add_body::<D>(world, entity),
            Request::AddRigid => add_rigid::<D>(world, entity),
            Request::RemoveBody => {
                // A body that is removed before its asset is loaded must not enter later, so its request to
                // enter is dropped.
                waiting.retain(|request| *request != (entity, Request::AddBody));
                remove_body::<D>(world, entity)
            }
            Request::RemoveRigid => remove_rigid::<D>(world, entity),
        };
        match entry {
            Ok(Entry::Waits) => waiting.push((entity, request)),
            Ok(Entry::Entered | Entry::Left) => {}
            Err(problem) => reject(world, entity, problem),
        }
    }
    if let Some(mut queue) = world.get_resource_mut::<Queue<D>>() {
        queue.wait(waiting);
    }
}

fn reject(world: &mut World, entity: Entity, problem: Problem) {
    if let Ok(mut entity) = world.get_entity_mut(entity) {
        entity.insert(Rejected(problem.clone()));
    }
    let entity = Some(entity);
    world.write_message(Rejection { entity, problem });
}

fn add_body<D: Dimension>(world: &mut World, entity: Entity) -> Result<Entry, Problem> {
    let Some(soft) = world.get::<SoftBody<D>>(entity) else {
        return Ok(Entry::Left);
    };
    let voxels = match &soft.source {
        Source::Grid(grid) => Some(Voxels {
            grid: grid.clone()?,
            colours: Vec::new(),
            notes: Vec::new(),
        }),
        Source::Asset(handle) => find_voxels(world, handle)?,
    };
    let Some(Voxels { grid, colours, .. }) = voxels else {
        return Ok(Entry::Waits);
    };
    let transform = transform_of(world, entity)?;
    let pose = Pose::of(&transform)?;
    let materials = materials_of(world, entity, &grid);
    let body = fuwafuwa::SoftBody::new(grid.scaled(pose.scale)?, &materials)?;
    let body = pose.place(body);

    let velocity = world.get::<Velocity>(entity).copied();
    let gravity = world.get::<GravityScale>(entity).copied();
    let mut soft_world = world.resource_mut::<SoftWorld<D>>();
    let id = soft_world.add_body(entity, body)?;
    let engine = soft_world.engine_mut();
    let mut outcome = Ok(());
    if let Some(velocity) = velocity {
        outcome = engine.add_velocity(id, engine_velocity(velocity));
    }
    if let Some(GravityScale(scale)) = gravity {
        outcome = outcome.and_then(|()| engine.set_gravity_scale(id, scale));
    }
    if let Err(refused) = outcome {
        // The body is removed without further messages, because nothing can have touched it since it was
        // added above.
        soft_world.remove_body(entity);
        return Err(refused.into());
    }
    show::<D>(world, entity, colours);
    let mut entity = world.entity_mut(entity);
    entity.remove::<Rejected>();
    entity.insert((
        SoftBodyId(id),
        LastWritten::new(pose, transform, velocity, gravity),
    ));
    Ok(Entry::Entered)
}

/// Returns the materials of a body. The last material is repeated until each material number of the grid has
/// one.
fn materials_of<D: Dimension>(world: &World, entity: Entity, grid: &VoxelGrid<D>) -> Vec<Material> {
    let materials = world.get::<SoftMaterials>(entity).cloned();
    let SoftMaterials(mut materials) = materials.unwrap_or_default();
    let numbers = grid.voxels().map(|voxel| usize::from(grid.material(voxel)));
    let most = numbers.max().unwrap_or(0);
    if let Some(&last) = materials.last() {
        materials.resize(most.max(materials.len()), last);
    }
    materials
}

/// Returns the voxels of an asset; `None` while it is loading.
fn find_voxels<D: Dimension>(
    world: &World,
    handle: &Handle<Voxels<D>>,
) -> Result<Option<Voxels<D>>, Problem> {
    let Some(assets) = world.get_resource::<Assets<Voxels<D>>>() else {
        return Err(Problem::Asset("the app has no AssetPlugin".into()));
    };
    if let Some(voxels) = assets.get(handle) {
        return Ok(Some(voxels.clone()));
    }
    let server = world.get_resource::<AssetServer>();
    match server.and_then(|server| server.get_load_state(handle)) {
        Some(LoadState::Failed(error)) => Err(Problem::Asset(error.to_string())),
        Some(LoadState::NotLoaded) | None => Err(Problem::Asset("asset is not loading".into())),
        Some(LoadState::Loading | LoadState::Loaded) => Ok(None),
    }
}

/// Gives a new body a mesh, if the app has meshes and the entity is not marked [`WithoutMesh`]. A body that
/// replaces the previous body of its entity reuses the mesh of that body.
fn show<D: Dimension>(world: &mut World, entity: Entity, of_file: Vec<[f32; 3]>) {
    let is_shown = world.get::<WithoutMesh>(entity).is_none();
    let mut usual = SoftColours::default();
    if !of_file.is_empty() {
        usual.materials = of_file;
    }
    let colours = world.get::<SoftColours>(entity).cloned().unwrap_or(usual);
    let known = world.get::<BodyMesh<D>>(entity).map(BodyMesh::mesh);
    let Some(mut meshes) = world.get_resource_mut::<Assets<Mesh>>() else {
        return;
    };
    if !is_shown {
        return;
    }
    let mesh = known.unwrap_or_else(|| meshes.add(empty_mesh()));
    let drawn = BodyMesh::<D>::new(mesh.clone(), colours);
    let mut entity = world.entity_mut(entity);
    D::show(&mut entity, mesh);
    entity.insert(drawn);
}

fn add_rigid<D: Dimension>(world: &mut World, entity: Entity) -> Result<Entry, Problem> {
    let Some(rigid) = world.get::<RigidBody<D>>(entity).cloned() else {
        return Ok(Entry::Left);
    };
    let transform = transform_of(world, entity)?;
    let pose = Pose::of(&transform)?;
    let velocity = world.get::<Velocity>(entity).copied();
    let shape = pose.scaled(rigid.shape);
    let middle = middle_of(&shape, rigid.motion_type);
    let shape = shape.translated(-middle);
    let middle = bevy_vector(middle);
    let position = pose.translation + pose.rotation * middle;
    let own = fuwafuwa::RigidBody::new(shape, rigid.motion_type)
        .at(engine_vector(position))
        .rotated(engine_rotation(transform.rotation))
        .with_friction(rigid.friction)
        .with_restitution(rigid.restitution)
        .with_sensor(rigid.is_sensor)
        .with_layers(rigid.layers);

    let mut soft_world = world.resource_mut::<SoftWorld<D>>();
    let id = soft_world.add_rigid(entity, own)?;
    if let Some(velocity) = velocity
        && velocity != Velocity::default()
        && let Err(refused) = soft_world
            .engine_mut()
            .set_velocity(id, engine_velocity(velocity))
    {
        soft_world.remove_rigid(entity);
        return Err(refused.into());
    }
    let followed = LastWritten {
        middle,
        ..LastWritten::new(pose, transform, velocity, None)
    };
    let mut entity = world.entity_mut(entity);
    entity.remove::<Rejected>();
    entity.insert((RigidBodyId(id), followed));
    Ok(Entry::Entered)
}

/// Returns the point of the shape that becomes the origin of the body in the engine. For a dynamic body this
/// is the middle of the shape, about which it rotates; for others it is the origin of the entity.
fn middle_of<D: Dimension>(shape: &Shape<D>, motion_type: MotionType) -> D::Vector {
    let [low, high] = shape.bounds();
    let middle = (low + high) * 0.5;
    match motion_type {
        // An unbounded shape has no middle; the engine rejects it.
        MotionType::Dynamic { .. } if middle.is_finite() => middle,
        _ => D::Vector::ZERO,
    }
}

fn remove_body<D: Dimension>(world: &mut World, entity: Entity) -> Result<Entry, Problem> {
    // Ignores the error if the body was already removed through the engine.
    let _ = world.resource_mut::<SoftWorld<D>>().remove_body(entity);
    // Removes the components of the old body. The entity may already be despawned, or may have a new body.
    if let Ok(mut entity) = world.get_entity_mut(entity) {
        entity.remove::<(SoftBodyId, LastWritten)>();
        if !entity.contains::<SoftBody<D>>() {
            D::hide(&mut entity);
            entity.remove::<BodyMesh<D>>();
        }
    }
    Ok(Entry::Left)
}

fn remove_rigid<D: Dimension>(world: &mut World, entity: Entity) -> Result<Entry, Problem> {
    let _ = world.resource_mut::<SoftWorld<D>>().remove_rigid(entity);
    if let Ok(mut entity) = world.get_entity_mut(entity) {
        entity.remove::<(RigidBodyId, LastWritten)>();
    }
    Ok(Entry::Left)
}

/// Returns the transform of an entity whose body is about to enter the world. Fails if the entity already has
/// a body, or has a parent.
fn transform_of(world: &World, entity: Entity) -> Result<Transform, Problem> {
    if world.get::<SoftBodyId>(entity).is_some() || world.get::<RigidBodyId>(entity).is_some() {
        return Err(Problem::DuplicateBody);
    }
    if world.get::<ChildOf>(entity).is_some() {
        return Err(Problem::InvalidTransform(
            "belong to an entity without a parent",
        ));
    }
    Ok(world.get::<Transform>(entity).copied().unwrap_or_default())
}

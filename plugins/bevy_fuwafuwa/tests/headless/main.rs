//! Tests of the plugin in apps without a window.

mod assets;
mod bits;
mod contacts;
mod life;
mod meshes;
mod mistakes;
mod motion;
mod rigid;

use bevy_app::{App, TaskPoolPlugin, Update};
use bevy_asset::{AssetPlugin, Assets};
use bevy_ecs::entity::Entity;
use bevy_ecs::message::{Message, Messages};
use bevy_fuwafuwa::Dimension;
use bevy_fuwafuwa::fuwafuwa::SoftBody as Body;
use bevy_fuwafuwa::prelude::*;
use bevy_mesh::Mesh;
use bevy_transform::components::Transform;

/// Returns an app in which each update runs one tick.
fn app<D: Dimension>() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default()));
    app.add_plugins(FuwafuwaPlugin::<D>::default().in_schedule(Update));
    app
}

fn run(app: &mut App, ticks: usize) {
    (0..ticks).for_each(|_| app.update());
}

fn at(x: f32, y: f32) -> Transform {
    Transform::from_xyz(x, y, 0.0)
}

fn transform(app: &App, entity: Entity) -> Transform {
    *app.world()
        .get::<Transform>(entity)
        .expect("the entity has a transform")
}

fn world<D: Dimension>(app: &App) -> &SoftWorld<D> {
    app.world().resource::<SoftWorld<D>>()
}

fn body<D: Dimension>(app: &App, entity: Entity) -> &Body<D> {
    let world = world::<D>(app);
    let id = world.soft_body_of(entity).expect("the body has entered");
    &world.engine()[id]
}

fn mesh(app: &App, entity: Entity) -> &Mesh {
    let entity = app.world().entity(entity);
    let flat = entity.get::<bevy_mesh::Mesh2d>().map(|mesh| &mesh.0);
    let deep = entity.get::<bevy_mesh::Mesh3d>().map(|mesh| &mesh.0);
    let handle = flat.or(deep).expect("the entity has a mesh");
    let meshes = app.world().resource::<Assets<Mesh>>();
    meshes.get(handle).expect("the mesh asset exists")
}

/// Returns all messages of type `M` that the last update sent.
fn messages<M: Message + Clone>(app: &App) -> Vec<M> {
    let messages = app.world().resource::<Messages<M>>();
    messages.iter_current_update_messages().cloned().collect()
}

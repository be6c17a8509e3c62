//! What differs between the plane and space on the side of Bevy.

use crate::asset::{ModelLoader, SilhouetteLoader};
use crate::surface::Surface;
use crate::surface::plane::Sheet;
use crate::surface::space::Hull;
use bevy_app::App;
use bevy_asset::{AssetApp, Handle};
use bevy_ecs::world::EntityWorldMut;
use bevy_mesh::{Mesh, Mesh2d, Mesh3d};
use fuwafuwa::{Dim, Dim2, Dim3};

/// The plane or space: [`Dim2`] or [`Dim3`], and no other.
pub trait Dimension: Dim {
    #[doc(hidden)]
    #[allow(private_bounds)]
    type Surface: Surface<Self>;

    /// Gives an entity a mesh to be drawn.
    #[doc(hidden)]
    fn show(entity: &mut EntityWorldMut<'_>, mesh: Handle<Mesh>);

    /// Takes that away.
    #[doc(hidden)]
    fn hide(entity: &mut EntityWorldMut<'_>);

    /// Reads files as shapes.
    #[doc(hidden)]
    fn read_files(app: &mut App);
}

impl Dimension for Dim2 {
    type Surface = Sheet;

    fn show(entity: &mut EntityWorldMut<'_>, mesh: Handle<Mesh>) {
        entity.insert(Mesh2d(mesh));
    }

    fn hide(entity: &mut EntityWorldMut<'_>) {
        entity.remove::<Mesh2d>();
    }

    fn read_files(app: &mut App) {
        app.register_asset_loader(SilhouetteLoader);
    }
}

impl Dimension for Dim3 {
    type Surface = Hull;

    fn show(entity: &mut EntityWorldMut<'_>, mesh: Handle<Mesh>) {
        entity.insert(Mesh3d(mesh));
    }

    fn hide(entity: &mut EntityWorldMut<'_>) {
        entity.remove::<Mesh3d>();
    }

    fn read_files(app: &mut App) {
        app.register_asset_loader(ModelLoader);
    }
}

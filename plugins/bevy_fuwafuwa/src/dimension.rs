//! Trait that covers the differences between 2D and 3D.

use crate::asset::{ModelLoader, SilhouetteLoader};
use crate::surface::Surface;
use crate::surface::plane::PlaneSurface;
use crate::surface::space::SpaceSurface;
use bevy_app::App;
use bevy_asset::{AssetApp, Handle};
use bevy_ecs::world::EntityWorldMut;
use bevy_mesh::{Mesh, Mesh2d, Mesh3d};
use fuwafuwa::{Dim, Dim2, Dim3};

/// Number of dimensions: [`Dim2`] or [`Dim3`].
pub trait Dimension: Dim {
    #[doc(hidden)]
    #[allow(private_bounds)]
    type Surface: Surface<Self>;

    /// Adds the mesh component to an entity.
    #[doc(hidden)]
    fn show(entity: &mut EntityWorldMut<'_>, mesh: Handle<Mesh>);

    /// Removes the mesh component.
    #[doc(hidden)]
    fn hide(entity: &mut EntityWorldMut<'_>);

    /// Registers the asset loader of the dimension.
    #[doc(hidden)]
    fn read_files(app: &mut App);
}

impl Dimension for Dim2 {
    type Surface = PlaneSurface;

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
    type Surface = SpaceSurface;

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

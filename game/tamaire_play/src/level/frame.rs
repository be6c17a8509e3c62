//! Levels around a body from a file: the built-in level that surrounds it, and the body's size and place there.

use super::most_solid;
use fuwafuwa::{Dim, Dim2, Dim3};
use fuwafuwa_scenes::import::FileType;
use fuwafuwa_scenes::scene::{Scene, SceneError};

/// Share of the room that a body may take on an axis.
const MAX_ROOM_SHARE: f32 = 0.9;

/// Minimum distance of a body from the basket [m].
const BASKET_GAP: f32 = 0.1;

/// Returns the name of the built-in level in which a picture or a model replaces the body; `None` for a file of
/// another type.
pub(super) fn level_around(found: FileType) -> Option<&'static str> {
    match found {
        FileType::Vox => Some("classic-3d"),
        found if found.is_readable_picture() => Some("classic"),
        _ => None,
    }
}

/// Size of the first body of a scene.
pub(super) struct BodySize {
    /// Width on each axis [m]; one voxel on the third axis in 2D.
    widths: [f32; 3],
    /// Area in 2D [m²], volume in 3D [m³].
    content: f32,
}

impl BodySize {
    /// Measures the first body of a scene, whose files are embedded.
    pub(super) fn of(scene: &Scene) -> Result<Self, SceneError> {
        match scene.dim {
            2 => Self::in_dim::<Dim2>(scene),
            _ => Self::in_dim::<Dim3>(scene),
        }
    }

    fn in_dim<D: Dim>(scene: &Scene) -> Result<Self, SceneError> {
        let mut alone = scene.clone();
        alone.body.truncate(1);
        let world = alone.build_within::<D>(most_solid::<D>(scene))?;
        let mut size = Self {
            widths: [0.0; 3],
            content: 0.0,
        };
        for (_, body) in world.soft_bodies() {
            let (grid, voxel) = (body.grid(), body.grid().voxel_size());
            size.widths = grid.size().map(|extent| extent as f32 * voxel);
            size.content = grid.solid_count() as f32 * voxel.powi(D::N as i32);
        }
        Ok(size)
    }
}

/// Scales the first body to the area (volume in 3D) of the body that it replaces, so that the basket stays as
/// tight. Limits it to the room left of the basket. Keeps its left edge, and its centre on the other axes.
pub(super) fn fit_body(scene: &mut Scene, before: &BodySize) -> Result<(), SceneError> {
    let own = BodySize::of(scene)?;
    let ratio = before.content / own.content;
    let wanted = match scene.dim {
        2 => ratio.sqrt(),
        _ => ratio.cbrt(),
    };
    let [low, high] = scene.view;
    let basket = scene.game.as_ref().and_then(|game| game.basket.as_ref());
    let right = basket.map_or(high[0], |basket| {
        basket.centre[0] - basket.half[0] - BASKET_GAP
    });
    let floats = scene.gravity[1] == 0.0;
    let dim = usize::from(scene.dim);
    let Some(body) = scene.body.first_mut() else {
        return Ok(());
    };
    let rooms = [
        right - body.at[0],
        MAX_ROOM_SHARE * (high[1] - if floats { low[1] } else { body.at[1] }),
        MAX_ROOM_SHARE * (high[2] - low[2]),
    ];
    let fits = (0..dim).map(|axis| rooms[axis] / own.widths[axis]);
    let scale = fits.fold(wanted, f32::min);
    // Rounds to 0.1 mm, so that the roots need not have the same last bit on every machine.
    let width = (body.width * scale * 1e4).round() / 1e4;
    let scale = width / body.width;
    body.width = width;
    // The left side stays where the hand finds it. A body that lies on the floor stays there.
    for axis in if floats { 1 } else { 2 }..dim {
        body.at[axis] += 0.5 * (before.widths[axis] - scale * own.widths[axis]);
    }
    Ok(())
}

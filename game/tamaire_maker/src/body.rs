//! Drawings as bodies of levels, and back.

use crate::drawing::Drawing;
use crate::palette::{Palette, number_in};
use fuwafuwa::{Dim, Dim2, Dim3, Vec3, VoxelGrid};
use fuwafuwa_scenes::scene::{BodyText, MAX_MATERIALS, VoxelsText};
use fuwafuwa_scenes::{Scene, SceneError};

/// Edge length of a cell of the paper in a room [m], so that a full page is 0.9 m wide.
pub const PAPER_CELL: f32 = 0.9 / 64.0;
/// Edge length of a cell of a block in a room [m].
pub const BLOCK_CELL: f32 = 0.9 / 32.0;

/// Makes a drawing the body with index `body` of a scene, or a new body without an index. Its middle comes to `centre`
/// [m], or stays where the body was. The crayons become materials of the scene. Returns the index of the body, or `None`
/// if the drawing is empty.
pub fn put(
    scene: &mut Scene,
    body: Option<usize>,
    drawing: &Drawing,
    palette: &Palette,
    centre: Vec3,
) -> Option<usize> {
    let cell = match drawing.is_paper() {
        true => PAPER_CELL,
        false => BLOCK_CELL,
    };
    let before = body.and_then(|body| scene.body.get(body));
    let cell = before
        .and_then(|body| body.voxels.as_ref())
        .map_or(cell, |voxels| voxels.voxel_size);
    let (mut voxels, _) = drawing.voxels(cell)?;
    let mut numbers = [0u8; 256];
    for (number, material) in (1..).zip(palette.materials()) {
        if drawing.cells().contains(&number) {
            numbers[usize::from(number)] = number_in(&mut scene.material, material, MAX_MATERIALS);
        }
    }
    voxels.runs = renumbered(&voxels.runs, |number| numbers[usize::from(number)]);
    let extent = extent_of(&voxels);
    let centre = before.and_then(centre_of).unwrap_or(centre);
    let mut at = centre - 0.5 * extent;
    if scene.dim == 2 {
        at.z = 0.0;
    }
    let text = BodyText {
        voxels: Some(voxels),
        at: at.to_array(),
        ..BodyText::default()
    };
    match body.and_then(|body| scene.body.get_mut(body)) {
        Some(known) => *known = text,
        None => scene.body.push(text),
    }
    Some(
        body.filter(|&body| body < scene.body.len())
            .unwrap_or(scene.body.len() - 1),
    )
}

/// Returns the middle of a body of voxels [m]; `None` for other bodies.
fn centre_of(body: &BodyText) -> Option<Vec3> {
    let voxels = body.voxels.as_ref()?;
    Some(Vec3::from(body.at) + 0.5 * extent_of(voxels))
}

/// Returns the size of a grid of voxels [m].
fn extent_of(voxels: &VoxelsText) -> Vec3 {
    let [x, y, z] = voxels.size.map(|count| count as f32 * voxels.voxel_size);
    Vec3::new(x, y, z)
}

/// Returns run lengths with other numbers.
fn renumbered(runs: &str, number: impl Fn(u8) -> u8) -> String {
    let runs = runs.split_ascii_whitespace().map(|run| {
        let parts = run.split_once('x');
        let known = parts.and_then(|(length, found)| Some((length, found.parse().ok()?)));
        known.map_or_else(
            || run.to_string(),
            |(length, found)| format!("{length}x{}", number(found)),
        )
    });
    runs.collect::<Vec<_>>().join(" ")
}

/// Brings a body of a scene to the paper: returns its drawing and the crayons that it needs. `None` if the scene has no
/// such body.
///
/// # Errors
/// [`SceneError`] if the body cannot be built.
pub fn take(scene: &Scene, body: usize) -> Result<Option<(Drawing, Palette)>, SceneError> {
    match scene.dim {
        2 => taken::<Dim2>(scene, body),
        _ => taken::<Dim3>(scene, body),
    }
}

fn taken<D: Dim>(scene: &Scene, body: usize) -> Result<Option<(Drawing, Palette)>, SceneError> {
    let Some(text) = scene.body.get(body) else {
        return Ok(None);
    };
    let mut alone = scene.clone();
    alone.body = vec![text.clone()];
    alone.obstacle.clear();
    alone.hand.clear();
    alone.rigid_body.clear();
    alone.joint.clear();
    alone.knife.clear();
    alone.switch.clear();
    alone.field.clear();
    alone.game = None;
    let tinted = alone.tint_grids::<D>()?.into_iter().next().flatten();
    let world = alone.build::<D>()?;
    let plain = world.soft_bodies().next().map(|(_, body)| body.grid());
    let Some(grid) = tinted.as_ref().or(plain) else {
        return Ok(None);
    };
    let mut palette = Palette::default();
    let numbers: Vec<u8> = (scene.material.iter())
        .map(|material| palette.number_of(material))
        .collect();
    let grid = grid_with(grid, |material| {
        let place = usize::from(material).checked_sub(1);
        let known = place.and_then(|place| numbers.get(place));
        known.copied().unwrap_or(1)
    });
    Ok(Some((Drawing::of_grid(&grid), palette)))
}

/// Returns a grid with other material numbers for its solid voxels.
fn grid_with<D: Dim>(grid: &VoxelGrid<D>, number: impl Fn(u8) -> u8) -> VoxelGrid<D> {
    let materials = grid.voxels().map(|voxel| match grid.material(voxel) {
        0 => 0,
        material => number(material),
    });
    let size = grid.size().map(|count| count as usize);
    let changed = VoxelGrid::from_materials(size, grid.voxel_size(), materials.collect::<Vec<_>>());
    changed.unwrap_or_else(|_| grid.clone())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Brush;
    use crate::palette::crayon;
    use tamaire_play::playground::Stuff;

    fn blank(dim: u8) -> Scene {
        Scene::read("blank", &format!("dim = {dim}\nmaterial = []"), &[]).unwrap()
    }

    #[test]
    fn drawing_comes_back_from_the_room_with_its_crayons() {
        for mut drawing in [Drawing::paper(), Drawing::block()] {
            let dim = if drawing.is_paper() { 2 } else { 3 };
            let middle = 0.5 * Vec3::from(drawing.size().map(|count| count as f32));
            let [clay, stone] = [Stuff::Clay, Stuff::Stone].map(Stuff::number);
            drawing.stroke(middle, middle + 6.0 * Vec3::X, 4.0, Brush::Draw(clay));
            drawing.end_stroke();
            drawing.stroke(middle, middle, 2.0, Brush::Paint(stone));
            drawing.end_stroke();
            let mut scene = blank(dim);
            let body = put(&mut scene, None, &drawing, &Palette::default(), Vec3::ONE);
            assert_eq!(body, Some(0));
            assert_eq!(scene.material, [crayon(Stuff::Clay), crayon(Stuff::Stone)]);
            let (again, palette) = take(&scene, 0).unwrap().unwrap();
            assert_eq!(palette, Palette::default());
            let count = |drawing: &Drawing, crayon| {
                drawing
                    .cells()
                    .iter()
                    .filter(|&&cell| cell == crayon)
                    .count()
            };
            for crayon in [clay, stone] {
                assert!(count(&drawing, crayon) > 0);
                assert_eq!(count(&again, crayon), count(&drawing, crayon), "{dim}D");
            }
            let same = put(&mut scene, body, &again, &palette, Vec3::ZERO);
            assert_eq!((same, scene.body.len()), (body, 1));
            let centre = centre_of(&scene.body[0]).unwrap();
            let expected = if dim == 2 {
                Vec3::new(1.0, 1.0, centre.z)
            } else {
                Vec3::ONE
            };
            assert!((centre - expected).length() < 1e-3, "{centre}");
        }
    }

    #[test]
    fn empty_drawing_adds_nothing() {
        let mut scene = blank(2);
        let drawing = Drawing::paper();
        let put = put(&mut scene, None, &drawing, &Palette::default(), Vec3::ZERO);
        assert!(put.is_none() && scene.body.is_empty() && scene.material.is_empty());
    }
}

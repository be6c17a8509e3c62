//! Drawings as bodies of levels, and back.

use crate::drawing::Drawing;
use crate::items::{Item, bounds};
use crate::palette::{Palette, number_in};
use fuwafuwa::{Dim, Dim2, Dim3, Vec3, VoxelGrid};
use fuwafuwa_scenes::scene::{BodyText, MAX_MATERIALS, VoxelsText};
use fuwafuwa_scenes::{Scene, SceneError};

/// Edge length of a cell of the paper in a room [m], so that a full page is 0.9 m wide.
const PAPER_CELL: f32 = 0.9 / 64.0;
/// Edge length of a cell of a block in a room [m].
const BLOCK_CELL: f32 = 0.9 / 32.0;

/// Makes a drawing the body with index `body` of a scene, or a new body without an index. Its middle comes to `centre`
/// [m], or stays where the body was. A cell is `cell` [m] wide; by default, a page or a block is 0.9 m wide. The crayons
/// become materials of the scene. Returns the index of the body, or `None` if the drawing is empty.
pub fn put(
    scene: &mut Scene,
    body: Option<usize>,
    drawing: &Drawing,
    palette: &Palette,
    (centre, cell): (Vec3, Option<f32>),
) -> Option<usize> {
    let cell = cell.unwrap_or(match drawing.is_paper() {
        true => PAPER_CELL,
        false => BLOCK_CELL,
    });
    let (mut voxels, _) = drawing.voxels(cell)?;
    // A number without a material is drawn with the first one, so that no cell is lost.
    let mut numbers = [1u8; 256];
    numbers[0] = 0;
    for (number, material) in (1..=u8::MAX).zip(palette.materials()) {
        if drawing.cells().contains(&number) {
            numbers[usize::from(number)] = number_in(&mut scene.material, material, MAX_MATERIALS);
        }
    }
    voxels.runs = renumbered(&voxels.runs, |number| numbers[usize::from(number)]);
    let known = body.filter(|&body| body < scene.body.len());
    let before = known.and_then(|body| middle_of(scene, body));
    let text = drawn(known.map(|body| &scene.body[body]), voxels);
    let place = known.unwrap_or(scene.body.len());
    match known {
        Some(body) => scene.body[body] = text,
        None => scene.body.push(text),
    }
    if let Some(now) = middle_of(scene, place) {
        let by = before.unwrap_or(centre) - now;
        let at = &mut scene.body[place].at;
        (at[0], at[1]) = (at[0] + by.x, at[1] + by.y);
        if scene.dim == 3 {
            at[2] += by.z;
        }
    }
    Some(place)
}

/// Returns a body of voxels with the motion, layers and rotation of the body that it replaces.
fn drawn(before: Option<&BodyText>, voxels: VoxelsText) -> BodyText {
    let usual = BodyText::default();
    let before = before.cloned().unwrap_or_default();
    BodyText {
        voxels: Some(voxels),
        shape: None,
        file: None,
        model: None,
        content: None,
        state: None,
        n: None,
        fill: None,
        plain: None,
        keep_colours: None,
        material: None,
        width: usual.width,
        proportions: usual.proportions,
        colours: usual.colours,
        part: usual.part,
        ..before
    }
}

fn middle_of(scene: &Scene, body: usize) -> Option<Vec3> {
    let [low, high] = bounds(scene, Item::Body(body))?;
    Some(0.5 * (low + high))
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

/// Drawing of a body of a scene.
pub struct Taken {
    /// The drawing.
    pub drawing: Drawing,
    /// Edge length of a cell [m], by which the body keeps its size.
    pub cell: f32,
}

/// Brings a body of a scene to the paper. Its materials are added to the palette. `None` if the scene has no such body.
///
/// # Errors
/// [`SceneError`] if the body cannot be built.
pub fn take(
    scene: &Scene,
    body: usize,
    palette: &mut Palette,
) -> Result<Option<Taken>, SceneError> {
    match scene.dim {
        2 => taken::<Dim2>(scene, body, palette),
        _ => taken::<Dim3>(scene, body, palette),
    }
}

fn taken<D: Dim>(
    scene: &Scene,
    body: usize,
    palette: &mut Palette,
) -> Result<Option<Taken>, SceneError> {
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
    let materials = scene.material.iter();
    let numbers: Vec<u8> = materials
        .map(|material| palette.number_of(material))
        .collect();
    let grid = grid_with(grid, |material| {
        let place = usize::from(material).checked_sub(1);
        let known = place.and_then(|place| numbers.get(place));
        known.copied().unwrap_or(1)
    });
    let drawing = Drawing::of_grid(&grid);
    // A grid that is too large for the sheet has fewer, larger cells there.
    let longest = grid.size().into_iter().max().unwrap_or(1) as f32;
    let shown = drawing.bounds().map_or(1, |[low, high]| {
        let lengths = [0, 1, 2].map(|axis: usize| high[axis] + 1 - low[axis]);
        lengths.into_iter().max().unwrap_or(1)
    });
    let scale = (longest / shown as f32).max(1.0);
    let fits = grid.size().map(|count| count as usize);
    let is_whole = (0..3).all(|axis| fits[axis] <= drawing.size()[axis]);
    let cell = grid.voxel_size() * if is_whole { 1.0 } else { scale };
    Ok(Some(Taken { drawing, cell }))
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
            let (mut scene, mut palette) = (blank(dim), Palette::default());
            let body = put(&mut scene, None, &drawing, &palette, (Vec3::ONE, None));
            assert_eq!(body, Some(0));
            assert_eq!(scene.material, [crayon(Stuff::Clay), crayon(Stuff::Stone)]);
            let again = take(&scene, 0, &mut palette).unwrap().unwrap();
            assert_eq!(palette, Palette::default());
            let count = |drawing: &Drawing, crayon| {
                let cells = drawing.cells().iter();
                cells.filter(|&&cell| cell == crayon).count()
            };
            for crayon in [clay, stone] {
                assert!(count(&drawing, crayon) > 0);
                assert_eq!(count(&again.drawing, crayon), count(&drawing, crayon));
            }
            let known = scene.clone();
            let place = (Vec3::ZERO, Some(again.cell));
            let same = put(&mut scene, body, &again.drawing, &palette, place);
            assert_eq!((same, scene.body.len()), (body, 1));
            let [before, after] = [&known, &scene].map(|scene| middle_of(scene, 0).unwrap());
            assert!((after - before).length() < 1e-3, "{after}");
            let length = scene.body[0].voxels.as_ref().unwrap().voxel_size;
            assert_eq!(length, known.body[0].voxels.as_ref().unwrap().voxel_size);
        }
    }

    #[test]
    fn redrawn_body_keeps_its_place_rotation_weight_and_size() {
        let text = "dim = 2\n[[body]]\nshape = \"box\"\nn = 20\nwidth = 0.5\nat = [0.3, 0.4, 0.0]\n\
                    rotation_vector = [0.0, 0.0, 0.5]\ngravity_scale = 0.2";
        let mut scene = Scene::read("turned", text, &[]).unwrap();
        let before = bounds(&scene, Item::Body(0)).unwrap();
        let mut palette = Palette::default();
        let taken = take(&scene, 0, &mut palette).unwrap().unwrap();
        let place = (Vec3::ZERO, Some(taken.cell));
        put(&mut scene, Some(0), &taken.drawing, &palette, place);
        let after = bounds(&scene, Item::Body(0)).unwrap();
        for (a, b) in before.into_iter().zip(after) {
            assert!((a - b).length() < 1e-3, "{a} {b}");
        }
        assert_eq!(scene.body[0].gravity_scale, Some(0.2));
        assert!(scene.body[0].voxels.is_some() && scene.body[0].shape.is_none());
    }

    #[test]
    fn empty_drawing_adds_nothing() {
        let mut scene = blank(2);
        let drawing = Drawing::paper();
        let place = (Vec3::ZERO, None);
        let put = put(&mut scene, None, &drawing, &Palette::default(), place);
        assert!(put.is_none() && scene.body.is_empty() && scene.material.is_empty());
    }

    #[test]
    fn number_without_a_material_is_drawn_with_the_first_one() {
        let mut drawing = Drawing::paper();
        let middle = Vec3::new(32.0, 32.0, 0.5);
        drawing.stroke(middle, middle, 4.0, Brush::Draw(u8::MAX));
        drawing.end_stroke();
        let (mut scene, mut palette) = (blank(2), Palette::default());
        put(&mut scene, None, &drawing, &palette, (Vec3::ZERO, None));
        scene.material.push(crayon(Stuff::Jelly));
        let again = take(&scene, 0, &mut palette).unwrap().unwrap();
        assert_eq!(again.drawing.solid_count(), drawing.solid_count());
    }
}

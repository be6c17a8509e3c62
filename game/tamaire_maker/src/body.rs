//! Drawings as bodies of levels, and back.

use crate::drawing::Drawing;
use crate::items::{Item, bounds};
use crate::palette::{Palette, number_in, renumbered_runs};
use fuwafuwa::{Dim, Dim2, Dim3, Vec3, VoxelGrid};
use fuwafuwa_scenes::scene::{BodyText, MAX_BODIES, MaterialText, VoxelsText};
use fuwafuwa_scenes::{Scene, SceneError};
use std::collections::BTreeSet;

/// Edge length of a cell of the paper in a room [m], so that a full page is 0.9 m wide.
const PAPER_CELL: f32 = 0.9 / 64.0;
/// Edge length of a cell of a block in a room [m].
const BLOCK_CELL: f32 = 0.9 / 32.0;

/// Replaces the body with index `body` with a drawing, or adds a body if `body` is `None`. A replaced body keeps its middle;
/// a new one has it at `centre` [m]. `cell` is the edge length of a cell [m]; by default, a page or a block is 0.9 m wide.
/// The crayons become materials of the scene. Returns the index of the body. Returns `None` and changes nothing if the
/// drawing is empty, or if the scene can have no further body or material.
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
    let known = body.filter(|&body| body < scene.body.len());
    if known.is_none() && scene.body.len() >= MAX_BODIES {
        return None;
    }
    // A number without a material is drawn with the first one, so that no cell is lost.
    let mut numbers = [1u8; 256];
    numbers[0] = 0;
    let mut materials = scene.material.clone();
    for (number, material) in (1..=u8::MAX).zip(palette.materials()) {
        if drawing.cells().contains(&number) {
            numbers[usize::from(number)] = number_in(&mut materials, material)?;
        }
    }
    scene.material = materials;
    voxels.runs = renumbered_runs(&voxels.runs, |number| numbers[usize::from(number)]);
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

/// Drawing of a body of a scene.
pub struct Taken {
    /// The drawing.
    pub drawing: Drawing,
    /// Edge length of a cell [m], by which the body keeps its size.
    pub cell: f32,
}

/// Brings a body of a scene to the paper. Its materials are added to the palette; one for which the palette has no space
/// becomes the first crayon. `None` if the scene has no such body.
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
    let numbers = numbers_in(palette, &scene.material, grid);
    let grid = grid_with(grid, |material| numbers[usize::from(material)]);
    let (drawing, scale) = Drawing::of_grid_scaled(&grid);
    let cell = grid.voxel_size() * scale;
    Ok(Some(Taken { drawing, cell }))
}

/// Returns the number in the palette of each material that a grid uses. 1 for a material that is unknown or has no space.
fn numbers_in<D: Dim>(
    palette: &mut Palette,
    materials: &[MaterialText],
    grid: &VoxelGrid<D>,
) -> [u8; 256] {
    let used: BTreeSet<u8> = grid.voxels().map(|voxel| grid.material(voxel)).collect();
    let mut numbers = [1; 256];
    for number in used {
        let place = usize::from(number).checked_sub(1);
        let material = place.and_then(|place| materials.get(place));
        let known = material.and_then(|material| palette.number_of(material));
        numbers[usize::from(number)] = known.unwrap_or(1);
    }
    numbers
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
    use fuwafuwa_scenes::scene::Form;
    use tamaire_play::playground::Stuff;

    fn blank(dim: u8) -> Scene {
        Scene::read("blank", &format!("dim = {dim}\nmaterial = []"), &[]).unwrap()
    }

    fn coloured(red: u8) -> MaterialText {
        MaterialText {
            colour: Some([red, 0, 0]),
            ..crayon(Stuff::Jelly)
        }
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
    fn redrawn_body_with_an_empty_margin_keeps_its_size() {
        let mut scene = blank(2);
        scene.material.push(crayon(Stuff::Jelly));
        // A square of 30 voxels with a margin of 30 below and on the left, and 40 above and on the right.
        let rows = ["30x0 30x1 40x0"; 30].join(" ");
        scene.body.push(BodyText {
            voxels: Some(VoxelsText {
                size: [100, 100, 1],
                voxel_size: 0.01,
                runs: format!("3000x0 {rows} 4000x0"),
                surface: None,
            }),
            ..BodyText::default()
        });
        let taken = take(&scene, 0, &mut Palette::default()).unwrap().unwrap();
        assert_eq!(taken.drawing.solid_count(), 900);
        assert!((taken.cell - 0.01).abs() < 1e-6, "{}", taken.cell);
    }

    #[test]
    fn taken_body_adds_only_the_materials_that_it_uses() {
        let mut scene = blank(2);
        scene.material = (1..=200).map(coloured).collect();
        scene.body.push(BodyText {
            shape: Some(Form::Box),
            n: Some(8),
            material: Some(7),
            ..BodyText::default()
        });
        let mut palette = Palette::default();
        take(&scene, 0, &mut palette).unwrap().unwrap();
        let known = palette.materials();
        assert_eq!(known.len(), Stuff::ALL.len() + 1);
        assert_eq!(known.last(), Some(&coloured(7)));
    }

    #[test]
    fn drawing_without_space_for_it_changes_nothing() {
        let mut drawing = Drawing::paper();
        let middle = Vec3::new(32.0, 32.0, 0.5);
        drawing.stroke(middle, middle, 4.0, Brush::Draw(Stuff::Clay.number()));
        drawing.end_stroke();
        let (palette, place) = (Palette::default(), (Vec3::ZERO, None));
        let mut many_materials = blank(2);
        many_materials.material = (1..=u8::MAX).map(coloured).collect();
        let mut many_bodies = blank(2);
        many_bodies.body = vec![BodyText::default(); MAX_BODIES];
        for mut scene in [many_materials, many_bodies] {
            let before = scene.clone();
            assert_eq!(put(&mut scene, None, &drawing, &palette, place), None);
            assert!(scene == before);
        }
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

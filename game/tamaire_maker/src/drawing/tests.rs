use super::*;
use fastrand::Rng;
use fuwafuwa::{Dim2, Dim3, Vec3, World};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{BodyText, Form};

const FORMS: [Form; 6] = [
    Form::Ball,
    Form::Box,
    Form::Ring,
    Form::Heart,
    Form::Flower,
    Form::Empty,
];
const CRAYONS: u8 = 6;

fn blank(is_paper: bool) -> Drawing {
    match is_paper {
        true => Drawing::paper(),
        false => Drawing::block(),
    }
}

/// Returns a random point in the drawing or less than 4 cells outside.
fn point(drawing: &Drawing, rng: &mut Rng) -> Vec3 {
    let size = Vec3::from(drawing.size().map(|extent| extent as f32));
    let share = Vec3::new(rng.f32(), rng.f32(), rng.f32());
    share * (size + 8.0) - 4.0
}

fn brush(rng: &mut Rng) -> Brush {
    match rng.u8(0..6) {
        0 => Brush::Paint(rng.u8(0..=CRAYONS)),
        1 => Brush::Erase,
        _ => Brush::Draw(rng.u8(1..=CRAYONS)),
    }
}

/// Draws a polygonal line.
fn scribble(drawing: &mut Drawing, brush: Brush, rng: &mut Rng) {
    let start = point(drawing, rng);
    let radius = 0.5 + 2.5 * rng.f32();
    let mut from = start;
    for _ in 0..rng.u8(1..6) {
        let to = point(drawing, rng);
        drawing.stroke(from, to, radius, brush);
        from = to;
    }
    if rng.bool() {
        drawing.stroke(from, start, radius, brush);
    }
}

/// Makes a change with a random tool.
fn change(drawing: &mut Drawing, rng: &mut Rng) {
    drawing.set_mirror(rng.u8(0..4) == 0);
    drawing.set_closes(rng.u8(0..4) != 0);
    match rng.u8(0..12) {
        0 => drawing.clear(),
        1..4 => {
            let at = drawing
                .size()
                .map(|extent| rng.i32(-1..extent as i32 + 1).max(0));
            drawing.fill(at, rng.u8(0..=CRAYONS));
        }
        4..6 => {
            let (form, centre) = (FORMS[rng.usize(0..6)], point(drawing, rng));
            let width = 20.0 * rng.f32();
            drawing.stamp(form, centre, width, rng.u8(0..=CRAYONS));
        }
        _ => {
            scribble(drawing, brush(rng), rng);
            drawing.end_stroke();
        }
    }
}

fn random_drawing(is_paper: bool, rng: &mut Rng) -> Drawing {
    let mut drawing = blank(is_paper);
    while drawing.is_empty() {
        (0..rng.u8(1..8)).for_each(|_| change(&mut drawing, rng));
    }
    drawing
}

/// Returns a drawing of which a share of the cells is solid.
fn noise(size: [usize; 3], share: f32, rng: &mut Rng) -> Drawing {
    let cells = (0..size.iter().product()).map(|_| match rng.f32() < share {
        true => rng.u8(1..=CRAYONS),
        false => 0,
    });
    Drawing::of_cells(size, cells.collect()).unwrap()
}

fn small_size(is_paper: bool, rng: &mut Rng) -> [usize; 3] {
    let depth = if is_paper { 1 } else { rng.usize(2..9) };
    [rng.usize(1..12), rng.usize(1..12), depth]
}

fn all_points(size: [usize; 3]) -> Vec<[i32; 3]> {
    points_in([0; 3], size.map(|extent| extent as i32 - 1)).collect()
}

/// Returns the cells at the faces of a cell, inside or outside.
fn around(drawing: &Drawing, at: [i32; 3]) -> Vec<[i32; 3]> {
    let axes = if drawing.size()[2] == 1 { 2 } else { 3 };
    let mut found = Vec::new();
    for axis in 0..axes {
        for step in [-1, 1] {
            let mut next = at;
            next[axis] += step;
            found.push(next);
        }
    }
    found
}

fn is_inside(drawing: &Drawing, at: [i32; 3]) -> bool {
    (0..3).all(|axis| at[axis] >= 0 && at[axis] < drawing.size()[axis] as i32)
}

/// Returns the cells of a region by sweeps over all cells until nothing changes.
fn swept(
    drawing: &Drawing,
    is_start: impl Fn([i32; 3]) -> bool,
    passes: impl Fn([i32; 3]) -> bool,
) -> Vec<bool> {
    let points = all_points(drawing.size());
    let mut region = vec![false; points.len()];
    loop {
        let mut is_changed = false;
        let sweep = (0..points.len()).chain((0..points.len()).rev());
        for index in sweep {
            let at = points[index];
            if region[index] || !passes(at) {
                continue;
            }
            let is_next = |next: &[i32; 3]| {
                is_inside(drawing, *next) && region[drawing.lattice.index(*next).unwrap()]
            };
            if is_start(at) || around(drawing, at).iter().any(is_next) {
                region[index] = true;
                is_changed = true;
            }
        }
        if !is_changed {
            return region;
        }
    }
}

fn swept_outside(drawing: &Drawing) -> Vec<bool> {
    let is_border = |at| {
        around(drawing, at)
            .iter()
            .any(|&next| !is_inside(drawing, next))
    };
    swept(drawing, is_border, |at| drawing.cell(at) == 0)
}

#[test]
fn history_visits_the_states_of_a_list_after_random_tools() {
    let mut rng = Rng::with_seed(1);
    for (is_paper, count) in [(true, 1000), (false, 200)] {
        for _ in 0..count {
            let mut drawing = blank(is_paper);
            let (mut states, mut now) = (vec![drawing.cells().to_vec()], 0usize);
            for _ in 0..rng.u8(4..12) {
                match rng.u8(0..6) {
                    0 => {
                        assert_eq!(drawing.undo(), now > 0);
                        now = now.saturating_sub(1);
                    }
                    1 => {
                        assert_eq!(drawing.redo(), now + 1 < states.len());
                        now = (now + 1).min(states.len() - 1);
                    }
                    _ => {
                        change(&mut drawing, &mut rng);
                        if drawing.cells() != states[now] {
                            states.truncate(now + 1);
                            states.push(drawing.cells().to_vec());
                            now += 1;
                        }
                    }
                }
                assert!(drawing.cells() == states[now]);
                assert_eq!(drawing.can_undo(), now > 0);
                assert_eq!(drawing.can_redo(), now + 1 < states.len());
            }
            for expected in states[..now].iter().rev() {
                assert!(drawing.undo() && drawing.cells() == expected);
            }
            assert!(drawing.is_empty() && !drawing.undo());
            for expected in &states[1..] {
                assert!(drawing.redo() && drawing.cells() == expected);
            }
            assert!(!drawing.redo());
        }
    }
}

#[test]
fn undo_ends_a_stroke_and_takes_it_back() {
    let mut drawing = Drawing::paper();
    drawing.stroke(Vec3::splat(9.0), Vec3::splat(20.0), 2.0, Brush::Draw(3));
    let drawn = drawing.clone();
    assert!(drawing.can_undo() && drawing.undo() && drawing.is_empty());
    assert!(drawing.redo() && drawing == drawn && !drawing.can_redo());
}

fn built<D: Dim>(voxels: VoxelsText) -> World<D> {
    let young = (1..=CRAYONS).map(|number| format!("[[material]]\nyoung = {number}000.0\n"));
    let text = format!("dim = {}\n{}", D::N, young.collect::<String>());
    let mut scene = Scene::read("drawing", &text, &[]).unwrap();
    scene.body.push(BodyText {
        voxels: Some(voxels),
        ..BodyText::default()
    });
    let scene = Scene::read("again", &scene.text().unwrap(), &[]).unwrap();
    scene.build().unwrap()
}

fn check_voxels<D: Dim>(drawing: &Drawing) {
    let (voxels, low) = drawing.voxels(0.01).unwrap();
    let world = built::<D>(voxels);
    let (_, body) = world.soft_bodies().next().unwrap();
    let grid = body.grid();
    assert_eq!(grid.voxel_size(), 0.01);
    for at in all_points(drawing.size()) {
        let voxel = [0, 1, 2].map(|axis: usize| at[axis] - low[axis] as i32);
        assert_eq!(drawing.cell(at), grid.material(voxel), "{at:?}");
    }
    let again = Drawing::of_grid(grid);
    assert_eq!(again.size(), drawing.size());
    let [low, high] = again.bounds().unwrap();
    for axis in 0..3 {
        let margins = low[axis].abs_diff(again.size()[axis] - 1 - high[axis]);
        assert!(margins <= 1, "in the middle");
    }
    assert_eq!(
        again.voxels(0.01).unwrap().0,
        drawing.voxels(0.01).unwrap().0
    );
}

#[test]
fn voxels_come_back_from_the_world_of_a_scene() {
    let mut rng = Rng::with_seed(2);
    (0..1000).for_each(|_| check_voxels::<Dim2>(&random_drawing(true, &mut rng)));
    (0..200).for_each(|_| check_voxels::<Dim3>(&random_drawing(false, &mut rng)));
    assert!(Drawing::paper().voxels(0.01).is_none());
}

#[test]
fn stroke_changes_cells_near_its_line() {
    let mut rng = Rng::with_seed(3);
    for is_paper in [true, false] {
        for _ in 0..30 {
            let mut drawing = blank(is_paper);
            drawing.set_mirror(rng.bool());
            let [mut from, mut to] = [0, 1].map(|_| point(&drawing, &mut rng));
            let radius = 1.0 + 3.0 * rng.f32();
            drawing.stroke(from, to, radius, Brush::Draw(2));
            if is_paper {
                (from.z, to.z) = (0.5, 0.5);
            }
            let line: Vec<Vec3> = (0..=300).map(|k| from.lerp(to, k as f32 / 300.0)).collect();
            let distance = |at: Vec3| {
                let distances = line.iter().map(|point| point.distance(at));
                distances.fold(f32::INFINITY, f32::min)
            };
            let width = drawing.size()[0] as f32;
            for at in all_points(drawing.size()) {
                let centre = Vec3::from(at.map(|k| k as f32 + 0.5));
                let image = Vec3::new(width - centre.x, centre.y, centre.z);
                let apart = match drawing.mirror() {
                    true => distance(centre).min(distance(image)),
                    false => distance(centre),
                };
                if (apart - radius).abs() > 0.01 {
                    assert_eq!(drawing.cell(at) == 2, apart < radius, "{at:?}");
                }
            }
        }
    }
}

#[test]
fn thinnest_stroke_has_no_gaps() {
    let mut rng = Rng::with_seed(4);
    for is_paper in [true, false] {
        for _ in 0..100 {
            let mut drawing = blank(is_paper);
            let high = Vec3::from(drawing.size().map(|extent| extent as f32));
            let [from, to] = [0, 1].map(|_| point(&drawing, &mut rng).clamp(Vec3::ZERO, high));
            assert!(drawing.stroke(from, to, 0.0, Brush::Draw(1)));
            assert_eq!(drawing.pieces().count, 1, "{from} {to}");
        }
    }
}

#[test]
fn brushes_change_solid_and_empty_cells_as_they_say() {
    let mut drawing = Drawing::block();
    let middle = Vec3::splat(16.0);
    assert!(!drawing.stroke(middle, middle, 5.0, Brush::Paint(2)));
    assert!(!drawing.stroke(middle, middle, 5.0, Brush::Erase));
    assert!(drawing.stroke(middle, middle, 5.0, Brush::Draw(1)));
    assert!(!drawing.stroke(middle, middle, 5.0, Brush::Draw(1)));
    let solid = drawing.solid_count();
    assert!(drawing.stroke(middle, middle, 9.0, Brush::Paint(2)));
    assert_eq!(drawing.solid_count(), solid);
    assert!(drawing.cells().iter().all(|&cell| cell == 0 || cell == 2));
    assert!(drawing.stroke(middle, middle, 9.0, Brush::Erase) && drawing.is_empty());
}

/// Adds a hollow ball with a hole. Returns the place of the hole.
fn pierce_ball(drawing: &mut Drawing, rng: &mut Rng) -> Vec3 {
    let middle = Vec3::splat(16.0);
    let way = (point(drawing, rng) - middle).normalize_or(Vec3::Y);
    drawing.set_mirror(false);
    drawing.stamp(Form::Ball, middle, 22.0, 1);
    drawing.stroke(middle, middle, 7.0, Brush::Erase);
    drawing.stroke(middle, middle + 30.0 * way, 3.0, Brush::Erase);
    drawing.end_stroke();
    middle + 9.0 * way
}

#[test]
fn end_of_stroke_fills_what_a_sweep_finds_enclosed() {
    let mut rng = Rng::with_seed(5);
    for (is_paper, count) in [(true, 60), (false, 15)] {
        let mut filled = 0;
        for _ in 0..count {
            let (closes, crayon) = (rng.u8(0..4) != 0, rng.u8(1..=CRAYONS));
            let mut drawing = random_drawing(is_paper, &mut rng);
            let plug = (!is_paper).then(|| pierce_ball(&mut drawing, &mut rng));
            drawing.set_mirror(false);
            drawing.set_closes(closes);
            let before = swept_outside(&drawing);
            match plug {
                Some(plug) => _ = drawing.stroke(plug, plug, 4.5, Brush::Draw(crayon)),
                None => scribble(&mut drawing, Brush::Draw(crayon), &mut rng),
            }
            let now = swept_outside(&drawing);
            let mut expected = drawing.cells().to_vec();
            for (index, cell) in expected.iter_mut().enumerate() {
                if closes && *cell == 0 && before[index] && !now[index] {
                    *cell = crayon;
                    filled += 1;
                }
            }
            drawing.end_stroke();
            assert!(drawing.cells() == expected);
        }
        assert!(filled > 0, "some strokes enclose cells");
    }
}

#[test]
fn sphere_of_strokes_in_space_is_filled() {
    let mut drawing = Drawing::block();
    let middle = Vec3::splat(16.0);
    drawing.stroke(middle, middle, 9.0, Brush::Draw(1));
    drawing.stroke(middle, middle, 6.0, Brush::Erase);
    let top = middle + 5.0 * Vec3::Y;
    drawing.stroke(top, top + 9.0 * Vec3::Y, 2.0, Brush::Erase);
    drawing.end_stroke();
    let open = drawing.solid_count();
    let plug = middle + 7.5 * Vec3::Y;
    drawing.stroke(plug, plug, 3.0, Brush::Draw(2));
    drawing.end_stroke();
    assert_eq!(drawing.cell([16; 3]), 2);
    let ball = all_points([BLOCK; 3]).into_iter().filter(|at| {
        let centre = Vec3::from(at.map(|k| k as f32 + 0.5));
        centre.distance(middle) <= 9.0
    });
    assert!(ball.clone().all(|at| drawing.cell(at) != 0));
    assert!(drawing.undo() && drawing.solid_count() == open);
}

#[test]
fn fill_changes_the_region_of_a_sweep() {
    let mut rng = Rng::with_seed(6);
    let [mut filled, mut refused] = [0, 0];
    for k in 0..600 {
        let size = small_size(k % 2 == 0, &mut rng);
        let mut drawing = noise(size, 0.5 + 0.5 * rng.f32(), &mut rng);
        let at = size.map(|extent| rng.i32(0..extent as i32));
        let (known, crayon) = (drawing.cell(at), rng.u8(0..=CRAYONS));
        let region = swept(
            &drawing,
            |cell| cell == at,
            |cell| drawing.cell(cell) == known,
        );
        let outside = swept_outside(&drawing);
        let is_open = outside[drawing.lattice.index(at).unwrap()];
        let before = drawing.clone();
        let is_filled = drawing.fill(at, crayon);
        assert_eq!(is_filled, !is_open && crayon != known);
        for (index, &cell) in drawing.cells().iter().enumerate() {
            match is_filled && region[index] {
                true => assert_eq!(cell, crayon),
                false => assert_eq!(cell, before.cells()[index]),
            }
        }
        assert_eq!(drawing.undo(), is_filled);
        assert!(drawing == before);
        filled += usize::from(is_filled && known == 0);
        refused += usize::from(is_open);
    }
    assert!(filled > 0 && refused > 0);
    assert!(!Drawing::paper().fill([0, -1, 0], 1) && !Drawing::paper().fill([i32::MAX; 3], 1));
}

#[test]
fn stamp_is_the_shape_of_the_engine_around_its_centre() {
    for n in [7, 8, 20] {
        let mut paper = Drawing::paper();
        assert!(paper.stamp(Form::Heart, Vec3::new(20.0, 30.0, 0.0), n as f32, 4));
        let heart = VoxelGrid::<Dim2>::heart(n, 1.0).unwrap();
        assert_eq!(paper.solid_count(), heart.solid_count());
        let low = [20, 30].map(|k: i32| (k as f32 - 0.5 * n as f32).round() as i32);
        for voxel in heart.voxels() {
            let at = [low[0] + voxel[0], low[1] + voxel[1], 0];
            assert_eq!(paper.cell(at), 4 * heart.material(voxel));
        }
        let mut block = Drawing::block();
        block.set_mirror(true);
        assert!(block.stamp(Form::Ring, Vec3::new(6.0, 16.0, 16.0), n as f32, 1));
        for [x, y, z] in all_points([BLOCK; 3]) {
            assert_eq!(block.cell([x, y, z]), block.cell([31 - x, y, z]));
        }
        assert!(block.undo() && block.is_empty());
    }
}

#[test]
fn odd_input_does_nothing() {
    let mut rng = Rng::with_seed(7);
    for is_paper in [true, false] {
        let mut drawing = random_drawing(is_paper, &mut rng);
        let before = drawing.clone();
        let good = Vec3::splat(5.0);
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let odd = Vec3::new(5.0, bad, 5.0);
            assert!(!drawing.stroke(odd, good, 3.0, Brush::Draw(9)));
            assert!(!drawing.stroke(good, odd, 3.0, Brush::Draw(9)));
            assert!(!drawing.stroke(good, good, bad, Brush::Draw(9)));
            assert!(!drawing.stamp(Form::Ball, odd, 3.0, 9));
            assert!(!drawing.stamp(Form::Ball, good, bad, 9));
            assert!(drawing.hit(odd, good).is_none() && drawing.hit(good, odd).is_none());
            assert!(drawing.floor_hit(odd, good).is_none());
        }
        let far = Vec3::splat(f32::MAX);
        for mirror in [false, true] {
            drawing.set_mirror(mirror);
            assert!(!drawing.stroke(far, far, 3.0, Brush::Draw(9)));
            assert!(!drawing.stamp(Form::Box, far, 3.0, 9));
            assert!(!drawing.stamp(Form::Box, -far, 3.0, 9));
        }
        assert!(!drawing.stamp(Form::Ball, good, 0.0, 9));
        assert!(!drawing.stamp(Form::Empty, good, 9.0, 9));
        assert!(drawing.hit(good, Vec3::ZERO).is_none());
        drawing.hit(-far, far);
        drawing.hit(far, Vec3::splat(-f32::MIN_POSITIVE));
        assert!(drawing == before);
        assert!(drawing.stroke(-far, far, f32::MAX, Brush::Draw(9)));
        assert_eq!(drawing.solid_count(), drawing.cells().len());
    }
    assert!(Drawing::of_cells([0, 1, 1], Vec::new()).is_none());
    assert!(Drawing::of_cells([usize::MAX; 3], Vec::new()).is_none());
    assert!(Drawing::of_cells([65, 1, 1], vec![0; 65]).is_none());
    assert!(Drawing::of_cells([2, 2, 2], vec![0; 7]).is_none());
    assert!(Drawing::of_cells([2, 2, 2], vec![0; 8]).is_some());
}

/// Returns the root of a cell in a forest.
fn root(parents: &mut [usize], mut index: usize) -> usize {
    while parents[index] != index {
        parents[index] = parents[parents[index]];
        index = parents[index];
    }
    index
}

#[test]
fn pieces_are_those_of_union_find() {
    let mut rng = Rng::with_seed(8);
    for k in 0..300 {
        let size = small_size(k % 2 == 0, &mut rng);
        let drawing = noise(size, rng.f32(), &mut rng);
        let points = all_points(size);
        let mut parents: Vec<usize> = (0..points.len()).collect();
        for (index, &at) in points.iter().enumerate() {
            for next in around(&drawing, at) {
                if drawing.cell(at) != 0 && drawing.cell(next) != 0 {
                    let next = drawing.lattice.index(next).unwrap();
                    let (a, b) = (root(&mut parents, index), root(&mut parents, next));
                    parents[a.max(b)] = a.min(b);
                }
            }
        }
        // The root of a set is its first cell, so roots and pieces have the same order.
        let (mut roots, mut expected) = (Vec::new(), Vec::new());
        for index in 0..points.len() {
            let is_solid = drawing.cells()[index] != 0;
            let root = root(&mut parents, index);
            if is_solid && root == index {
                roots.push(root);
            }
            let number = roots.iter().position(|&known| known == root);
            expected.push(number.map_or(0, |number| number as u16 + 1));
        }
        let pieces = drawing.pieces();
        assert_eq!(pieces.of_cell, expected);
        assert_eq!(pieces.count, roots.len());
    }
}

#[test]
fn thin_cells_are_in_no_solid_block_of_two() {
    let mut rng = Rng::with_seed(9);
    for k in 0..200 {
        let size = small_size(k % 2 == 0, &mut rng);
        let drawing = noise(size, 0.4 + 0.6 * rng.f32(), &mut rng);
        let expected = all_points(size).into_iter().map(|at| {
            let corners = if size[2] == 1 { 4 } else { 8 };
            let bits = |number: i32| [number & 1, number >> 1 & 1, number >> 2 & 1];
            let sum = |a: [i32; 3], b: [i32; 3]| [0, 1, 2].map(|axis: usize| a[axis] + b[axis]);
            let is_in_block = (0..corners).any(|place| {
                let low = sum(at, bits(place).map(|k| -k));
                (0..corners).all(|corner| drawing.cell(sum(low, bits(corner))) != 0)
            });
            drawing.cell(at) != 0 && !is_in_block
        });
        assert_eq!(drawing.thin_cells(), expected.collect::<Vec<bool>>());
    }
}

#[test]
fn bounds_enclose_the_solid_cells() {
    let mut rng = Rng::with_seed(10);
    for k in 0..200 {
        let drawing = noise(small_size(k % 2 == 0, &mut rng), 0.05, &mut rng);
        let points = all_points(drawing.size());
        let solid = points.iter().filter(|&&at| drawing.cell(at) != 0);
        let on_axis = |axis: usize| solid.clone().map(move |at| at[axis] as usize);
        let expected = (!drawing.is_empty()).then(|| {
            [
                [0, 1, 2].map(|axis| on_axis(axis).min().unwrap()),
                [0, 1, 2].map(|axis| on_axis(axis).max().unwrap()),
            ]
        });
        assert_eq!(drawing.bounds(), expected);
    }
}

/// Returns the small drawing and the block cell of its low corner.
fn small_in_block(drawing: &Drawing) -> (Drawing, [i32; 3]) {
    let small = drawing.small().unwrap();
    let [width, height, _] = small.size().map(|extent| extent as i32);
    (small, [(32 - width) / 2, (32 - height) / 2, 16])
}

#[test]
fn puffed_drawing_is_symmetric_about_the_scaled_drawing() {
    let mut rng = Rng::with_seed(11);
    for _ in 0..150 {
        let paper = random_drawing(true, &mut rng);
        let puffed = paper.puffed();
        let (small, low) = small_in_block(&paper);
        assert_eq!(puffed.size(), [BLOCK; 3]);
        for [x, y, z] in all_points([BLOCK; 3]) {
            let cell = puffed.cell([x, y, z]);
            let sheet = small.cell([x - low[0], y - low[1], 0]);
            assert_eq!(cell, puffed.cell([x, y, 31 - z]), "symmetric");
            assert!(cell == 0 || cell == sheet, "the crayon keeps its place");
            if z == 16 {
                assert_eq!(cell, sheet, "the middle");
            } else if z > 16 && cell != 0 {
                assert_ne!(puffed.cell([x, y, z - 1]), 0, "columns have no holes");
            }
        }
        assert!(puffed.puffed() == puffed);
    }
    assert!(Drawing::paper().puffed() == Drawing::block());
}

#[test]
fn rim_distance_is_that_of_the_nearest_empty_cell() {
    let mut rng = Rng::with_seed(12);
    for _ in 0..100 {
        let size = small_size(true, &mut rng);
        let drawing = noise(size, 0.95, &mut rng);
        let high = size.map(|extent| extent as i32);
        let empty: Vec<[i32; 3]> = points_in([-1, -1, 0], [high[0], high[1], 0])
            .filter(|&at| drawing.cell(at) == 0)
            .collect();
        let distances = all_points(size).into_iter().map(|at| {
            let point = |at: [i32; 3]| Vec3::from(at.map(|k| k as f32));
            let all = empty.iter().map(|&other| point(other).distance(point(at)));
            (all.fold(f32::INFINITY, f32::min) - 0.5).max(0.0)
        });
        for (found, expected) in drawing.rim_distances().into_iter().zip(distances) {
            assert!((found - expected).abs() < 1e-4, "{found} {expected}");
        }
    }
}

#[test]
fn puffed_disc_is_a_ball() {
    let mut paper = Drawing::paper();
    let centre = Vec3::new(20.0, 40.0, 0.0);
    paper.stroke(centre, centre, 12.0, Brush::Draw(1));
    let puffed = paper.puffed();
    let ball = 4.0 / 3.0 * std::f32::consts::PI * 12.0f32.powi(3);
    let share = puffed.solid_count() as f32 / ball;
    assert!((0.9..1.15).contains(&share), "{share}");
    let [low, high] = puffed.bounds().unwrap();
    for axis in 0..3 {
        let width = high[axis] - low[axis] + 1;
        assert!((22..=25).contains(&width), "{width} on axis {axis}");
    }
}

#[test]
fn lathed_drawing_equals_itself_turned_by_a_quarter() {
    let mut rng = Rng::with_seed(13);
    for _ in 0..150 {
        let paper = random_drawing(true, &mut rng).completed();
        let lathed = paper.lathed();
        let (small, low) = small_in_block(&paper);
        let width = small.size()[0] as i32;
        // Twice the coordinate of the axis, from the centre of the first cell.
        let doubled = 2 * low[0] + width - 1;
        for [x, y, z] in all_points([BLOCK; 3]) {
            let turned = [z, y, doubled - x];
            assert_eq!(lathed.cell([x, y, z]), lathed.cell(turned), "{x} {y} {z}");
        }
        // In the plane of the axis of an odd width, the right half is the drawing itself.
        for [x, y, _] in all_points(small.size()) {
            if width % 2 == 1 && 2 * x + 1 >= width && small.cell([x, y, 0]) != 0 {
                let at = [low[0] + x, low[1] + y, doubled / 2];
                assert_eq!(lathed.cell(at), small.cell([x, y, 0]));
            }
        }
        assert!(!lathed.is_empty());
    }
    assert!(Drawing::paper().lathed().is_empty());
}

#[test]
fn narrow_drawings_do_not_vanish_on_the_lathe() {
    for width in 1..4 {
        let line = Drawing::of_cells([width, 9, 1], vec![1; 9 * width]).unwrap();
        let [low, high] = line.lathed().bounds().unwrap();
        assert_eq!(high[0] - low[0] + 1, width);
        assert_eq!(high[1] - low[1] + 1, 9);
    }
}

#[test]
fn slab_repeats_the_scaled_drawing() {
    let mut rng = Rng::with_seed(14);
    for thickness in [0, 1, 2, 7, 32, usize::MAX] {
        let paper = random_drawing(true, &mut rng);
        let slab = paper.slab(thickness);
        let (small, low) = small_in_block(&paper);
        let layers = (0..32).filter(|&z| {
            let is_sheet = |[x, y, _]: [i32; 3]| {
                slab.cell([x, y, z]) == small.cell([x - low[0], y - low[1], 0])
            };
            all_points([BLOCK, BLOCK, 1]).into_iter().all(is_sheet)
        });
        let layers: Vec<i32> = layers.collect();
        let count = thickness.clamp(1, 32);
        assert_eq!(layers.len(), count);
        assert_eq!(slab.solid_count(), count * small.solid_count());
        assert_eq!(layers[count - 1] - layers[0] + 1, count as i32, "one plate");
        assert!(
            (31 - layers[count - 1]).abs_diff(layers[0]) <= 1,
            "in the middle"
        );
    }
}

#[test]
fn reduced_cells_are_the_majority_of_what_they_cover() {
    let mut rng = Rng::with_seed(15);
    for k in 0..100 {
        let to = small_size(k % 2 == 0, &mut rng);
        let factor = [2, 3, if to[2] == 1 { 1 } else { 2 }];
        let from = [0, 1, 2].map(|axis: usize| to[axis] * factor[axis]);
        let cells: Vec<u8> = (0..from.iter().product())
            .map(|_| rng.u8(0..8).saturating_sub(4))
            .collect();
        let cell = |[x, y, z]: [usize; 3]| cells[x + from[0] * (y + from[1] * z)];
        let found = shrink::sampled(from, to, cell);
        let mut counts = Vec::new();
        for at in all_points(to) {
            let mut count = [0; 8];
            for offset in all_points(factor) {
                let old = [0, 1, 2]
                    .map(|axis: usize| (at[axis] * factor[axis] as i32 + offset[axis]) as usize);
                count[usize::from(cell(old))] += 1;
            }
            counts.push(count);
        }
        let solid = |count: &[i32; 8]| count[1..].iter().sum::<i32>();
        let fullest = counts.iter().map(solid).max().unwrap();
        let third = factor.iter().product::<usize>() as f32 / 3.0 - 0.01;
        let least = third.min(fullest as f32);
        for (&crayon, count) in found.iter().zip(&counts) {
            let is_solid = solid(count) > 0 && solid(count) as f32 >= least;
            assert_eq!(crayon != 0, is_solid);
            if is_solid {
                let most = count[1..].iter().max();
                assert_eq!(Some(&count[usize::from(crayon)]), most);
            }
        }
    }
}

#[test]
fn reduced_lines_do_not_vanish() {
    let mut rng = Rng::with_seed(16);
    for _ in 0..60 {
        let mut paper = Drawing::paper();
        let turn = std::f32::consts::TAU * rng.f32();
        let arm = 31.0 * Vec3::new(turn.cos(), turn.sin(), 0.0);
        let centre = Vec3::new(32.0, 32.0, 0.0);
        paper.stroke(centre - arm, centre + arm, 0.75, Brush::Draw(1));
        let small = paper.small().unwrap();
        let size = small.size();
        assert_eq!(size[0].max(size[1]), 30);
        let along = usize::from(size[1] > size[0]);
        for k in 0..30 {
            let is_on_line = |at: &[i32; 3]| at[along] == k && small.cell(*at) != 0;
            assert!(all_points(size).iter().any(is_on_line), "{turn}");
        }
    }
}

#[test]
fn large_grid_is_reduced_to_the_paper_or_block() {
    let disc = VoxelGrid::<Dim2>::ball(200, 1.0).unwrap();
    let paper = Drawing::of_grid(&disc);
    assert_eq!(paper.size(), [PAPER, PAPER, 1]);
    let expected = std::f32::consts::PI * 32.0f32.powi(2);
    assert!((paper.solid_count() as f32 / expected - 1.0).abs() < 0.05);
    for [x, y, _] in all_points(paper.size()) {
        assert_eq!(paper.cell([x, y, 0]), paper.cell([63 - x, 63 - y, 0]));
        assert_eq!(paper.cell([x, y, 0]), paper.cell([y, x, 0]));
    }
    let ring = VoxelGrid::<Dim3>::ring(70, 1.0).unwrap();
    let block = Drawing::of_grid(&ring);
    let [low, high] = block.bounds().unwrap();
    assert_eq!((low[0], high[0], low[1], high[1]), (0, 31, 0, 31));
    assert!(
        (7..=9).contains(&(high[2] - low[2] + 1)),
        "keeps its proportions"
    );
    assert_eq!(block.cell([16; 3]), 0, "keeps its hole");
    let line = VoxelGrid::<Dim3>::from_fn([1, 900, 1], 1.0, |_| 7).unwrap();
    assert_eq!(Drawing::of_grid(&line).solid_count(), 32);
}

/// Returns the range of positions at which a ray is in a cell.
fn crossing(origin: Vec3, direction: Vec3, at: [i32; 3]) -> Option<f64> {
    let (mut first, mut last) = (0.0f64, f64::INFINITY);
    for axis in 0..3 {
        let (o, d) = (f64::from(origin[axis]), f64::from(direction[axis]));
        let ends = [0, 1].map(|k| (f64::from(at[axis] + k) - o) / d);
        first = first.max(ends[0].min(ends[1]));
        last = last.min(ends[0].max(ends[1]));
    }
    (first <= last).then_some(first)
}

#[test]
fn hit_is_the_first_solid_cell_of_a_march() {
    let mut rng = Rng::with_seed(17);
    let [mut hits, mut misses] = [0, 0];
    for k in 0..300 {
        let drawing = match k % 3 {
            0 => random_drawing(k % 2 == 0, &mut rng),
            _ => noise(small_size(false, &mut rng), 0.3 * rng.f32(), &mut rng),
        };
        let points = all_points(drawing.size());
        let solid = points.into_iter().filter(|&at| drawing.cell(at) != 0);
        let solid: Vec<[i32; 3]> = solid.collect();
        for _ in 0..10 {
            let origin = match rng.bool() {
                true => point(&drawing, &mut rng),
                false => 2.0 * point(&drawing, &mut rng) - 10.0,
            };
            let mut direction = point(&drawing, &mut rng) - origin;
            direction[0] += 1e-3 * f32::from(direction[0].abs() < 1e-3);
            let length = direction.length();
            let nearest = { solid.iter() }.filter_map(|&at| crossing(origin, direction, at));
            let nearest = nearest.min_by(f64::total_cmp);
            let hit = drawing.hit(origin, direction);
            assert_eq!(hit.is_some(), nearest.is_some());
            let until = hit.map_or(200.0, |hit| hit.point.distance(origin) - 0.01);
            for step in 0..(until / 0.02) as usize {
                let sample = origin + direction * (0.02 * step as f32 / length);
                let cell = sample.to_array().map(|k| k.floor() as i32);
                assert_eq!(drawing.cell(cell), 0, "the march is free before the hit");
            }
            let (Some(hit), Some(nearest)) = (hit, nearest) else {
                misses += 1;
                continue;
            };
            hits += 1;
            assert_ne!(drawing.cell(hit.cell), 0);
            let expected = origin + direction * nearest as f32;
            assert!(hit.point.distance(expected) < 1e-3, "{hit:?} {expected}");
            let low = Vec3::from(hit.cell.map(|k| k as f32));
            let in_cell = hit.point - low;
            assert!(in_cell.cmpge(Vec3::ZERO).all() && in_cell.cmple(Vec3::ONE).all());
            let normal = Vec3::from(hit.normal.map(|k| k as f32));
            match nearest > 0.0 {
                true => {
                    assert!(normal.length() == 1.0 && normal.dot(direction) < 0.0);
                    assert_eq!(in_cell.dot(normal), normal.max(Vec3::ZERO).length());
                }
                false => assert_eq!((normal, hit.point), (Vec3::ZERO, origin)),
            }
        }
    }
    assert!(hits > 400 && misses > 400, "{hits} {misses}");
}

#[test]
fn ray_along_an_axis_hits_face_to_face() {
    let mut drawing = Drawing::block();
    drawing.stamp(Form::Box, Vec3::splat(16.0), 4.0, 1);
    for axis in 0..3 {
        for side in [-1i32, 1] {
            let mut origin = Vec3::splat(16.5);
            origin[axis] += 50.0 * side as f32;
            let mut direction = Vec3::ZERO;
            direction[axis] = -side as f32;
            let hit = drawing.hit(origin, direction).unwrap();
            let mut expected = [16; 3];
            expected[axis] = if side > 0 { 17 } else { 14 };
            assert_eq!(hit.cell, expected);
            assert_eq!(hit.normal[axis], side);
            assert_eq!(hit.point[axis], if side > 0 { 18.0 } else { 14.0 });
            assert!(drawing.hit(origin, -direction).is_none());
        }
    }
}

#[test]
fn floor_hit_is_in_the_middle_plane_of_the_block() {
    let mut rng = Rng::with_seed(18);
    let block = Drawing::block();
    let mut found = 0;
    for _ in 0..500 {
        let origin = 2.0 * point(&block, &mut rng) - 16.0;
        let direction = point(&block, &mut rng) - origin;
        let hit = block.floor_hit(origin, direction);
        // Bisects for the plane, far along the ray.
        let (mut low, mut high) = (0.0f32, 100.0f32);
        let is_before = |k: f32| (origin.z + k * direction.z < 16.0) == (origin.z < 16.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            *(if is_before(middle) {
                &mut low
            } else {
                &mut high
            }) = middle;
        }
        let expected = origin + high * direction;
        let edge = (expected.x - 16.0).abs().max((expected.y - 16.0).abs());
        if high < 99.0 && (edge - 16.0).abs() > 0.05 {
            assert_eq!(hit.is_some(), edge < 16.0, "{origin} {direction}");
        }
        if let Some(hit) = hit {
            found += 1;
            assert_eq!(hit.point.z, 16.0);
            assert!(hit.point.distance(expected) < 0.01);
            assert_eq!(hit.cell[2], 16);
            assert_eq!(hit.normal[2], if origin.z > 16.0 { 1 } else { -1 });
        }
    }
    assert!(found > 50, "{found}");
}

#[test]
fn visible_faces_are_between_solid_and_empty_cells() {
    let mut rng = Rng::with_seed(19);
    for k in 0..100 {
        let drawing = noise(small_size(k % 2 == 0, &mut rng), rng.f32(), &mut rng);
        let faces: Vec<Face> = drawing.visible_faces().collect();
        for face in &faces {
            let at = face.cell.map(|k| k as i32);
            let mut next = at;
            next[face.axis] += if face.is_high { 1 } else { -1 };
            assert!(face.crayon != 0 && drawing.cell(at) == face.crayon);
            assert_eq!(drawing.cell(next), 0);
        }
        let points = all_points(drawing.size());
        let count = points
            .iter()
            .filter(|&&at| drawing.cell(at) != 0)
            .map(|&at| {
                let next = around(&drawing, at).into_iter();
                next.filter(|&next| drawing.cell(next) == 0).count()
            });
        assert_eq!(faces.len(), count.sum::<usize>());
        let mut unique = faces.clone();
        unique.sort_by_key(|face| (face.cell, face.axis, face.is_high));
        unique.dedup();
        assert_eq!(unique.len(), faces.len());
    }
}

#[test]
fn half_an_outline_is_turned_about_the_middle_of_the_paper() {
    let mut half = Drawing::paper();
    half.set_closes(false);
    half.stroke(
        Vec3::new(33.0, 20.0, 0.5),
        Vec3::new(44.0, 20.0, 0.5),
        2.0,
        Brush::Draw(1),
    );
    half.end_stroke();
    let mut whole = half.clone();
    whole.stroke(
        Vec3::new(31.0, 20.0, 0.5),
        Vec3::new(20.0, 20.0, 0.5),
        2.0,
        Brush::Draw(1),
    );
    whole.end_stroke();
    assert_eq!(half.lathed().cells(), whole.lathed().cells());
}

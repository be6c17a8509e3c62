//! The models of a MagicaVoxel file are put together as its scene says, and no scene causes harm.

use crate::damage::{self, Noise};
use crate::vox_file::{
    self, chunk, file, group, layer, model_chunks, shape, size, solid, transform, voxels,
};
use fuwafuwa::{Dim3, VoxelGrid};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::import::{Import, ImportError, Model, vox};
use std::collections::{BTreeMap, HashMap};

fn import(bytes: &[u8]) -> Result<Import<Dim3>, ImportError> {
    vox("test.vox", bytes, 0.25)
}

/// Returns the materials of all solid voxels by their positions on the axes of the file, with the lowest
/// position on each axis at 0.
fn cells(grid: &VoxelGrid<Dim3>) -> BTreeMap<[i32; 3], u8> {
    let depth = grid.size()[2];
    let solid = grid.voxels().filter(|&voxel| grid.is_solid(voxel));
    let on_file = solid.map(|[x, y, z]| ([x, depth - 1 - z, y], grid.material([x, y, z])));
    on_file.collect()
}

fn cells_of(bytes: &[u8]) -> BTreeMap<[i32; 3], u8> {
    cells(&import(bytes).unwrap().grid)
}

fn told(bytes: &[u8]) -> String {
    let notes = import(bytes).unwrap().notes;
    let notes = notes.iter().map(ToString::to_string);
    notes.collect::<Vec<_>>().join("; ")
}

fn refusal(bytes: &[u8]) -> String {
    import(bytes).unwrap_err().to_string()
}

/// Frame with a translation.
fn at(translation: &str) -> Vec<(&str, &str)> {
    vec![("_t", translation)]
}

/// Returns a scene with models of one voxel, with palette indices 1, 2, …, at the given positions.
fn dots(places: &[&str]) -> Vec<u8> {
    let count = places.len() as i32;
    let children: Vec<i32> = (0..count).map(|k| 2 + 2 * k).collect();
    let mut models = Vec::new();
    let mut nodes = [transform(0, 1, -1, &[], &[&[]]), group(1, &[], &children)].concat();
    for (number, place) in (0..count).zip(places) {
        models.extend(model_chunks([1; 3], &[[0, 0, 0, 1 + number as u8]]));
        let id = 2 + 2 * number;
        nodes.extend(transform(id, id + 1, -1, &[], &[&at(place)]));
        nodes.extend(shape(id + 1, &[], &[number]));
    }
    file(200, &[models, nodes])
}

/// A torso of 12 × 6 × 12 with two legs and a hat, which is on a layer of its own.
fn character(hat: &[(&str, &str)], hat_layer: &[(&str, &str)]) -> Vec<Vec<u8>> {
    let parts = [[12, 6, 12], [4, 4, 10], [4, 4, 10], [12, 12, 3]];
    let places = ["0 0 6", "-8 0 6", "8 0 6", "0 0 14"];
    let mut chunks = Vec::new();
    for (index, part) in (1..).zip(parts) {
        chunks.push(model_chunks(
            part.map(u32::from),
            &solid([0; 3], part, index),
        ));
    }
    chunks.push(transform(0, 1, -1, &[], &[&[]]));
    chunks.push(group(1, &[], &[2, 4, 6, 8]));
    for (number, place) in (0..4).zip(places) {
        let (id, name) = (2 + 2 * number, format!("part {number}"));
        let named: &[(&str, &str)] = &[&[("_name", name.as_str())], hat].concat();
        let (named, layer) = if number == 3 {
            (named, 1)
        } else {
            (&named[..1], 0)
        };
        chunks.push(transform(id, id + 1, layer, named, &[&at(place)]));
        chunks.push(shape(id + 1, &[], &[number]));
    }
    chunks.push(layer(0, &[("_name", "body")]));
    chunks.push(layer(1, hat_layer));
    chunks
}

#[test]
fn visible_models_are_put_in_their_places() {
    const HIDDEN: (&str, &str) = ("_hidden", "1");
    // The torso takes x = -6 to 5, y = -3 to 2, z = 0 to 11; the legs take four columns beside it, at
    // y = -2 to 1 and z = 1 to 10; the hat lies on the torso, at x and y = -6 to 5, z = 13 to 15.
    let (torso, leg, hat) = (12 * 6 * 12, 4 * 4 * 10, 12 * 12 * 3);
    let whole = import(&file(150, &character(&[], &[("_hidden", "0")]))).unwrap();
    assert_eq!(whole.grid.size(), [20, 16, 12]);
    assert_eq!(whole.grid.solid_count(), torso + 2 * leg + hat);
    let cells = cells(&whole.grid);
    for (place, index) in [
        ([4, 3, 0], 1), // low corner of the torso
        ([15, 8, 11], 1),
        ([0, 4, 1], 2), // left leg
        ([3, 7, 10], 2),
        ([19, 7, 10], 3), // right leg
        ([4, 0, 13], 4),  // hat
        ([15, 11, 15], 4),
    ] {
        assert_eq!(cells.get(&place), Some(&index), "{place:?}");
    }
    assert!(!cells.contains_key(&[0, 4, 0]) && !cells.contains_key(&[4, 3, 12]));

    for (of_hat, of_layer) in [(&[][..], &[HIDDEN][..]), (&[HIDDEN], &[])] {
        let bytes = file(150, &character(of_hat, of_layer));
        let bare = import(&bytes).unwrap().grid;
        assert_eq!(
            (bare.size(), bare.solid_count()),
            ([20, 12, 6], torso + 2 * leg)
        );
        assert_eq!(told(&bytes), "test.vox: a hidden model is left out");
    }
}

#[test]
fn order_of_chunks_does_not_matter() {
    let chunks = character(&[], &[]);
    let expected = cells_of(&file(150, &chunks));
    // Nodes before models, and nodes in reverse order; the order of the models gives them their numbers.
    let (models, nodes) = chunks.split_at(4);
    let reversed: Vec<_> = nodes.iter().rev().cloned().collect();
    assert_eq!(
        cells_of(&file(150, &[&reversed, models].concat())),
        expected
    );
}

/// Rotation or reflection as a matrix.
type Matrix = [[i32; 3]; 3];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |row: usize, column: usize| (0..3).map(|k| a[row][k] * b[k][column]).sum();
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| entry(row, column)))
}

/// Packs a matrix into a byte, as the documentation of the format describes.
fn packed(matrix: &Matrix) -> u8 {
    let column = |row: usize| (0..3).position(|k| matrix[row][k] != 0).unwrap() as u8;
    let sign = |row: usize| u8::from(matrix[row].contains(&-1));
    column(0) | column(1) << 2 | sign(0) << 4 | sign(1) << 5 | sign(2) << 6
}

/// All products of quarter turns about x and z: the 24 rotations of a cube.
fn rotations() -> Vec<Matrix> {
    const UNIT: Matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const ABOUT_X: Matrix = [[1, 0, 0], [0, 0, -1], [0, 1, 0]];
    const ABOUT_Z: Matrix = [[0, -1, 0], [1, 0, 0], [0, 0, 1]];
    let mut found = vec![UNIT];
    let mut next = 0;
    while next < found.len() {
        for turn in [ABOUT_X, ABOUT_Z] {
            let turned = product(&turn, &found[next]);
            if !found.contains(&turned) {
                found.push(turned);
            }
        }
        next += 1;
    }
    found
}

/// Moves the centre of a voxel, measured from the pivot, and returns the voxel that contains the result.
fn moved(matrix: &Matrix, translation: [i32; 3], size: [i32; 3], voxel: [i32; 3]) -> [i32; 3] {
    let centre = [0, 1, 2].map(|k| f64::from(voxel[k]) + 0.5 - f64::from(size[k] / 2));
    [0, 1, 2].map(|row| {
        let along: f64 = (0..3).map(|k| f64::from(matrix[row][k]) * centre[k]).sum();
        (along + f64::from(translation[row])).floor() as i32
    })
}

/// Shifts voxels so that the lowest position on each axis is 0.
fn shifted(voxels: &HashMap<[i32; 3], u8>) -> BTreeMap<[i32; 3], u8> {
    let low = [0, 1, 2].map(|axis| voxels.keys().map(|voxel| voxel[axis]).min().unwrap());
    let shift = |voxel: &[i32; 3]| [0, 1, 2].map(|axis| voxel[axis] - low[axis]);
    voxels
        .iter()
        .map(|(voxel, &index)| (shift(voxel), index))
        .collect()
}

#[test]
fn all_rotations_and_reflections_turn_a_model_about_its_pivot() {
    const MIRROR: Matrix = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let rotations = rotations();
    assert_eq!(rotations.len(), 24);
    let mirrored = rotations.iter().map(|turn| product(turn, &MIRROR));
    let arm = [
        [0, 0, 0, 1],
        [1, 0, 0, 2],
        [2, 0, 0, 3],
        [0, 1, 0, 4],
        [0, 3, 0, 5],
        [0, 0, 4, 6],
    ];
    // Another model at a fixed place shows the position of the turned one.
    let mark = ([9, 9, 9], 7);
    for (size, turn) in [[3, 4, 5], [4, 5, 6]].into_iter().flat_map(|size| {
        rotations
            .iter()
            .copied()
            .chain(mirrored.clone())
            .map(move |turn| (size, turn))
    }) {
        let byte = packed(&turn).to_string();
        let bytes = file(
            200,
            &[
                model_chunks(size, &arm),
                model_chunks([1; 3], &[[0, 0, 0, mark.1]]),
                group(0, &[], &[1, 3]),
                transform(1, 2, -1, &[], &[&[("_r", &byte), ("_t", "1 -2 3")]]),
                shape(2, &[], &[0]),
                transform(3, 4, -1, &[], &[&at("9 9 9")]),
                shape(4, &[], &[1]),
            ],
        );
        let place = |[x, y, z, index]: [u8; 4]| {
            let voxel = [x, y, z].map(i32::from);
            (
                moved(&turn, [1, -2, 3], size.map(|k| k as i32), voxel),
                index,
            )
        };
        let expected = arm.into_iter().map(place).chain([mark]).collect();
        assert_eq!(cells_of(&bytes), shifted(&expected), "{size:?} {turn:?}");
    }
}

/// The documentation of the format packs this matrix into 1 + 8 + 32 + 64 = 105: x from y, y from −z, z
/// from −x.
#[test]
fn rotation_of_the_documentation_is_read_row_by_row() {
    let bytes = file(
        150,
        &[
            model_chunks(
                [4; 3],
                &[[0, 0, 0, 1], [3, 0, 0, 2], [0, 2, 0, 3], [0, 0, 1, 4]],
            ),
            transform(0, 1, -1, &[], &[&[("_r", "105")]]),
            shape(1, &[], &[0]),
        ],
    );
    let expected = [
        ([0, 1, 3], 1),
        ([0, 1, 0], 2),
        ([2, 1, 3], 3),
        ([0, 0, 3], 4),
    ];
    assert_eq!(cells_of(&bytes), expected.into());
}

#[test]
fn groups_move_and_hide_what_they_contain() {
    // A quarter turn about z (x from −y, y from x) of a group that moves its model by (5, 0, 0) puts the
    // model at (0, 5, 0); the outer group moves it to (0, 5, 7).
    let turned = packed(&[[0, -1, 0], [1, 0, 0], [0, 0, 1]]).to_string();
    let scene = |outer: &[(&str, &str)], inner: &[(&str, &str)], leaf: &[(&str, &str)]| {
        file(
            200,
            &[
                model_chunks([2; 3], &solid([0; 3], [2; 3], 1)),
                model_chunks([2; 3], &solid([0; 3], [2; 3], 2)),
                transform(0, 1, -1, &[], &[&[]]),
                group(1, &[], &[2, 8]),
                transform(2, 3, -1, outer, &[&at("0 0 7")]),
                group(3, &[], &[4]),
                transform(4, 5, -1, &[], &[&[("_r", &turned)]]),
                group(5, inner, &[6]),
                transform(6, 7, -1, &[], &[&at("5 0 0")]),
                shape(7, leaf, &[0]),
                transform(8, 9, -1, &[], &[&[]]),
                shape(9, &[], &[1]),
            ],
        )
    };
    let cells = cells_of(&scene(&[], &[], &[]));
    let first = cells.iter().filter(|(_, index)| **index == 1);
    let expected = solid([0, 5, 7], [2; 3], 1).into_iter();
    let expected = expected.map(|[x, y, z, _]| [x, y, z].map(i32::from));
    assert!(first.map(|(place, _)| *place).eq(expected));
    let hidden = &[("_hidden", "1")][..];
    for (outer, inner, leaf) in [
        (hidden, &[][..], &[][..]),
        (&[], hidden, &[]),
        (&[], &[], hidden),
    ] {
        let bytes = scene(outer, inner, leaf);
        assert_eq!(import(&bytes).unwrap().grid.size(), [2; 3]);
        assert_eq!(told(&bytes), "test.vox: a hidden model is left out");
    }
}

#[test]
fn all_hidden_models_leave_an_empty_shape() {
    let bytes = file(
        200,
        &[
            model_chunks([1; 3], &[[0, 0, 0, 1]]),
            transform(0, 1, -1, &[("_hidden", "1")], &[&[]]),
            shape(1, &[], &[0]),
        ],
    );
    let expected = "test.vox: the shape is empty: there is no solid voxel in the visible models of the file; others are hidden or not placed in MagicaVoxel's world";
    assert_eq!(refusal(&bytes), expected);
}

#[test]
fn named_part_is_taken_alone() {
    let bytes = file(150, &character(&[], &[("_hidden", "1")]));
    let part = |name: &str| Model::decode_part("test.vox", &bytes, Some(name));
    assert_eq!(part("part 1").unwrap().size(), [4, 10, 4]);
    // A part that was asked for may be hidden.
    assert_eq!(part("part 3").unwrap().size(), [12, 3, 12]);
    assert!(part("part 3").unwrap().notes().is_empty());
    assert_eq!(
        part("head").unwrap_err().to_string(),
        "test.vox: expected the name of a part: \"part 0\", \"part 1\", \"part 2\", \"part 3\", found \"head\""
    );
    let plain = vox_file::model([1; 3], &[[0, 0, 0, 1]]);
    let none = Model::decode_part("test.vox", &plain, Some("head")).unwrap_err();
    assert_eq!(
        none.to_string(),
        "test.vox: expected a named part (no part of the file has a name, so `model` cannot choose one), found \"head\""
    );
}

#[test]
fn scene_makes_a_body_of_a_named_part_and_keeps_the_notes() {
    let text = |fields: &str| {
        format!(
            "dim = 3\n{}[[body]]\nfile = \"a.vox\"\n{fields}",
            "[[material]]\n".repeat(4)
        )
    };
    let embedded = |fields: &str| {
        let mut scene = Scene::read("toy.toml", &text(fields), &[]).unwrap();
        let bytes = file(150, &character(&[], &[("_hidden", "1")]));
        scene.embed_files(&|_| Ok(bytes.clone())).unwrap();
        let world = scene.build::<Dim3>();
        (
            scene,
            world.map(|world| world.soft_bodies().next().unwrap().1.grid().size()),
        )
    };
    let (scene, size) = embedded("");
    assert_eq!(size.unwrap(), [20, 12, 6]);
    let notes: Vec<_> = scene.notes().iter().map(ToString::to_string).collect();
    assert_eq!(notes, ["a.vox: a hidden model is left out"]);
    let (scene, size) = embedded("model = \"part 2\"\n");
    assert_eq!((size.unwrap(), scene.notes().len()), ([4, 10, 4], 0));
    let (_, size) = embedded("model = \"head\"\n");
    let error = size.unwrap_err().to_string();
    assert!(error.contains("\"part 3\", found \"head\""), "{error}");
    let shape = text("model = \"head\"").replace("file = \"a.vox\"", "shape = \"ball\"\nn = 4");
    let error = Scene::read("toy.toml", &shape, &[])
        .unwrap()
        .build::<Dim3>()
        .unwrap_err();
    assert!(
        error.to_string().contains("only a .vox file has parts"),
        "{error}"
    );
}

#[test]
fn animation_gives_its_first_frame() {
    let frames = [
        model_chunks([9; 3], &[]),
        model_chunks([2; 3], &solid([0; 3], [2; 3], 1)),
        model_chunks([3; 3], &solid([0; 3], [3; 3], 1)),
        model_chunks([4; 3], &solid([0; 3], [4; 3], 1)),
    ];
    let packed = file(150, &[chunk(b"PACK", &[4, 0, 0, 0], &[]), frames.concat()]);
    let note = "test.vox: only the first frame is taken; 2 more frames are left out";
    assert_eq!(import(&packed).unwrap().grid.size(), [2; 3]);
    assert_eq!(told(&packed), note);

    let moving = [at("0 0 0"), at("1 0 0")];
    let moving: Vec<&[_]> = moving.iter().map(Vec::as_slice).collect();
    let scene = file(
        200,
        &[
            frames.concat(),
            transform(0, 1, -1, &[], &moving),
            shape(1, &[], &[0, 2, 1, 3]),
        ],
    );
    assert_eq!(import(&scene).unwrap().grid.size(), [3; 3]);
    assert_eq!(told(&scene), note);
}

#[test]
fn models_without_a_place_in_the_scene_are_left_out() {
    let bytes = file(
        200,
        &[
            model_chunks([1; 3], &[[0, 0, 0, 1]]),
            model_chunks([2; 3], &solid([0; 3], [2; 3], 2)),
            model_chunks([5; 3], &[]),
            transform(0, 1, -1, &[], &[&[]]),
            shape(1, &[], &[0]),
        ],
    );
    assert_eq!(import(&bytes).unwrap().grid.size(), [1; 3]);
    assert_eq!(
        told(&bytes),
        "test.vox: a model that is not placed in MagicaVoxel's world is left out"
    );
}

#[test]
fn overlap_belongs_to_the_first_model_since_version_200() {
    let scene = |version: u32| {
        let rows = [solid([0; 3], [4, 1, 1], 1), solid([0; 3], [4, 1, 1], 2)];
        file(
            version,
            &[
                model_chunks([4, 1, 1], &rows[0]),
                model_chunks([4, 1, 1], &rows[1]),
                group(0, &[], &[1, 3]),
                transform(1, 2, -1, &[], &[&[]]),
                shape(2, &[], &[0]),
                transform(3, 4, -1, &[], &[&at("1 0 0")]),
                shape(4, &[], &[1]),
            ],
        )
    };
    let row = |version| cells_of(&scene(version)).into_values().collect::<Vec<_>>();
    assert_eq!(
        (row(200), row(150)),
        (vec![1, 1, 1, 1, 2], vec![1, 2, 2, 2, 2])
    );
    let note = "test.vox: models of different colours overlap in 3 voxels";
    assert_eq!(
        (told(&scene(200)).as_str(), told(&scene(150)).as_str()),
        (note, note)
    );
}

#[test]
fn note_counts_the_pieces_into_which_the_engine_divides_a_body() {
    // Eight cubes in a checkerboard of 4 × 4 × 2 cells touch only along edges.
    let cubes = (0..16).filter(|k| (k % 4 + k / 4) % 2 == 0);
    let cubes = cubes.flat_map(|k| solid([3 * (k % 4), 3 * (k / 4), 0], [3; 3], 1));
    let bytes = vox_file::model([12, 12, 3], &cubes.collect::<Vec<_>>());
    let expected = "test.vox: the shape falls into 8 pieces: some touch only at edges or corners, so they come apart";
    assert_eq!(told(&bytes), expected);
    let text = "dim = 3\n[[body]]\nfile = \"a.vox\"\n";
    let mut scene = Scene::read("toy.toml", text, &[]).unwrap();
    scene.embed_files(&|_| Ok(bytes.clone())).unwrap();
    assert_eq!(scene.notes().len(), 1);
    let mut world = scene.build::<Dim3>().unwrap();
    world.step();
    assert_eq!(world.soft_bodies().next().unwrap().1.pieces().count(), 8);
}

#[test]
fn box_around_the_solid_voxels_is_limited() {
    let far = import(&dots(&["-1000 0 2000000000", "-1000 3 2000000000"])).unwrap();
    assert_eq!(
        far.grid.size(),
        [1, 1, 4],
        "only the distance between the models counts"
    );
    let long = import(&dots(&["-1000 0 0", "23 0 0"])).unwrap();
    assert_eq!(long.grid.size(), [1024, 1, 1]);
    let expected = "test.vox: expected at most 1024 voxels on an axis and 16777216 in all in the box around the solid voxels, found ";
    let advice =
        "times too wide: scale the model down or choose a part of it with model = \"name\")";
    for (places, found) in [
        (["-1000 0 0", "1000 0 0"], "2001 x 1 x 1 = 2001 (2.0 "),
        (
            ["0 0 0", "511 511 511"],
            "512 x 512 x 512 = 134217728 (2.0 ",
        ),
        (
            ["-2147483648 0 0", "2147483647 0 0"],
            "4294967296 x 1 x 1 = 4294967296 (4194304.0 ",
        ),
    ] {
        assert_eq!(
            refusal(&dots(&places)),
            format!("{expected}{found}{advice}")
        );
    }
}

#[test]
fn scene_names_its_limit_and_the_size_of_the_model() {
    let text = "dim = 3\n[[body]]\nfile = \"a.vox\"\n";
    let mut scene = Scene::read("toy.toml", text, &[]).unwrap();
    // A cube of 10³ voxels, and a dot that does not count although it doubles the box.
    let cube = (0..1000).map(|k| [k % 10, k / 10 % 10, k / 100, 1].map(|k: u16| k as u8));
    let voxels: Vec<_> = cube.chain([[19, 9, 9, 1]]).collect();
    let bytes = vox_file::model([20, 10, 10], &voxels);
    scene.embed_files(&|_| Ok(bytes.clone())).unwrap();
    assert!(scene.build_within::<Dim3>(1001).is_ok());
    let error = scene.build_within::<Dim3>(513).unwrap_err().to_string();
    let expected = "expected 513 solid voxels at most in all bodies together, found 1001, of which 1001 in this model; make the model smaller, to 80 % of its width, or use a part of it with model = \"name\"";
    assert!(error.ends_with(expected), "{error}");
}

#[test]
fn damaged_scene_names_the_node() {
    let one = model_chunks([1; 3], &[[0, 0, 0, 1]]);
    let scene = |nodes: &[Vec<u8>]| file(200, &[std::slice::from_ref(&one), nodes].concat());
    let frame =
        |frame: &[(&str, &str)]| scene(&[transform(0, 1, -1, &[], &[frame]), shape(1, &[], &[0])]);
    for (bytes, expected) in [
        (
            scene(&[group(0, &[], &[1]), group(1, &[], &[0])]),
            ", chunk nGRP at byte 64: expected nodes without a cycle, found node 0 below itself",
        ),
        (
            scene(&[group(7, &[], &[8]), group(8, &[], &[7])]),
            ", chunk nGRP at byte 64: expected a node that is no child of another node, found none",
        ),
        (
            scene(&[group(0, &[], &[5])]),
            ": expected a node 5, which is a child of another node, found none",
        ),
        (
            scene(&[shape(0, &[], &[0, 1])]),
            ", chunk nSHP at byte 64: expected a model below 1, the number of models in the file, found 1",
        ),
        (
            scene(&[shape(0, &[], &[0]), shape(0, &[], &[0])]),
            ", chunk nSHP at byte 96: expected a node with an id of its own, found a second node 0",
        ),
        (
            scene(&[transform(0, 1, -1, &[], &[]), shape(1, &[], &[0])]),
            ", chunk nTRN at byte 64: expected at least one frame, found none",
        ),
        (
            frame(&[("_t", "1 2")]),
            ", chunk nTRN at byte 64: expected three whole numbers of voxels in _t, found \"1 2\"",
        ),
        (
            frame(&[("_t", "1 2 9999999999")]),
            ", chunk nTRN at byte 64: expected three whole numbers of voxels in _t, found \"1 2 9999999999\"",
        ),
        (
            frame(&[("_r", "5")]),
            ", chunk nTRN at byte 64: expected a rotation by right angles in _r, found \"5\"",
        ),
        (
            scene(&[chunk(b"nGRP", &[0; 4], &[])]),
            ", byte 80: expected 4 bytes for the number of attributes, found 0",
        ),
        (
            scene(&[chunk(b"nSHP", &[0, 0, 0, 0, 255, 255, 255, 255], &[])]),
            ", byte 84: expected 4 bytes for the length of a text, found 0",
        ),
        (
            file(150, &[size([1; 3]), size([1; 3]), voxels(0, &[])]),
            ", chunk SIZE at byte 44: expected a chunk XYZI after SIZE, found a second chunk SIZE",
        ),
    ] {
        assert_eq!(refusal(&bytes), format!("test.vox{expected}"));
    }
}

#[test]
fn hostile_scene_is_refused_quickly() {
    let one = model_chunks([1; 3], &[[0, 0, 0, 1]]);
    let limit = "test.vox: expected at most 131072 objects and groups, copies included, found more (merge objects before saving)";
    // 2^40 paths lead through 40 groups that each contain the next one twice.
    let doubled = (0..40).map(|id| group(id, &[], &[id + 1, id + 1]));
    let doubled: Vec<_> = doubled.chain([shape(40, &[], &[0]), one.clone()]).collect();
    assert_eq!(refusal(&file(200, &doubled)), limit);
    let wide = group(0, &[], &vec![1; 1_000_000]);
    assert_eq!(
        refusal(&file(200, &[wide, shape(1, &[], &[0]), one.clone()])),
        limit
    );
    let chain = |length: i32| {
        let nodes = (0..length).map(|id| transform(id, id + 1, -1, &[], &[&at("2147483647 0 0")]));
        nodes
            .chain([shape(length, &[], &[0]), one.clone()])
            .collect::<Vec<_>>()
    };
    assert_eq!(
        import(&file(200, &chain(200_000))).unwrap().grid.size(),
        [1; 3]
    );
    assert_eq!(refusal(&file(200, &chain(300_000))), limit);
    // A full model, placed so often that only its voxels are too many.
    let full = model_chunks([64; 3], &solid([0; 3], [64; 3], 1));
    let often = group(0, &[], &[1; 65]);
    let expected = "test.vox: expected at most 16777216 voxels in all visible models together, found 17039360 (choose a part of the scene with model = \"name\")";
    assert_eq!(
        refusal(&file(200, &[full, often, shape(1, &[], &[0])])),
        expected
    );
}

#[test]
fn model_longer_than_the_format_allows_is_written_in_blocks() {
    let is_solid =
        |[x, y, z]: [i32; 3]| (x * x + 3 * y + 7 * z) % 11 == 0 && !(260..500).contains(&x);
    let grid = VoxelGrid::<Dim3>::from_fn([700, 3, 270], 0.25, |voxel| {
        u8::from(is_solid(voxel)) * (1 + (voxel[0] % 5) as u8)
    });
    let grid = grid.unwrap();
    let model = Model::of("test.vox", &grid, &[[1, 2, 3]; 5]).unwrap();
    let again = Model::decode("test.vox", &model.bytes()).unwrap();
    assert_eq!(again.size(), model.size());
    assert_eq!(again.palette(), model.palette());
    assert!(again.notes().is_empty());
    assert_eq!(
        cells(&again.grid(0.25, &Default::default()).unwrap()),
        cells(&grid)
    );
    assert_eq!(again.bytes(), model.bytes());
}

/// Node of a random scene, placed below its parent.
struct Random {
    matrix: Matrix,
    translation: [i32; 3],
    is_hidden: bool,
    kind: Kind,
}

enum Kind {
    Group(Vec<Random>),
    Model(usize),
}

impl Random {
    fn of(noise: &mut Noise, rotations: &[Matrix], levels: usize) -> Self {
        let kind = match levels == 0 || noise.below(3) == 0 {
            true => Kind::Model(noise.below(3)),
            false => {
                let count = 1 + noise.below(3);
                let children = (0..count).map(|_| Self::of(noise, rotations, levels - 1));
                Kind::Group(children.collect())
            }
        };
        Self {
            matrix: rotations[noise.below(rotations.len())],
            translation: [0; 3].map(|_| noise.below(9) as i32 - 4),
            is_hidden: noise.below(6) == 0,
            kind,
        }
    }

    /// Writes the node and everything below it. Returns its id.
    fn write(&self, ids: &mut std::ops::RangeFrom<i32>, chunks: &mut Vec<Vec<u8>>) -> i32 {
        let (id, child) = (ids.next().unwrap(), ids.next().unwrap());
        let [x, y, z] = self.translation;
        let (rotation, translation) = (packed(&self.matrix).to_string(), format!("{x} {y} {z}"));
        let hidden: &[_] = if self.is_hidden {
            &[("_hidden", "1")]
        } else {
            &[]
        };
        chunks.push(transform(
            id,
            child,
            -1,
            hidden,
            &[&[("_r", &rotation), ("_t", &translation)]],
        ));
        match &self.kind {
            Kind::Model(model) => chunks.push(shape(child, &[], &[*model as i32])),
            Kind::Group(children) => {
                let children = children.iter().map(|node| node.write(ids, chunks));
                let children: Vec<i32> = children.collect();
                chunks.push(group(child, &[], &children));
            }
        }
        id
    }

    /// Returns the positions of all visible voxels, measured at their centres from the origin of the parent.
    /// An earlier voxel precedes a later one.
    fn centres(&self, models: &[([u32; 3], Vec<[u8; 4]>)]) -> Vec<([f64; 3], u8)> {
        if self.is_hidden {
            return Vec::new();
        }
        let own = match &self.kind {
            Kind::Group(children) => children
                .iter()
                .flat_map(|node| node.centres(models))
                .collect(),
            Kind::Model(model) => {
                let (size, voxels) = &models[*model];
                let centre = |voxel: &[u8; 4]| {
                    let place = |k: usize| f64::from(voxel[k]) + 0.5 - f64::from(size[k] / 2);
                    ([0, 1, 2].map(place), voxel[3])
                };
                voxels.iter().map(centre).collect::<Vec<_>>()
            }
        };
        let moved = own.into_iter().map(|(centre, index)| {
            let along = |row: usize, k: usize| f64::from(self.matrix[row][k]) * centre[k];
            let place = |row| (0..3).map(|k| along(row, k)).sum::<f64>();
            (
                [0, 1, 2].map(|row| place(row) + f64::from(self.translation[row])),
                index,
            )
        });
        moved.collect()
    }
}

#[test]
fn random_scenes_are_assembled_like_by_matrices() {
    let mut noise = Noise(11);
    let rotations = rotations();
    let mut full = 0;
    for round in 0..300 {
        let models: Vec<([u32; 3], Vec<[u8; 4]>)> = (1..=3)
            .map(|index| {
                let size = [0; 3].map(|_| 1 + noise.below(4) as u8);
                let mut voxels = solid([0; 3], size, index);
                voxels.retain(|_| noise.below(3) > 0);
                (size.map(u32::from), voxels)
            })
            .collect();
        let root = Random::of(&mut noise, &rotations, 3);
        let mut chunks: Vec<_> = models
            .iter()
            .map(|(size, list)| model_chunks(*size, list))
            .collect();
        root.write(&mut (0..), &mut chunks);
        let version = [150, 200][round % 2];
        let mut centres = root.centres(&models);
        if version == 200 {
            centres.reverse();
        }
        let expected: HashMap<_, _> = centres
            .into_iter()
            .map(|(centre, index)| (centre.map(|k| k.floor() as i32), index))
            .collect();
        let outcome = import(&file(version, &chunks));
        if expected.is_empty() {
            assert!(
                outcome
                    .unwrap_err()
                    .to_string()
                    .contains("the shape is empty")
            );
        } else {
            assert_eq!(cells(&outcome.unwrap().grid), shifted(&expected), "{round}");
            full += 1;
        }
    }
    assert!(full > 150, "most scenes must have visible voxels: {full}");
}

#[test]
fn import_survives_damaged_scenes() {
    let mut noise = Noise(5);
    let whole = file(
        200,
        &character(&[], &[("_hidden", "1")])[4..]
            .iter()
            .cloned()
            .chain((0..4).map(|_| model_chunks([2; 3], &[[0, 0, 0, 1], [1, 1, 1, 2]])))
            .collect::<Vec<_>>(),
    );
    let mut taken = 0;
    for _ in 0..2_000 {
        let outcome = import(&noise.damaged(&whole)).map(|import| import.grid);
        taken += usize::from(outcome.is_ok());
        damage::check(outcome);
    }
    assert!(taken > 100, "some damage must be harmless: {taken}");
}

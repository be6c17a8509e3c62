//! MagicaVoxel models become solid shapes, and no input bytes cause harm.

use crate::damage::{self, Noise};
use crate::vox_file::{self, chunk, file, model, size, voxels};
use fuwafuwa::{Dim3, Error, VoxelGrid};
use fuwafuwa_scenes::import::{Colours, FilePosition, ImportError, Model, Problem, vox};

/// Encodes a palette with red as colour 1, dark red as 2, green as 7 and black for all others.
fn palette() -> Vec<u8> {
    let mut colours = [[0, 0, 0, 255]; 256];
    colours[0] = [255, 0, 0, 255];
    colours[1] = [120, 0, 0, 255];
    colours[6] = [0, 255, 0, 255];
    chunk(b"RGBA", colours.as_flattened(), &[])
}

/// Encodes a file with much that is ignored: a second model and unknown chunks.
fn full() -> Vec<u8> {
    let first = [[0, 0, 0, 1], [1, 2, 3, 7], [1, 0, 0, 2], [0, 2, 0, 255]];
    file(
        200,
        &[
            chunk(b"PACK", &2_u32.to_le_bytes(), &[]),
            chunk(b"what", b"ever", &chunk(b"SIZE", &[9; 12], &[])),
            size([2, 3, 4]),
            voxels(first.len(), &first),
            size([1, 1, 1]),
            voxels(1, &[[0, 0, 0, 9]]),
            palette(),
        ],
    )
}

fn import(bytes: &[u8]) -> Result<VoxelGrid<Dim3>, ImportError> {
    vox("test.vox", bytes, 0.25).map(|import| import.grid)
}

#[test]
fn vox_maps_axes_with_y_up_and_front_to_viewer() {
    let grid = import(&full()).unwrap();
    assert_eq!(grid.size(), [2, 4, 3], "sizes on x, z and y of the file");
    assert_eq!(grid.voxel_size(), 0.25);
    assert_eq!(grid.solid_count(), 4);
    for (voxel, material) in [
        ([0, 0, 2], 1),   // corner at the origin: left, bottom, front
        ([1, 0, 2], 2),   // one to the right
        ([0, 0, 0], 255), // farthest along y: at the back
        ([1, 3, 0], 7),   // and at the top
    ] {
        assert_eq!(grid.material(voxel), material, "{voxel:?}");
    }
    let twice = import(&model([1; 3], &[[0, 0, 0, 4], [0, 0, 0, 5]])).unwrap();
    assert_eq!(twice.material([0; 3]), 5);
}

#[test]
fn grid_maps_colours_and_palette_indices_to_materials() {
    let model = Model::decode("test.vox", &full()).unwrap();
    assert_eq!(model.size(), [2, 4, 3]);
    let grid = |indices: &[(u8, u8)], named: &[([u8; 3], u8)]| {
        let (indices, named) = (indices.iter().copied(), named.iter().copied());
        let (indices, named) = (indices.collect(), named.collect());
        let grid = model.grid(1.0, &Colours { indices, named });
        // Positions of the voxels with palette index 1, 2, 7 and 255.
        let places = [[0, 0, 2], [1, 0, 2], [1, 3, 0], [0, 0, 0]];
        grid.map(|grid| places.map(|at| grid.material(at)))
            .map_err(|error| error.to_string())
    };
    let (red, green) = ([250, 10, 10], [0, 200, 0]);
    assert_eq!(grid(&[], &[]), Ok([1, 2, 7, 255]));
    let every = [(1, 3), (2, 3), (7, 0), (255, 1)];
    assert_eq!(grid(&every, &[]), Ok([3, 3, 0, 1]));
    // Black voxels get the material of green, which is closer to black than red is; an index takes precedence
    // over a colour.
    assert_eq!(grid(&[], &[(red, 1), (green, 2)]), Ok([1, 1, 2, 2]));
    assert_eq!(grid(&[(1, 9)], &[(red, 1), (green, 2)]), Ok([9, 1, 2, 2]));
    let lacking = grid(&[(1, 3), (2, 3), (255, 1)], &[]);
    let expected = "test.vox: expected a material for the palette index 7, found none";
    assert_eq!(lacking, Err(expected.into()));
    let nothing = grid(&[], &[(red, 0)]).unwrap_err();
    assert!(nothing.contains("no solid voxel"), "{nothing}");
}

/// Decodes two voxels with palette indices 1 and `index`, and returns the colours of the whole palette and
/// the material of the second voxel if white is material 1 and red is material 2.
fn palette_of(index: u8, chunks: &[Vec<u8>]) -> (Vec<[u8; 3]>, u8) {
    let both = [
        size([2, 1, 1]),
        voxels(2, &[[0, 0, 0, 1], [1, 0, 0, index]]),
    ];
    let bytes = file(150, &[&both[..], chunks].concat());
    let model = Model::decode("test.vox", &bytes).unwrap();
    let colours = Colours {
        named: [([255; 3], 1), ([255, 0, 0], 2)].into(),
        ..Colours::default()
    };
    let grid = model.grid(1.0, &colours).unwrap();
    (model.palette().to_vec(), grid.material([1, 0, 0]))
}

#[test]
fn file_without_palette_has_default_colours() {
    // Index 36 of MagicaVoxel's default palette is red, index 246 a light grey.
    assert_eq!(palette_of(36, &[]).1, 2);
    assert_eq!(palette_of(246, &[]).1, 1);
    let (colours, _) = palette_of(1, &[]);
    assert_eq!(colours.len(), 255);
    assert_eq!((colours[35], colours[245]), ([255, 0, 0], [238; 3]));
}

#[test]
fn short_palette_is_completed_from_the_default_one() {
    let short = chunk(b"RGBA", &[200, 100, 50, 255, 255, 1, 2, 255], &[]);
    let (colours, material) = palette_of(2, &[short]);
    assert_eq!(colours[..3], [[200, 100, 50], [255, 1, 2], [255, 255, 153]]);
    assert_eq!((colours.len(), material), (255, 2));
}

#[test]
fn entry_with_index_0_is_an_empty_voxel() {
    let list = [
        [0, 0, 0, 0],
        [1, 1, 1, 5],
        [2, 2, 2, 0],
        [2, 1, 1, 6],
        [2, 1, 1, 0],
    ];
    let grid = import(&model([3; 3], &list)).unwrap();
    assert_eq!((grid.size(), grid.material([0; 3])), ([1; 3], 5));
}

#[test]
fn canvas_around_a_model_does_not_count() {
    let die = |canvas: u32, low: u8| {
        let solid = vox_file::solid([low; 3], [16, 15, 14], 3);
        import(&model([canvas; 3], &solid)).unwrap()
    };
    let alone = die(16, 0);
    assert_eq!(alone.size(), [16, 14, 15]);
    assert_eq!(alone, die(40, 12));
    assert_eq!(alone, die(256, 240));
    // Voxels that become empty by their colour do not count either.
    let plate = vox_file::solid([0; 3], [20, 20, 1], 9);
    let die = vox_file::solid([2, 2, 1], [16, 15, 14], 3);
    let both = Model::decode("test.vox", &model([20; 3], &[plate, die].concat())).unwrap();
    let indices = [(3, 3), (9, 0)].into();
    let named = Default::default();
    assert_eq!(both.grid(0.25, &Colours { indices, named }).unwrap(), alone);
}

#[test]
fn vox_accepts_largest_model() {
    let corners = [[0, 0, 0, 1], [255, 255, 255, 1]];
    let grid = import(&model([256; 3], &corners)).unwrap();
    assert_eq!(grid.size(), [256; 3]);
    assert!(grid.is_solid([0, 0, 255]) && grid.is_solid([255, 255, 0]));
}

#[test]
fn error_names_position_of_each_fault() {
    let one = [[0, 0, 0, 1]];
    let main = |lengths: [u32; 2]| {
        let lengths = lengths.map(u32::to_le_bytes).concat();
        [&b"VOX \x96\0\0\0MAIN"[..], &lengths].concat()
    };
    let cases = [
        (
            vec![],
            ", byte 0: expected 4 bytes for the letters \"VOX \", found 0",
        ),
        (
            b"\x89PNG1234".to_vec(),
            ", byte 0: expected the letters \"VOX \", found \"\\x89PNG\"",
        ),
        (
            file(149, &[]),
            ", byte 4: expected a version from 150 to 200, found 149",
        ),
        (
            [b"VOX \x96\0\0\0".to_vec(), size([1; 3])].concat(),
            ", byte 8: expected the chunk MAIN, found SIZE",
        ),
        (
            main([u32::MAX; 2]),
            ", byte 20: expected 4294967295 bytes for the chunk MAIN, found 0",
        ),
        (
            main([0, u32::MAX]),
            ", byte 20: expected 4294967295 bytes for the children of the chunk MAIN, found 0",
        ),
        (
            file(150, &[]),
            ", byte 20: expected a model of chunks SIZE and XYZI, found no more chunks",
        ),
        (
            file(150, &[size([1; 3])]),
            ", byte 44: expected a model of chunks SIZE and XYZI, found no more chunks",
        ),
        (
            file(150, &[voxels(1, &one), size([1; 3])]),
            ", chunk XYZI at byte 20: expected a chunk SIZE before it, found none",
        ),
        (
            file(150, &[chunk(b"SIZE", &[1; 8], &[])]),
            ", chunk SIZE at byte 20: expected 12 bytes for a size on three axes, found 8",
        ),
        (
            model([1, 0, 1], &one),
            ", byte 60: expected a voxel in the box of 1 x 0 x 1, found (0, 0, 0)",
        ),
        (
            model([1, 1, 257], &one),
            ", chunk SIZE at byte 20: 257 voxels on an axis are too many, the limit is 256",
        ),
        (
            model([u32::MAX; 3], &one),
            ", chunk SIZE at byte 20: 4294967295 voxels on an axis are too many, the limit is 256",
        ),
        (
            model([1; 3], &[]),
            ": the shape is empty: there is no solid voxel in the models of the file",
        ),
        (
            file(150, &[size([1; 3]), voxels(2, &one)]),
            ", chunk XYZI at byte 44: expected 12 bytes for 2 voxels, found 8",
        ),
        (
            file(150, &[size([1; 3]), voxels(u32::MAX as usize, &one)]),
            ", chunk XYZI at byte 44: expected 17179869184 bytes for 4294967295 voxels, found 8",
        ),
        (
            file(150, &[size([1; 3]), voxels(0, &one)]),
            ", chunk XYZI at byte 44: expected 4 bytes for 0 voxels, found 8",
        ),
        (
            model([2, 3, 4], &[[0, 0, 0, 1], [2, 0, 0, 1]]),
            ", byte 64: expected a voxel in the box of 2 x 3 x 4, found (2, 0, 0)",
        ),
        (
            model([2, 3, 4], &[[0, 3, 0, 1]]),
            ", byte 60: expected a voxel in the box of 2 x 3 x 4, found (0, 3, 0)",
        ),
        (
            model([2, 3, 4], &[[0, 0, 4, 1]]),
            ", byte 60: expected a voxel in the box of 2 x 3 x 4, found (0, 0, 4)",
        ),
        (
            model([1; 3], &[[0, 0, 0, 0]]),
            ": the shape is empty: there is no solid voxel in the models of the file",
        ),
        (
            file(
                150,
                &[size([1; 3]), voxels(1, &one), chunk(b"RGBA", &[0; 5], &[])],
            ),
            ", chunk RGBA at byte 64: expected 4 bytes for each of at most 256 colours, found 5 bytes",
        ),
    ];
    for (bytes, expected) in cases {
        let error = import(&bytes).unwrap_err().to_string();
        assert_eq!(error, format!("test.vox{expected}"));
    }
}

#[test]
fn vox_rejects_invalid_voxel_size() {
    let error = vox("test.vox", &full(), 0.0).unwrap_err();
    assert_eq!(error.position, FilePosition::File);
    let Problem::Grid(error) = error.problem else {
        panic!("{error}");
    };
    assert!(matches!(*error, Error::InvalidParameter { .. }));
}

#[test]
fn decode_survives_deeply_nested_chunks() {
    let levels = 200_000;
    let mut bytes = b"VOX \x96\0\0\0".to_vec();
    for level in 0..levels {
        bytes.extend(b"MAIN\0\0\0\0");
        bytes.extend((12 * (levels - 1 - level) as u32).to_le_bytes());
    }
    let error = import(&bytes).unwrap_err().to_string();
    assert!(error.ends_with("found no more chunks"), "{error}");
}

#[test]
fn decode_rejects_truncated_model_at_every_length() {
    // The chunk MAIN holds the length of the file, so every missing byte is noticed.
    let bytes = full();
    for length in 0..bytes.len() {
        match import(&bytes[..length]).unwrap_err() {
            ImportError {
                position: FilePosition::Byte(at),
                ..
            } => assert!(at <= length),
            error => panic!("{length}: {error}"),
        }
    }
}

#[test]
fn decode_survives_damaged_models() {
    let mut noise = Noise(3);
    // The model has none of the chunks that the decoder ignores, so that most damage hits relevant bytes.
    let first = [[0, 0, 0, 1], [1, 2, 3, 7]];
    let chunks = [size([2, 3, 4]), voxels(2, &first), chunk(b"what", b"", &[])];
    let mut taken = 0;
    for _ in 0..5_000 {
        for bytes in [file(150, &chunks), model([2, 3, 4], &[[1, 2, 3, 4]])] {
            let outcome = import(&noise.damaged(&bytes));
            taken += usize::from(outcome.is_ok());
            damage::check(outcome);
        }
    }
    assert!(taken > 100, "some damage must be harmless: {taken}");
}

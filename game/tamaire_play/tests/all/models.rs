//! Tests that the model files of the built-in levels are as generated here.

use std::path::PathBuf;
use tamaire_play::{InputFrame, Level, Replay, Round};

/// Returns the model of a crème caramel, 26 voxels wide and 16 high: custard (colour 1) under caramel (colour
/// 2).
fn pudding() -> Vec<u8> {
    const ACROSS: u8 = 26;
    const HIGH: u8 = 16;
    let mut voxels = Vec::new();
    for z in 0..HIGH {
        let height = (f32::from(z) + 0.5) / f32::from(HIGH);
        // The pudding is a truncated cone with a rounded upper edge.
        let rounding = (height - 0.85).max(0.0) / 0.15;
        let half = 0.5 * f32::from(ACROSS);
        let radius = half * (1.0 - 0.28 * height - 0.125 * rounding * rounding);
        for (y, x) in (0..ACROSS).flat_map(|y| (0..ACROSS).map(move |x| (y, x))) {
            let [a, b] = [x, y].map(|k| f32::from(k) + 0.5 - half);
            let from_axis = (a * a + b * b).sqrt();
            // Lowers the boundary of the caramel near the rim, as if it had run down a little.
            let caramel = 0.84 - 0.12 * (from_axis / (0.75 * half)).powi(4).min(1.0);
            if from_axis < radius {
                voxels.push([x, y, z, 1 + u8::from(height > caramel)]);
            }
        }
    }
    let mut colours = [[0, 0, 0, 255]; 256];
    colours[0] = [0xf7, 0xd6, 0x7a, 255];
    colours[1] = [0x8a, 0x47, 0x1c, 255];
    model([ACROSS, ACROSS, HIGH], &voxels, &colours)
}

/// Returns the bytes of a MagicaVoxel file with a size, voxels with colour indices from 1, and a palette.
fn model(size: [u8; 3], voxels: &[[u8; 4]], colours: &[[u8; 4]; 256]) -> Vec<u8> {
    let size = size.map(|extent| u32::from(extent).to_le_bytes());
    let count = (voxels.len() as u32).to_le_bytes();
    let chunks = [
        chunk(b"SIZE", size.as_flattened(), &[]),
        chunk(b"XYZI", &[&count, voxels.as_flattened()].concat(), &[]),
        chunk(b"RGBA", colours.as_flattened(), &[]),
    ];
    let version = 150_u32.to_le_bytes();
    [
        b"VOX ".as_slice(),
        &version,
        &chunk(b"MAIN", &[], &chunks.concat()),
    ]
    .concat()
}

fn chunk(name: &[u8; 4], contents: &[u8], children: &[u8]) -> Vec<u8> {
    let lengths = [contents, children].map(|part| (part.len() as u32).to_le_bytes());
    [name, lengths.as_flattened(), contents, children].concat()
}

/// Loader that fails for every file, because the models name no files.
fn nothing(_: &str) -> std::io::Result<Vec<u8>> {
    Err(std::io::ErrorKind::NotFound.into())
}

fn place() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("levels/pudding.vox")
}

#[test]
fn pudding_file_matches_its_generator() {
    let found = std::fs::read(place()).unwrap();
    assert!(
        found == pudding(),
        "write the file again: cargo test -p tamaire_play --test all models -- --ignored"
    );
}

#[test]
#[ignore = "writes the model"]
fn write_the_pudding() {
    std::fs::write(place(), pudding()).unwrap();
}

#[test]
fn model_of_any_colours_becomes_the_body_of_a_level() {
    let level = Level::read("pudding.vox", &pudding(), &nothing).unwrap();
    assert_eq!(level.game().name.en, "pudding");
    assert_eq!(level.scene().dim, 3);
    let level = level.scene().build::<fuwafuwa::Dim3>().unwrap();
    assert!(level.soft_bodies().next().unwrap().1.grid().solid_count() > 5000);

    let refused = |bytes: &[u8]| {
        let error = Level::read("wide.VOX", bytes, &nothing).unwrap_err();
        error.to_string()
    };
    // Empty voxels of a canvas do not count, but solid ones do.
    let all =
        (0..65 * 64 * 64).map(|k| [k % 65, k / 65 % 64, k / 65 / 64, 79].map(|k: u32| k as u8));
    let wide = refused(&model(
        [65, 64, 64],
        &all.collect::<Vec<_>>(),
        &[[0; 4]; 256],
    ));
    let expected = "expected 262144 solid voxels at most in all bodies together, found 266240";
    assert!(wide.contains(expected), "{wide}");
    let hollow = [[0, 0, 0, 79], [99, 99, 99, 79]];
    let hollow = model([100; 3], &hollow, &[[0; 4]; 256]);
    assert!(Level::read("hollow.vox", &hollow, &nothing).is_ok());
    let torn = refused(&pudding()[..1000]);
    for (said, place) in [(&wide, ": "), (&torn, ", byte 20: expected ")] {
        let begin = format!("cannot make a body from wide.VOX{place}");
        assert!(said.starts_with(&begin), "{said}");
        assert!(
            !said.contains("classic"),
            "the error must not name the level around the body: {said}"
        );
    }
}

#[test]
fn replay_does_not_reveal_folders() {
    let shape = "shape = \"ball\"\nn = 24";
    let (_, classic) = tamaire_play::level::NAMED_3D[0];
    assert!(classic.contains(shape), "{classic}");
    let body = "file = \"/home/secret/mine.vox\"\ncolours = { \"1\" = 1, \"2\" = 1 }";
    let own = classic.replace(shape, body).into_bytes();
    let fetch = |name: &str| {
        assert_eq!(name, "/home/secret/mine.vox");
        Ok(pudding())
    };
    for (file, bytes) in [("mine.vox", pudding()), ("own.toml", own)] {
        let level = Level::read(&format!("/home/secret/{file}"), &bytes, &fetch).unwrap();
        assert_eq!(
            Level::read_kept(&level.id, level.text_to_keep().unwrap().as_bytes()).unwrap(),
            level
        );
        let round = Round::<fuwafuwa::Dim3>::new(std::sync::Arc::new(level));
        let text = Replay::of(&round).text_to_keep().unwrap();
        assert!(
            text.contains("mine.vox") && !text.contains("secret"),
            "{file}"
        );
    }
}

#[test]
fn model_in_two_parts_counts_as_whole() {
    let cubes = (0..24u8).filter(|x| !(10..14).contains(x));
    let voxels = cubes.flat_map(|x| (0..100).map(move |k| [x, k % 10, k / 10, 1]));
    let voxels: Vec<_> = voxels.collect();
    let bytes = model([24, 10, 10], &voxels, &[[200; 4]; 256]);
    let level = Level::read("two.vox", &bytes, &nothing).unwrap();
    let mut round = Round::<fuwafuwa::Dim3>::new(std::sync::Arc::new(level));
    round.step(InputFrame::default());
    assert_eq!(round.progress().pieces, 2);
    assert_eq!(round.progress().kept, 1.0);
}

#[test]
fn model_of_a_level_keeps_only_what_is_visible() {
    let die: Vec<_> = (0..1000_u16)
        .map(|k| [k % 10, k / 10 % 10, k / 100].map(|k| 200 + k as u8))
        .map(|[x, y, z]| [x, y, z, 1])
        .collect();
    let colours = [[200; 4]; 256];
    let bytes = model([255; 3], &die, &colours);
    let level = Level::read("die.vox", &bytes, &nothing).unwrap();
    assert!(level.scene().notes().is_empty());
    let alone: Vec<_> = die
        .iter()
        .map(|&[x, y, z, k]| [x - 200, y - 200, z - 200, k])
        .collect();
    let alone = Level::read("die.vox", &model([10; 3], &alone, &colours), &nothing).unwrap();
    let grid = |level: &Level| {
        let world = level.scene().build::<fuwafuwa::Dim3>().unwrap();
        world.soft_bodies().next().unwrap().1.grid().clone()
    };
    assert_eq!(grid(&level), grid(&alone));
    assert_eq!(grid(&level).size(), [10; 3]);

    // Two more models without a scene are frames of an animation, and are not stored with the level.
    let mut animated = bytes[..bytes.len() - 12 - 1024].to_vec();
    let frame = &bytes[20..animated.len()].to_vec();
    animated.extend([&frame[..], frame].concat());
    let length = (animated.len() as u32 - 20).to_le_bytes();
    animated[16..20].copy_from_slice(&length);
    let level = Level::read("die.vox", &animated, &nothing).unwrap();
    let notes: Vec<_> = level
        .scene()
        .notes()
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(
        notes,
        ["die.vox: only the first frame is taken; 2 more frames are left out"]
    );
    assert!(level.text_to_keep().unwrap().len() < animated.len());
}

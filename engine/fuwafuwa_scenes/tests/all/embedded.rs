//! Tests of embedded files: no larger than the bodies of the scene need, and with the same voxels as the
//! original files.

use crate::damage::Noise;
use crate::picture::png_of;
use crate::vox_file::{file, group, model_chunks, shape, transform};
use base64::Engine;
use base64::prelude::BASE64_STANDARD as BASE64;
use fuwafuwa::{Dim, Dim2, Dim3};
use fuwafuwa_scenes::Scene;

/// Encodes a picture of random red, green, blue and alpha.
fn noisy_picture(width: u32, height: u32, is_opaque: bool) -> Vec<u8> {
    let mut noise = Noise(7);
    let samples = 4 * width * height;
    let sample = |at: u32| match at % 4 == 3 && is_opaque {
        true => 255,
        false => noise.below(256) as u8,
    };
    let samples: Vec<u8> = (0..samples).map(sample).collect();
    png_of(width, height, &samples)
}

/// Encodes a model with one voxel in ten solid, and a large unknown chunk.
fn cluttered_model(size: [u8; 3]) -> Vec<u8> {
    let mut noise = Noise(7);
    let chunk = |name: &[u8; 4], contents: &[u8], children: &[u8]| {
        let lengths = [contents, children].map(|part| (part.len() as u32).to_le_bytes());
        [name, lengths.as_flattened(), contents, children].concat()
    };
    let axes = size.map(|extent| u32::from(extent).to_le_bytes());
    let mut voxels = Vec::new();
    for x in 0..size[0] {
        for y in 0..size[1] {
            for z in 0..size[2] {
                if noise.below(10) == 0 {
                    voxels.push([x, y, z, 1 + noise.below(3) as u8]);
                }
            }
        }
    }
    let count = (voxels.len() as u32).to_le_bytes();
    let mut colours = [[200u8, 200, 200, 255]; 256];
    colours[1] = [255, 0, 0, 255];
    let children = [
        chunk(b"JUNK", &vec![7; 1 << 18], &[]),
        chunk(b"SIZE", axes.as_flattened(), &[]),
        chunk(b"XYZI", &[&count, voxels.as_flattened()].concat(), &[]),
        chunk(b"RGBA", colours.as_flattened(), &[]),
    ];
    let version = 150_u32.to_le_bytes();
    let main = chunk(b"MAIN", &[], &children.concat());
    [b"VOX ", &version[..], &main].concat()
}

/// Checks that a scene has the same voxels with the whole file and with the file reduced to the voxels of its
/// bodies, if the pixels of a picture count as they are. Returns the length of the embedded content.
fn check<D: Dim>(file: &str, bytes: &[u8], fields: &str) -> usize {
    let material = "[[material]]\n".repeat(3);
    let text = format!(
        "dim = {}\n{material}[[body]]\nfile = {file:?}\n{fields}",
        D::N
    );
    let scene = Scene::read("toy.toml", &text, &[]).unwrap();
    let mut embedded = scene.clone();
    embedded.body[0].plain = (D::N == 2).then_some(true);
    let fetch = |name: &str| {
        assert_eq!(name, file);
        Ok(bytes.to_vec())
    };
    embedded.embed_files(&fetch).unwrap();
    let built = |scene: &Scene| {
        let world = scene.build::<D>().unwrap();
        let grid = world.soft_bodies().next().unwrap().1.grid().clone();
        let materials: Vec<u8> = grid.voxels().map(|voxel| grid.material(voxel)).collect();
        (grid.size(), materials)
    };
    let refused = scene.build::<D>().unwrap_err().to_string();
    assert!(
        refused.contains("expected the content of the file"),
        "{refused}"
    );
    let mut whole = scene;
    whole.body[0].content = Some(BASE64.encode(bytes));
    assert!(built(&embedded) == built(&whole), "{file}, {fields}");
    let again = embedded.clone();
    let nothing = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    embedded.embed_files(&nothing).unwrap();
    assert_eq!(embedded, again, "embedded content stays unchanged");
    embedded.body[0].content.as_ref().unwrap().len()
}

#[test]
fn embed_reduces_large_picture_to_voxels() {
    let wide = noisy_picture(300, 200, false);
    assert!(wide.len() > 200_000);
    let colours =
        "colours = { \"#ff0000\" = 2, \"#00ff00\" = 1, \"#0000ff\" = 0, \"#fe0000\" = 3 }";
    for fields in ["n = 48\n", "n = 47\n", "n = 300\n", "", colours] {
        let with_n = format!("{fields}\n");
        assert!(
            check::<Dim2>("a.png", &wide, &with_n) < wide.len() / 2,
            "{fields}"
        );
    }
    let small = format!("n = 40\n{colours}\n");
    assert!(check::<Dim2>("b.png", &wide, &small) < 10_000);
    // An opaque picture, read as a drawing: in 64 voxels across it is mostly solid, in 6 it is solid
    // everywhere.
    let opaque = noisy_picture(200, 300, true);
    assert!(check::<Dim2>("c.png", &opaque, "n = 64\n") < 10_000);
    assert!(check::<Dim2>("d.png", &opaque, "n = 6\n") < 1000);
}

#[test]
fn embed_strips_unknown_chunks_from_model() {
    let model = cluttered_model([7, 9, 11]);
    for fields in ["", "colours = { \"#ff0000\" = 2, \"#ffffff\" = 1 }\n"] {
        assert!(check::<Dim3>("a.vox", &model, fields) < 5000);
    }
    // A small file is embedded unchanged.
    let small = noisy_picture(20, 20, false);
    let length = check::<Dim2>("e.png", &small, "n = 5\n");
    assert_eq!(length, small.len().div_ceil(3) * 4);
}

/// Returns the scene of a body made from a file, with the file embedded.
fn embedded(dim: usize, name: &str, bytes: &[u8], fields: &str) -> Scene {
    let text = format!("dim = {dim}\n[[material]]\n[[body]]\nfile = {name:?}\n{fields}");
    let mut scene = Scene::read("toy.toml", &text, &[]).unwrap();
    scene.embed_files(&|_| Ok(bytes.to_vec())).unwrap();
    scene
}

#[test]
fn plain_picture_tells_of_pieces() {
    // Two solid pixels that touch only at a corner, and the same in blocks of 200 × 200 noisy pixels, which are
    // too many to be embedded whole.
    let corner = [[0, 0, 0, 255], [0; 4], [0; 4], [0, 0, 0, 255]];
    let small = png_of(2, 2, corner.as_flattened());
    let mut noise = Noise(3);
    let pixel = |at: u32| {
        let is_solid = (at % 400 < 200) == (at / 400 < 200);
        let [red, green, blue] = [0; 3].map(|_| noise.below(256) as u8);
        [red, green, blue, if is_solid { 255 } else { 0 }]
    };
    let pixels: Vec<[u8; 4]> = (0..400 * 400).map(pixel).collect();
    let large = png_of(400, 400, pixels.as_flattened());
    assert!(large.len() > 1 << 16);
    for bytes in [small, large] {
        let scene = embedded(2, "a.png", &bytes, "n = 2\nplain = true\n");
        let [note] = scene.notes() else {
            panic!("{:?}", scene.notes());
        };
        let text = note.to_string();
        assert!(
            text.starts_with("a.png: the shape falls into 2 pieces"),
            "{text}"
        );
    }
}

#[test]
fn several_models_are_embedded_as_one() {
    let model = |index: u8| model_chunks([1; 3], &[[0, 0, 0, index]]);
    let one = file(150, &[model(1)]);
    let scene = embedded(3, "a.vox", &one, "");
    assert_eq!(scene.body[0].content, Some(BASE64.encode(&one)));

    let nodes = |models: &[i32]| {
        let at = [("_t", "1 0 0")];
        let frames: [&[(&str, &str)]; 2] = [&[], &at];
        let ids = (2..).step_by(2);
        let mut nodes = transform(0, 1, -1, &[], &[&[]]);
        let children: Vec<i32> = ids.clone().take(models.len()).collect();
        nodes.extend(group(1, &[], &children));
        for ((id, &model), frame) in ids.zip(models).zip(frames) {
            nodes.extend(transform(id, id + 1, -1, &[], &[frame]));
            nodes.extend(shape(id + 1, &[], &[model]));
        }
        nodes
    };
    for bytes in [
        file(200, &[model(1), nodes(&[0])]),
        file(200, &[model(1), model(1), nodes(&[0, 1])]),
        file(150, &[model(1), model(1)]),
    ] {
        let scene = embedded(3, "a.vox", &bytes, "");
        let content = scene.body[0].content.as_ref().unwrap();
        let content = BASE64.decode(content).unwrap();
        let has = |name: &[u8]| content.windows(4).filter(|found| *found == name).count();
        assert_eq!([has(b"XYZI"), has(b"nTRN")], [1, 0]);
        assert_ne!(content, bytes);
    }
}

//! PNG pictures become flat shapes, pixel by pixel, and no input bytes cause harm.

use crate::damage::{self, Noise};
use fuwafuwa::{Dim2, Error, VoxelGrid};
use fuwafuwa_scenes::import::{
    Colours, FilePosition, ImportError, MAX_FILE_BYTES, MAX_PIXELS, Picture, Problem,
};
use png::{BitDepth, ColorType, Encoder, Filter};

type Setting<'a, 'b> = Encoder<'a, &'b mut Vec<u8>>;

/// Encodes samples as a PNG file.
fn encode(
    size: [u32; 2],
    (colour, depth): (ColorType, BitDepth),
    samples: &[u8],
    set: impl Fn(&mut Setting),
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    set(&mut encoder);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(samples).unwrap();
    writer.finish().unwrap();
    bytes
}

const GREY: (ColorType, BitDepth) = (ColorType::Grayscale, BitDepth::Eight);
const COLOUR: (ColorType, BitDepth) = (ColorType::Rgba, BitDepth::Eight);

fn grey(width: u32, samples: &[u8]) -> Vec<u8> {
    let height = samples.len() as u32 / width;
    encode([width, height], GREY, samples, |_| {})
}

/// Encodes a greyscale picture. `#` is black, anything else white; the first row is the top.
fn drawing(rows: &[&str]) -> Vec<u8> {
    let sample = |sign| if sign == b'#' { 0 } else { 255 };
    let samples: Vec<u8> = rows
        .iter()
        .flat_map(|row| row.bytes())
        .map(sample)
        .collect();
    grey(rows[0].len() as u32, &samples)
}

fn import(bytes: &[u8], across: usize) -> Result<VoxelGrid<Dim2>, ImportError> {
    Picture::decode("test.png", bytes)?.grid(across, 0.5, &Colours::default())
}

/// Returns the materials of a grid, the highest row first.
fn rows(grid: &VoxelGrid<Dim2>) -> Vec<String> {
    let [width, height, _] = grid.size();
    let sign = |at| char::from(b".#23456789"[usize::from(grid.material(at))]);
    let row = |y| (0..width).map(|x| sign([x, y, 0])).collect();
    (0..height).rev().map(row).collect()
}

fn check(bytes: &[u8], across: usize, expect: &[&str]) {
    assert_eq!(rows(&import(bytes, across).unwrap()), expect);
}

fn complaint(bytes: &[u8]) -> String {
    import(bytes, 8).unwrap_err().to_string()
}

#[test]
fn png_puts_top_row_highest() {
    let bytes = drawing(&["##..", ".#..", "...#"]);
    check(&bytes, 1024, &["##..", ".#..", "...#"]);
    assert_eq!(import(&bytes, 8).unwrap().voxel_size(), 0.5);
    assert_eq!(Picture::decode("a", &bytes).unwrap().size(), [4, 3]);
}

#[test]
fn png_decodes_each_colour_type_and_depth() {
    use BitDepth::{Eight, Four, One, Sixteen, Two};
    use ColorType::{Grayscale, GrayscaleAlpha, Indexed, Rgb, Rgba};
    // Each case has a solid and an empty pixel. They are dark and light, opaque and transparent, or of
    // another colour and of the transparent colour of the file.
    let half = &[255, 255, 128, 0, 0, 0, 127, 255];
    let none = |_: &mut Setting| {};
    let palette = |encoder: &mut Setting| encoder.set_palette(vec![90, 0, 0, 255, 255, 200]);
    let clear_palette = |encoder: &mut Setting| {
        encoder.set_palette(vec![255, 255, 255, 0, 0, 0]);
        encoder.set_trns(vec![255, 0]);
    };
    let clear_grey = |encoder: &mut Setting| encoder.set_trns(vec![0, 9]);
    let clear_colour = |encoder: &mut Setting| encoder.set_trns(vec![0, 1, 0, 2, 0, 3]);
    type Case<'a> = (ColorType, BitDepth, &'a [u8], &'a dyn Fn(&mut Setting));
    let cases: [Case; 18] = [
        (Grayscale, One, &[0b0100_0000], &none),
        (Grayscale, Two, &[0b0111_0000], &none),
        (Grayscale, Four, &[0x7f], &none),
        (Grayscale, Eight, &[127, 128], &none),
        (Grayscale, Sixteen, &[127, 255, 128, 0], &none),
        (GrayscaleAlpha, Eight, &[255, 128, 0, 127], &none),
        (GrayscaleAlpha, Sixteen, half, &none),
        (Rgb, Eight, &[255, 0, 0, 200, 255, 220], &none),
        (
            Rgb,
            Sixteen,
            &[0, 0, 0, 0, 0, 0, 255, 255, 255, 255, 255, 255],
            &none,
        ),
        (Rgba, Eight, &[255, 255, 255, 255, 0, 0, 0, 0], &none),
        (Rgba, Sixteen, &[[255; 8], [0; 8]].concat(), &none),
        (Indexed, One, &[0b0100_0000], &palette),
        (Indexed, Two, &[0b0001_0000], &palette),
        (Indexed, Four, &[0x01], &palette),
        (Indexed, Eight, &[0, 1], &palette),
        (Indexed, Eight, &[0, 1], &clear_palette),
        (Grayscale, Eight, &[200, 9], &clear_grey),
        (Rgb, Eight, &[3, 2, 1, 1, 2, 3], &clear_colour),
    ];
    for (colour, depth, samples, set) in cases {
        let bytes = encode([2, 1], (colour, depth), samples, set);
        let found = rows(&import(&bytes, 8).unwrap());
        assert_eq!(found, ["#."], "{colour:?} {depth:?}");
    }
}

/// Encodes 2 × 2 pixels in the passes of Adam7, which the encoder cannot write. As raw bytes, the passes
/// equal one row of 6 pixels, two of which stand for the filters of the later passes.
///
/// ```text
///   2 × 2 pixels:  0 a | 0 b | 0 c d     each pass begins each of its rows with a filter, here 0
///   6 × 1 pixels:  0 a   0 b   0 c d
/// ```
fn interlaced([a, b, c, d]: [u8; 4]) -> Vec<u8> {
    let unfiltered = |encoder: &mut Setting| encoder.set_filter(Filter::NoFilter);
    let mut bytes = encode([6, 1], GREY, &[a, 0, b, 0, c, d], unfiltered);
    bytes[28] = 1;
    with_size(&bytes, [2, 2])
}

#[test]
fn png_decodes_interlaced_picture() {
    check(&interlaced([255, 0, 0, 0]), 8, &[".#", "##"]);
    check(&interlaced([0, 0, 255, 0]), 8, &["##", ".#"]);
}

#[test]
fn png_selects_opaque_pixels_of_sprite_and_dark_pixels_of_drawing() {
    let pixels = |pixels: &[[u8; 4]]| {
        let size = [pixels.len() as u32, 1];
        encode(size, COLOUR, pixels.as_flattened(), |_| {})
    };
    let (black, white) = ([0, 0, 0, 255], [255; 4]);
    check(&pixels(&[black, white, [0, 0, 0, 127]]), 8, &["##."]);
    // Here no pixel is more than half transparent, so the picture is read as a drawing: its pixels are
    // blended with white paper.
    check(&pixels(&[black, white, [0, 0, 0, 128]]), 8, &["#.#"]);
    check(&pixels(&[black, white, [20, 20, 20, 128]]), 8, &["#.."]);
    // Colours of the pixels: orange, yellow, pale pink, light grey. Only the first two are dark or strong
    // enough to be solid.
    let crayons = [[255, 165, 0], [255, 255, 0], [255, 190, 200], [200; 3]];
    let crayons = crayons.map(|[red, green, blue]| [red, green, blue, 255]);
    check(&pixels(&crayons), 8, &["##.."]);
}

#[test]
fn grid_scales_down_large_picture() {
    let bytes = drawing(&["##..", "#...", "####", "..##"]);
    // With 2 voxels across, each voxel covers 4 pixels, of which 3, 0, 2 and 4 are black.
    check(&bytes, 2, &["#.", "##"]);
    check(&bytes, 9, &["##..", "#...", "####", "..##"]);
    // A row of 3 pixels becomes 2 voxels: each voxel covers one pixel and half of the middle one.
    check(&drawing(&["#.#"]), 2, &["##"]);
    check(&drawing(&["..#"]), 2, &[".#"]);
    check(&drawing(&[".#.", ".#.", "##."]), 2, &["..", "#."]);
    // The sizes in voxels are rounded, and a long picture keeps at least one voxel across.
    check(&drawing(&["#####"; 3]), 3, &["###", "###"]);
    check(&drawing(&["########"]), 2, &["##"]);
    check(&drawing(&["#"; 500]), 2, &["#", "#"]);
}

/// Pixels in red, a darker red, green and transparent.
const PAINTED: [[u8; 4]; 8] = [
    [255, 0, 0, 255],
    [200, 40, 40, 255],
    [0, 255, 0, 255],
    [0, 255, 0, 0],
    [255, 0, 0, 255],
    [255, 0, 0, 255],
    [0, 200, 20, 255],
    [255, 0, 0, 90],
];

fn painted(across: usize, named: &[([u8; 3], u8)]) -> Vec<String> {
    let bytes = encode([4, 2], COLOUR, PAINTED.as_flattened(), |_| {});
    let colours = Colours {
        named: named.iter().copied().collect(),
        ..Colours::default()
    };
    let picture = Picture::decode("test.png", &bytes).unwrap();
    rows(&picture.grid(across, 1.0, &colours).unwrap())
}

#[test]
fn grid_takes_material_of_nearest_colour() {
    let (red, green) = ([255, 0, 0], [0, 255, 0]);
    assert_eq!(painted(9, &[]), ["###.", "###."]);
    assert_eq!(painted(9, &[(red, 3), (green, 2)]), ["332.", "332."]);
    assert_eq!(painted(9, &[(red, 3), (green, 0)]), ["33..", "33.."]);
    assert_eq!(painted(9, &[(red, 7)]), ["777.", "777."]);
    assert_eq!(painted(2, &[(red, 3), (green, 2)]), ["32"]);
    // Half of the picture is red and a quarter is green, so red has the largest solid area.
    assert_eq!(painted(1, &[(red, 3), (green, 2)]), ["3"]);
}

#[test]
fn grid_rejects_palette_indices_for_picture() {
    let picture = Picture::decode("test.png", &drawing(&["#"])).unwrap();
    let colours = Colours {
        indices: [(7, 1)].into(),
        ..Colours::default()
    };
    let error = picture.grid(8, 1.0, &colours).unwrap_err().to_string();
    assert!(error.ends_with("found the palette index 7"), "{error}");
}

#[test]
fn error_names_missing_pixels_for_empty_picture() {
    assert_eq!(
        complaint(&drawing(&["..", ".."])),
        "test.png: the shape is empty: there is no pixel with a red, green or blue below 128"
    );
    // One of the four pixels of a voxel is black.
    let mut thin = ["................"; 16];
    thin[4] = "......#.........";
    assert_eq!(
        complaint(&drawing(&thin)),
        "test.png: the shape is empty: solid pixels cover less than half of every voxel"
    );
    let clear = (ColorType::GrayscaleAlpha, BitDepth::Eight);
    let clear = complaint(&encode([1, 1], clear, &[0, 127], |_| {}));
    assert!(clear.ends_with("an alpha of 128 or more"), "{clear}");
}

#[test]
fn decode_rejects_wrong_size_from_header() {
    let most = MAX_PIXELS;
    let one = drawing(&["#"]);
    for size in [
        [most + 1, 1],
        [1, most + 1],
        [1, u32::MAX >> 1],
        [u32::MAX >> 1; 2],
        [u32::MAX; 2],
    ] {
        let error = import(&with_size(&one, size), 8).unwrap_err();
        assert_eq!(error.position, FilePosition::Chunk(*b"IHDR", 8));
        assert!(
            matches!(error.problem, Problem::TooLarge { found, limit, .. }
            if found == u64::from(size[0].max(size[1])) && limit == u64::from(most))
        );
    }
    assert_eq!(
        complaint(&with_size(&one, [most + 1, 1])),
        "test.png, chunk IHDR at byte 8: 8193 pixels on a side are too many, the limit is 8192; scale the picture down to 99 %"
    );
    // The header states more pixels than a file of this length can contain at the best compression.
    assert_eq!(
        complaint(&with_size(&one, [4096, 4096])),
        "test.png, chunk IHDR at byte 8: expected at least 16261 bytes for 4096 x 4096 pixels, found 67"
    );
    assert!(complaint(&with_size(&one, [100, 100])).contains("expected a PNG picture"));
    for size in [[0, 0], [0, 1], [1, 0]] {
        assert!(complaint(&with_size(&one, size)).contains("expected a PNG picture"));
    }
    let widest = grey(most, &vec![0; most as usize]);
    assert_eq!(import(&widest, 8).unwrap().size(), [8, 1, 1]);
}

#[test]
fn png_rejects_invalid_arguments() {
    let bytes = drawing(&["#"]);
    for across in [0, 1025, usize::MAX] {
        let error = import(&bytes, across).unwrap_err().to_string();
        let expected = format!("test.png: expected 1 to 1024 voxels across, found {across}");
        assert_eq!(error, expected);
    }
    for size in [f32::NAN, -1.0, 0.0, f32::INFINITY] {
        let picture = Picture::decode("test.png", &bytes).unwrap();
        let error = picture.grid(8, size, &Colours::default()).unwrap_err();
        let Problem::Grid(error) = error.problem else {
            panic!("{error}");
        };
        assert!(matches!(*error, Error::InvalidParameter { .. }));
    }
}

#[test]
fn decode_rejects_too_long_file() {
    let long = vec![0; MAX_FILE_BYTES as usize + 1];
    let error = complaint(&long);
    assert!(error.contains("the limit is 134217728"), "{error}");
}

#[test]
fn decode_rejects_truncated_picture_at_every_length() {
    for bytes in samples() {
        assert!(import(&bytes, 4).is_ok());
        for length in 0..bytes.len() {
            let error = import(&bytes[..length], 4).unwrap_err();
            assert!(
                matches!(error.problem, Problem::Unexpected { .. }),
                "{error}"
            );
            let is_inside = !matches!(error.position, FilePosition::Byte(at) if at > length);
            assert!(is_inside, "{length}: {error}");
        }
    }
    assert_eq!(
        complaint(&drawing(&["#"])[..40]),
        "test.png, byte 40: expected a PNG picture, found the end of the file"
    );
    assert_eq!(
        complaint(b"VOX \x96\0\0\0MAIN"),
        "test.png: expected a picture (PNG, JPEG, WebP, GIF or BMP), found a MagicaVoxel model"
    );
}

#[test]
fn decode_survives_damaged_pictures() {
    let mut noise = Noise(1);
    for bytes in samples() {
        for _ in 0..1500 {
            let mut broken = noise.damaged(&bytes);
            damage::check(import(&broken, 4));
            // A checksum reveals most damage, so corrected checksums let the damage reach the decoder.
            mend_checksums(&mut broken);
            damage::check(import(&broken, 4));
        }
    }
    for length in 0..500 {
        let bytes: Vec<u8> = (0..length).map(|_| noise.below(256) as u8).collect();
        assert!(import(&bytes, 4).is_err());
    }
}

#[test]
fn decode_rejects_first_frame_smaller_than_picture() {
    let mut bytes = animated();
    let control = bytes.windows(4).position(|word| word == b"fcTL").unwrap();
    bytes[control + 8..control + 12].copy_from_slice(&1_u32.to_be_bytes());
    mend_checksums(&mut bytes);
    assert!(complaint(&bytes).contains("expected a PNG picture"));
}

/// Encodes a small picture for each kind of decoding.
fn samples() -> Vec<Vec<u8>> {
    let indexed = encode(
        [5, 3],
        (ColorType::Indexed, BitDepth::Two),
        &[0b0001_1000, 0, 0b1111_0000, 0, 0, 0],
        |encoder| {
            encoder.set_palette(vec![0, 0, 0, 255, 255, 255, 9, 9, 9, 0, 0, 0]);
            encoder.set_trns(vec![255, 0]);
            let (title, comment) = ("Title".into(), "Comment".into());
            encoder.add_text_chunk(title, "a shape".into()).unwrap();
            encoder
                .add_ztxt_chunk(comment, "a longer text".into())
                .unwrap();
        },
    );
    let deep = (ColorType::Rgba, BitDepth::Sixteen);
    vec![
        drawing(&["##..", ".#..", "...#"]),
        encode(
            [3, 2],
            (ColorType::Grayscale, BitDepth::One),
            &[0, 0],
            |_| {},
        ),
        encode(
            [2, 1],
            deep,
            &[0, 0, 0, 0, 0, 0, 255, 255].repeat(2),
            |_| {},
        ),
        indexed,
        animated(),
        interlaced([0; 4]),
    ]
}

/// Encodes two frames of 2 × 2 pixels. The first frame is the picture that viewers without animation show.
fn animated() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, 2, 2);
    encoder.set_animated(2, 0).unwrap();
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[0; 4]).unwrap();
    writer.write_image_data(&[255; 4]).unwrap();
    writer.finish().unwrap();
    bytes
}

fn with_size(bytes: &[u8], size: [u32; 2]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[16..20].copy_from_slice(&size[0].to_be_bytes());
    bytes[20..24].copy_from_slice(&size[1].to_be_bytes());
    mend_checksums(&mut bytes);
    bytes
}

/// Corrects the checksums of all chunks whose length is plausible.
fn mend_checksums(bytes: &mut [u8]) {
    let mut at = 8;
    while let Some(word) = bytes.get(at..at + 4) {
        let length = u32::from_be_bytes(word.try_into().unwrap()) as usize;
        let end = at + 8 + length;
        if end + 4 > bytes.len() {
            return;
        }
        let checksum = crc(&bytes[at + 4..end]);
        bytes[end..end + 4].copy_from_slice(&checksum.to_be_bytes());
        at = end + 4;
    }
}

/// Returns the CRC of the PNG specification, annex D, computed bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    let mut remainder = u32::MAX;
    for &byte in bytes {
        remainder ^= u32::from(byte);
        for _ in 0..8 {
            let low = remainder & 1;
            remainder = (remainder >> 1) ^ (low * 0xedb8_8320);
        }
    }
    !remainder
}

//! JPEG, WebP, GIF and BMP files become flat shapes, and no input bytes cause harm.

use crate::damage::{self, Noise};
use fuwafuwa::Dim2;
use fuwafuwa_scenes::import::{ImportError, Picture, PictureOptions, Problem, picture};
use image::codecs::gif::GifEncoder;
use image::{DynamicImage, Frame, ImageFormat, Rgb, RgbImage, RgbaImage};
use std::io::Cursor;

/// Red L of 64 × 96 pixels in a white picture of 80 × 128: an upright bar and a foot to the right, both 32 pixels
/// wide.
fn l_shape() -> DynamicImage {
    let is_solid =
        |x: u32, y: u32| (8..72).contains(&x) && (16..112).contains(&y) && (x < 40 || y >= 80);
    RgbImage::from_fn(80, 128, |x, y| {
        Rgb(if is_solid(x, y) {
            [255, 0, 0]
        } else {
            [255; 3]
        })
    })
    .into()
}

/// The L in voxels of 16 pixels.
const UPRIGHT: [&str; 6] = ["##..", "##..", "##..", "##..", "####", "####"];

fn encoded(format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    l_shape().write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

const FORMATS: [ImageFormat; 4] = [
    ImageFormat::Jpeg,
    ImageFormat::WebP,
    ImageFormat::Gif,
    ImageFormat::Bmp,
];

/// Returns the rows of the shape in voxels of 16 pixels, the highest first.
fn rows(bytes: &[u8], longer: usize) -> Vec<String> {
    let grid = picture("photo.png", bytes, longer, 0.5).unwrap().grid;
    let [width, height, _] = grid.size();
    let sign = |at| if grid.is_solid(at) { '#' } else { '.' };
    let row = |y| (0..width).map(|x| sign([x, y, 0])).collect();
    (0..height).rev().map(row).collect()
}

#[test]
fn picture_is_decoded_by_content_whatever_its_name() {
    for format in FORMATS {
        let found = rows(&encoded(format), 6);
        assert_eq!(found, UPRIGHT, "{format:?}");
    }
}

/// Adds an EXIF segment with an orientation after the first marker of a JPEG file.
fn with_orientation(jpeg: &[u8], orientation: u8) -> Vec<u8> {
    let exif = [
        &b"\xff\xe1\0\x22Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0"[..],
        &[orientation, 0, 0, 0, 0, 0, 0],
    ]
    .concat();
    [&jpeg[..2], &exif, &jpeg[2..]].concat()
}

#[test]
fn photo_is_turned_as_its_exif_orientation_says() {
    let jpeg = encoded(ImageFormat::Jpeg);
    // The values of EXIF: 1 is upright, 3 upside down; the camera of 6 was turned so that the picture must be
    // turned a quarter to the right, 8 to the left; 2 is mirrored.
    for (orientation, expected) in [
        (1, &UPRIGHT[..]),
        (2, &["..##", "..##", "..##", "..##", "####", "####"]),
        (3, &["####", "####", "..##", "..##", "..##", "..##"]),
        (6, &["######", "######", "##....", "##...."]),
        (8, &["....##", "....##", "######", "######"]),
    ] {
        assert_eq!(
            rows(&with_orientation(&jpeg, orientation), 6),
            expected,
            "{orientation}"
        );
    }
}

#[test]
fn decode_refuses_size_from_header_before_it_allocates() {
    let mut bmp = encoded(ImageFormat::Bmp);
    bmp[18..22].copy_from_slice(&20_000u32.to_le_bytes());
    let mut gif = encoded(ImageFormat::Gif);
    gif[6..8].copy_from_slice(&u16::MAX.to_le_bytes());
    for (bytes, expected) in [(bmp, 20_000), (gif, 65_535)] {
        let error = Picture::decode("big", &bytes).unwrap_err();
        let Problem::TooLarge { found, limit, .. } = error.problem else {
            panic!("{error}");
        };
        assert_eq!((found, limit), (expected, 8192));
    }
}

#[test]
fn decode_refuses_size_that_file_is_too_short_for() {
    let mut bmp = encoded(ImageFormat::Bmp);
    bmp[18..22].copy_from_slice(&7000u32.to_le_bytes());
    bmp[22..26].copy_from_slice(&7000u32.to_le_bytes());
    let mut gif = encoded(ImageFormat::Gif);
    let side = 6000u16.to_le_bytes();
    gif[6..10].copy_from_slice(&[side, side].concat());
    for (bytes, expected) in [
        (bmp, "expected at least 382813 bytes for 7000 x 7000 pixels"),
        (gif, "expected at least 13187 bytes for 6000 x 6000 pixels"),
    ] {
        let error = Picture::decode("test.pic", &bytes).unwrap_err().to_string();
        let found = format!("test.pic: {expected}, found {}", bytes.len());
        assert_eq!(error, found);
    }
    let mut bmp = encoded(ImageFormat::Bmp);
    bmp[18..22].copy_from_slice(&8192u32.to_le_bytes());
    bmp[22..26].copy_from_slice(&8192u32.to_le_bytes());
    let error = Picture::decode("test.bmp", &bmp).unwrap_err().to_string();
    let expected = "test.bmp: 67108864 pixels are too many, the limit is 50331648; scale the picture down to 86 %";
    assert_eq!(error, expected);
}

#[test]
fn animation_gives_its_first_frame_with_a_note() {
    let mut gif = Vec::new();
    let mut encoder = GifEncoder::new(&mut gif);
    for side in [20, 10, 5] {
        let is_solid = |x: u32, y: u32| x < side && y < side;
        let pixel = |x, y| {
            image::Rgba(if is_solid(x, y) {
                [0, 0, 0, 255]
            } else {
                [255; 4]
            })
        };
        let frame = Frame::new(RgbaImage::from_fn(40, 40, pixel));
        encoder.encode_frame(frame).unwrap();
    }
    drop(encoder);
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 4, 1);
    encoder.set_animated(3, 0).unwrap();
    let mut writer = encoder.write_header().unwrap();
    for row in [[0, 255, 255, 255], [255, 0, 0, 255], [255; 4]] {
        writer.write_image_data(&row).unwrap();
    }
    writer.finish().unwrap();
    for (bytes, width) in [(gif, 20), (png, 1)] {
        let import = picture("test.gif", &bytes, 64, 0.5).unwrap();
        assert_eq!(import.grid.size(), [width, width, 1]);
        let notes: Vec<_> = import.notes.iter().map(ToString::to_string).collect();
        let expected = "test.gif: only the first frame is taken; 2 more frames are left out";
        assert_eq!(notes, [expected]);
    }
    let import = picture("test.gif", &encoded(ImageFormat::Gif), 6, 0.5).unwrap();
    assert_eq!(import.notes, []);
}

#[test]
fn decode_halves_picture_wider_than_4096_pixels() {
    let wide = RgbImage::from_fn(6000, 20, |x, _| Rgb([if x < 3000 { 0 } else { 255 }; 3]));
    let mut bytes = Cursor::new(Vec::new());
    wide.write_to(&mut bytes, ImageFormat::Bmp).unwrap();
    let picture = Picture::decode("wide", bytes.get_ref()).unwrap();
    assert_eq!(picture.size(), [3000, 10]);
    let grid = picture.import(&PictureOptions::default()).unwrap().grid;
    // The bar of 1500 × 10 pixels is less than half a voxel high, so it is thickened to 2 voxels.
    assert_eq!(grid.size(), [64, 2, 1]);
}

fn import(bytes: &[u8]) -> Result<fuwafuwa::VoxelGrid<Dim2>, ImportError> {
    Ok(picture("test.jpg", bytes, 6, 0.5)?.grid)
}

#[test]
fn decode_names_format_of_damaged_picture() {
    for (format, name) in [
        (ImageFormat::Gif, "a GIF picture"),
        (ImageFormat::WebP, "a WebP picture"),
    ] {
        let error = import(&encoded(format)[..40]).unwrap_err().to_string();
        assert!(
            error.starts_with(&format!("test.jpg: expected {name}, found ")),
            "{error}"
        );
    }
}

#[test]
fn decode_survives_damaged_pictures() {
    let mut noise = Noise(1);
    for format in FORMATS {
        let whole = encoded(format);
        for round in 0..300 {
            let broken = noise.damaged(&whole);
            damage::check(import(&broken));
            damage::check(import(&whole[..whole.len() * round / 300]));
        }
    }
}

#[test]
fn decode_refuses_jpeg_without_its_end() {
    let jpeg = encoded(ImageFormat::Jpeg);
    // What follows the end marker does not matter, and a thumbnail in EXIF data has an end marker of its own.
    let thumbnail = b"\xff\xe1\0\x06\xff\xd9\xff\xd9";
    let with_thumbnail = [&jpeg[..2], thumbnail, &jpeg[2..]].concat();
    for good in [&[&jpeg[..], b"more"].concat(), &with_thumbnail] {
        assert_eq!(rows(good, 6), UPRIGHT);
    }
    for length in [20, 40, jpeg.len() / 2, jpeg.len() - 40, jpeg.len() - 1] {
        for whole in [&jpeg, &with_thumbnail] {
            let error = Picture::decode("cut.jpg", &whole[..length]).unwrap_err();
            assert_eq!(
                error.to_string(),
                format!(
                    "cut.jpg, byte {length}: expected the rest of the JPEG picture up to its end marker, found the end of the file"
                )
            );
        }
    }
}

//! Levels made from pictures.

use fuwafuwa::Dim2;
use std::sync::Arc;
use tamaire_play::level::NAMED;
use tamaire_play::{AnyRound, Level, Replay};

/// Returns a picture of black shapes on white paper, as a PNG file.
fn drawing([width, height]: [u32; 2], is_black: impl Fn(f32, f32) -> bool) -> Vec<u8> {
    let mut pixels = Vec::new();
    for row in 0..height {
        for column in 0..width {
            let is_black = is_black(column as f32 + 0.5, row as f32 + 0.5);
            pixels.push(if is_black { 0 } else { 255 });
        }
    }
    encoded([width, height], png::ColorType::Grayscale, &pixels)
}

fn encoded([width, height]: [u32; 2], colour: png::ColorType, pixels: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(colour);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(pixels).unwrap();
    writer.finish().unwrap();
    bytes
}

fn read(name: &str, bytes: &[u8]) -> Level {
    let nothing = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    Level::read(name, bytes, &nothing).unwrap()
}

/// Returns the low corner, the widths and the area of the body of a level.
fn body(level: &Level) -> ([f32; 2], [f32; 2], f32) {
    let world = level.scene().build::<Dim2>().unwrap();
    let (_, body) = world.soft_bodies().next().unwrap();
    let (grid, voxel) = (body.grid(), body.grid().voxel_size());
    let [columns, rows, _] = grid.size().map(|extent| extent as f32 * voxel);
    let area = grid.solid_count() as f32 * voxel * voxel;
    let [x, y, _] = level.scene().body[0].at;
    ([x, y], [columns, rows], area)
}

#[test]
fn drawn_body_has_area_of_body_of_classic() {
    let (_, _, wanted) = body(&Level::open("classic").unwrap());
    // A ring with a pen of 4 pixels, which is filled, and a bar twice as wide as high.
    let ring = drawing([400, 500], |x, y| {
        ((x - 200.0).hypot(y - 300.0) - 90.0).abs() < 2.0
    });
    let bar = drawing([300, 300], |x, y| {
        (50.0..250.0).contains(&x) && (100.0..200.0).contains(&y)
    });
    for (bytes, widths) in [(ring, [1.0, 1.0]), (bar, [1.253, 0.627])] {
        // The name has no ending, so only the content can tell that this is a picture.
        let (low, found, area) = body(&read("my drawing", &bytes));
        assert!((area / wanted - 1.0).abs() < 0.02, "{area}");
        for axis in 0..2 {
            assert!((found[axis] / widths[axis] - 1.0).abs() < 0.03, "{found:?}");
        }
        assert_eq!(low[0], -1.1);
        assert!((low[1] + 0.5 * found[1]).abs() < 1e-3, "{low:?}");
    }
}

#[test]
fn drawn_body_fits_into_room_beside_basket() {
    let upright = drawing([300, 300], |x, y| {
        (140.0..160.0).contains(&x) && (10.0..290.0).contains(&y)
    });
    let level = read("a.png", &upright);
    let (low, widths, _) = body(&level);
    assert!(
        (widths[1] - 1.8).abs() < 0.01 && low[1] > -1.0,
        "{widths:?}"
    );
    let flat = drawing([300, 300], |x, y| {
        (140.0..160.0).contains(&y) && (10.0..290.0).contains(&x)
    });
    let (low, widths, _) = body(&read("a.png", &flat));
    // The basket of Classic begins at 0.649 m.
    assert!(
        (low[0] + widths[0] - 0.549).abs() < 0.01,
        "{low:?} {widths:?}"
    );
}

#[test]
fn content_decides_between_level_and_replay() {
    let (_, classic) = NAMED[0];
    let picture = drawing([8, 8], |x, _| x < 4.0);
    for (bytes, is_level, is_replay) in [
        (classic.as_bytes(), true, false),
        (&picture[..], true, false),
        (b"VOX \x96\0\0\0MAIN", true, false),
        (
            b"version = 7\nlevel_hash = \"0\"\n\n[scene.game]\n",
            false,
            true,
        ),
        (b"no level and no replay", false, false),
    ] {
        assert_eq!(
            (Level::is_in(bytes), Replay::is_in(bytes)),
            (is_level, is_replay)
        );
    }
}

#[test]
fn picture_of_built_in_level_is_embedded_whole() {
    use base64::Engine;
    let cat = Level::open("cat").unwrap();
    let body = &cat.scene().body[0];
    let content = body.content.as_ref().unwrap();
    let content = base64::prelude::BASE64_STANDARD.decode(content).unwrap();
    // The hash of the level covers its text with the content, so replays and links stay valid only if both
    // are as they were before pictures had the field `plain`.
    assert!(content == include_bytes!("../../levels/cat.png"));
    assert_eq!((body.plain, body.fill), (None, None));
}

/// Returns a disc of red crayon with a black outline on white paper, as a PNG file.
fn coloured_drawing() -> Vec<u8> {
    let mut pixels = Vec::new();
    for at in 0..300 * 300 {
        let (x, y) = ((at % 300) as f32 - 150.0, (at / 300) as f32 - 150.0);
        pixels.extend(match x.hypot(y) {
            0.0..100.0 => [220u8, 40, 50],
            100.0..110.0 => [0; 3],
            _ => [255; 3],
        });
    }
    encoded([300; 2], png::ColorType::Rgb, &pixels)
}

#[test]
fn drawn_body_keeps_colours_in_stored_level_and_replay() {
    let level = read("a.png", &coloured_drawing());
    let kept = Level::read_kept("a.png", level.text_to_keep().unwrap().as_bytes()).unwrap();
    let replay = AnyRound::new(Arc::new(level.clone())).replay();
    let replay = Replay::read(&replay.text()).unwrap();
    let replayed = replay.level().unwrap();
    for level in [&level, &kept, &replayed] {
        // Material 1 of Classic, then red and black.
        let [None, Some(red), Some(black)] = *level.colours() else {
            panic!("{:?}", level.colours());
        };
        assert!(red[0] > 200 && red[1] < 100 && red[2] < 100, "{red:?}");
        assert!(black.into_iter().all(|channel| channel < 60), "{black:?}");
        let grid = level.tint_grids::<Dim2>()[0].as_ref().unwrap();
        let [columns, rows, _] = grid.size();
        assert_eq!(grid.material([columns / 2, rows / 2, 0]), 2);
        assert_eq!(grid.material([1, rows / 2, 0]), 3);
        assert!(level.is_drawing(0) && !level.is_drawing(1));
    }
    assert_eq!(kept.hash(), level.hash());
    let cat = Level::open("cat").unwrap();
    assert!(!cat.is_drawing(0) && cat.tint_grids::<Dim2>()[0].is_none());
}

//! Drawings on paper become solid bodies: on clean paper, and in photos with lines, shadows and noise.

use crate::damage::Noise;
use crate::picture::png_of;
use fuwafuwa::{Dim2, VoxelGrid};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::import::{Import, NoteKind, Picture, PictureOptions};

/// Paper on which shapes are drawn, in pixels from the top left.
struct Sheet {
    size: [usize; 2],
    pixels: Vec<[f64; 3]>,
}

const WHITE: [f64; 3] = [255.0; 3];
const BLACK: [f64; 3] = [0.0; 3];

impl Sheet {
    fn new(size: [usize; 2], colour: [f64; 3]) -> Self {
        let pixels = vec![colour; size[0] * size[1]];
        Self { size, pixels }
    }

    /// Paints the pixels whose centres `is_in` accepts.
    fn paint(&mut self, colour: [f64; 3], is_in: impl Fn(f64, f64) -> bool) {
        for (at, pixel) in self.pixels.iter_mut().enumerate() {
            let (column, row) = (at % self.size[0], at / self.size[0]);
            if is_in(column as f64 + 0.5, row as f64 + 0.5) {
                *pixel = colour;
            }
        }
    }

    fn disc(&mut self, colour: [f64; 3], [x, y]: [f64; 2], radius: f64) {
        self.paint(colour, |a, b| (a - x).hypot(b - y) <= radius);
    }

    /// Draws a circle with a pen of width `pen`, except where it is within `gap` right of the top.
    fn circle(&mut self, colour: [f64; 3], [x, y]: [f64; 2], radius: f64, pen: f64, gap: f64) {
        self.paint(colour, |a, b| {
            let is_gap = b < y && (0.0..gap).contains(&(a - x));
            !is_gap && ((a - x).hypot(b - y) - radius).abs() <= 0.5 * pen
        });
    }

    fn line(&mut self, colour: [f64; 3], from: [f64; 2], to: [f64; 2], pen: f64) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        self.paint(colour, |a, b| {
            let by = [a - from[0], b - from[1]];
            let share = ((by[0] * along[0] + by[1] * along[1]) / square).clamp(0.0, 1.0);
            (by[0] - share * along[0]).hypot(by[1] - share * along[1]) <= 0.5 * pen
        });
    }

    /// Draws a figure `high` pixels high: head with eyes, body, arms and legs.
    fn figure(&mut self, ink: [f64; 3], [x, y]: [f64; 2], high: f64, pen: f64) {
        let at = |a: f64, b: f64| [x + a * high, y + b * high];
        self.circle(ink, at(0.0, -0.3), 0.2 * high, pen, 0.0);
        self.circle(ink, at(0.0, 0.1), 0.2 * high, pen, 0.0);
        for side in [-1.0, 1.0] {
            self.disc(ink, at(0.07 * side, -0.33), 0.02 * high);
            self.line(ink, at(0.19 * side, 0.05), at(0.4 * side, -0.1), pen);
            self.line(ink, at(0.08 * side, 0.28), at(0.12 * side, 0.5), pen);
        }
    }

    /// Adds a shadow that darkens the lower left corner to `darkest`, and noise of `deviation`.
    fn photographed(&mut self, darkest: f64, deviation: f64) {
        let mut noise = Noise(5);
        let [width, height] = self.size.map(|side| side as f64);
        for (at, pixel) in self.pixels.iter_mut().enumerate() {
            let (column, row) = (at % self.size[0], at / self.size[0]);
            let light = 0.6 * column as f64 / width + 0.4 * (1.0 - row as f64 / height);
            let light = darkest + (1.0 - darkest) * light;
            // The sum of four uniform numbers is close to a normal one.
            let sum: usize = (0..4).map(|_| noise.below(1000)).sum();
            let by = (sum as f64 - 1998.0) / 577.0 * deviation;
            *pixel = pixel.map(|channel| (channel * light + by).clamp(0.0, 255.0));
        }
    }

    fn png(&self) -> Vec<u8> {
        self.clear_png(|_, _| false)
    }

    /// Encodes the sheet with those pixels transparent whose centres `is_clear` accepts.
    fn clear_png(&self, is_clear: impl Fn(f64, f64) -> bool) -> Vec<u8> {
        let mut samples = Vec::new();
        for (at, &[red, green, blue]) in self.pixels.iter().enumerate() {
            let (column, row) = (at % self.size[0], at / self.size[0]);
            let is_clear = is_clear(column as f64 + 0.5, row as f64 + 0.5);
            let alpha = if is_clear { 0 } else { 255 };
            samples.extend([red as u8, green as u8, blue as u8, alpha]);
        }
        png_of(self.size[0] as u32, self.size[1] as u32, &samples)
    }

    fn import(&self, across: usize, fill: bool) -> Import<Dim2> {
        let options = PictureOptions {
            across,
            fill,
            ..PictureOptions::default()
        };
        let picture = Picture::decode("test.png", &self.png()).unwrap();
        picture.import(&options).unwrap()
    }
}

fn count(grid: &VoxelGrid<Dim2>) -> f64 {
    grid.solid_count() as f64
}

/// Returns the number of voxels of a disc.
fn disc(across: f64) -> f64 {
    std::f64::consts::FRAC_PI_4 * across * across
}

fn materials(grid: &VoxelGrid<Dim2>) -> Vec<u8> {
    grid.voxels().map(|voxel| grid.material(voxel)).collect()
}

/// Returns the share of voxels that two grids of about the same size have in common.
fn overlap(a: &VoxelGrid<Dim2>, b: &VoxelGrid<Dim2>) -> f64 {
    let both = a
        .voxels()
        .filter(|&at| a.is_solid(at) && b.is_solid(at))
        .count() as f64;
    both / (count(a) + count(b) - both)
}

#[test]
fn import_gives_same_body_with_any_margin() {
    let bodies = [[120, 120], [240, 240], [720, 1020]].map(|size| {
        let mut sheet = Sheet::new(size, WHITE);
        let middle = size.map(|side| (side / 2) as f64);
        sheet.disc(BLACK, middle, 60.0);
        sheet.import(64, true)
    });
    for body in &bodies {
        assert_eq!(body.grid.size(), [64, 64, 1]);
        assert!((count(&body.grid) / disc(64.0) - 1.0).abs() < 0.01);
        assert_eq!(materials(&body.grid), materials(&bodies[0].grid));
        assert_eq!(body.notes, []);
    }
}

#[test]
fn import_fills_closed_outline_unless_fill_is_off() {
    let mut sheet = Sheet::new([800, 900], WHITE);
    sheet.circle([20.0, 20.0, 90.0], [400.0, 400.0], 300.0, 12.0, 0.0);
    // Eyes in the head, which must not become loose pieces.
    sheet.disc(BLACK, [320.0, 330.0], 20.0);
    sheet.circle(BLACK, [480.0, 330.0], 20.0, 6.0, 0.0);
    let filled = sheet.import(60, true);
    assert!((count(&filled.grid) / disc(60.0) - 1.0).abs() < 0.02);
    assert_eq!(filled.notes, []);

    let hollow = sheet.import(60, false);
    assert!(!hollow.grid.is_solid([30, 30, 0]));
    // The pen is 1.2 voxels wide and becomes 2 voxels wide.
    let ring = disc(60.0) - disc(56.0);
    assert!(
        (count(&hollow.grid) / ring - 1.0).abs() < 0.3,
        "{}",
        count(&hollow.grid)
    );
    let pieces = NoteKind::Pieces {
        pieces: 3,
        touch: false,
    };
    assert_eq!(hollow.notes[0].kind, pieces);
}

#[test]
fn import_closes_gap_of_one_voxel_before_it_fills() {
    let across = |gap: f64| {
        let mut sheet = Sheet::new([700, 700], WHITE);
        sheet.circle(BLACK, [350.0, 350.0], 300.0, 8.0, gap);
        sheet.import(60, true).grid
    };
    // A voxel is 10 pixels wide.
    assert!((count(&across(10.0)) / disc(60.0) - 1.0).abs() < 0.02);
    assert!(count(&across(50.0)) < 0.3 * disc(60.0));
}

#[test]
fn import_thickens_pen_thinner_than_a_voxel() {
    // Pens of 2 pixels, voxels of 25, at all angles and places.
    for k in 0..12 {
        let angle = f64::from(k) * 0.26;
        let (along, up) = (250.0 * angle.cos(), 250.0 * angle.sin());
        let mut sheet = Sheet::new([600, 600], WHITE);
        let middle = [300.0 + f64::from(k), 300.0];
        let to = [middle[0] + along, middle[1] - up];
        sheet.line(BLACK, [middle[0] - along, middle[1] + up], to, 2.0);
        let body = sheet.import(20, true);
        assert_eq!(body.notes, [], "{k}");
        assert_eq!(body.grid.size().into_iter().max(), Some(20));
        let found = count(&body.grid);
        assert!((20.0..80.0).contains(&found), "{k}: {found}");
    }
}

#[test]
fn import_of_photo_gives_body_of_drawing() {
    let mut clean = Sheet::new([600, 800], WHITE);
    clean.figure(BLACK, [300.0, 400.0], 500.0, 7.0);
    let clean = clean.import(64, true);
    assert_eq!(clean.notes, []);
    // Head and body of 0.4 of the height each, which overlap in nothing, and four limbs.
    let discs = 2.0 * disc(0.4 * 64.0);
    assert!((discs..1.25 * discs).contains(&count(&clean.grid)));

    let paper = [250.0, 247.0, 235.0];
    let (blue, grey) = ([30.0, 40.0, 130.0], [110.0, 108.0, 112.0]);
    for (ink, faint, is_squared) in [
        (blue, [175.0, 205.0, 238.0], false),
        (blue, [175.0, 205.0, 238.0], true),
        (grey, [225.0, 230.0, 238.0], false),
    ] {
        let mut sheet = Sheet::new([600, 800], paper);
        // Ruled lines of a page that is turned a little.
        sheet.paint(faint, |x, y| {
            let across = is_squared && (x - 0.05 * y).rem_euclid(40.0) < 2.0;
            across || (y + 0.05 * x).rem_euclid(40.0) < 2.0
        });
        sheet.figure(ink, [300.0, 400.0], 500.0, 7.0);
        sheet.photographed(0.5, 5.0);
        let body = sheet.import(64, true);
        let shared = overlap(&clean.grid, &body.grid);
        assert!(shared > 0.95, "{shared}");
        let pieces = |kind: &NoteKind| matches!(kind, NoteKind::Pieces { .. });
        assert!(!body.notes.iter().any(|note| pieces(&note.kind)));
    }
}

#[test]
fn import_leaves_out_table_below_paper_and_says_so() {
    let mut sheet = Sheet::new([900, 1100], [110.0, 70.0, 45.0]);
    sheet.paint([250.0, 248.0, 240.0], |x, y| {
        (60.0..820.0).contains(&(x - 0.04 * y)) && (50.0..1000.0).contains(&(y + 0.04 * x))
    });
    sheet.circle(BLACK, [460.0, 500.0], 250.0, 10.0, 0.0);
    sheet.photographed(0.7, 4.0);
    let body = sheet.import(50, true);
    assert!((count(&body.grid) / disc(50.0) - 1.0).abs() < 0.03);
    let told: Vec<String> = body.notes.iter().map(ToString::to_string).collect();
    let expected = "test.png: what lies along the edge of the picture is left out";
    assert_eq!(told[0], expected);
}

#[test]
fn import_tells_of_specks_and_loose_pieces() {
    let mut sheet = Sheet::new([640, 640], WHITE);
    sheet.circle(BLACK, [320.0, 320.0], 200.0, 10.0, 0.0);
    // Voxels of 640 / 64 pixels: a dot of three voxels outside is a piece, and one of a fifth is a speck.
    sheet.disc(BLACK, [590.0, 320.0], 25.0);
    sheet.disc(BLACK, [40.0, 40.0], 1.0);
    let body = sheet.import(64, true);
    let kinds: Vec<&NoteKind> = body.notes.iter().map(|note| &note.kind).collect();
    let pieces = NoteKind::Pieces {
        pieces: 2,
        touch: false,
    };
    assert_eq!(kinds, [&NoteKind::Specks { left_out: 1 }, &pieces]);
}

#[test]
fn speck_far_away_does_not_coarsen_drawing() {
    let mut sheet = Sheet::new([900, 900], WHITE);
    // A frame of 128 pixels with a dot of 6 pixels in it, which is 3 voxels wide.
    sheet.line(BLACK, [40.0, 40.0], [168.0, 40.0], 4.0);
    sheet.line(BLACK, [40.0, 40.0], [40.0, 168.0], 4.0);
    sheet.disc(BLACK, [120.0, 120.0], 3.0);
    let alone = sheet.import(64, false);
    sheet.disc(BLACK, [880.0, 880.0], 1.5);
    let beside_speck = sheet.import(64, false);
    assert_eq!(materials(&beside_speck.grid), materials(&alone.grid));
    assert_eq!(beside_speck.notes[0].kind, NoteKind::Specks { left_out: 1 });
    assert!(matches!(
        alone.notes[0].kind,
        NoteKind::Pieces { pieces: 2, .. }
    ));
}

#[test]
fn error_of_blank_paper_names_missing_line() {
    let mut sheet = Sheet::new([300, 400], [240.0, 240.0, 225.0]);
    sheet.photographed(0.5, 4.0);
    let picture = Picture::decode("test.png", &sheet.png()).unwrap();
    let error = picture.import(&PictureOptions::default()).unwrap_err();
    let expected = "test.png: the shape is empty: there is no line that is clearly darker or more coloured than the paper";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn import_keeps_rules_of_sprites_but_trims_them() {
    let clear = [0; 4];
    let black = [0, 0, 0, 255];
    let mut pixels = vec![clear; 60];
    // A ring of 3 × 3 pixels with a hole, in a picture of 10 × 6.
    for (row, column) in [
        (1, 4),
        (1, 5),
        (1, 6),
        (2, 4),
        (2, 6),
        (3, 4),
        (3, 5),
        (3, 6),
    ] {
        pixels[row * 10 + column] = black;
    }
    let bytes = png_of(10, 6, pixels.as_flattened());
    let body = Picture::decode("test.png", &bytes).unwrap();
    let body = body.import(&PictureOptions::default()).unwrap();
    assert_eq!(materials(&body.grid), [1, 1, 1, 1, 0, 1, 1, 1, 1]);
}

#[test]
fn scene_embeds_voxels_of_drawing_and_keeps_them() {
    let mut sheet = Sheet::new([400, 400], WHITE);
    sheet.circle(BLACK, [200.0, 150.0], 100.0, 6.0, 0.0);
    let (bytes, expected) = (sheet.png(), sheet.import(40, true));
    for (fields, solid) in [
        ("", count(&expected.grid)),
        ("fill = false", count(&sheet.import(40, false).grid)),
    ] {
        let text = format!("dim = 2\n[[body]]\nfile = \"a drawing\"\nn = 40\n{fields}\n");
        let mut scene = Scene::read("toy.toml", &text, &[]).unwrap();
        scene.embed_files(&|_| Ok(bytes.clone())).unwrap();
        let world = scene.build::<Dim2>().unwrap();
        let (_, body) = world.soft_bodies().next().unwrap();
        assert_eq!(count(body.grid()), solid, "{fields}");
        assert_eq!(body.grid().size(), [40, 40, 1]);
        // Read again, the scene needs neither the file nor the rules for drawings.
        let again = toml::to_string(&scene).unwrap();
        assert_eq!(Scene::read("toy.toml", &again, &[]).unwrap(), scene);
    }
    let refused = |text: &str, bytes: &[u8]| {
        let mut scene = Scene::read("toy.toml", text, &[]).unwrap();
        scene
            .embed_files(&|_| Ok(bytes.to_vec()))
            .unwrap_err()
            .to_string()
    };
    let flat = "dim = 2\n[[body]]\nfile = \"a.png\"\n";
    assert_eq!(
        refused(flat, b"VOX \x96\0\0\0MAIN"),
        "toy.toml, line 3: body 1, file: a.png: expected a picture (PNG, JPEG, WebP, GIF or BMP) for dim = 2, found a MagicaVoxel model"
    );
    let deep = "dim = 3\n[[body]]\nfile = \"a.vox\"\n";
    assert_eq!(
        refused(deep, b"version https://git-lfs.github.com/spec/v1\n"),
        "toy.toml, line 3: body 1, file: a.vox: expected a MagicaVoxel model for dim = 3, found a Git LFS pointer, not the file itself (run git lfs pull)"
    );
}

#[test]
fn outline_at_edge_of_cropped_picture_is_kept() {
    let mut sheet = Sheet::new([400, 400], WHITE);
    sheet.paint(BLACK, |x, y| {
        let edge = x.min(y).min(400.0 - x).min(400.0 - y);
        edge < 10.0
    });
    sheet.disc(BLACK, [130.0, 130.0], 20.0);
    sheet.disc(BLACK, [270.0, 130.0], 20.0);
    sheet.line(BLACK, [100.0, 240.0], [300.0, 310.0], 10.0);
    let body = sheet.import(60, true);
    assert_eq!(body.grid.size(), [60, 60, 1]);
    assert!(count(&body.grid) > 0.98 * 3600.0, "{}", count(&body.grid));
    assert_eq!(body.notes, []);
}

#[test]
fn diagonal_line_of_pixels_is_one_piece() {
    for is_falling in [false, true] {
        let mut sheet = Sheet::new([40, 40], WHITE);
        sheet.paint(BLACK, |x, y| {
            let across = if is_falling { y } else { 40.0 - y };
            (x - across).abs() < 0.5
        });
        let body = sheet.import(64, true);
        assert_eq!(body.notes, []);
        assert_eq!(body.grid.size(), [40, 40, 1]);
        // A line of n pixels needs a pixel at each of its n - 1 corners.
        assert_eq!(count(&body.grid), 79.0);
    }
}

fn import(bytes: &[u8], across: usize) -> Import<Dim2> {
    let options = PictureOptions {
        across,
        ..PictureOptions::default()
    };
    let picture = Picture::decode("test.png", bytes).unwrap();
    picture.import(&options).unwrap()
}

#[test]
fn lines_on_transparent_ground_are_a_drawing() {
    let from_middle = |x: f64, y: f64| (x - 400.0).hypot(y - 400.0);
    let sheet = Sheet::new([800, 800], BLACK);
    // A circle with a pen of 12 pixels and an eye is filled.
    let lines = sheet.clear_png(|x, y| {
        (from_middle(x, y) - 300.0).abs() > 6.0 && (x - 330.0).hypot(y - 350.0) > 20.0
    });
    let drawn = import(&lines, 60);
    assert!((count(&drawn.grid) / disc(60.0) - 1.0).abs() < 0.02);
    assert_eq!(drawn.notes, []);
    // A ring with a width of 100 pixels is a sprite and keeps its hole.
    let ring = sheet.clear_png(|x, y| (from_middle(x, y) - 250.0).abs() > 50.0);
    let ring = import(&ring, 60);
    let expected = disc(60.0) - disc(40.0);
    assert!((count(&ring.grid) / expected - 1.0).abs() < 0.03);
}

#[test]
fn paper_with_transparent_corners_is_paper() {
    let mut sheet = Sheet::new([600, 800], WHITE);
    sheet.circle(BLACK, [300.0, 400.0], 200.0, 8.0, 0.0);
    let opaque = sheet.import(50, true);
    let is_outside_corner = |x: f64, y: f64| {
        let [x, y] = [(x - 300.0).abs() - 240.0, (y - 400.0).abs() - 340.0];
        x > 0.0 && y > 0.0 && x.hypot(y) > 60.0
    };
    let rounded = import(&sheet.clear_png(is_outside_corner), 50);
    let stray = import(&sheet.clear_png(|x, y| x == 300.5 && y == 100.5), 50);
    for body in [rounded, stray] {
        assert_eq!(materials(&body.grid), materials(&opaque.grid));
        assert_eq!(body.notes, []);
    }
    // A sprite in strong colours has rounded corners, too.
    let mut sheet = Sheet::new([600, 600], [0.0, 160.0, 60.0]);
    sheet.disc(BLACK, [200.0, 250.0], 40.0);
    let is_outside_corner = |x: f64, y: f64| {
        let [x, y] = [(x - 300.0).abs() - 240.0, (y - 300.0).abs() - 240.0];
        x > 0.0 && y > 0.0 && x.hypot(y) > 60.0
    };
    let sprite = import(&sheet.clear_png(is_outside_corner), 50);
    assert_eq!(sprite.grid.size(), [50, 50, 1]);
    assert!(count(&sprite.grid) > 0.98 * 2500.0);
}

const RED: [f64; 3] = [214.0, 40.0, 44.0];
const BLUE: [f64; 3] = [40.0, 90.0, 200.0];
const YELLOW: [f64; 3] = [250.0, 214.0, 40.0];

/// A figure 480 pixels high: a head of paper with two eyes in a black outline, a red body and blue legs.
fn coloured_figure() -> Sheet {
    let mut sheet = Sheet::new([400, 560], WHITE);
    sheet.disc(RED, [200.0, 310.0], 110.0);
    for side in [-60.0, 60.0] {
        sheet.line(BLUE, [200.0 + side, 390.0], [200.0 + side, 505.0], 50.0);
    }
    sheet.disc(WHITE, [200.0, 140.0], 90.0);
    sheet.circle(BLACK, [200.0, 140.0], 90.0, 12.0, 0.0);
    for side in [-35.0, 35.0] {
        sheet.disc(BLACK, [200.0 + side, 130.0], 12.0);
    }
    sheet
}

fn import_tinted(bytes: &[u8], across: usize) -> (VoxelGrid<Dim2>, Vec<[u8; 3]>) {
    let options = PictureOptions {
        across,
        ..PictureOptions::default()
    };
    let picture = Picture::decode("test.png", bytes).unwrap();
    let (tinted, tints) = picture.import_tinted(&options).unwrap();
    // Tints change neither the shape nor the notes.
    let plain = picture.import(&options).unwrap();
    assert_eq!(tinted.notes, plain.notes);
    let solid = |grid: &VoxelGrid<Dim2>| -> Vec<bool> {
        grid.voxels().map(|voxel| grid.is_solid(voxel)).collect()
    };
    assert_eq!(solid(&tinted.grid), solid(&plain.grid));
    (tinted.grid, tints)
}

/// Returns whether a tint is a drawn colour, mixed with a little of the colour of skin.
fn is_tint_of(tint: [u8; 3], drawn: [f64; 3]) -> bool {
    (0..3).all(|k| (f64::from(tint[k]) - drawn[k]).abs() < 60.0)
}

#[test]
fn import_tinted_keeps_colours_of_crayons_paper_and_pen() {
    let clean = coloured_figure();
    let mut photo = coloured_figure();
    photo.photographed(0.55, 6.0);
    for sheet in [clean, photo] {
        let (grid, tints) = import_tinted(&sheet.png(), 60);
        assert_eq!(tints.len(), 4, "{tints:?}");
        let at = |x: f64, y: f64| {
            // The figure lies between the rows 44 and 530, and voxels are as high as 60 of them.
            let voxel = (530.0 - 44.0) / 60.0;
            let left = 0.5 * f64::from(grid.size()[0]);
            let (x, y) = ((x - 200.0) / voxel + left, (530.0 - y) / voxel);
            tints[usize::from(grid.material([x as i32, y as i32, 0])) - 1]
        };
        for (place, drawn) in [
            ([200.0, 310.0], RED),
            ([120.0, 310.0], RED),
            ([140.0, 470.0], BLUE),
            ([200.0, 170.0], WHITE),
            ([165.0, 130.0], BLACK),
            ([235.0, 130.0], BLACK),
            ([200.0, 52.0], BLACK),
        ] {
            let found = at(place[0], place[1]);
            assert!(is_tint_of(found, drawn), "{place:?}: {found:?}");
        }
        // The most frequent tint comes first: of the body with 110² π pixels less what the head covers.
        assert!(is_tint_of(tints[0], RED), "{tints:?}");
    }
}

#[test]
fn import_tinted_gives_silhouette_of_one_pen_no_tints() {
    for (ink, expected) in [
        (BLACK, None),
        ([50.0, 50.0, 60.0], None),
        (RED, Some(RED)),
        (YELLOW, Some(YELLOW)),
    ] {
        let mut sheet = Sheet::new([300, 300], WHITE);
        sheet.disc(ink, [150.0, 150.0], 100.0);
        let (grid, tints) = import_tinted(&sheet.png(), 40);
        assert_eq!(tints.len(), usize::from(expected.is_some()), "{ink:?}");
        assert!(
            tints
                .iter()
                .zip(expected)
                .all(|(&tint, ink)| is_tint_of(tint, ink))
        );
        assert!(materials(&grid).iter().all(|&number| number <= 1));
    }
}

#[test]
fn import_tinted_finds_six_tints_at_most() {
    let colours = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| [0, 1, 2].map(|bit| 220 * (k >> bit & 1)));
    let mut pixels = Vec::new();
    for at in 0..80 * 80 {
        let [red, green, blue] = colours[at % 80 / 10].map(|channel| channel as u8);
        // A transparent row makes the picture a sprite, in which white counts, too.
        pixels.extend([red, green, blue, if at < 80 { 0 } else { 255 }]);
    }
    let (grid, tints) = import_tinted(&png_of(80, 80, &pixels), 80);
    assert_eq!(tints.len(), 6);
    let numbers = materials(&grid);
    assert!((1..=6).all(|number| numbers.contains(&number)));
    assert_eq!(numbers.iter().max(), Some(&6));
}

#[test]
fn import_tinted_colours_thickened_strokes_like_their_ink() {
    let mut sheet = Sheet::new([600, 600], WHITE);
    // A pen of 4 pixels in voxels of 25.
    sheet.line(BLUE, [50.0, 550.0], [550.0, 50.0], 4.0);
    let (grid, tints) = import_tinted(&sheet.png(), 20);
    assert!(tints.len() == 1 && is_tint_of(tints[0], BLUE), "{tints:?}");
    assert!(count(&grid) >= 20.0);
}

/// Returns a scene in which a hand tears a body from a picture, with its files embedded.
fn torn_scene(fields: &str, bytes: &[u8]) -> Scene {
    let text = format!(
        "dim = 2\ngravity = [0.0, 0.0, 0.0]\n[[material]]\nyoung = 4000.0\n[[material]]\nyoung = 6000.0\nstrength = 600.0\n\
         [[body]]\nfile = \"a drawing\"\nn = 40\n{fields}\n[[obstacle]]\n\
         half_space = {{ normal = [-1.0, 0.0, 0.0], point = [1.0, 0.0, 0.0] }}\n[[hand]]\nradius = 0.05\n\
         path = [[0.0, -0.2, 0.6, 0.0], [1.0, 0.9, 0.4, 0.0]]\n"
    );
    let mut scene = Scene::read("toy.toml", &text, &[]).unwrap();
    scene.embed_files(&|_| Ok(bytes.to_vec())).unwrap();
    scene
}

#[test]
fn tints_do_not_change_motion() {
    let bytes = coloured_figure().png();
    let mut worlds = ["material = 2", "material = 2\nkeep_colours = true"].map(|fields| {
        let scene = torn_scene(fields, &bytes);
        (scene.build::<Dim2>().unwrap(), scene)
    });
    let mut split = 0;
    for tick in 0..90 {
        let states = worlds.each_mut().map(|(world, scene)| {
            scene.set_hand_targets(world, tick);
            world.step();
            let (_, body) = world.soft_bodies().next().unwrap();
            split = body.pieces().list.len();
            let nodes = body.mesh().nodes();
            let bits = nodes.map(|(id, _)| {
                let (at, velocity, _) = body.node_state(id);
                [at.x, at.y, velocity.x, velocity.y].map(f32::to_bits)
            });
            bits.collect::<Vec<_>>()
        });
        assert!(states[0] == states[1], "tick {tick}");
    }
    assert!(split > 1, "nothing tore, so fracture was not compared");
}

#[test]
fn scene_names_tints_and_keeps_them() {
    let bytes = coloured_figure().png();
    let scene = torn_scene("material = 2\nkeep_colours = true", &bytes);
    let (_, tints) = import_tinted(&bytes, 40);
    let colours = scene.colours();
    assert_eq!(colours[..2], [None, None]);
    let found: Vec<[u8; 3]> = colours[2..].iter().flatten().copied().collect();
    assert_eq!(found, tints);
    // Each tint has the values of material 2.
    let made = scene.materials();
    assert!(made[2..].iter().all(|material| *material == made[1]));
    let body = &scene.body[0];
    assert_eq!((body.keep_colours, body.material), (None, None));
    assert_eq!(body.colours.len(), tints.len());

    // In the world there is only material 2; the tints are those of the picture.
    let world = scene.build::<Dim2>().unwrap();
    let (_, built) = world.soft_bodies().next().unwrap();
    let solid = materials(built.grid());
    assert!(solid.iter().all(|&number| number == 0 || number == 2));
    let (grid, _) = import_tinted(&bytes, 40);
    let shifted = materials(&grid)
        .into_iter()
        .map(|k| if k > 0 { k + 2 } else { 0 });
    let tinted = scene.tint_grids::<Dim2>().unwrap();
    let tinted = tinted[0].as_ref().unwrap();
    assert_eq!(materials(tinted), shifted.collect::<Vec<_>>());

    let text = scene.text().unwrap();
    let again = Scene::read("toy.toml", &text, &[]).unwrap();
    assert!(again == scene && again.build::<Dim2>().unwrap().hash() == world.hash());

    // Without the key, nothing about colours is written.
    let plain = torn_scene("", &bytes);
    assert!(!plain.text().unwrap().contains("colour ="));
    assert!(!plain.text().unwrap().contains("keep_colours"));
    assert_eq!(plain.tint_grids::<Dim2>().unwrap(), [None]);
}

#[test]
fn only_materials_with_colour_are_tints() {
    let numbers = |second: &str| {
        let text = format!(
            "dim = 2\n[[material]]\n[[material]]\n{second}\n[[body]]\nvoxels = {{ size = [4, 1, 1], voxel_size = 0.1, \
             runs = \"2x1 2x2\" }}\n"
        );
        let scene = Scene::read("toy.toml", &text, &[]).unwrap();
        let world = scene.build::<Dim2>().unwrap();
        let (_, body) = world.soft_bodies().next().unwrap();
        materials(body.grid())
    };
    // Files without colours keep their bits, so equal materials stay apart.
    assert_eq!(numbers(""), [1, 1, 2, 2]);
    assert_eq!(numbers("colour = [1, 2, 3]"), [1, 1, 1, 1]);
    assert_eq!(numbers("colour = [1, 2, 3]\nyoung = 9000.0"), [1, 1, 2, 2]);
}

#[test]
fn wrong_colours_are_named() {
    let read = |text: &str| Scene::read("toy.toml", text, &[]).unwrap_err().to_string();
    let wrong = read("dim = 2\n[[material]]\ncolour = [256, 0, 0]\n");
    assert!(
        wrong.starts_with("toy.toml, line 3") && wrong.contains("256"),
        "{wrong}"
    );
    let refused = |fields: &str| {
        let text = format!("dim = 2\n[[body]]\nfile = \"a.png\"\n{fields}\n");
        let mut scene = Scene::read("toy.toml", &text, &[]).unwrap();
        let embedded = scene.embed_files(&|_| Ok(coloured_figure().png()));
        embedded
            .and_then(|()| scene.build::<Dim2>().map(|_| ()))
            .unwrap_err()
            .to_string()
    };
    let both = refused("keep_colours = true\nplain = true");
    assert!(
        both.contains("body 1, keep_colours: not allowed together with plain"),
        "{both}"
    );
    let both = refused("keep_colours = true\ncolours = { \"#ff0000\" = 1 }");
    assert!(
        both.contains("keep_colours: not allowed together with plain, nor"),
        "{both}"
    );
    let missing = refused("keep_colours = true\nmaterial = 7");
    assert!(
        missing.contains("material: expected 1, found 7"),
        "{missing}"
    );
    let text = "dim = 2\n[[body]]\nshape = \"ball\"\nn = 8\nkeep_colours = true\n";
    let scene = Scene::read("toy.toml", text, &[]).unwrap();
    let wrong = scene.build::<Dim2>().unwrap_err().to_string();
    assert!(
        wrong.contains("keep_colours: only for a picture"),
        "{wrong}"
    );
}

#[test]
fn table_around_slightly_turned_paper_is_left_out() {
    let plain = import(&coloured_figure().png(), 60);
    for degrees in [0.7f64, 2.5, -5.0] {
        let mut sheet = coloured_figure();
        let (sine, cosine) = degrees.to_radians().sin_cos();
        sheet.paint([70.0, 60.0, 55.0], |x, y| {
            let (x, y) = (x - 200.0, y - 280.0);
            (x * cosine + y * sine).abs() > 200.0 || (y * cosine - x * sine).abs() > 280.0
        });
        let turned = import(&sheet.png(), 60);
        assert_eq!(materials(&turned.grid), materials(&plain.grid), "{degrees}");
        let kinds = turned.notes.iter().map(|note| &note.kind);
        let left_out = kinds.filter(|kind| **kind == NoteKind::Surroundings { left_out: 4 });
        assert_eq!(left_out.count(), 1, "{:?}", turned.notes);
    }
}

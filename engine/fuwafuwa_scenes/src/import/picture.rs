//! Import of pictures: a drawing or a sprite becomes a flat shape.

use super::colours::Colours;
use super::content::FileType;
use super::drawing;
use super::error::{
    FilePosition, ImportError, PositionedProblem, Problem, in_file, no_grid, too_large_with,
    unexpected,
};
use super::file::check_length;
use super::frames;
use super::mask::{Component, Mask, longer};
use super::note::{Import, ImportNote, NoteKind};
use super::paper::Drawing;
use super::tints::{self, Sample, Samples, Tinted};
use super::{photo, png};
use fuwafuwa::MAX_EXTENT;
use fuwafuwa::{Dim2, Error, VoxelGrid};
use std::ops::Range;

/// Maximum width and height of a picture [pixels].
pub const MAX_PIXELS: u32 = 8192;

/// Maximum number of pixels of a picture: 8192 × 6144, as a camera of 50 megapixels takes.
pub const MAX_AREA: u64 = 3 << 24;

/// Maximum width and height of a decoded picture [pixels]; a larger one is halved. A picture of this size takes
/// 64 MiB.
const MAX_DECODED: usize = 4096;

/// Maximum mean width of the strokes of a drawing without paper, as a share of its longer side. Wider opaque parts
/// are sprites.
const WIDEST_STROKE: f64 = 0.05;
/// Maximum share of transparent pixels at the corners of paper.
const MOST_CORNERS: f64 = 0.1;
/// Maximum share of transparent pixels that do not count at all.
const MOST_STRAY: f64 = 0.001;
/// Minimum red, green and blue of paper with transparent corners. A sprite with such corners is rarely as bright.
const LEAST_BRIGHT: u8 = 192;

/// A decoded picture.
#[derive(Clone, Debug)]
pub struct Picture {
    file: String,
    pixels: Pixels,
    /// Number of frames of an animation that are not imported.
    later_frames: usize,
}

/// Size of a picture and its pixels.
#[derive(Clone, Debug)]
pub(super) struct Pixels {
    pub size: [usize; 2],
    /// Red, green, blue and alpha, row by row from the top.
    pub colours: Vec<[u8; 4]>,
}

/// Options of [`Picture::import`].
#[derive(Clone, Debug)]
pub struct PictureOptions {
    /// Maximum number of voxels on the longer side of the body, 1 to [`MAX_EXTENT`]. Default 64; doubling it
    /// makes simulation about four times as slow.
    pub across: usize,
    /// Edge length of a voxel [m]. Default 1/64.
    pub voxel_size: f32,
    /// Materials of colours. By default no colour is named, and all solid pixels have material 1.
    pub colours: Colours,
    /// Whether closed outlines of a drawing are filled. Default true.
    pub fill: bool,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            across: 64,
            voxel_size: 1.0 / 64.0,
            colours: Colours::default(),
            fill: true,
        }
    }
}

/// Imports a picture with voxels of edge length `voxel_size` [m], at most `across` on its longer side; see
/// [`Picture::import`]. `file` is the name used in errors.
///
/// # Errors
/// [`ImportError`] names the file, the position in it, and what was expected there.
pub fn picture(
    file: &str,
    bytes: &[u8],
    across: usize,
    voxel_size: f32,
) -> Result<Import<Dim2>, ImportError> {
    Picture::decode(file, bytes)?.import(&PictureOptions {
        across,
        voxel_size,
        ..PictureOptions::default()
    })
}

impl Picture {
    /// Decodes a PNG, JPEG, WebP, GIF or BMP file. The content decides the format, not the name. A photo is
    /// turned as its EXIF orientation says. From an animated PNG file, takes the image that viewers without
    /// animation show; from another animated file, the first frame. [`Picture::import`] notes how many frames are
    /// left out. `file` is the name used in errors.
    ///
    /// # Errors
    /// [`ImportError`] if the file is longer than [`super::MAX_FILE_BYTES`], is damaged, truncated or of
    /// another type, or has more than [`MAX_PIXELS`] on a side or more than [`MAX_AREA`] in all.
    pub fn decode(file: &str, bytes: &[u8]) -> Result<Self, ImportError> {
        let pixels = in_file(file, check_length(bytes).and_then(|()| decode(bytes)))?;
        Ok(Self {
            file: file.into(),
            pixels,
            later_frames: frames::left_out(bytes),
        })
    }

    /// Returns the number of pixels in the header of a picture file, at most [`MAX_AREA`]; 0 if the header is
    /// invalid.
    pub(crate) fn pixels_of(bytes: &[u8]) -> usize {
        let size = match FileType::of(bytes) {
            FileType::Png => png::size_of(bytes),
            found => photo::format_of(found).and_then(|format| photo::size_of(bytes, format)),
        };
        let [width, height] = size.unwrap_or_default();
        MAX_AREA.min(u64::from(width) * u64::from(height)) as usize
    }

    /// Returns the note on frames of an animation that are not imported.
    pub(crate) fn frames_note(&self) -> Option<ImportNote> {
        let left_out = self.later_frames;
        let kind = NoteKind::Frames { left_out };
        (left_out > 0).then(|| ImportNote::new(&self.file, kind))
    }

    /// Returns width and height [pixels]. A side of more than 4096 pixels was halved.
    pub fn size(&self) -> [usize; 2] {
        self.pixels.size
    }

    /// Converts what the picture shows to voxels. The top row is the highest. The empty margin around the solid
    /// pixels is trimmed before the picture is scaled.
    ///
    /// These rules decide which pixels are solid, and their material:
    /// - If the options name colours, a pixel gets the material of the nearest one. It is empty if that
    ///   material is 0, or if the pixel is more than half transparent (alpha below 128).
    /// - Otherwise all solid pixels have material 1. If any pixel is more than half transparent, the picture
    ///   is a sprite: the other pixels are solid. If they are thin strokes, they are the ink of a drawing. Bright
    ///   paper with rounded transparent corners, and a picture with a few stray transparent pixels, are drawings
    ///   on white paper.
    /// - If no pixel is so transparent, the picture is a drawing. Ink is what is clearly darker or more
    ///   coloured than the paper around it, so the paper may be coloured, lined or shaded. Closed outlines are
    ///   filled, unless [`PictureOptions::fill`] is off. Gaps of about one voxel are closed. Strokes thinner
    ///   than a voxel are thickened, so that they hold. Specks smaller than a quarter of a voxel, and what
    ///   surrounds the paper along much of the picture's edge, are left out.
    ///
    /// A shape with more than `across` pixels on its longer side is scaled down to `across` voxels. A voxel is
    /// solid if at least half of its area is covered by solid pixels. It gets the material with the largest
    /// area; of equal areas, the lowest number counts. A smaller shape keeps its pixels.
    ///
    /// # Errors
    /// [`ImportError`] if `across` is not 1 to [`MAX_EXTENT`], if no voxel is solid, if the colours name
    /// palette indices, or if the engine rejects `voxel_size`.
    pub fn import(&self, options: &PictureOptions) -> Result<Import<Dim2>, ImportError> {
        let (grid, kinds, _) = in_file(&self.file, self.try_import(options))?;
        Ok(self.noted(grid, kinds))
    }

    /// Imports the picture like [`Picture::import`], and keeps its colours: material number `n` of the voxels
    /// has the tint at index `n − 1` of the second result, as red, green and blue.
    ///
    /// There are at most six tints, the most frequent first. Shades of a colour are one tint. Solid paper
    /// is one tint, as white as in full light. Lines remain visible from about a quarter of a voxel. All tints are mixed with a little of the colour of skin.
    ///
    /// If all solid pixels have one dark pen colour, the list is empty and their material is 1. The list is also
    /// empty if the options name colours, which then decide the materials.
    ///
    /// # Errors
    /// Same errors as [`Picture::import`].
    pub fn import_tinted(
        &self,
        options: &PictureOptions,
    ) -> Result<(Import<Dim2>, Vec<[u8; 3]>), ImportError> {
        let (grid, kinds, samples) = in_file(&self.file, self.try_import(options))?;
        let tinted = samples.and_then(|samples| tints::tinted(&grid, samples()));
        let (grid, tints) = match tinted {
            Some(Tinted { grid, tints }) => (grid, tints),
            None => (grid, Vec::new()),
        };
        Ok((self.noted(grid, kinds), tints))
    }

    fn noted(&self, grid: VoxelGrid<Dim2>, kinds: Vec<NoteKind>) -> Import<Dim2> {
        let notes = kinds.into_iter();
        let notes = notes.map(|kind| ImportNote::new(&self.file, kind));
        Import {
            grid,
            notes: self.frames_note().into_iter().chain(notes).collect(),
        }
    }

    /// Converts each pixel of the picture to voxels of edge length `voxel_size` [m], as for pixel art: the
    /// empty margin is kept, outlines are not filled and strokes are not thickened.
    ///
    /// The rules of [`Picture::import`] decide which pixels are solid, except for drawings: pixels whose red,
    /// green or blue is below 128 of 255, as stored, are solid.
    ///
    /// # Errors
    /// Same errors as [`Picture::import`].
    pub fn grid(
        &self,
        across: usize,
        voxel_size: f32,
        colours: &Colours,
    ) -> Result<VoxelGrid<Dim2>, ImportError> {
        let grid = check_options(across, colours).and_then(|()| {
            let rule = SolidRule::of(&self.pixels, colours);
            let shape = self.shape(&rule);
            let grid = shape.grid(across, voxel_size);
            grid.map_err(|error| no_shape(error, &shape, rule.sought()))
        });
        in_file(&self.file, grid)
    }

    fn try_import(&self, options: &PictureOptions) -> Result<Imported<'_>, PositionedProblem> {
        let PictureOptions { across, .. } = *options;
        check_options(across, &options.colours)?;
        let rule = SolidRule::of(&self.pixels, &options.colours);
        let (drawing, sought) = match rule {
            SolidRule::Drawn => (Some(self.pixels.drawing()), INK),
            SolidRule::Alpha => (self.pixels.drawing_of_sprite(), rule.sought()),
            SolidRule::Colour(_) => (None, rule.sought()),
        };
        let mut samples: Option<Box<dyn FnOnce() -> Samples + '_>> = None;
        let (shape, mut notes) = match drawing {
            Some(drawing) => {
                let mut solid = drawing::solid(&drawing.ink, across, options.fill);
                let shape = Shape::of(&solid.mask);
                let notes = std::mem::take(&mut solid.notes);
                samples = Some(Box::new(move || solid.samples(&drawing)));
                (shape, notes)
            }
            None => {
                if let SolidRule::Alpha = rule {
                    samples = Some(Box::new(|| self.opaque()));
                }
                (self.shape(&rule).trimmed(), Vec::new())
            }
        };
        let grid = shape.grid(across, options.voxel_size);
        let grid = grid.map_err(|error| no_shape(error, &shape, sought))?;
        notes.extend(NoteKind::of_pieces(&grid));
        Ok((grid, notes, samples))
    }

    /// Returns the colours of the opaque pixels, without the empty margin.
    fn opaque(&self) -> Samples {
        let [columns, rows] = self.shape(&SolidRule::Alpha).solid().extent();
        let rows_of_all = self.pixels.colours.chunks_exact(self.pixels.size[0]);
        let kept = rows_of_all.skip(rows.start).take(rows.len());
        let pixels = kept.flat_map(|row| &row[columns.clone()]).map(|&pixel| {
            let [red, green, blue, _] = pixel;
            is_opaque(pixel).then_some(Sample {
                colour: [red, green, blue],
                weight: 1,
            })
        });
        Samples {
            size: [columns.len(), rows.len()],
            pixels: pixels.collect(),
        }
    }

    /// Returns the material of each pixel.
    fn shape(&self, rule: &SolidRule) -> Shape {
        let pixels = self.pixels.colours.iter();
        Shape {
            size: self.pixels.size,
            materials: pixels.map(|&pixel| rule.material_of(pixel)).collect(),
        }
    }
}

/// Voxels, notes, and a function that returns the colours of the solid pixels.
type Imported<'a> = (
    VoxelGrid<Dim2>,
    Vec<NoteKind>,
    Option<Box<dyn FnOnce() -> Samples + 'a>>,
);

/// Returns a PNG file with one pixel per voxel, which [`Picture::grid`] converts to the same voxels. Returns
/// `None` if a material has no colour among `colours`.
pub(crate) fn png_of(grid: &VoxelGrid<Dim2>, colours: &Colours) -> Option<Vec<u8>> {
    let [columns, rows, _] = grid.size();
    let colour_of = |material: u8| match material {
        0 => Some([u8::MAX, u8::MAX, u8::MAX, 0]),
        // A file without a transparent pixel is read as a drawing on white paper, in which black is
        // solid, too.
        _ if colours.named.is_empty() => Some([0, 0, 0, u8::MAX]),
        _ => {
            let mut named = colours.named.iter();
            let (&[red, green, blue], _) = named.find(|(_, named)| **named == material)?;
            Some([red, green, blue, u8::MAX])
        }
    };
    let mut pixels = Vec::new();
    for y in (0..rows).rev() {
        for x in 0..columns {
            pixels.extend(colour_of(grid.material([x, y, 0]))?);
        }
    }
    png::encode([columns as u32, rows as u32], &pixels).ok()
}

fn decode(bytes: &[u8]) -> Result<Pixels, PositionedProblem> {
    let mut pixels = match FileType::of(bytes) {
        FileType::Png => png::decode(bytes)?,
        found => match photo::format_of(found) {
            Some(format) => photo::decode(bytes, format, found)?,
            None => return Err(unexpected(FilePosition::File, EXPECTED, found)),
        },
    };
    while pixels.size.into_iter().max() > Some(MAX_DECODED) {
        pixels = pixels.halved();
    }
    Ok(pixels)
}

/// Expected type of a file.
const EXPECTED: &str = "a picture (PNG, JPEG, WebP, GIF or BMP)";

/// Solid part of a drawing on paper.
const INK: &str = "line that is clearly darker or more coloured than the paper";

/// Checks the size in a picture's header, before memory is allocated for its pixels.
pub(super) fn check_size(
    place: FilePosition,
    [width, height]: [u32; 2],
) -> Result<(), PositionedProblem> {
    let (side, area) = (width.max(height), u64::from(width) * u64::from(height));
    let (what, found, limit) = if side > MAX_PIXELS {
        ("pixels on a side", side.into(), MAX_PIXELS.into())
    } else if area > MAX_AREA {
        ("pixels", area, MAX_AREA)
    } else {
        return Ok(());
    };
    let share = f64::from(MAX_PIXELS) / f64::from(side);
    let share = share.min((MAX_AREA as f64 / area as f64).sqrt());
    let percent = (100.0 * share) as u32;
    let advice = match percent {
        0 => String::new(),
        _ => format!("; scale the picture down to {percent} %"),
    };
    Err(too_large_with(place, what, found, limit, advice))
}

fn check_options(across: usize, colours: &Colours) -> Result<(), PositionedProblem> {
    if !(1..=MAX_EXTENT).contains(&across) {
        let expected = format!("1 to {MAX_EXTENT} voxels across");
        return Err(unexpected(FilePosition::File, expected, across.to_string()));
    }
    if let Some(index) = colours.indices.keys().next() {
        let found = format!("the palette index {index}");
        let expected = "red, green and blue for each material of a picture";
        return Err(unexpected(FilePosition::File, expected, found));
    }
    Ok(())
}

/// Returns the problem of a shape whose grid the engine rejects; `sought` names what would have been solid.
fn no_shape(error: Error, shape: &Shape, sought: &'static str) -> PositionedProblem {
    let has_solid = shape.materials.iter().any(|&material| material != 0);
    match error {
        Error::EmptyGrid if has_solid => (FilePosition::File, Problem::TooThin),
        error => no_grid(error, sought),
    }
}

impl Pixels {
    /// Returns the drawing on paper that the picture shows.
    fn drawing(&self) -> Drawing {
        Drawing::on_paper(self.size, &self.colours)
    }

    /// Returns the drawing that a picture with transparent pixels shows, if it is no sprite.
    fn drawing_of_sprite(&self) -> Option<Drawing> {
        let opaque = Mask {
            size: self.size,
            on: self.colours.iter().map(|&pixel| is_opaque(pixel)).collect(),
        };
        let drawn = self.is_paper(&opaque).then(|| self.drawing());
        if let Some(drawing) = drawn.filter(|drawing| drawing.ink.on.contains(&true)) {
            return Some(drawing);
        }
        let widest = WIDEST_STROKE * longer(&opaque.extent()) as f64;
        let is_drawing = opaque.stroke_width() < widest;
        is_drawing.then(|| Drawing::without_paper(opaque, &self.colours))
    }

    /// Returns whether only a few stray pixels are transparent, or only the rounded corners of bright paper.
    fn is_paper(&self, opaque: &Mask) -> bool {
        let [width, height] = self.size;
        let all = self.colours.len();
        let solid = opaque.on.iter().filter(|is_on| **is_on).count();
        let clear = (all - solid) as f64 / all.max(1) as f64;
        if clear > MOST_CORNERS || clear <= MOST_STRAY {
            return clear <= MOST_STRAY;
        }
        let is_bright = |pixel: &&[u8; 4]| {
            is_opaque(**pixel) && pixel[..3].iter().all(|&channel| channel >= LEAST_BRIGHT)
        };
        let is_at_end = |range: &Range<usize>, side: usize| {
            (range.start == 0 || range.end == side) && 2 * range.len() < side
        };
        let is_corner = |component: &Component| {
            let [columns, rows] = &component.extent;
            is_at_end(columns, width) && is_at_end(rows, height)
        };
        let is_mostly_bright = 2 * self.colours.iter().filter(is_bright).count() >= solid;
        let clear = opaque.clone().inverted().components();
        is_mostly_bright && clear.list.iter().all(is_corner)
    }

    /// Returns the picture at half its size. Each pixel is the mean of a block of 2 × 2; the last row and
    /// column of an odd number are left out.
    fn halved(&self) -> Self {
        let size = self.size.map(|side| (side / 2).max(1));
        let mut colours = Vec::with_capacity(size[0] * size[1]);
        for row in 0..size[1] {
            for column in 0..size[0] {
                colours.push(self.mean([2 * column, 2 * row]));
            }
        }
        Self { size, colours }
    }

    /// Returns the mean colour of a block of 2 × 2 pixels, weighted by alpha.
    fn mean(&self, [column, row]: [usize; 2]) -> [u8; 4] {
        let [width, height] = self.size;
        let (right, below) = ((column + 1).min(width - 1), (row + 1).min(height - 1));
        let block = [[column, row], [right, row], [column, below], [right, below]];
        let mut sums = [0u32; 4];
        for [column, row] in block {
            let [red, green, blue, alpha] = self.colours[row * width + column].map(u32::from);
            let weighted = [red * alpha, green * alpha, blue * alpha, alpha];
            (0..4).for_each(|k| sums[k] += weighted[k]);
        }
        let [red, green, blue, alpha] = sums;
        let of = |sum: u32| (sum / alpha.max(1)) as u8;
        [of(red), of(green), of(blue), (alpha / 4) as u8]
    }
}

/// Rule that decides the material of a pixel.
enum SolidRule<'a> {
    Colour(&'a Colours),
    Alpha,
    Drawn,
}

impl<'a> SolidRule<'a> {
    fn of(pixels: &Pixels, colours: &'a Colours) -> Self {
        if !colours.named.is_empty() {
            return Self::Colour(colours);
        }
        let is_sprite = pixels.colours.iter().any(|&pixel| !is_opaque(pixel));
        if is_sprite { Self::Alpha } else { Self::Drawn }
    }

    /// Returns the material of a pixel, 0 if it is empty.
    fn material_of(&self, pixel: [u8; 4]) -> u8 {
        let [red, green, blue, _] = pixel;
        match self {
            Self::Colour(_) if !is_opaque(pixel) => 0,
            Self::Colour(colours) => colours.nearest([red, green, blue]).unwrap_or(0),
            Self::Alpha => u8::from(is_opaque(pixel)),
            Self::Drawn => u8::from(is_drawn(pixel)),
        }
    }

    fn sought(&self) -> &'static str {
        match self {
            Self::Colour(_) => "pixel with an alpha of 128 or more whose colour is not empty",
            Self::Alpha => "pixel with an alpha of 128 or more",
            Self::Drawn => "pixel with a red, green or blue below 128",
        }
    }
}

fn is_opaque(pixel: [u8; 4]) -> bool {
    pixel[3] >= 128
}

/// Returns whether a pixel, blended with white paper, is dark or strongly coloured.
fn is_drawn(pixel: [u8; 4]) -> bool {
    const WHITE: u32 = 255;
    let [red, green, blue, alpha] = pixel.map(u32::from);
    let shade = (WHITE - red.min(green).min(blue)) * alpha / WHITE;
    WHITE - shade < 128
}

/// Material of each pixel, row by row from the top; 0 is empty.
struct Shape {
    size: [usize; 2],
    materials: Vec<u8>,
}

impl Shape {
    fn of(mask: &Mask) -> Self {
        Self {
            size: mask.size,
            materials: mask.on.iter().copied().map(u8::from).collect(),
        }
    }

    /// Returns which pixels are solid.
    fn solid(&self) -> Mask {
        let on = self.materials.iter().map(|&material| material != 0);
        Mask {
            size: self.size,
            on: on.collect(),
        }
    }

    /// Returns the shape without the empty rows and columns around what is solid.
    fn trimmed(&self) -> Self {
        let [columns, rows] = self.solid().extent();
        let rows_of_all = self.materials.chunks_exact(self.size[0]);
        let kept = rows_of_all.skip(rows.start).take(rows.len());
        Self {
            size: [columns.len(), rows.len()],
            materials: kept
                .flat_map(|row| &row[columns.clone()])
                .copied()
                .collect(),
        }
    }

    /// Returns the voxels of the shape, at most `across` on the longer side.
    fn grid(&self, across: usize, voxel_size: f32) -> Result<VoxelGrid<Dim2>, Error> {
        let [width, height] = self.size;
        if self.materials.is_empty() {
            return Err(Error::EmptyGrid);
        }
        let [columns, rows] = scaled(self.size, across);
        let highest = self.materials.iter().max().copied().unwrap_or(0);
        let mut areas = vec![0; 1 + usize::from(highest)];
        VoxelGrid::from_fn([columns, rows, 1], voxel_size, |[x, y, _]| {
            areas.fill(0);
            for (row, high) in covered(height, rows, rows - 1 - y as usize) {
                for (column, wide) in covered(width, columns, x as usize) {
                    areas[usize::from(self.materials[row * width + column])] += high * wide;
                }
            }
            largest(&areas)
        })
    }
}

/// Returns the size in voxels of a picture with `across` voxels on its longer side, with proportions as close
/// as whole voxels allow.
fn scaled(size: [usize; 2], across: usize) -> [usize; 2] {
    let longer = size[0].max(size[1]);
    let across = across.min(longer);
    size.map(|side| ((2 * side * across + longer) / (2 * longer)).max(1))
}

/// Returns the pixels that voxel `index` of `voxels` covers on an axis of `pixels`, each with the covered
/// length in units of a pixel divided by `voxels`. Integers keep the areas exact.
///
/// ```text
///   3 pixels   ├─────┼─────┼─────┤      covered(3, 2, 0): all of pixel 0 (2), half of pixel 1 (1)
///   2 voxels   ├────────┼────────┤
/// ```
pub(super) fn covered(
    pixels: usize,
    voxels: usize,
    index: usize,
) -> impl Iterator<Item = (usize, u64)> {
    let (low, high) = (index * pixels, (index + 1) * pixels);
    (low / voxels..high.div_ceil(voxels)).map(move |pixel| {
        let part = high.min((pixel + 1) * voxels) - low.max(pixel * voxels);
        (pixel, part as u64)
    })
}

/// Returns the material with the largest covered area, or 0 if more than half is empty; `areas[0]` is the
/// empty area.
fn largest(areas: &[u64]) -> u8 {
    let solid: u64 = areas[1..].iter().sum();
    if solid == 0 || solid < areas[0] {
        return 0;
    }
    let most = (1..areas.len()).min_by_key(|&material| std::cmp::Reverse(areas[material]));
    most.map_or(0, |material| material as u8)
}

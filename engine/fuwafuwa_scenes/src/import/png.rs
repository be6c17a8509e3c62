//! Import of PNG pictures: a drawing or a sprite becomes a flat shape.

use super::colours::Colours;
use super::error::{
    FilePosition, ImportError, PositionedProblem, Problem, in_file, no_grid, unexpected,
};
use super::file::check_length;
use ::png::{
    BitDepth, ColorType, Decoder, DecodingError, Encoder, EncodingError, Limits, Transformations,
};
use fuwafuwa::MAX_EXTENT;
use fuwafuwa::{Dim2, VoxelGrid};
use std::io::{Cursor, ErrorKind};

/// Maximum width and height of a picture [pixels]; a picture of this size takes 64 MiB when decoded.
pub const MAX_PIXELS: u32 = 4096;

/// Maximum memory for the decoder's own tables and rows [bytes].
const DECODER_BYTES: usize = 1 << 24;

/// Maximum expansion of deflate, the compression of PNG: decoded bytes per compressed byte.
const MOST_INFLATED: usize = 1032;

/// A decoded picture.
#[derive(Clone, Debug)]
pub struct Picture {
    file: String,
    size: [usize; 2],
    /// Red, green, blue and alpha, row by row from the top.
    pixels: Vec<[u8; 4]>,
}

/// Imports a PNG silhouette with voxels of edge length `voxel_size` [m], at most `across` on its longer side;
/// see [`Picture::grid`]. `file` is the name used in errors.
///
/// # Errors
/// [`ImportError`] names the file, the position in it, and what was expected there.
pub fn png(
    file: &str,
    bytes: &[u8],
    across: usize,
    voxel_size: f32,
) -> Result<VoxelGrid<Dim2>, ImportError> {
    Picture::decode(file, bytes)?.grid(across, voxel_size, &Colours::default())
}

impl Picture {
    /// Decodes a PNG file of any colour type. From an animated file, takes the image that viewers without
    /// animation show. `file` is the name used in errors.
    ///
    /// # Errors
    /// [`ImportError`] if the file is longer than [`super::MAX_FILE_BYTES`], is damaged or truncated, or has
    /// more than [`MAX_PIXELS`] on a side.
    pub fn decode(file: &str, bytes: &[u8]) -> Result<Self, ImportError> {
        in_file(file, check_length(bytes))?;
        let mut cursor = Cursor::new(bytes);
        let outcome = decode(&mut cursor).unwrap_or_else(|error| {
            let place = FilePosition::Byte(cursor.position() as usize);
            let found = match error {
                DecodingError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
                    "the end of the file".into()
                }
                error => error.to_string(),
            };
            Err(unexpected(place, "a PNG picture", found))
        });
        let (size, pixels) = in_file(file, outcome)?;
        let file = file.into();
        Ok(Self { file, size, pixels })
    }

    /// Returns width and height [pixels].
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Converts the picture to voxels of edge length `voxel_size` [m]. The top row is the highest.
    ///
    /// These rules decide which pixels are solid, and their material:
    /// - If `colours` names colours, a pixel gets the material of the nearest one. It is empty if that
    ///   material is 0, or if the pixel is more than half transparent (alpha below 128).
    /// - Otherwise all solid pixels have material 1. If any pixel is more than half transparent, the picture
    ///   is a sprite: the other pixels are solid.
    /// - If no pixel is so transparent, the picture is a drawing on white paper. Pixels whose red, green or
    ///   blue is below 128 of 255, as stored, are solid.
    ///
    /// A picture with more than `across` pixels on its longer side is scaled down to `across` voxels. A voxel
    /// is solid if at least half of its area is covered by solid pixels. It gets the material with the
    /// largest area; of equal areas, the lowest number counts. A smaller picture keeps its pixels.
    ///
    /// # Errors
    /// [`ImportError`] if `across` is not 1 to [`MAX_EXTENT`], if no voxel is solid, if `colours` names
    /// palette indices, or if the engine rejects `voxel_size`.
    pub fn grid(
        &self,
        across: usize,
        voxel_size: f32,
        colours: &Colours,
    ) -> Result<VoxelGrid<Dim2>, ImportError> {
        in_file(&self.file, self.try_grid(across, voxel_size, colours))
    }

    /// Returns a PNG file with one pixel per voxel, which gives the same voxels as this picture. Returns
    /// `None` if the picture has no solid voxel.
    pub(crate) fn reduced_png(&self, across: usize, colours: &Colours) -> Option<Vec<u8>> {
        let grid = self.grid(across, 1.0, colours).ok()?;
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
        encode([columns as u32, rows as u32], &pixels).ok()
    }

    fn try_grid(
        &self,
        across: usize,
        voxel_size: f32,
        colours: &Colours,
    ) -> Result<VoxelGrid<Dim2>, PositionedProblem> {
        if !(1..=MAX_EXTENT).contains(&across) {
            let expected = format!("1 to {MAX_EXTENT} voxels across");
            return Err(unexpected(FilePosition::File, expected, across.to_string()));
        }
        if let Some(index) = colours.indices.keys().next() {
            let found = format!("the palette index {index}");
            let expected = "red, green and blue for each material of a picture";
            return Err(unexpected(FilePosition::File, expected, found));
        }
        let rule = SolidRule::of(self, colours);
        let materials: Vec<u8> = self
            .pixels
            .iter()
            .map(|&pixel| rule.material_of(pixel))
            .collect();

        let [width, height] = self.size;
        let [columns, rows] = scaled(self.size, across);
        let highest = materials.iter().max().copied().unwrap_or(0);
        let mut areas = vec![0; 1 + usize::from(highest)];
        VoxelGrid::from_fn([columns, rows, 1], voxel_size, |[x, y, _]| {
            areas.fill(0);
            for (row, high) in covered(height, rows, rows - 1 - y as usize) {
                for (column, wide) in covered(width, columns, x as usize) {
                    areas[usize::from(materials[row * width + column])] += high * wide;
                }
            }
            largest(&areas)
        })
        .map_err(|error| no_grid(error, rule.sought()))
    }
}

/// Rule that decides the material of a pixel.
enum SolidRule<'a> {
    Colour(&'a Colours),
    Alpha,
    Drawn,
}

impl<'a> SolidRule<'a> {
    fn of(picture: &Picture, colours: &'a Colours) -> Self {
        if !colours.named.is_empty() {
            return Self::Colour(colours);
        }
        let is_sprite = picture.pixels.iter().any(|&pixel| !is_opaque(pixel));
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

type Pixels = ([usize; 2], Vec<[u8; 4]>);

fn decode(cursor: &mut Cursor<&[u8]>) -> Result<Result<Pixels, PositionedProblem>, DecodingError> {
    let length = cursor.get_ref().len();
    let limits = Limits {
        bytes: DECODER_BYTES,
    };
    let mut decoder = Decoder::new_with_limits(cursor, limits);
    decoder.set_transformations(Transformations::normalize_to_color8() | Transformations::ALPHA);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let header = decoder.read_header_info()?;
    let (width, height) = header.size();
    let place = FilePosition::Chunk(*b"IHDR", 8);
    if width.max(height) > MAX_PIXELS {
        let too_large = Problem::TooLarge {
            what: "pixels on a side",
            found: width.max(height).into(),
            limit: MAX_PIXELS.into(),
        };
        return Ok(Err((place, too_large)));
    }
    // This check runs before memory is allocated: a file of a few bytes cannot contain a large picture.
    let needed = header.raw_bytes().div_ceil(MOST_INFLATED);
    if needed > length {
        let expected = format!("at least {needed} bytes for {width} x {height} pixels");
        return Ok(Err(unexpected(place, expected, format!("{length}"))));
    }

    let mut reader = decoder.read_info()?;
    let length = reader.output_buffer_size();
    let mut channels = vec![0; length.ok_or(DecodingError::LimitsExceeded)?];
    let frame = reader.next_frame(&mut channels)?;
    // Reads the file to its end, so that a file truncated after the last row of pixels is rejected, too.
    reader.finish()?;
    let pixels = channels[..frame.buffer_size()]
        .chunks_exact(frame.color_type.samples())
        .map(|pixel| match *pixel {
            [grey, alpha] => [grey, grey, grey, alpha],
            [red, green, blue, alpha] => [red, green, blue, alpha],
            _ => unreachable!("the decoder adds an alpha channel"),
        });
    let size = [frame.width as usize, frame.height as usize];
    Ok(Ok((size, pixels.collect())))
}

/// Encodes red, green, blue and alpha, row by row from the top, as a PNG file.
fn encode([width, height]: [u32; 2], pixels: &[u8]) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
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
fn covered(pixels: usize, voxels: usize, index: usize) -> impl Iterator<Item = (usize, u64)> {
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

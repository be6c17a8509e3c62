//! Shapes from files: a silhouette from PNG, a model from MagicaVoxel's .vox.
//!
//! Files may be anything. Sizes are checked before memory is asked for, and what is wrong is said
//! with the file, the place in it and what was expected there.

use fuwafuwa::grid::{BuildError, MAX_EXTENT};
use fuwafuwa::{Dim2, Dim3, VoxelGrid};
use std::path::Path;

/// Most pixels on an axis of a PNG.
pub const MAX_PIXELS: u32 = 8192;

/// Why a shape could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file cannot be read.
    #[error("{file}: {source}")]
    File {
        /// The file.
        file: String,
        /// Why.
        source: std::io::Error,
    },
    /// It is not what its name says, or breaks off.
    #[error("{file}: {place}: {reason}")]
    Content {
        /// The file.
        file: String,
        /// Where in the file.
        place: String,
        /// What was expected and what was found.
        reason: String,
    },
    /// The shape in it cannot be a grid.
    #[error("{file}: {source}")]
    Shape {
        /// The file.
        file: String,
        /// Why.
        source: BuildError,
    },
}

/// The silhouette in a PNG file, `across` voxels on its longer side, of edge length `voxel_size` [m].
///
/// A pixel belongs to the body when it is opaque, if any pixel of the image is not (alpha of at
/// least a half), and otherwise when it is dark (a luminance below a half): a sprite, or a drawing
/// on white paper. A voxel is solid when at least half of the pixels under it belong to the body.
/// The lowest row of pixels is the lowest row of voxels. All voxels are of material 1.
///
/// # Errors
/// [`ImportError`] names the file and what is wrong with it.
pub fn png(path: &Path, across: usize, voxel_size: f32) -> Result<VoxelGrid<Dim2>, ImportError> {
    png_bytes(&name_of(path), &read(path)?, across, voxel_size)
}

/// As [`png()`], from bytes in memory; `file` names them in errors.
///
/// # Errors
/// As [`png()`].
pub fn png_bytes(
    file: &str,
    bytes: &[u8],
    across: usize,
    voxel_size: f32,
) -> Result<VoxelGrid<Dim2>, ImportError> {
    let bad = |place: &str, reason: String| ImportError::Content {
        file: file.into(),
        place: place.into(),
        reason,
    };
    if across == 0 || across > MAX_EXTENT {
        let reason = format!("{across} is not between 1 and {MAX_EXTENT}");
        return Err(bad("voxels across", reason));
    }
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::ALPHA | png::Transformations::STRIP_16);
    let header = decoder.read_header_info();
    let header = header.map_err(|error| bad("header", error.to_string()))?;
    let (width, height) = (header.width, header.height);
    if width > MAX_PIXELS || height > MAX_PIXELS {
        let reason = format!("{width} x {height} pixels, at most {MAX_PIXELS} on an axis are read");
        return Err(bad("header", reason));
    }
    let reader = decoder.read_info();
    let mut reader = reader.map_err(|error| bad("header", error.to_string()))?;
    let length = reader.output_buffer_size();
    let length = length.ok_or_else(|| bad("header", "the image is too large".into()))?;
    let mut pixels = vec![0; length];
    let frame = reader.next_frame(&mut pixels);
    let frame = frame.map_err(|error| bad("pixels", error.to_string()))?;
    let belongs = silhouette(&pixels[..frame.buffer_size()], frame.color_type.samples());
    let (width, height) = (frame.width as usize, frame.height as usize);
    let longer = width.max(height);
    let across = across.min(longer);
    let extent = |pixels: usize| (pixels * across / longer).max(1);
    let size = [extent(width), extent(height), 1];
    let solid = |at: [i32; 3]| {
        let [x, y] = [at[0] as usize, size[1] - 1 - at[1] as usize];
        let columns = x * width / size[0]..((x + 1) * width / size[0]).max(x * width / size[0] + 1);
        let rows = y * height / size[1]..((y + 1) * height / size[1]).max(y * height / size[1] + 1);
        let all = columns.len() * rows.len();
        let inside = rows.map(|row| {
            let row = &belongs[row * width..][columns.clone()];
            row.iter().filter(|&&belongs| belongs).count()
        });
        u8::from(2 * inside.sum::<usize>() >= all)
    };
    VoxelGrid::from_fn(size, voxel_size, solid).map_err(|source| ImportError::Shape {
        file: file.into(),
        source,
    })
}

/// Which pixels, each of so many samples with alpha last, belong to the body.
fn silhouette(pixels: &[u8], samples: usize) -> Vec<bool> {
    let has_alpha = samples == 2 || samples == 4;
    let alpha = |pixel: &[u8]| if has_alpha { pixel[samples - 1] } else { 255 };
    let is_sprite = pixels.chunks_exact(samples).any(|pixel| alpha(pixel) < 255);
    let belongs = |pixel: &[u8]| {
        if is_sprite {
            return alpha(pixel) >= 128;
        }
        let [red, green, blue] = match samples {
            1 | 2 => [pixel[0]; 3],
            _ => [pixel[0], pixel[1], pixel[2]],
        };
        // Luminance by ITU-R BT.709, in thousandths.
        213 * u32::from(red) + 715 * u32::from(green) + 72 * u32::from(blue) < 128 * 1000
    };
    pixels.chunks_exact(samples).map(belongs).collect()
}

/// The first model in a .vox file of MagicaVoxel, its voxels of edge length `voxel_size` [m].
///
/// The palette index of a voxel is the number of its material. MagicaVoxel's z points up, ours is
/// y: its (x, y, z) become our (x, z, depth − 1 − y), so that nothing is mirrored.
///
/// # Errors
/// [`ImportError`] names the file, the byte where it went wrong, and what was expected there.
pub fn vox(path: &Path, voxel_size: f32) -> Result<VoxelGrid<Dim3>, ImportError> {
    vox_bytes(&name_of(path), &read(path)?, voxel_size)
}

/// As [`vox()`], from bytes in memory; `file` names them in errors.
///
/// # Errors
/// As [`vox()`].
pub fn vox_bytes(
    file: &str,
    bytes: &[u8],
    voxel_size: f32,
) -> Result<VoxelGrid<Dim3>, ImportError> {
    let mut input = Input { file, bytes, at: 0 };
    input.expect(b"VOX ")?;
    let version = input.number()?;
    if !(150..=200).contains(&version) {
        return Err(input.wrong(format!("version {version}, 150 to 200 are read")));
    }
    input.expect(b"MAIN")?;
    let (content, _) = (input.number()?, input.number()?);
    input.skip(content)?;
    let mut size: Option<[usize; 3]> = None;
    while input.at < bytes.len() {
        let chunk = input.take(4)?.to_vec();
        let (content, children) = (input.number()?, input.number()?);
        let end = input
            .at
            .checked_add(content)
            .filter(|&end| end <= bytes.len());
        let end = end.ok_or_else(|| {
            input.wrong(format!(
                "a chunk of {content} bytes goes on beyond the end of the file"
            ))
        })?;
        match &chunk[..] {
            b"SIZE" => size = Some(input.size()?),
            b"XYZI" => {
                let size = size.ok_or_else(|| input.wrong("XYZI before SIZE".into()))?;
                let materials = input.voxels(size, end)?;
                let [x, y, z] = size;
                let grid = VoxelGrid::from_materials([x, z, y], voxel_size, materials);
                return grid.map_err(|source| ImportError::Shape {
                    file: file.into(),
                    source,
                });
            }
            _ => {}
        }
        input.at = end;
        input.skip(children)?;
    }
    Err(input.wrong("no model: the chunk XYZI is missing".into()))
}

/// Bytes of a file, and how far they are read.
struct Input<'a> {
    file: &'a str,
    bytes: &'a [u8],
    at: usize,
}

impl Input<'_> {
    fn wrong(&self, reason: String) -> ImportError {
        ImportError::Content {
            file: self.file.into(),
            place: format!("byte {}", self.at),
            reason,
        }
    }

    fn take(&mut self, count: usize) -> Result<&[u8], ImportError> {
        let end = self
            .at
            .checked_add(count)
            .filter(|&end| end <= self.bytes.len());
        let end = end.ok_or_else(|| {
            let left = self.bytes.len() - self.at;
            self.wrong(format!(
                "{count} bytes expected, the file ends after {left}"
            ))
        })?;
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    fn skip(&mut self, count: usize) -> Result<(), ImportError> {
        self.take(count).map(|_| ())
    }

    fn expect(&mut self, name: &[u8; 4]) -> Result<(), ImportError> {
        let start = self.at;
        if self.take(4)? == name {
            return Ok(());
        }
        self.at = start;
        let name = String::from_utf8_lossy(name);
        Err(self.wrong(format!("{name:?} expected: this is no .vox file")))
    }

    fn number(&mut self) -> Result<usize, ImportError> {
        let bytes = self.take(4)?;
        let bytes: [u8; 4] = bytes.try_into().expect("four bytes were taken");
        Ok(u32::from_le_bytes(bytes) as usize)
    }

    fn size(&mut self) -> Result<[usize; 3], ImportError> {
        let size = [self.number()?, self.number()?, self.number()?];
        // Coordinates in the file are single bytes.
        if size.iter().any(|&extent| extent == 0 || extent > 256) {
            return Err(self.wrong(format!(
                "a model of {size:?} voxels, 1 to 256 on an axis are read"
            )));
        }
        Ok(size)
    }

    /// The materials of a model whose voxels are listed up to `end`, in our order.
    fn voxels(&mut self, size: [usize; 3], end: usize) -> Result<Vec<u8>, ImportError> {
        let count = self.number()?;
        let room = end.saturating_sub(self.at) / 4;
        if count > room {
            return Err(self.wrong(format!("{count} voxels announced, the chunk holds {room}")));
        }
        let [width, depth, height] = size;
        let mut materials = vec![0; width * depth * height];
        for _ in 0..count {
            let voxel = self.take(4)?;
            let at = [voxel[0], voxel[1], voxel[2]].map(usize::from);
            let material = voxel[3];
            if (0..3).any(|axis| at[axis] >= size[axis]) || material == 0 {
                self.at -= 4;
                return Err(self.wrong(format!(
                    "a voxel at {at:?} of colour {material}: outside the {size:?} of the model, or of colour 0"
                )));
            }
            let [x, y, z] = at;
            materials[((depth - 1 - y) * height + z) * width + x] = material;
        }
        Ok(materials)
    }
}

fn name_of(path: &Path) -> String {
    path.display().to_string()
}

fn read(path: &Path) -> Result<Vec<u8>, ImportError> {
    std::fs::read(path).map_err(|source| ImportError::File {
        file: name_of(path),
        source,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A PNG of 6 x 4 pixels, dark or opaque where `solid` says so.
    fn drawing(colour: png::ColorType, depth: png::BitDepth) -> Vec<u8> {
        let solid = |x: usize, y: usize| y == 3 || x == 1;
        let mut data = Vec::new();
        for y in 0..4 {
            let mut bits = Vec::new();
            for x in 0..6 {
                let dark: u16 = if solid(x, y) { 0 } else { 0xffff };
                let opaque = 0xffff - dark;
                let samples: Vec<u16> = match colour {
                    png::ColorType::Grayscale => vec![dark],
                    png::ColorType::GrayscaleAlpha => vec![0x8000, opaque],
                    png::ColorType::Rgb => vec![dark; 3],
                    png::ColorType::Rgba => vec![0xffff, 0, 0, opaque],
                    png::ColorType::Indexed => vec![u16::from(solid(x, y))],
                };
                for sample in samples {
                    match depth {
                        png::BitDepth::Sixteen => data.extend(sample.to_be_bytes()),
                        png::BitDepth::Eight if colour == png::ColorType::Indexed => {
                            data.push(sample as u8)
                        }
                        png::BitDepth::Eight => data.push((sample >> 8) as u8),
                        _ => bits.push(u8::from(sample != 0)),
                    }
                }
            }
            if !bits.is_empty() {
                let row = bits
                    .iter()
                    .enumerate()
                    .fold(0u8, |row, (x, bit)| row | bit << (7 - x));
                data.push(row);
            }
        }
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, 6, 4);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        if colour == png::ColorType::Indexed {
            encoder.set_palette(vec![255, 255, 255, 10, 20, 30]);
        }
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&data).unwrap();
        writer.finish().unwrap();
        file
    }

    #[test]
    fn silhouettes_of_every_kind_of_png() {
        use png::{BitDepth, ColorType};
        for (colour, depth) in [
            (ColorType::Grayscale, BitDepth::One),
            (ColorType::Grayscale, BitDepth::Eight),
            (ColorType::Grayscale, BitDepth::Sixteen),
            (ColorType::GrayscaleAlpha, BitDepth::Eight),
            (ColorType::Rgb, BitDepth::Eight),
            (ColorType::Rgb, BitDepth::Sixteen),
            (ColorType::Rgba, BitDepth::Eight),
            (ColorType::Rgba, BitDepth::Sixteen),
            (ColorType::Indexed, BitDepth::Eight),
        ] {
            let grid = png_bytes("a.png", &drawing(colour, depth), 64, 0.1).unwrap();
            assert_eq!(grid.size(), [6, 4, 1], "{colour:?} {depth:?}");
            for at in grid.voxels() {
                let expected = at[1] == 0 || at[0] == 1;
                assert_eq!(
                    grid.is_solid(at),
                    expected,
                    "{colour:?} {depth:?} at {at:?}"
                );
            }
        }
        let file = drawing(ColorType::Rgb, BitDepth::Eight);
        assert_eq!(png_bytes("a.png", &file, 3, 0.1).unwrap().size(), [3, 2, 1]);
    }

    /// A model of 3 x 2 x 4 voxels with two voxels.
    fn model() -> Vec<u8> {
        let mut bytes = b"VOX ".to_vec();
        let mut put =
            |words: &[u32]| bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        put(&[150, u32::from_le_bytes(*b"MAIN"), 0, 52]);
        put(&[u32::from_le_bytes(*b"SIZE"), 12, 0, 3, 2, 4]);
        put(&[u32::from_le_bytes(*b"XYZI"), 12, 0, 2]);
        bytes.extend([2, 0, 3, 7, 0, 1, 0, 1]);
        bytes
    }

    #[test]
    fn a_vox_model_stands_upright() {
        let grid = vox_bytes("a.vox", &model(), 0.1).unwrap();
        assert_eq!(grid.size(), [3, 4, 2]);
        assert_eq!(grid.material([2, 3, 1]), 7);
        assert_eq!(grid.material([0, 0, 0]), 1);
        assert_eq!(grid.solid_count(), 2);
    }

    #[test]
    fn hostile_files_get_an_error_and_no_panic() {
        let png_file = drawing(png::ColorType::Rgba, png::BitDepth::Eight);
        let vox_file = model();
        for length in 0..png_file.len() {
            // The last chunk only marks the end; without it the picture is whole.
            let result = png_bytes("a.png", &png_file[..length], 16, 0.1);
            assert!(result.is_err() || length > png_file.len() - 16, "{length}");
        }
        for length in 0..vox_file.len() {
            assert!(
                vox_bytes("a.vox", &vox_file[..length], 0.1).is_err(),
                "{length}"
            );
        }
        let mut seed = 5u32;
        for _ in 0..20_000 {
            for (file, is_png) in [(&png_file, true), (&vox_file, false)] {
                let mut file = file.clone();
                for _ in 0..3 {
                    seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    let place = (seed >> 8) as usize % file.len();
                    file[place] ^= (seed >> 3) as u8;
                }
                if is_png {
                    drop(png_bytes("a.png", &file, 16, 0.1));
                } else {
                    drop(vox_bytes("a.vox", &file, 0.1));
                }
            }
        }
    }

    #[test]
    fn errors_name_file_place_and_limit() {
        let mut far = model();
        let place = far.len() - 8;
        far[place] = 9;
        let message = vox_bytes("cat.vox", &far, 0.1).unwrap_err().to_string();
        assert!(
            message.contains("cat.vox: byte 60") && message.contains("[9, 0, 3]"),
            "{message}"
        );
        let message = vox_bytes("cat.vox", b"PNG nonsense", 0.1)
            .unwrap_err()
            .to_string();
        assert!(message.contains("no .vox file"), "{message}");
        let missing = png(Path::new("nowhere.png"), 16, 0.1)
            .unwrap_err()
            .to_string();
        assert!(missing.contains("nowhere.png"), "{missing}");
        let mut empty = model();
        empty[56] = 0;
        let message = vox_bytes("cat.vox", &empty, 0.1).unwrap_err().to_string();
        assert!(message.contains("no voxel is solid"), "{message}");
    }
}

//! Import of MagicaVoxel's .vox files: a model becomes a solid shape.
//!
//! ```text
//!   "VOX " version                       every number is 4 bytes, little-endian
//!   MAIN  length, length of children     every chunk: name, two lengths, contents, children
//!    ├─ SIZE  x y z                      ┐ once for
//!    ├─ XYZI  count {x y z index}…       ┘ each model
//!    ├─ RGBA  256 × {red green blue alpha}, palette index 1 first
//!    └─ PACK, nTRN, MATL, …              ignored
//! ```
//!
//! The crate `dot_vox` is not used: it recurses into nested chunks, so a small hostile file overflows the
//! stack, and it drops damaged chunks silently.

use super::colours::Colours;
use super::error::{
    FilePosition, ImportError, PositionedProblem, Problem, in_file, no_grid, unexpected,
};
use super::file::check_length;
use fuwafuwa::{Dim3, VoxelGrid};

/// Maximum number of voxels on an axis of a model: the format stores each coordinate in a byte.
pub const MAX_VOXELS_ACROSS: u32 = 256;

/// Accepted versions of the format: 150, and 200 since MagicaVoxel 0.99.7. The chunks read here are the same
/// in both.
const VERSIONS: std::ops::RangeInclusive<u32> = 150..=200;

/// A model on the engine's axes (y up).
#[derive(Clone, Debug)]
pub struct Model {
    file: String,
    size: [usize; 3],
    /// Palette index of each voxel, 0 where empty. The first axis changes fastest.
    voxels: Vec<u8>,
    /// Red, green and blue, palette index 1 first.
    palette: Option<Vec<[u8; 3]>>,
}

/// Imports the first model of a MagicaVoxel file with voxels of edge length `voxel_size` [m]. The palette
/// index of a voxel is its material; see [`Model::grid`]. `file` is the name used in errors.
///
/// # Errors
/// [`ImportError`] names the file, the position in it, and what was expected there.
pub fn vox(file: &str, bytes: &[u8], voxel_size: f32) -> Result<VoxelGrid<Dim3>, ImportError> {
    Model::decode(file, bytes)?.grid(voxel_size, &Colours::default())
}

impl Model {
    /// Decodes the first model of a MagicaVoxel file. `file` is the name used in errors. The model's
    /// transform in the file's scene is ignored.
    ///
    /// In MagicaVoxel the z axis points up, in the engine the y axis. The model is rotated, not mirrored:
    ///
    /// ```text
    ///   MagicaVoxel   z           y  engine      x ← x
    ///                 │  y        │              y ← z
    ///                 │ ╱         │              z ← size of y − 1 − y
    ///                 └── x       └── x
    ///                            ╱
    ///                           z
    /// ```
    ///
    /// # Errors
    /// [`ImportError`] if the file is longer than [`super::MAX_FILE_BYTES`], is damaged or truncated, or has
    /// more than [`MAX_VOXELS_ACROSS`] voxels on an axis.
    pub fn decode(file: &str, bytes: &[u8]) -> Result<Self, ImportError> {
        let model = check_length(bytes).and_then(|()| Self::try_decode(file, bytes));
        in_file(file, model)
    }

    /// Creates a model from a grid. The material of a voxel becomes its palette index; `colours` gives the
    /// colours of the palette, index 1 first, and missing ones are black.
    ///
    /// # Errors
    /// [`ImportError`], which names `file`, if the grid has more than [`MAX_VOXELS_ACROSS`] voxels on an
    /// axis.
    pub fn of(
        file: &str,
        grid: &VoxelGrid<Dim3>,
        colours: &[[u8; 3]],
    ) -> Result<Self, ImportError> {
        let size = grid.size().map(|extent| extent as usize);
        let longest = size.into_iter().max().unwrap_or(0) as u64;
        let too_large = Problem::TooLarge {
            what: "voxels on an axis",
            found: longest,
            limit: MAX_VOXELS_ACROSS.into(),
        };
        let fits = longest <= MAX_VOXELS_ACROSS.into();
        in_file(
            file,
            fits.then_some(()).ok_or((FilePosition::File, too_large)),
        )?;
        let mut palette = colours.to_vec();
        palette.resize(256, [0; 3]);
        Ok(Self {
            file: file.into(),
            size,
            voxels: grid.voxels().map(|voxel| grid.material(voxel)).collect(),
            palette: (!colours.is_empty()).then_some(palette),
        })
    }

    /// Returns the number of voxels on each axis of the engine, empty layers included.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Returns red, green and blue by palette index, 1 first; `None` if the file has no palette.
    pub fn palette(&self) -> Option<&[[u8; 3]]> {
        self.palette.as_deref()
    }

    /// Converts the model to voxels of edge length `voxel_size` [m].
    ///
    /// Without `colours`, the palette index of a voxel, 1 to 255 as stored in the file, is its material
    /// number. Otherwise `colours` gives the material for the index or, if the index is not named, for the
    /// nearest colour.
    ///
    /// # Errors
    /// [`ImportError`] if no voxel is solid, if `colours` has no material for an index, or if the engine
    /// rejects `voxel_size`.
    pub fn grid(&self, voxel_size: f32, colours: &Colours) -> Result<VoxelGrid<Dim3>, ImportError> {
        in_file(&self.file, self.try_grid(voxel_size, colours))
    }

    /// Returns a file with only this model, which gives the same voxels.
    pub fn bytes(&self) -> Vec<u8> {
        let [width, height, depth] = self.size;
        let chunk = |name: &[u8; 4], contents: &[u8], children: &[u8]| {
            let lengths = [contents.len() as u32, children.len() as u32].map(u32::to_le_bytes);
            [name, lengths.as_flattened(), contents, children].concat()
        };
        let size = [width, depth, height].map(|extent| (extent as u32).to_le_bytes());
        let mut voxels = Vec::new();
        for (at, &index) in self.voxels.iter().enumerate() {
            let (x, y, z) = (at % width, at / width % height, at / width / height);
            // Converts the position to the axes of the file, on which z points up.
            let [x, y, z] = [x, depth - 1 - z, y].map(|k| k as u8);
            if index != 0 {
                voxels.extend([x, y, z, index]);
            }
        }
        let count = (voxels.len() as u32 / 4).to_le_bytes();
        let mut children = chunk(b"SIZE", size.as_flattened(), &[]);
        children.extend(chunk(b"XYZI", &[&count, &voxels[..]].concat(), &[]));
        if let Some(palette) = &self.palette {
            let colours = palette.iter();
            let colours = colours.flat_map(|&[red, green, blue]| [red, green, blue, u8::MAX]);
            children.extend(chunk(b"RGBA", &colours.collect::<Vec<_>>(), &[]));
        }
        let version = VERSIONS.start().to_le_bytes();
        [b"VOX ", &version[..], &chunk(b"MAIN", &[], &children)].concat()
    }

    fn try_grid(
        &self,
        voxel_size: f32,
        colours: &Colours,
    ) -> Result<VoxelGrid<Dim3>, PositionedProblem> {
        let mut is_used = [false; 256];
        for &index in &self.voxels {
            is_used[usize::from(index)] = true;
        }
        let mut materials = [0; 256];
        for index in (1..=u8::MAX).filter(|&index| is_used[usize::from(index)]) {
            materials[usize::from(index)] = self.material(index, colours)?;
        }
        let voxels = self.voxels.iter();
        let voxels = voxels.map(|&index| materials[usize::from(index)]).collect();
        VoxelGrid::from_materials(self.size, voxel_size, voxels)
            .map_err(|error| no_grid(error, "solid voxel in the first model"))
    }

    fn material(&self, index: u8, colours: &Colours) -> Result<u8, PositionedProblem> {
        if let Some(&material) = colours.indices.get(&index) {
            return Ok(material);
        }
        if colours.named.is_empty() {
            let all_are_materials = colours.indices.is_empty();
            return all_are_materials.then_some(index).ok_or_else(|| {
                let expected = format!("a material for the palette index {index}");
                unexpected(FilePosition::File, expected, "none")
            });
        }
        let palette = self.palette.as_ref().ok_or_else(|| {
            let expected = "a chunk RGBA with the named colours";
            unexpected(
                FilePosition::File,
                expected,
                "none (name palette indices instead)",
            )
        })?;
        let nearest = colours.nearest(palette[usize::from(index) - 1]);
        Ok(nearest.expect("at least one colour is named"))
    }

    fn try_decode(name: &str, bytes: &[u8]) -> Result<Self, PositionedProblem> {
        let mut file = Bytes { bytes, at: 0 };
        let word = file.word("the letters \"VOX \"")?;
        if word != *b"VOX " {
            let found = format!("\"{}\"", word.escape_ascii());
            return Err(unexpected(
                FilePosition::Byte(0),
                "the letters \"VOX \"",
                found,
            ));
        }
        let version = file.number("the version")?;
        if !VERSIONS.contains(&version) {
            let expected = format!("a version from {} to {}", VERSIONS.start(), VERSIONS.end());
            return Err(unexpected(
                FilePosition::Byte(4),
                expected,
                version.to_string(),
            ));
        }
        let main = file.chunk()?;
        if main.name != *b"MAIN" {
            let found = main.name.escape_ascii().to_string();
            return Err(unexpected(FilePosition::Byte(8), "the chunk MAIN", found));
        }

        let (mut size, mut voxels, mut palette) = (None, None, None);
        let mut chunks = main.children;
        while !chunks.bytes.is_empty() {
            let chunk = chunks.chunk()?;
            match &chunk.name {
                b"SIZE" if size.is_none() => size = Some(chunk.size()?),
                b"XYZI" if voxels.is_none() => {
                    let none = || unexpected(chunk.place, "a chunk SIZE before it", "none");
                    voxels = Some(chunk.voxels(size.ok_or_else(none)?)?);
                }
                b"RGBA" => palette = Some(chunk.palette()?),
                _ => {}
            }
        }
        let end = FilePosition::Byte(chunks.at);
        let none = || unexpected(end, "a model of chunks SIZE and XYZI", "no more chunks");
        let ([width, depth, height], voxels) = size.zip(voxels).ok_or_else(none)?;
        Ok(Self {
            file: name.into(),
            size: [width, height, depth],
            voxels,
            palette,
        })
    }
}

/// Unread part of a file; `at` is its offset in the file.
#[derive(Clone, Copy)]
struct Bytes<'a> {
    bytes: &'a [u8],
    at: usize,
}

struct Chunk<'a> {
    name: [u8; 4],
    place: FilePosition,
    contents: Bytes<'a>,
    children: Bytes<'a>,
}

impl<'a> Bytes<'a> {
    /// Takes the next `count` bytes; `what` names their content in errors.
    fn take(&mut self, count: usize, what: &str) -> Result<Self, PositionedProblem> {
        let Some((taken, rest)) = self.bytes.split_at_checked(count) else {
            let expected = format!("{count} bytes for {what}");
            let found = self.bytes.len().to_string();
            return Err(unexpected(FilePosition::Byte(self.at), expected, found));
        };
        let at = self.at;
        *self = Self {
            bytes: rest,
            at: at + count,
        };
        Ok(Self { bytes: taken, at })
    }

    fn word(&mut self, what: &str) -> Result<[u8; 4], PositionedProblem> {
        let word = self.take(4, what)?.bytes;
        Ok(word.try_into().expect("four bytes were taken"))
    }

    fn number(&mut self, what: &str) -> Result<u32, PositionedProblem> {
        self.word(what).map(u32::from_le_bytes)
    }

    fn chunk(&mut self) -> Result<Chunk<'a>, PositionedProblem> {
        let at = self.at;
        let name = self.word("the name of a chunk")?;
        let length = self.number("the length of a chunk")?;
        let length_of_children = self.number("the length of the children of a chunk")?;
        let title = name.escape_ascii();
        Ok(Chunk {
            name,
            place: FilePosition::Chunk(name, at),
            contents: self.take(length as usize, &format!("the chunk {title}"))?,
            children: self.take(
                length_of_children as usize,
                &format!("the children of the chunk {title}"),
            )?,
        })
    }
}

impl Chunk<'_> {
    /// Checks that the contents have `expected` bytes; `what` names them in errors.
    fn check_length(&self, expected: u64, what: &str) -> Result<(), PositionedProblem> {
        let found = self.contents.bytes.len() as u64;
        let expected_text = format!("{expected} bytes for {what}");
        let wrong = unexpected(self.place, expected_text, found.to_string());
        (found == expected).then_some(()).ok_or(wrong)
    }

    /// Returns the size of a model on the axes of the file.
    fn size(&self) -> Result<[usize; 3], PositionedProblem> {
        self.check_length(12, "a size on three axes")?;
        let mut contents = self.contents;
        let mut size = [0; 3];
        for extent in &mut size {
            let found = contents.number("a size")?;
            if found == 0 {
                let expected = format!("1 to {MAX_VOXELS_ACROSS} voxels on an axis");
                return Err(unexpected(self.place, expected, "0"));
            }
            if found > MAX_VOXELS_ACROSS {
                let too_large = Problem::TooLarge {
                    what: "voxels on an axis",
                    found: found.into(),
                    limit: MAX_VOXELS_ACROSS.into(),
                };
                return Err((self.place, too_large));
            }
            *extent = found as usize;
        }
        Ok(size)
    }

    /// Returns the palette indices of a model of `size` (on the axes of the file) in the engine's order. If
    /// the file lists a voxel twice, the voxel gets the later index.
    fn voxels(&self, size: [usize; 3]) -> Result<Vec<u8>, PositionedProblem> {
        let mut contents = self.contents;
        let count = contents.number("the number of voxels")?;
        self.check_length(4 + 4 * u64::from(count), &format!("{count} voxels"))?;
        let [width, depth, height] = size;
        let mut voxels = vec![0; width * depth * height];
        for (number, voxel) in contents.bytes.chunks_exact(4).enumerate() {
            let place = FilePosition::Byte(contents.at + 4 * number);
            let [x, y, z] = [voxel[0], voxel[1], voxel[2]].map(usize::from);
            if x >= width || y >= depth || z >= height {
                let expected = format!("a voxel in the box of {width} x {depth} x {height}");
                return Err(unexpected(place, expected, format!("({x}, {y}, {z})")));
            }
            if voxel[3] == 0 {
                return Err(unexpected(place, "a palette index from 1 to 255", "0"));
            }
            voxels[((depth - 1 - y) * height + z) * width + x] = voxel[3];
        }
        Ok(voxels)
    }

    fn palette(&self) -> Result<Vec<[u8; 3]>, PositionedProblem> {
        self.check_length(1024, "256 colours")?;
        let colours = self.contents.bytes.chunks_exact(4);
        Ok(colours.map(|k| [k[0], k[1], k[2]]).collect())
    }
}

//! Import of MagicaVoxel's .vox files: the visible models become one solid shape.
//!
//! ```text
//!   "VOX " version                       every number is 4 bytes, little-endian
//!   MAIN  length, length of children     every chunk: name, two lengths, contents, children
//!    ├─ SIZE  x y z                      ┐ once for
//!    ├─ XYZI  count {x y z index}…       ┘ each model
//!    ├─ RGBA  {red green blue alpha}…, palette index 1 first
//!    ├─ nTRN, nGRP, nSHP                 scene of models, see `graph.rs`
//!    ├─ LAYR  layers, which can be hidden
//!    └─ PACK, MATL, …                    ignored
//! ```
//!
//! The crate `dot_vox` is not used: it recurses into nested chunks, so a small hostile file overflows the
//! stack, and it drops damaged chunks silently.

mod assembly;
mod chunk;
mod graph;
mod motion;
mod palette;
mod write;

use self::assembly::{Solid, StoredModel, assemble, check_size};
use self::chunk::{Bytes, POSITIONS};
use self::graph::{Graph, Placed, Placement};
use self::motion::Motion;
use self::palette::Palette;
use super::colours::Colours;
use super::error::{
    FilePosition, ImportError, PositionedProblem, Problem, in_file, no_grid, unexpected,
};
use super::file::check_length;
use super::note::{Import, ImportNote, NoteKind};
use fuwafuwa::{Dim3, VoxelGrid};

/// Maximum number of voxels on an axis of one model of a file: the format stores each coordinate in a byte.
pub const MAX_VOXELS_ACROSS: u32 = 256;

/// Maximum number of voxels, solid or empty, in the box around the solid voxels of all visible models of a
/// file: as many as in the largest single model.
pub const MAX_MODEL_VOXELS: u64 = 1 << 24;

/// Accepted versions of the format: 150, and 200 since MagicaVoxel 0.99.7. The chunks read here are the same
/// in both.
const VERSIONS: std::ops::RangeInclusive<u32> = 150..=200;

/// The visible models of a file, assembled to one, on the engine's axes (y up). Each face of its box touches
/// a solid voxel.
#[derive(Clone, Debug)]
pub struct Model {
    file: String,
    solid: Solid,
    palette: Palette,
    notes: Vec<ImportNote>,
    work: usize,
    is_alone: bool,
}

/// Imports a MagicaVoxel file with voxels of edge length `voxel_size` [m]. The palette index of a voxel is
/// its material; see [`Model::decode`] and [`Model::grid`]. `file` is the name used in errors and notes.
///
/// # Errors
/// [`ImportError`] names the file, the position in it, and what was expected there.
pub fn vox(file: &str, bytes: &[u8], voxel_size: f32) -> Result<Import<Dim3>, ImportError> {
    Model::decode(file, bytes)?.import(voxel_size, &Colours::default())
}

impl Model {
    /// Decodes a MagicaVoxel file. `file` is the name used in errors and notes.
    ///
    /// The visible models are put together as MagicaVoxel shows them: translated and rotated about their
    /// pivots, which are half the size of a model, rounded down to whole voxels. Models are left out if they,
    /// a group around them, or their layer is hidden. Of an animation, the first frame counts. If models
    /// overlap, the first one in the scene decides the material of a voxel, as in MagicaVoxel since version
    /// 0.99.7 (files of version 200); in older files it is the last one. A file without a scene has one
    /// model; several models are the frames of an animation, of which the first one with voxels counts.
    /// [`Model::notes`] tells what was left out.
    ///
    /// Empty space around the solid voxels is removed.
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
    /// [`ImportError`] if the file is longer than [`super::MAX_FILE_BYTES`], is damaged or truncated, has no
    /// solid voxel, or has more than [`MAX_VOXELS_ACROSS`] voxels on an axis of one model, more than
    /// [`fuwafuwa::MAX_EXTENT`] on an axis of the assembled model, or more than [`MAX_MODEL_VOXELS`] in all.
    pub fn decode(file: &str, bytes: &[u8]) -> Result<Self, ImportError> {
        Self::decode_part(file, bytes, None)
    }

    /// Decodes one part of a MagicaVoxel file: the models and groups called `part`, even if they are hidden.
    /// `None` stands for the whole file. See [`Model::decode`].
    ///
    /// # Errors
    /// Same errors as [`Model::decode`]. If no part has this name, the error lists the names that exist.
    pub fn decode_part(file: &str, bytes: &[u8], part: Option<&str>) -> Result<Self, ImportError> {
        let model = check_length(bytes).and_then(|()| Self::try_decode(file, bytes, part));
        in_file(file, model)
    }

    /// Creates a model from the solid voxels of a grid. The material of a voxel becomes its palette index;
    /// `colours` gives the colours of the palette, index 1 first. Missing ones are black; without any, the
    /// palette is MagicaVoxel's default.
    ///
    /// # Errors
    /// [`ImportError`], which names `file`, if the box around the solid voxels has more than
    /// [`MAX_MODEL_VOXELS`].
    pub fn of(
        file: &str,
        grid: &VoxelGrid<Dim3>,
        colours: &[[u8; 3]],
    ) -> Result<Self, ImportError> {
        let whole = Solid {
            size: grid.size().map(|extent| extent as usize),
            voxels: grid.voxels().map(|voxel| grid.material(voxel)).collect(),
        };
        let none = Problem::Empty("solid voxel in the grid");
        let solid = whole.trimmed().ok_or((FilePosition::File, none));
        let solid = solid.and_then(|solid| {
            let [width, height, depth] = solid.size.map(|extent| extent as u64);
            check_size([width, depth, height])?;
            Ok(solid)
        });
        let mut palette = [[0; 3]; 256];
        for (entry, colour) in palette.iter_mut().zip(colours) {
            *entry = *colour;
        }
        if colours.is_empty() {
            palette = palette::DEFAULT;
        }
        in_file(file, solid).map(|solid| Self {
            file: file.into(),
            work: solid.voxels.len(),
            solid,
            palette,
            notes: Vec::new(),
            is_alone: true,
        })
    }

    /// Returns the number of voxels on each axis of the engine.
    pub fn size(&self) -> [usize; 3] {
        self.solid.size
    }

    /// Returns red, green and blue by palette index, 1 first. Colours that the file does not give are those of
    /// MagicaVoxel's default palette.
    pub fn palette(&self) -> &[[u8; 3]] {
        &self.palette[..255]
    }

    /// Returns notes on what was left out of the model, and on overlaps.
    pub fn notes(&self) -> &[ImportNote] {
        &self.notes
    }

    /// Returns whether the file has no other model and no scene, so that its voxels depend on no rule of
    /// assembly.
    pub(crate) fn is_alone(&self) -> bool {
        self.is_alone
    }

    /// Returns the work of decoding the model, in steps that each take some nanoseconds.
    pub(crate) fn work(&self) -> usize {
        self.work
    }

    /// Converts the model to voxels of edge length `voxel_size` [m].
    ///
    /// Without `colours`, the palette index of a voxel, 1 to 255 as stored in the file, is its material
    /// number. Otherwise `colours` gives the material for the index or, if the index is not named, for the
    /// nearest colour. Space that becomes empty around the solid voxels is removed.
    ///
    /// # Errors
    /// [`ImportError`] if no voxel is solid, if `colours` has no material for an index, or if the engine
    /// rejects `voxel_size`.
    pub fn grid(&self, voxel_size: f32, colours: &Colours) -> Result<VoxelGrid<Dim3>, ImportError> {
        in_file(&self.file, self.try_grid(voxel_size, colours))
    }

    /// Converts the model to voxels like [`Model::grid`], with its notes. A further note tells if the solid
    /// voxels are not connected.
    ///
    /// # Errors
    /// Same errors as [`Model::grid`].
    pub fn import(&self, voxel_size: f32, colours: &Colours) -> Result<Import<Dim3>, ImportError> {
        let grid = self.grid(voxel_size, colours)?;
        let pieces = NoteKind::of_pieces(&grid).map(|kind| ImportNote::new(&self.file, kind));
        let notes = self.notes.iter().cloned().chain(pieces).collect();
        Ok(Import { grid, notes })
    }

    /// Returns a file with only this model, which gives the same voxels.
    pub fn bytes(&self) -> Vec<u8> {
        write::file(&self.solid, &self.palette)
    }

    fn try_grid(
        &self,
        voxel_size: f32,
        colours: &Colours,
    ) -> Result<VoxelGrid<Dim3>, PositionedProblem> {
        let mut is_used = [false; 256];
        for &index in &self.solid.voxels {
            is_used[usize::from(index)] = true;
        }
        let mut materials = [0; 256];
        for index in (1..=u8::MAX).filter(|&index| is_used[usize::from(index)]) {
            materials[usize::from(index)] = self.material(index, colours)?;
        }
        let voxels = self.solid.voxels.iter();
        let solid = Solid {
            size: self.solid.size,
            voxels: voxels.map(|&index| materials[usize::from(index)]).collect(),
        };
        let none = Problem::Empty("solid voxel: all colours of the model have material 0");
        let solid = solid.trimmed().ok_or((FilePosition::File, none))?;
        VoxelGrid::from_materials(solid.size, voxel_size, solid.voxels)
            .map_err(|error| no_grid(error, "solid voxel in the model"))
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
        let nearest = colours.nearest(self.palette[usize::from(index) - 1]);
        Ok(nearest.expect("at least one colour is named"))
    }

    fn try_decode(file: &str, bytes: &[u8], part: Option<&str>) -> Result<Self, PositionedProblem> {
        let content = Content::read(bytes)?;
        let mut placed = content.placed(part)?;
        if content.first_is_on_top {
            placed.models.reverse();
        }
        let (solid, disputed) = assemble(&content.models, &placed.models)?;
        if solid.voxels.is_empty() {
            let what = match (part, placed.hidden + placed.unplaced) {
                (Some(_), _) => "solid voxel in this part of the file",
                (None, 0) => "solid voxel in the models of the file",
                (None, _) => {
                    "solid voxel in the visible models of the file; others are hidden or not placed in MagicaVoxel's world"
                }
            };
            return Err((FilePosition::File, Problem::Empty(what)));
        }
        let models = placed.models.iter();
        let listed = models.map(|placement| content.models[placement.model].voxels.len());
        Ok(Self {
            file: file.into(),
            work: solid.voxels.len() + listed.sum::<usize>() + 16 * placed.visits,
            solid,
            palette: content.palette,
            notes: notes(file, &placed, disputed),
            is_alone: content.models.len() == 1 && content.graph.is_empty(),
        })
    }
}

/// Returns the notes on what was left out, and on the number of voxels for which overlapping models have
/// different colours.
fn notes(file: &str, placed: &Placed, disputed: usize) -> Vec<ImportNote> {
    let kinds = [
        (
            placed.hidden,
            NoteKind::HiddenModels {
                left_out: placed.hidden,
            },
        ),
        (
            placed.unplaced,
            NoteKind::UnplacedModels {
                left_out: placed.unplaced,
            },
        ),
        (
            placed.later_frames,
            NoteKind::Frames {
                left_out: placed.later_frames,
            },
        ),
        (disputed, NoteKind::Overlap { voxels: disputed }),
    ];
    let kinds = kinds.into_iter().filter(|(count, _)| *count > 0);
    kinds.map(|(_, kind)| ImportNote::new(file, kind)).collect()
}

/// Chunks of a file that matter for its shape.
struct Content<'a> {
    models: Vec<StoredModel>,
    palette: Palette,
    graph: Graph<'a>,
    /// Whether the first of overlapping models decides the material of a voxel, not the last.
    first_is_on_top: bool,
}

impl<'a> Content<'a> {
    fn read(bytes: &'a [u8]) -> Result<Self, PositionedProblem> {
        let mut file = Bytes { bytes, at: 0 };
        let version = read_version(&mut file)?;
        let main = file.chunk()?;
        if main.name != *b"MAIN" {
            let found = main.name.escape_ascii().to_string();
            return Err(unexpected(FilePosition::Byte(8), "the chunk MAIN", found));
        }
        let mut content = Self {
            models: Vec::new(),
            palette: palette::DEFAULT,
            graph: Graph::default(),
            first_is_on_top: version == *VERSIONS.end(),
        };
        let mut is_known = vec![false; POSITIONS];
        let mut pending = None;
        let mut chunks = main.children;
        while !chunks.bytes.is_empty() {
            let chunk = chunks.chunk()?;
            match &chunk.name {
                b"SIZE" if pending.is_none() => pending = Some(chunk.size()?),
                b"SIZE" => {
                    let found = "a second chunk SIZE";
                    return Err(unexpected(chunk.place, "a chunk XYZI after SIZE", found));
                }
                b"XYZI" => {
                    let none = || unexpected(chunk.place, "a chunk SIZE before it", "none");
                    let size = pending.take().ok_or_else(none)?;
                    let voxels = chunk.voxels(size, &mut is_known)?;
                    content.models.push(StoredModel { size, voxels });
                }
                b"RGBA" => content.palette = chunk.palette()?,
                b"nTRN" | b"nGRP" | b"nSHP" => content.graph.add_node(&chunk)?,
                b"LAYR" => content.graph.add_layer(&chunk)?,
                _ => {}
            }
        }
        if content.models.is_empty() || pending.is_some() {
            let end = FilePosition::Byte(chunks.at);
            let expected = "a model of chunks SIZE and XYZI";
            return Err(unexpected(end, expected, "no more chunks"));
        }
        Ok(content)
    }

    /// Returns the models of the part called `part`, or of the whole file.
    fn placed(&self, part: Option<&str>) -> Result<Placed, PositionedProblem> {
        let models = self.models.iter();
        let is_solid: Vec<bool> = models.map(|model| !model.voxels.is_empty()).collect();
        if !self.graph.is_empty() || part.is_some() {
            return self.graph.placed(&is_solid, part);
        }
        let first = is_solid.iter().position(|&is_solid| is_solid);
        let count = is_solid.iter().filter(|&&is_solid| is_solid).count();
        let motion = Motion::NONE;
        Ok(Placed {
            models: first
                .map(|model| Placement { model, motion })
                .into_iter()
                .collect(),
            later_frames: count.saturating_sub(1),
            ..Placed::default()
        })
    }
}

fn read_version(file: &mut Bytes) -> Result<u32, PositionedProblem> {
    let word = file.word("the letters \"VOX \"")?;
    if word != *b"VOX " {
        let expected = "the letters \"VOX \"";
        let found = format!("\"{}\"", word.escape_ascii());
        return Err(unexpected(FilePosition::Byte(0), expected, found));
    }
    let version = file.number("the version")?;
    if !VERSIONS.contains(&version) {
        let expected = format!("a version from {} to {}", VERSIONS.start(), VERSIONS.end());
        return Err(unexpected(FilePosition::Byte(4), expected, version));
    }
    Ok(version)
}

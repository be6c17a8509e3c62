//! Shapes from files: pictures in 2D, MagicaVoxel models (`.vox`) in 3D.
//!
//! ```no_run
//! # use bevy_asset::AssetServer;
//! # use bevy_fuwafuwa::asset::{Voxels, VoxelsSettings};
//! # use bevy_fuwafuwa::{SoftBody2d, SoftBody3d};
//! # let assets: &AssetServer = unimplemented!();
//! let dice = SoftBody3d::asset(assets.load("dice.vox"));
//! // With a voxel size other than the default:
//! let small = |settings: &mut VoxelsSettings| settings.voxel_size = 0.01;
//! let cat = SoftBody2d::asset(assets.load_builder().with_settings(small).load("cat.png"));
//! ```
//!
//! Files are untrusted input. Every file gives either a grid or an error that names the byte position and the
//! expected content. Sizes are checked against their limits before memory is allocated; a file has at most
//! [`MAX_FILE_BYTES`]. In a `.vox` file the palette index of a voxel is its material number. A body without
//! [`crate::component::SoftColours`] uses the colours of its `.vox` file.

use bevy_asset::io::Reader;
use bevy_asset::{Asset, AssetLoader, AsyncReadExt, LoadContext};
use bevy_reflect::TypePath;
use fuwafuwa::{Dim, Dim2, Dim3, VoxelGrid};
use fuwafuwa_scenes::import::{Colours, Model, picture};
pub use fuwafuwa_scenes::import::{ImportError, ImportNote, MAX_FILE_BYTES, NoteKind};
use serde::{Deserialize, Serialize};
use std::{fmt, io};

/// Voxels loaded from a file.
#[derive(Asset, Clone, Debug)]
pub struct Voxels<D: Dim> {
    /// Solid voxels and their materials.
    pub grid: VoxelGrid<D>,
    /// Colours of the materials, number 1 first, as in [`crate::component::SoftColours`]. Empty for a
    /// picture.
    pub colours: Vec<[f32; 3]>,
    /// Notes on what was left out of the file or may surprise, such as hidden models. The loaders also write
    /// them to the log as warnings.
    pub notes: Vec<ImportNote>,
}

/// Settings for converting a file to voxels.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VoxelsSettings {
    /// Edge length of a voxel [m]. Default 1/32: a shape 32 voxels across is 1 m across.
    pub voxel_size: f32,
    /// Maximum number of voxels along the longer side of a picture, default 64. Larger pictures are scaled
    /// down. Doubling it makes simulation about four times as slow. Models are not scaled.
    pub max_across: usize,
}

impl Default for VoxelsSettings {
    fn default() -> Self {
        Self {
            voxel_size: 1.0 / 32.0,
            max_across: 64,
        }
    }
}

/// Error of loading voxels from a file.
#[derive(Debug)]
pub enum VoxelsError {
    /// The file could not be read.
    Unreadable(io::Error),
    /// The contents are not a valid shape.
    Import(ImportError),
}

impl fmt::Display for VoxelsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(error) => write!(f, "cannot read the file: {error}"),
            Self::Import(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for VoxelsError {}

impl From<io::Error> for VoxelsError {
    fn from(error: io::Error) -> Self {
        Self::Unreadable(error)
    }
}

impl From<ImportError> for VoxelsError {
    fn from(error: ImportError) -> Self {
        Self::Import(error)
    }
}

/// Reads PNG, JPEG, WebP, GIF and BMP files as [`Voxels<Dim2>`]. If the picture has transparency, opaque pixels
/// are solid; otherwise, or if they are thin lines, it is a drawing, whose closed outlines are filled. The empty
/// margin is trimmed. Bevy's own loader still reads these files as images, because the requested asset type selects the loader.
#[derive(Copy, Clone, Debug, Default, TypePath)]
pub struct SilhouetteLoader;

/// Reads the visible models of a MagicaVoxel file, put together, as [`Voxels<Dim3>`]. Without colours in the
/// file, MagicaVoxel's default palette is used.
#[derive(Copy, Clone, Debug, Default, TypePath)]
pub struct ModelLoader;

impl AssetLoader for SilhouetteLoader {
    type Asset = Voxels<Dim2>;
    type Settings = VoxelsSettings;
    type Error = VoxelsError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        settings: &VoxelsSettings,
        context: &mut LoadContext<'_>,
    ) -> Result<Voxels<Dim2>, VoxelsError> {
        let bytes = bytes_of(reader).await?;
        let file = context.path().to_string();
        let import = picture(&file, &bytes, settings.max_across, settings.voxel_size)?;
        warn_of(&import.notes);
        Ok(Voxels {
            grid: import.grid,
            colours: Vec::new(),
            notes: import.notes,
        })
    }

    fn extensions(&self) -> &[&str] {
        &["png", "jpg", "jpeg", "webp", "gif", "bmp"]
    }
}

impl AssetLoader for ModelLoader {
    type Asset = Voxels<Dim3>;
    type Settings = VoxelsSettings;
    type Error = VoxelsError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        settings: &VoxelsSettings,
        context: &mut LoadContext<'_>,
    ) -> Result<Voxels<Dim3>, VoxelsError> {
        let bytes = bytes_of(reader).await?;
        let file = context.path().to_string();
        let model = Model::decode(&file, &bytes)?;
        let import = model.import(settings.voxel_size, &Colours::default())?;
        warn_of(&import.notes);
        let colours = model.palette().iter();
        let colours = colours.map(|colour| colour.map(|part| f32::from(part) / 255.0));
        Ok(Voxels {
            grid: import.grid,
            colours: colours.collect(),
            notes: import.notes,
        })
    }

    fn extensions(&self) -> &[&str] {
        &["vox"]
    }
}

/// Writes notes to the log, where a developer sees them.
fn warn_of(notes: &[ImportNote]) {
    for note in notes {
        tracing::warn!("{note}");
    }
}

/// Reads at most one byte more than the limit, which is enough to detect a file that is too long.
async fn bytes_of(reader: &mut dyn Reader) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut beginning = AsyncReadExt::take(reader, MAX_FILE_BYTES + 1);
    beginning.read_to_end(&mut bytes).await?;
    Ok(bytes)
}

/// This trait is implemented by hand, because the derive macro would require `TypePath` of the engine's
/// dimension types.
impl<D: Dim> TypePath for Voxels<D> {
    fn type_path() -> &'static str {
        match D::N {
            2 => "bevy_fuwafuwa::asset::Voxels<fuwafuwa::Dim2>",
            _ => "bevy_fuwafuwa::asset::Voxels<fuwafuwa::Dim3>",
        }
    }

    fn short_type_path() -> &'static str {
        match D::N {
            2 => "Voxels<Dim2>",
            _ => "Voxels<Dim3>",
        }
    }
}

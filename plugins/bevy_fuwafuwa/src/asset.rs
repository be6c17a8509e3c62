//! Shapes from files: silhouettes from PNG for the plane, models of MagicaVoxel (`.vox`) for space.
//!
//! ```no_run
//! # use bevy_asset::AssetServer;
//! # use bevy_fuwafuwa::asset::{Voxels, VoxelsSettings};
//! # use bevy_fuwafuwa::{SoftBody2d, SoftBody3d};
//! # let assets: &AssetServer = unimplemented!();
//! let dice = SoftBody3d::asset(assets.load("dice.vox"));
//! // Of other than the usual size:
//! let small = |settings: &mut VoxelsSettings| settings.voxel_size = 0.01;
//! let cat = SoftBody2d::asset(assets.load_builder().with_settings(small).load("cat.png"));
//! ```
//!
//! A file may come from anywhere. Whatever its bytes are, the answer is a grid or an error that says where in the file
//! what was expected; sizes are compared with their limits before memory is taken, [`MAX_FILE_BYTES`] at most. In a .vox
//! the palette index of a voxel is the number of its material, and a body without
//! [`crate::component::SoftColours`] has the colours of the file.

use bevy_asset::io::Reader;
use bevy_asset::{Asset, AssetLoader, AsyncReadExt, LoadContext};
use bevy_reflect::TypePath;
use fuwafuwa::{Dim, Dim2, Dim3, VoxelGrid};
use fuwafuwa_scenes::import::{Colours, Model, png};
pub use fuwafuwa_scenes::import::{ImportError, MAX_FILE_BYTES};
use serde::{Deserialize, Serialize};
use std::{fmt, io};

/// The voxels in a file.
#[derive(Asset, Clone, Debug)]
pub struct Voxels<D: Dim> {
    /// Which are solid, and of which material.
    pub grid: VoxelGrid<D>,
    /// The colours of the materials, number 1 first, as in [`crate::component::SoftColours`]; empty where the file says
    /// nothing.
    pub colours: Vec<[f32; 3]>,
}

/// How a file becomes voxels.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VoxelsSettings {
    /// How wide a voxel is [m]; usually 1/32, so that what is 32 voxels across is a metre across.
    pub voxel_size: f32,
    /// A picture with more pixels on its longer side is scaled down to so many voxels; usually 64. Each level of
    /// detail costs: twice as many take four times as long. Models are taken as they are.
    pub most_across: usize,
}

impl Default for VoxelsSettings {
    fn default() -> Self {
        Self {
            voxel_size: 1.0 / 32.0,
            most_across: 64,
        }
    }
}

/// Why a file gives no shape.
#[derive(Debug)]
pub enum VoxelsError {
    /// It cannot be read.
    Unreadable(io::Error),
    /// What stands in it is no shape.
    Import(ImportError),
}

impl fmt::Display for VoxelsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(error) => write!(f, "it cannot be read: {error}"),
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

/// Reads PNG files as [`Voxels<Dim2>`]: what is drawn, or what is not transparent. Bevy's own loader still reads them as
/// images: the type that is asked for decides.
#[derive(Copy, Clone, Debug, Default, TypePath)]
pub struct SilhouetteLoader;

/// Reads files of MagicaVoxel as [`Voxels<Dim3>`]: the first model in them.
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
        let grid = png(&file, &bytes, settings.most_across, settings.voxel_size)?;
        let colours = Vec::new();
        Ok(Voxels { grid, colours })
    }

    fn extensions(&self) -> &[&str] {
        &["png"]
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
        let grid = model.grid(settings.voxel_size, &Colours::default())?;
        let colours = model.palette().unwrap_or_default().iter();
        let colours = colours.map(|colour| colour.map(|part| f32::from(part) / 255.0));
        Ok(Voxels {
            grid,
            colours: colours.collect(),
        })
    }

    fn extensions(&self) -> &[&str] {
        &["vox"]
    }
}

/// The bytes of a file, and of one that is too long just enough to see that.
async fn bytes_of(reader: &mut dyn Reader) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut beginning = AsyncReadExt::take(reader, MAX_FILE_BYTES + 1);
    beginning.read_to_end(&mut bytes).await?;
    Ok(bytes)
}

/// Written out, since the engine's dimensions know nothing of Bevy.
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

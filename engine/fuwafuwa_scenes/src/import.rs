//! Shapes from files: a silhouette from a picture ([`picture()`]), a model from MagicaVoxel ([`vox()`]).
//!
//! Files are untrusted. For any bytes, the result is a grid or an [`ImportError`] that names the file, the
//! position in it and what was expected. Every size is compared with its limit and with the length of the
//! file before memory is allocated for it.

mod colours;
mod content;
mod drawing;
mod error;
mod file;
mod frames;
mod mask;
mod note;
mod paper;
mod photo;
mod picture;
mod png;
mod tints;
mod vox;

pub use self::colours::Colours;
pub use self::content::FileType;
pub use self::error::{
    FilePosition, ImportError, PositionedProblem, Problem, in_file, too_large, unexpected,
};
pub use self::file::MAX_FILE_BYTES;
pub use self::note::{Import, ImportNote, NoteKind};
pub(crate) use self::picture::png_of;
pub use self::picture::{MAX_AREA, MAX_PIXELS, Picture, PictureOptions, picture};
pub use self::vox::{MAX_MODEL_VOXELS, MAX_VOXELS_ACROSS, Model, vox};

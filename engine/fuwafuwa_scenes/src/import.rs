//! Shapes from files: a silhouette from PNG ([`png()`]), a model from MagicaVoxel ([`vox()`]).
//!
//! A file may come from anywhere. Whatever its bytes are, the answer is a grid or an [`ImportError`]
//! that says which file, where in it, and what was expected; every size is compared with its limit
//! and with the length of the file before memory is taken for it.

mod colours;
mod error;
mod file;
mod png;
mod vox;

pub use self::colours::Colours;
pub use self::error::{ImportError, Place, Problem};
pub use self::file::MAX_FILE_BYTES;
pub use self::png::{MAX_PIXELS, Picture, png};
pub use self::vox::{MAX_VOXELS_ACROSS, Model, vox};

//! Soft bodies from medical scans: [`Scan`] reads a NIfTI file, [`Segmentation`] assigns a material to each
//! position in it, and [`Organ`] turns the largest connected object into a grid of voxels at the requested
//! resolution.
//!
//! ```no_run
//! use fuwafuwa::{SoftBody, Material};
//! use fuwafuwa_scan::{Options, Organ, Scan, Segmentation};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scan = Scan::decode("head.nii.gz", &std::fs::read("head.nii.gz")?, |_| {})?;
//! let tissue = Segmentation::thresholds(&[(40.0..=250.0, 1)]);
//! let organ = Organ::of(&[&scan], &tissue, &Options::default(), |_| {})?;
//! println!("{:.0} ml", organ.millilitres(1));
//! let body = SoftBody::new(organ.grid, &[Material::default()])?;
//! # Ok(())
//! # }
//! ```
//!
//! **This is not a medical device.** It is made for games, demonstrations and teaching. Do not use its
//! results for diagnosis, planning or treatment.
//!
//! # Orientation
//!
//! Patient coordinates are RAS+: millimetres to the patient's *right*, to the front (*anterior*) and to the
//! head (*superior*), a right-handed system. The affine of a scan gives the position of each voxel in the
//! patient. The engine's y axis points up, so the patient is rotated, as MagicaVoxel models are, and never
//! mirrored:
//!
//! ```text
//!   patient   S            y  engine      x ← right
//!             │  A         │              y ← superior
//!             │ ╱          │              z ← posterior, the opposite of anterior
//!             └── R        └── x
//!                         ╱
//!                        z
//! ```
//!
//! A camera that looks along the negative z axis, as in the engine's pictures, sees the patient from behind,
//! with the left side on the left.
//!
//! # Untrusted files
//!
//! Files are untrusted. For any bytes, the result is a scan or an
//! [`ImportError`](fuwafuwa_scenes::import::ImportError) that names the field, what was expected and what was
//! found. Every size is compared with its limit, and with the amount the file can hold, before memory is
//! allocated or data decompressed.
//!
//! The crate `nifti` is not used: it allocates memory according to the header before it has seen the data,
//! does not support NIfTI-2, and depends on a matrix library for its affines. Only some twenty numbers of the
//! format are needed, so this crate reads them itself.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // brackets hold units, such as [mm]
#![allow(clippy::needless_range_loop)] // an axis indexes several vectors at once

mod header;
mod notes;
mod organ;
mod parse;
mod placement;
mod region;
mod scan;
mod segmentation;
mod stream;

pub use header::MAX_VOXELS;
pub use notes::warnings;
pub use organ::{Options, Organ, OrganError, RESOLUTIONS};
pub use parse::{Label, Threshold};
pub use placement::{Placement, PlacementSource, SPACINGS};
pub use scan::Scan;
pub use segmentation::Segmentation;
pub use stream::MAX_FILE_BYTES;

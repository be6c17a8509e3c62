//! Scans become soft bodies: a file of NIfTI is read ([`Scan`]), each place in it gets a material ([`Segmentation`]), and
//! the largest thing that hangs together becomes a grid of voxels at the resolution that was asked for ([`Organ`]).
//!
//! ```no_run
//! use fuwafuwa::{Body, Material};
//! use fuwafuwa_scan::{Options, Organ, Scan, Segmentation};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scan = Scan::decode("head.nii.gz", &std::fs::read("head.nii.gz")?, |_| {})?;
//! let tissue = Segmentation::thresholds(&[(40.0..=250.0, 1)]);
//! let organ = Organ::of(&[&scan], &tissue, &Options::default(), |_| {})?;
//! println!("{:.0} ml", organ.millilitres(1));
//! let body = Body::new(organ.grid, &[Material::default()])?;
//! # Ok(())
//! # }
//! ```
//!
//! **This is no medical device.** It is made to play, to show and to teach. Nothing that comes out of it may be used to
//! judge, to plan or to treat anybody.
//!
//! # Left, right, and which way up
//!
//! A patient's own axes are RAS+: millimetres to the patient's *right*, to the front (*anterior*) and to the head
//! (*superior*), a right-handed system. A scan tells by its affine where in it each of its voxels lies. The engine's y
//! is up; so the patient is turned, as models of MagicaVoxel are, and never mirrored:
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
//! Who looks against the engine's z, as its pictures do, sees the patient from behind, left on the left.
//!
//! # Strangers' files
//!
//! A file may come from anywhere. Whatever its bytes are, the answer is a scan or an
//! [`ImportError`](fuwafuwa_scenes::import::ImportError) that names the field, what it should be and what was found;
//! every size is compared with its limit, and with what the file can hold, before memory is taken or anything inflated.
//!
//! The crate `nifti` reads the format too. It takes memory by what the header says before it has seen the data, knows
//! nothing of NIfTI-2, and brings a library of matrices for its affines; what is needed of the format are some twenty
//! numbers, so they are read here.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units stand in brackets: [mm]
#![allow(clippy::needless_range_loop)] // an axis indexes several vectors at once

mod choice;
mod complaint;
mod header;
mod organ;
mod placement;
mod region;
mod scan;
mod segmentation;
mod stream;

pub use choice::{Label, Threshold};
pub use header::MAX_VOXELS;
pub use organ::{Options, Organ, OrganError, RESOLUTIONS};
pub use placement::{Placement, SPACINGS, Source};
pub use scan::Scan;
pub use segmentation::Segmentation;
pub use stream::MAX_FILE_BYTES;

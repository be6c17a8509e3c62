//! Soft bodies made of elements that are small at the surface, large inside, and refined where a crack runs
//! in.
//!
//! Modules in reading order; each uses only those before it:
//! - [`grid`]: solid voxels
//! - [`sharing`]: connectivity of the voxels
//! - [`pyramid`]: cell hierarchy
//! - [`stencil`]: element classes
//! - [`mesh`]: elements and nodes
//! - [`law`]: forces of one element
//! - [`solve`]: forces of all elements of a body
//! - [`body`]: state of a body
//! - `fracture` and `release`: location and execution of cracks
//! - `touch` and `contact`: broad phase and contact forces
//! - [`world`]: all bodies, and time
//!
//! Two and three dimensions share one implementation; [`dim`] contains everything that differs.
//!
//! New users start with the [`guide`], or with [`World`], [`SoftBody`] and [`VoxelGrid`]; `examples` contains
//! complete programs. Debug builds are about a hundred times slower unless your `Cargo.toml` optimises this
//! crate:
//! ```toml
//! [profile.dev.package.fuwafuwa]
//! opt-level = 3
//! ```
//!
//! # Features
//! All features are off by default.
//! - `serde`: saves and loads worlds, see the module `snapshot`
//! - `parallel`: steps large bodies on several threads, with bitwise identical results
#![forbid(unsafe_code)]
#![warn(missing_docs)]
// Units and sources stand in brackets: [m], [Endo 2004, §3.1].
#![allow(rustdoc::broken_intra_doc_links)]
// An axis indexes several vectors at once; zipping them would hide the formula.
#![allow(clippy::needless_range_loop)]

mod affine;
pub mod blade;
pub mod body;
mod breakable;
mod chains;
pub mod changes;
#[doc(hidden)]
pub mod compiled;
mod contact;
mod damping;
pub mod dim;
mod disjoint;
pub mod event;
mod fracture;
pub mod grid;
#[cfg(any(doc, doctest))]
pub mod guide;
pub mod handle;
pub mod hash;
pub mod ids;
pub mod joint;
pub mod knife;
mod lanes;
pub mod law;
pub mod layers;
pub mod material;
pub mod measure;
pub mod mesh;
pub mod momentum;
pub mod piece;
pub mod plasticity;
pub mod pyramid;
pub mod query;
mod release;
mod removal;
pub mod rigid;
pub mod rotation;
pub mod shape;
pub mod sharing;
mod sleep;
#[cfg(feature = "serde")]
pub mod snapshot;
pub mod solve;
pub mod stencil;
mod threads;
mod touch;
pub mod vector;
pub mod view;
pub mod world;

pub use blade::{Blade, CutReport};
pub use body::SoftBody;
pub use changes::{Bookmark, Changes};
pub use dim::{Dim, Dim2, Dim3, Point};
pub use event::{Event, ObjectRef, StepReport, With};
pub use grid::{BuildError, VoxelGrid};
pub use handle::{Gone, JointHandle, KnifeHandle, RigidBodyHandle, SoftBodyHandle};
pub use ids::{ElementId, NodeId, PieceId};
pub use joint::{Joint, JointAnchor, JointKind};
pub use knife::Knife;
pub use law::{Elasticity, Law};
pub use layers::Layers;
pub use material::{BodyError, Material};
pub use measure::{ElementState, Energy};
pub use mesh::Mesh;
pub use pyramid::Grading;
pub use query::{Queries, QueryHit, Thing};
pub use rigid::{MotionType, Reaction, RigidBody};
pub use rotation::Rotation;
pub use shape::{Shape, Vector};
pub use view::{ElementView, Facet, Outline, PieceView};
pub use world::{Hooks, PieceSize, Refused, Removed, Substep, World, WorldConfig, field_around};

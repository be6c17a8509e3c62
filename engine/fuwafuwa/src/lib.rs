//! Soft bodies made of elements that are small at the surface, large inside, and refined where a crack runs
//! in.
//!
//! Modules in reading order; a module uses mainly the modules above it:
//! - `error`: the error type
//! - `foundation`: dimensions, ids, arenas, hashing, threads
//! - `math`: vectors, rotations, velocities, SIMD lanes
//! - `material`: elastic, plastic and fracture constants
//! - `topology`: voxel grid, connectivity, cell hierarchy, element classes, mesh, pieces
//! - `rigid_body`: rigid bodies, shapes, layers
//! - `soft_body`: elastic force laws, forces of all elements, state, splits and removals, views
//! - `contact`: broad phase, contact solver, joints
//! - `fracture`: crack growth, cuts, knives
//! - `event`, `object_ref`, `query`: results for programs
//! - `world`: the simulated world and its time step
//! - [`inspect`]: internals for figures and renderers
//!
//! Two and three dimensions share one implementation; the module `dim` contains everything that differs.
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
//! - `parallel`: steps large bodies and many bodies on several threads, with bitwise identical results
#![forbid(unsafe_code)]
#![warn(missing_docs)]
// In comments, units and sources stand in brackets, for example [m] and [Endo 2004, §3.1]. Rustdoc takes such
// brackets for links, so its checks of links are off.
#![allow(rustdoc::private_intra_doc_links)]
#![allow(rustdoc::broken_intra_doc_links)]
// Loops over axes use one index for several vectors; zipped iterators would hide the formulas.
#![allow(clippy::needless_range_loop)]

// Modules in reading order: a module uses mainly the modules above it.
mod error;
mod foundation;
mod math;

mod material;
mod topology;

mod rigid_body;
mod soft_body;

mod contact;
mod fracture;

mod object_ref;

mod event;
mod query;
mod world;

#[cfg(any(doc, doctest))]
pub mod guide;
pub mod inspect;
#[doc(hidden)]
pub mod instances;
pub mod library;
#[cfg(feature = "serde")]
pub mod snapshot;

pub use contact::joint::{Joint, JointAnchor, JointKind, JointRef};
pub use error::Error;
pub use event::{Contact, Event, StepReport};
pub use foundation::arena::{
    GripHandle, JointHandle, KnifeHandle, RigidBodyHandle, SoftBodyHandle,
};
pub use foundation::dim::{Dim, Dim2, Dim3, DimAngular, DimVector, Point};
pub use foundation::ids::{ElementId, IndexVec, NodeId, PieceId};
pub use fracture::blade::{Blade, CutReport};
pub use fracture::knife::{Knife, KnifeRef};
pub use fracture::strength::{RateToughening, StrengthCriterion};
pub use glam;
pub use glam::{Vec2, Vec3};
pub use material::Material;
pub use math::rotation::Rotation;
pub use math::velocity::{Impulse, Velocity};
pub use object_ref::{ObjectRef, ObjectSelector};
pub use query::query_filter::QueryFilter;
pub use query::{HitElement, QueryHit, QueryOverlap, Ray};
pub use rigid_body::layers::Layers;
pub use rigid_body::shape::Shape;
pub use rigid_body::{MotionType, Reaction, RigidBody, RigidBodyRef};
pub use soft_body::SoftBody;
pub use soft_body::element_law::{Elasticity, Law};
pub use soft_body::element_state::{ElementState, Energy};
pub use soft_body::hyperelasticity::StressLaw;
pub use soft_body::momentum::Momentum;
pub use soft_body::rayleigh::Damping;
pub use soft_body::region_sums::RegionSums;
pub use soft_body::view::{ElementView, Facet, Outline, PieceView};
pub use soft_body::viscosity::PronyTerm;
pub use topology::cell_hierarchy::Grading;
pub use topology::changes::{Bookmark, Changes};
pub use topology::grid::{MAX_EXTENT, MAX_VOXELS, VOXEL_SIZES, VoxelGrid};
pub use world::{
    AfterSubstep, BodyHandle, DEFAULT_SUBSTEPS, DEFAULT_TICK, Grip, GripDrive, GripRef, Hooks,
    MAX_EXACT_SUBSTEPS, MAX_TICK, MIN_SUBSTEPS, MIN_TICK, PieceSize, ReactionForce, Removable,
    Removed, StiffBodies, Substep, World, World2, World3, WorldConfig, field_around,
};

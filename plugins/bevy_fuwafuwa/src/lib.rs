//! Soft bodies for Bevy that squash, tear and crumble: a plugin for the engine [fuwafuwa].
//!
//! ```
//! use bevy_app::App;
//! use bevy_fuwafuwa::prelude::*;
//! use bevy_transform::components::Transform;
//!
//! let mut app = App::new();
//! // In a program with a window: add DefaultPlugins first, leave out `in_schedule` (the default is
//! // FixedPostUpdate), and insert `Time::<Fixed>::from_hz(60.0)`.
//! app.add_plugins(FuwafuwaPlugin3d::default().in_schedule(bevy_app::Update));
//! app.world_mut().spawn(RigidBody3d::floor());
//! let ball = SoftBody3d::ball(12, 1.0);
//! let ball = app.world_mut().spawn((ball, Transform::from_xyz(0.0, 2.0, 0.0))).id();
//! app.update();
//! let height = app.world().get::<Transform>(ball).map_or(0.0, |at| at.translation.y);
//! assert!(height < 2.0, "it falls");
//! ```
//!
//! # Modules
//! - [`component`]: components of entities.
//! - [`FuwafuwaPlugin`]: the plugin.
//! - [`SoftWorld`]: the engine, for everything without a component.
//! - [`message`]: events of a tick.
//! - [`SoftQueries`]: ray casts, nearest points, overlaps.
//! - [`asset`]: shapes from files.
//! - [`convert`]: vectors of Bevy and of the engine.
//!
//! Internal modules, in the order of a tick: `queue` collects requests to enter and leave the world, `enter`
//! handles them, `push` and `steer` apply changed components, `step` runs the tick, `write` updates the
//! components. Helpers: `surface` turns a body into vertices, `drawn` writes them into a mesh, and `pose`
//! converts between a `Transform` and a soft body.
//!
//! # Time
//! Each run of the schedule is one tick of the engine, by default 1/60 s, independent of the clock. The
//! default schedule is `FixedPostUpdate`, which Bevy runs at 64 Hz;
//! `insert_resource(Time::<Fixed>::from_hz(60.0))` makes the simulation run in real time. Changes made in
//! `FixedUpdate` take effect in the same tick. [`SoftWorld::pause`] stops the simulation.
//!
//! # Coordinates
//! Metres, y up. The origin of a soft body is the middle of its voxel grid. Its `Transform` gives the initial
//! rotation, translation and uniform scale. After that the `Transform` follows the largest piece as if that
//! piece were rigid. Writing the `Transform` moves and rotates the body at once and leaves its velocity
//! unchanged. Bodies must not have parents. They may have children, which follow them and need `Visibility`
//! from the start. Rigid bodies work in the same way, but get no mesh: add your own. In 2D only rotation
//! about z is used, and the plugin never changes the z coordinate.
//!
//! # Meshes
//! A soft body gets one `Mesh`, as `Mesh3d` or `Mesh2d`. Add your own material; vertex colours show the voxel
//! materials. The mesh is created once. After that each tick overwrites positions and normals in the same
//! buffers. [`fuwafuwa::SoftBody::changes_since`] lists the nodes and elements that a tear has changed; only
//! the triangles of these elements are replaced, in free slots of the buffers. Indices and colours are
//! written only in such ticks, and nothing is written while a body sleeps. `Assets<Mesh>` sends `Modified` at
//! most once a tick.
//!
//! # Determinism
//! Soft and rigid bodies enter the world in the order in which their components were inserted. They leave in
//! the order in which they were removed or despawned. Both take effect at the beginning of the next tick. The
//! same commands give the same [`fuwafuwa::World::hash`] as the equivalent calls of the engine. A body with
//! an asset as shape enters once the asset is loaded. Where determinism matters, wait for the asset before
//! you spawn the body.
//!
//! # Errors
//! A body that cannot be made does not enter the world; everything else continues. Its entity gets
//! [`Rejected`], and [`message::Rejection`] gives the reason. The same message reports other requests that
//! could not be carried out.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units are given in brackets: [m]

pub mod asset;
mod colours;
pub mod component;
pub mod convert;
mod dimension;
mod drawn;
mod enter;
pub mod message;
mod plugin;
mod pose;
mod problem;
mod push;
mod query;
mod queue;
mod steer;
mod step;
mod surface;
mod world;
mod write;

pub use component::{RigidBody, SoftBody};
pub use dimension::Dimension;
pub use plugin::{FuwafuwaPlugin, FuwafuwaSystems};
pub use problem::{Problem, Rejected};
pub use query::{QueryHit, SoftQueries};
pub use world::{SoftWorld, SoftWorldConfig};

pub use fuwafuwa;

use fuwafuwa::{Dim2, Dim3};

/// Plugin for 2D.
pub type FuwafuwaPlugin2d = FuwafuwaPlugin<Dim2>;
/// Plugin for 3D.
pub type FuwafuwaPlugin3d = FuwafuwaPlugin<Dim3>;
/// Soft body in 2D.
pub type SoftBody2d = SoftBody<Dim2>;
/// Soft body in 3D.
pub type SoftBody3d = SoftBody<Dim3>;
/// Rigid body in 2D.
pub type RigidBody2d = RigidBody<Dim2>;
/// Rigid body in 3D.
pub type RigidBody3d = RigidBody<Dim3>;

/// The items that most programs need.
pub mod prelude {
    pub use crate::component::{
        ExternalImpulse, GravityScale, RigidBody, SoftBody, SoftColours, SoftMaterials,
        TargetPosition, Velocity,
    };
    pub use crate::message::{
        ContactEnded, ContactForce, ContactStarted, Cut, FellAsleep, JointBroke, LeftRange,
        NodeSplit, Overlapped, PieceDetached, Rejection, Removed, SensorEntered, SensorExited,
        WokeUp,
    };
    pub use crate::{
        FuwafuwaPlugin, FuwafuwaPlugin2d, FuwafuwaPlugin3d, FuwafuwaSystems, Rejected, RigidBody2d,
        RigidBody3d, SoftBody2d, SoftBody3d, SoftQueries, SoftWorld, SoftWorldConfig,
    };
    pub use fuwafuwa::inspect::Elasticity;
    pub use fuwafuwa::{
        Dim2, Dim3, Layers, Material as SoftMaterial, MotionType, Shape, VoxelGrid,
    };
}

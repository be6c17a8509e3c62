//! Soft bodies for Bevy that squash, tear and crumble: [fuwafuwa] as a plugin.
//!
//! ```
//! use bevy_app::App;
//! use bevy_fuwafuwa::prelude::*;
//! use bevy_transform::components::Transform;
//!
//! let mut app = App::new();
//! // In a program with a window: DefaultPlugins first, FixedPostUpdate instead of Update, which is where it runs
//! // unless told otherwise, and `Time::<Fixed>::from_hz(60.0)`.
//! app.add_plugins(FuwafuwaPlugin3d::default().in_schedule(bevy_app::Update));
//! app.world_mut().spawn(RigidBody3d::floor());
//! let ball = SoftBody3d::ball(12, 1.0);
//! let ball = app.world_mut().spawn((ball, Transform::from_xyz(0.0, 2.0, 0.0))).id();
//! app.update();
//! let height = app.world().get::<Transform>(ball).map_or(0.0, |at| at.translation.y);
//! assert!(height < 2.0, "it falls");
//! ```
//!
//! # The way through
//! [`component`] is what entities have → [`FuwafuwaPlugin`] what makes them move → [`SoftWorld`] the engine itself, for all
//! that has no component → [`message`] what happened → [`SoftQueries`] what is where → [`asset`] shapes from files.
//! Behind them: `queue` who comes and goes → `enter` lets them → `push` and `steer` do what was asked
//! of them → `step` → `write` tells
//! them where they are; `surface` is a body as vertices, `drawn` the mesh that is written from them, `pose` what a
//! `Transform` can say of something soft.
//!
//! # Time
//! A run of the schedule is a tick of the engine, 1/60 s whatever the clock says. It runs in `FixedPostUpdate`, of which
//! Bevy has 64 in a second unless told otherwise: `insert_resource(Time::<Fixed>::from_hz(60.0))` makes a second a second.
//! What you do in `FixedUpdate` counts in the same tick. [`SoftWorld::pause`] stops it.
//!
//! # Coordinates
//! Metres, y up. The origin of a soft body is the middle of its voxel grid. Its `Transform` says how it is put into the
//! world: turned, moved, and scaled by the same factor on all axes. From then on it follows the largest piece, as if that
//! were rigid; what you write into it moves and turns the body at once, and leaves its velocity. Bodies have no parents;
//! they may have children, which go with them, and then want `Visibility` from the start. What is rigid is the same, but
//! has no mesh of its own: give it one. In the plane only turns about z count, and z is yours.
//!
//! # Meshes
//! A soft body gets one `Mesh`, as `Mesh3d` or `Mesh2d`; the material is yours, and colours of vertices tell what it is
//! made of. The mesh is made once. After that each tick writes positions and normals over the old ones, in the same
//! buffers; what was released is asked of [`fuwafuwa::Body::changes_since`], and only the triangles at those elements are
//! taken down and put up, at the places that became free. Indices and colours are written only in such ticks, and nothing
//! at all while a body sleeps. `Assets<Mesh>` says `Modified` of it, no more than once a tick.
//!
//! # Same input, same bits
//! Bodies and rigid things enter the world in the order in which their components were inserted, and leave it in the order
//! in which they were removed or despawned, at the beginning of the next tick. The same commands give the same
//! [`fuwafuwa::World::hash`] as the same calls of the engine. Bodies whose shape is an asset enter when it is there: wait
//! for it where bits matter.
//!
//! # What cannot be
//! A body that cannot be made does not enter, and nothing else minds: its entity gets [`Rejected`], and
//! [`message::Rejection`] says why. The same message tells of what was asked and not done.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units stand in brackets: [m]

pub mod asset;
mod colours;
pub mod component;
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
pub use query::{Hit, SoftQueries};
pub use world::{SoftSettings, SoftWorld};

pub use fuwafuwa;

use fuwafuwa::{Dim2, Dim3};

/// The plugin for the plane.
pub type FuwafuwaPlugin2d = FuwafuwaPlugin<Dim2>;
/// The plugin for space.
pub type FuwafuwaPlugin3d = FuwafuwaPlugin<Dim3>;
/// A soft body in the plane.
pub type SoftBody2d = SoftBody<Dim2>;
/// A soft body in space.
pub type SoftBody3d = SoftBody<Dim3>;
/// Something rigid in the plane.
pub type RigidBody2d = RigidBody<Dim2>;
/// Something rigid in space.
pub type RigidBody3d = RigidBody<Dim3>;

/// What most programs need.
pub mod prelude {
    pub use crate::component::{
        ExternalImpulse, Goal, GravityScale, RigidBody, SoftBody, SoftColours, SoftMaterials,
        Velocity,
    };
    pub use crate::message::{
        ContactBegan, ContactEnded, Cut, Entered, FellAsleep, JointBroke, Left, Parted, Rejection,
        Removed, Torn, Touched, Woke,
    };
    pub use crate::{
        FuwafuwaPlugin, FuwafuwaPlugin2d, FuwafuwaPlugin3d, FuwafuwaSystems, Rejected, RigidBody2d,
        RigidBody3d, SoftBody2d, SoftBody3d, SoftQueries, SoftSettings, SoftWorld,
    };
    pub use fuwafuwa::{
        Dim2, Dim3, MotionType, Elasticity, Layers, Material as SoftMaterial, Shape, VoxelGrid,
    };
}

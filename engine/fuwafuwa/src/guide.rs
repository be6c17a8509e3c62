//! User guide, from a first body to the limits of the engine.
//!
//! Documentation only: the module contains no code except examples, and every example runs as a test. Terms:
//! a *body* is soft, a *rigid body* is fixed, kinematic, coupled or dynamic, and a *tick* is 1/60 s by
//! default.
//!
//! 1. [`first_body`]: five minutes to a falling ball
//! 2. [`tasks`]: eleven common tasks in 2D and in 3D
//! 3. [`materials`]: stiffness, density and strength; real values, and values for games
//! 4. [`acting`]: impulses, velocities, fields, hands, cuts
//! 5. [`asking`]: events, sensors, layers, rays, overlap tests, strain and energy
//! 6. [`rigids`]: rigid bodies and joints
//! 7. [`saving`]: snapshots, and rolling back
//! 8. [`costs`]: measured costs
//! 9. [`determinism`]: guarantees, and ways to break them
//! 10. [`how`]: how the simulation works, with figures
//! 11. [`neighbours`]: comparison with other engines
//!
//! # Crates
//!
//! | crate | use |
//! | --- | --- |
//! | `fuwafuwa` | always: the engine. It opens no window, reads no file, and reads no clock |
//! | `fuwafuwa_scenes` | worlds from text files, bodies from PNG and MagicaVoxel, recordings |
//! | `fuwafuwa_render` | drawing with wgpu; without its feature `gpu`, smooth vertices for other renderers |
//! | `fuwafuwa_painter` | SVG, PNG and GIF without a GPU: figures, films, tests |
//! | `fuwafuwa_scan` | medical scans (NIfTI) as bodies, for demonstration and teaching; not a medical device |
//! | `force_feedback`, `sticks` | force-feedback joysticks; usable without the engine |
//! | `bevy_fuwafuwa` | plugin for the Bevy game engine |
//! | `fuwafuwa_cli` | command line that runs, films, measures and checks scenes |
//!
//! The crates are not published: depend on them by path. Every interface may still change.

#[doc = include_str!("../guide/first_body.md")]
pub mod first_body {}

#[cfg(feature = "serde")]
#[doc = include_str!("../guide/tasks.md")]
pub mod tasks {}

#[doc = include_str!("../guide/materials.md")]
pub mod materials {}

#[doc = include_str!("../guide/acting.md")]
pub mod acting {}

#[doc = include_str!("../guide/asking.md")]
pub mod asking {}

#[doc = include_str!("../guide/rigids.md")]
pub mod rigids {}

#[doc = include_str!("../guide/saving.md")]
pub mod saving {}

#[doc = include_str!("../guide/costs.md")]
pub mod costs {}

#[doc = include_str!("../guide/determinism.md")]
pub mod determinism {}

// The SVG figures are embedded in the documentation page, so that the page needs no other files.
#[doc = include_str!("../guide/how_levels.md")]
#[doc = "<div class=\"fuwafuwa\"><style>.fuwafuwa svg { max-width: min(100%, 44em); max-height: 34em; height: auto; }</style>"]
#[doc = include_str!("../guide/figures/levels.svg")]
#[doc = "</div>"]
#[doc = ""]
#[doc = include_str!("../guide/how_tears.md")]
#[doc = "<div class=\"fuwafuwa\">"]
#[doc = include_str!("../guide/figures/remodel.svg")]
#[doc = "</div>"]
#[doc = ""]
#[doc = include_str!("../guide/how_time.md")]
#[doc = "<div class=\"fuwafuwa\">"]
#[doc = include_str!("../guide/figures/tear.svg")]
#[doc = "</div>"]
#[doc = ""]
#[doc = include_str!("../guide/how_more.md")]
pub mod how {}

#[doc = include_str!("../guide/neighbours.md")]
pub mod neighbours {}

/// Runs the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub mod readme {}

//! A guide for who wants to use the engine, from a first body to what it cannot do.
//!
//! It is made of words alone, for the documentation: no program has it. Every piece of code in it is run as a test. Words are
//! those of the engine: a *body* is soft, what is *rigid* is an obstacle, a hand or something that falls, a *tick* is 1/60 s.
//!
//! 1. [`first_body`]: five minutes to a ball that falls
//! 2. [`materials`]: how stiff, how heavy, how strong; real ones, and what a game does with them
//! 3. [`acting`]: impulses, velocities, fields, hands, cuts
//! 4. [`asking`]: events, sensors, layers, rays, what overlaps, strain and energy
//! 5. [`rigids`]: what is rigid, what falls, and joints
//! 6. [`saving`]: snapshots, and going back
//! 7. [`costs`]: what costs what, measured
//! 8. [`determinism`]: what holds, and what breaks it
//! 9. [`how`]: how it works, with figures
//! 10. [`neighbours`]: what others do better, and what they do not
//!
//! # Which crate
//!
//! | crate | when |
//! | --- | --- |
//! | `fuwafuwa` | always: the engine. It opens no window, reads no file, asks no clock |
//! | `fuwafuwa_scenes` | worlds from text files, bodies from PNG and MagicaVoxel, recordings |
//! | `fuwafuwa_render` | to draw with wgpu; or, without its feature `gpu`, smooth vertices for who draws another way |
//! | `fuwafuwa_painter` | SVG, PNG and GIF without a GPU: figures, films, tests |
//! | `fuwafuwa_scan` | medical scans (NIfTI) as bodies, to show and to teach; no medical device |
//! | `force_feedback`, `sticks` | sticks that push back; they know nothing of soft bodies and are good without the engine |
//! | `bevy_fuwafuwa` | all of it as a plugin for Bevy |
//! | `fuwafuwa_cli` | a command line that runs, films, measures and checks |
//!
//! Nothing is published: depend on them by path. Every interface may still change.

#[doc = include_str!("../guide/first_body.md")]
pub mod first_body {}

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

// Pictures are in the page itself, so that they are there wherever it is.
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

/// What the package says of itself has to run too.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub mod readme {}

//! A trainee cuts a soft organ, made from a scan or made up, and feels the knife.
//!
//! The way through, each module using only those above it:
//! [`case`] what is operated on → [`phantom`] a made-up organ → [`tools`] what is held → [`measures`] what is noted
//! → [`procedure`] one tick after the other → [`trainee`] what does one by itself → [`slices`] what lies inside now
//! → [`record`] all of it on file, and again to the same bits → [`report`] tables and plots → [`loading`] scans become a
//! case beside the window → [`save`] files → [`headless`] a procedure without a window → [`app`] the window.
//!
//! It stands on the game's window, stage, pace and devices, the crate `tamaire`.
//!
//! **This is no medical device.** It is made to show and to teach. Nothing that comes out of it may be used to judge, to
//! plan or to treat anybody, and nobody learns to operate by it.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units stand in brackets: [m]
#![allow(clippy::needless_range_loop)] // an axis indexes several vectors at once

#[cfg(feature = "window")]
pub mod app;
pub mod case;
#[cfg(feature = "window")]
pub mod headless;
pub mod loading;
pub mod measures;
pub mod phantom;
pub mod procedure;
pub mod record;
pub mod report;
pub mod save;
pub mod slices;
pub mod tools;
pub mod trainee;

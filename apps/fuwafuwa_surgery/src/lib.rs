//! Surgery trainer: a trainee cuts a soft organ, made from a scan or a phantom, and feels the knife.
//!
//! Modules, each using only those above it:
//!
//! - [`case`]: organ to be operated on
//! - [`phantom`]: synthetic organ
//! - [`tools`]: tools in the hand
//! - [`measures`]: measured values
//! - [`procedure`]: simulation, tick by tick
//! - [`trainee`]: automatic operator
//! - [`slices`]: sections of the deformed organ
//! - [`record`]: recordings and bit-exact replay
//! - [`report`]: tables and plots
//! - [`loading`]: loading in a background thread
//! - [`save`]: written files
//! - [`headless`]: procedures without a window
//! - [`app`]: the window
//!
//! Window, stage, timing and devices are in the crate `app_shell`.
//!
//! **This is not a medical device.** It is for demonstration and teaching. Its output must not be used to
//! diagnose, plan or treat, and it does not teach anyone to operate.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units are in brackets: [m]
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

//! Levels that players make, without a window.
//!
//! The modules, each of which uses only those above it:
//!
//! - [`history`]: undo and redo
//! - [`drawing`]: bodies drawn with crayons, on paper or in space
//! - [`palette`]: the materials of crayons
//! - [`items`]: everything that has a place in a level
//! - [`body`]: drawings as bodies of levels, and back
//! - [`document`]: the text of an edited level
//! - [`draft`]: a level that is being edited
//! - [`check`]: checks of a level before it is kept
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units in brackets, such as [m], are no links
#![allow(clippy::needless_range_loop)] // an axis indexes several vectors at once

pub mod body;
pub mod check;
pub mod document;
pub mod draft;
pub mod drawing;
pub mod history;
pub mod items;
pub mod palette;

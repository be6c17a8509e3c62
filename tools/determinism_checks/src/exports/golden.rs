//! The table of scenes for a program that loads this library as a WebAssembly module.
//!
//! Plain numbers only, so that no generated glue is needed. A scene is named by its place in
//! [`SCENES`]; a place past the end is a trap, as is a panic in a scene.
#![allow(unsafe_code)] // names without mangling, and nothing else

use crate::golden::SCENES;

/// How many scenes there are.
#[unsafe(no_mangle)]
pub extern "C" fn golden_count() -> usize {
    SCENES.len()
}

/// Where in memory the name of a scene begins, in UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn golden_name(scene: usize) -> *const u8 {
    SCENES[scene].name.as_ptr()
}

/// The length of the name of a scene, in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn golden_name_length(scene: usize) -> usize {
    SCENES[scene].name.len()
}

/// Runs a scene and hashes how it ends.
#[unsafe(no_mangle)]
pub extern "C" fn golden_run(scene: usize) -> u64 {
    (SCENES[scene].run)()
}

/// The hash that a scene must end in.
#[unsafe(no_mangle)]
pub extern "C" fn golden_hash(scene: usize) -> u64 {
    SCENES[scene].golden
}

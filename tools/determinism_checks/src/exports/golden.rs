//! Access to the table of scenes for a program that loads this library as a WebAssembly module.
//!
//! The functions use plain numbers only, so that no generated glue code is needed. A scene is named by its
//! index in [`SCENES`]. An index out of range traps, as does a panic in a scene.
#![allow(unsafe_code)] // only for unmangled names

use crate::golden::SCENES;

/// Returns the number of scenes.
#[unsafe(no_mangle)]
pub extern "C" fn golden_count() -> usize {
    SCENES.len()
}

/// Returns the address of a scene's name, in UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn golden_name(scene: usize) -> *const u8 {
    SCENES[scene].name.as_ptr()
}

/// Returns the length of a scene's name in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn golden_name_length(scene: usize) -> usize {
    SCENES[scene].name.len()
}

/// Runs a scene and returns the hash of its final state.
#[unsafe(no_mangle)]
pub extern "C" fn golden_run(scene: usize) -> u64 {
    (SCENES[scene].run)()
}

/// Returns the expected hash of a scene.
#[unsafe(no_mangle)]
pub extern "C" fn golden_hash(scene: usize) -> u64 {
    SCENES[scene].golden
}

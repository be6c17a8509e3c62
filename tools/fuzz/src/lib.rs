//! Robustness tests with untrusted input. A [`Door`] is an entry point for bytes from outside. It reads and
//! checks the bytes. If they describe a world, it also plays a tick. A door must neither panic nor take long,
//! and accepted input must survive being written and read again.
//!
//! Tests send some noise through each door. `cargo xtask fuzz` sends millions of inputs and looks for new
//! paths through the program. Both start with the same seeds. The tests also repeat earlier failures (folder
//! `found`).
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod doors;
mod game_files;
pub mod noise;
mod seeds;
mod tick;

/// Entry point for untrusted bytes.
#[derive(Copy, Clone)]
pub struct Door {
    /// Kind of input, such as `png`; the value of DOOR for the fuzzer.
    pub name: &'static str,
    /// Valid inputs that are then damaged. They are small, so that thousands of variants are fast.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Processes bytes. Returns whether they were accepted.
    pub enter: fn(&[u8]) -> bool,
}

/// All doors.
pub const DOORS: &[Door] = &[
    Door::new("scene", seeds::scenes, doors::scene),
    Door::new("level", seeds::levels, doors::level),
    Door::new("png", seeds::pictures, doors::png),
    Door::new("vox", seeds::models, doors::vox),
    Door::new("scan", seeds::scans, doors::scan),
    Door::new("replay", seeds::replays, doors::replay),
    Door::new("link", seeds::links, doors::link),
    Door::new("pack", seeds::packs, doors::pack),
    Door::new("recording", seeds::recordings, doors::recording),
    Door::new("procedure", seeds::procedures, doors::procedure),
    Door::new("snapshot", seeds::snapshots, doors::snapshot),
    Door::new("settings", game_files::settings_seeds, game_files::settings),
    Door::new("records", game_files::records_seeds, game_files::records),
];

impl Door {
    const fn new(
        name: &'static str,
        seeds: fn() -> Vec<Vec<u8>>,
        enter: fn(&[u8]) -> bool,
    ) -> Self {
        Self { name, seeds, enter }
    }

    /// Returns the door of this name, or `None`.
    pub fn named(name: &str) -> Option<&'static Self> {
        DOORS.iter().find(|door| door.name == name)
    }
}

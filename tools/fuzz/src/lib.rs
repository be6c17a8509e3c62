//! Robustness tests with untrusted input. A [`Door`] is an entry point for bytes from outside. It reads and
//! checks them, and if they make a world, plays a tick. It must neither panic nor take long, and accepted
//! input must survive being written and read again.
//!
//! Tests send some noise through each door. `cargo xtask fuzz` sends millions of inputs and looks for new
//! paths through the program. Both start with the same seeds and with earlier failures (folder `found`).
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod doors;
mod game_files;
pub mod noise;
mod seeds;
mod tick;

/// An entry point for untrusted bytes.
#[derive(Copy, Clone)]
pub struct Door {
    /// Name of the input.
    pub name: &'static str,
    /// Valid input to start from, small enough that thousands of variants are fast.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Processes bytes. Returns whether they were accepted.
    pub enter: fn(&[u8]) -> bool,
}

/// All doors.
pub const DOORS: &[Door] = &[
    Door {
        name: "scene",
        seeds: seeds::scenes,
        enter: doors::scene,
    },
    Door {
        name: "level",
        seeds: seeds::levels,
        enter: doors::level,
    },
    Door {
        name: "png",
        seeds: seeds::pictures,
        enter: doors::png,
    },
    Door {
        name: "vox",
        seeds: seeds::models,
        enter: doors::vox,
    },
    Door {
        name: "scan",
        seeds: seeds::scans,
        enter: doors::scan,
    },
    Door {
        name: "replay",
        seeds: seeds::replays,
        enter: doors::replay,
    },
    Door {
        name: "link",
        seeds: seeds::links,
        enter: doors::link,
    },
    Door {
        name: "recording",
        seeds: seeds::recordings,
        enter: doors::recording,
    },
    Door {
        name: "procedure",
        seeds: seeds::procedures,
        enter: doors::procedure,
    },
    Door {
        name: "snapshot",
        seeds: seeds::snapshots,
        enter: doors::snapshot,
    },
    Door {
        name: "settings",
        seeds: game_files::settings_seeds,
        enter: game_files::settings,
    },
    Door {
        name: "records",
        seeds: game_files::records_seeds,
        enter: game_files::records,
    },
];

impl Door {
    /// Returns the door of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        DOORS.iter().find(|door| door.name == name)
    }
}

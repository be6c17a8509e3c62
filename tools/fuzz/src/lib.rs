//! What strangers hand over. A [`Door`] takes bytes as a stranger would bring them, all the way: they are read, checked,
//! and where they make a world it plays a tick. Nothing may panic or take long, and what was taken must survive being
//! written and read again.
//!
//! Tests send some noise through each door; `cargo xtask fuzz` sends millions of inputs that look for new ways through
//! the program. Both begin with the same seeds, and with what was once found to go wrong (`found`).
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod doors;
pub mod noise;
mod notes;
mod seeds;
mod tick;

/// A way in for bytes.
#[derive(Copy, Clone)]
pub struct Door {
    /// What comes in by it.
    pub name: &'static str,
    /// Good bytes to begin with, small enough that thousands of them are quick.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Brings bytes in; whether they were taken.
    pub enter: fn(&[u8]) -> bool,
}

/// All of them.
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
        seeds: notes::settings_seeds,
        enter: notes::settings,
    },
    Door {
        name: "records",
        seeds: notes::records_seeds,
        enter: notes::records,
    },
];

impl Door {
    /// The door of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        DOORS.iter().find(|door| door.name == name)
    }
}

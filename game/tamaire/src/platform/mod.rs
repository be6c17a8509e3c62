//! Differences between a desktop and a browser: storage, sound output, screen and dialogs. The rest
//! of the game does not depend on the platform.

#[cfg(not(target_family = "wasm"))]
mod awake;
#[cfg(not(target_family = "wasm"))]
mod breath;
#[cfg(not(target_family = "wasm"))]
mod clipboard;
#[cfg(not(target_family = "wasm"))]
mod date;
#[cfg(not(target_family = "wasm"))]
mod dialog;
mod files;
#[cfg(not(target_family = "wasm"))]
mod folder;
mod given;
#[cfg(target_family = "wasm")]
#[path = "web/mod.rs"]
mod here;
mod keeping;
#[cfg(not(target_family = "wasm"))]
mod machine;
mod pictures;
#[cfg(not(target_family = "wasm"))]
mod screen;
#[cfg(not(target_family = "wasm"))]
mod sound;
mod storage;
#[cfg(not(target_family = "wasm"))]
pub mod supervisor;
#[cfg(not(target_family = "wasm"))]
mod writer;

#[cfg(target_family = "wasm")]
use here::{breath, clipboard, date, dialog, screen, sound, writer};

#[cfg(not(target_family = "wasm"))]
pub use awake::keep_awake;
pub use breath::Yielder;
pub use clipboard::Clipboard;
pub use date::{local as local_date, today};
pub use dialog::{Dialog, IS_THERE as HAS_DIALOG};
pub use files::{Damage, Files, MOST_LEVELS, StorageEvent};
pub use given::{DialogResult, OpenRequest, dropped};
#[cfg(not(target_family = "wasm"))]
pub use given::{level_at, replay_in};
#[cfg(target_family = "wasm")]
pub use here::{Host, set_host};
#[cfg(not(target_family = "wasm"))]
pub use machine::{StandFolder, TextFile, memory};
#[cfg(not(target_family = "wasm"))]
pub use pictures::Pictures;
pub use screen::{address_of_page, fill_screen, full_screen_of_page, restart, set_language};
pub use sound::Sound;
pub use storage::{Entry, Kind, Location, Nowhere, Storage, UpdateEntry};

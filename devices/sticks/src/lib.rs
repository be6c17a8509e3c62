//! Joysticks, flight sticks and pads.
//!
//! [`Sticks::open`] starts one thread that owns SDL. No other thread calls SDL, and SDL handles neither
//! window events nor signals. The thread publishes the latest [`Snapshot`], which any thread can take at any
//! time. Presses are counted, so comparing two snapshots misses none, even if they are far apart:
//!
//! ```
//! use sticks::{Change, Snapshot, Sticks};
//!
//! let sticks = Sticks::open()?;
//! let mut before = sticks.snapshot();
//! for _tick in 0..3 {
//!     let now = sticks.snapshot();
//!     for change in now.since(&before) {
//!         match change {
//!             Change::Connected(device) => println!("{device:?} is here"),
//!             Change::Disconnected(device) => println!("{device:?} has gone"),
//!             Change::Pressed { device, control } => println!("{device:?}: {control:?}"),
//!         }
//!     }
//!     before = now;
//! }
//! # Ok::<(), sticks::Error>(())
//! ```
//!
//! Device values are raw: without dead zone or calibration. The caller may apply [`radial_dead_zone`], or
//! move the focus of a menu with [`Navigator`].
//!
//! With the feature `haptic`, `Sticks::haptic` connects a device to the crate `force_feedback`: with forces
//! along two axes if the device has motors for them, otherwise with rumble.

#![deny(unsafe_code)]
#![allow(rustdoc::broken_intra_doc_links)] // units stand in brackets: [s]

mod device;
mod feel;
mod latest;

#[cfg(all(feature = "haptic", target_family = "wasm"))]
#[path = "felt.rs"]
mod haptic;
#[cfg(all(feature = "haptic", not(target_family = "wasm")))]
mod haptic;
#[cfg(all(feature = "haptic", not(target_family = "wasm")))]
mod held;
#[cfg(all(feature = "sdl", not(target_family = "wasm")))]
mod owner;
#[cfg(target_family = "wasm")]
#[path = "browser.rs"]
mod owner;
#[cfg(not(any(feature = "sdl", target_family = "wasm")))]
#[path = "nobody.rs"]
mod owner;
#[cfg(all(feature = "sdl", not(target_family = "wasm")))]
mod sdl;

#[cfg(all(
    any(test, feature = "virtual"),
    feature = "sdl",
    not(target_family = "wasm")
))]
mod puppet;
#[cfg(all(test, feature = "sdl"))]
mod tests;

use latest::Latest;
use std::sync::Arc;

pub use device::{
    Button, Change, Control, Device, DeviceId, DeviceInfo, Direction, Hat, Labels, Pad, PadButton,
    Snapshot,
};
pub use feel::{Navigator, Repeat, radial_dead_zone};
#[cfg(feature = "haptic")]
pub use haptic::Haptic;
pub use latest::Error;
#[cfg(all(
    any(test, feature = "virtual"),
    feature = "sdl",
    not(target_family = "wasm")
))]
pub use puppet::VirtualDevice;

/// All connected sticks and pads. Dropping this value closes them.
pub struct Sticks {
    latest: Latest,
    #[allow(dead_code, reason = "held for its drop, which ends the thread")]
    owner: owner::Owner,
}

impl Sticks {
    /// Starts the thread, which takes some ms; devices already connected appear in the first snapshot.
    /// Finding no device is not an error. Builds without SDL never find a device. A browser reports a pad
    /// only after one of its buttons was pressed.
    pub fn open() -> Result<Sticks, Error> {
        let latest = Latest::default();
        Ok(Sticks {
            owner: owner::Owner::start(latest.clone())?,
            latest,
        })
    }

    /// Returns the state of all devices. The state is at most 2 ms old (100 ms while no device is connected),
    /// unless a driver delays SDL. The call is cheap: it takes a lock and counts a reference.
    pub fn snapshot(&self) -> Arc<Snapshot> {
        #[cfg(target_family = "wasm")]
        self.owner.look();
        self.latest.get()
    }
}

//! Joysticks, flight sticks and pads.
//!
//! [`Sticks::open`] starts one thread that owns all of SDL: no other thread calls it, and it touches neither the window's
//! events nor signals. Whatever happens there ends up in the latest [`Snapshot`], which any thread may take at any time.
//! Presses are counted, so that whoever compares two snapshots misses none, however far apart they are:
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
//! # Ok::<(), sticks::NoSticks>(())
//! ```
//!
//! What a device says is not tampered with: no dead zone, no calibration. Those are functions of numbers, such as
//! [`radial_dead_zone`] and [`Navigator`], and the caller's choice.
//!
//! With the feature `haptic` `Sticks::haptic` lets a device be felt through `force_feedback`: by forces along two axes if it
//! has motors for them, else by rumbling.

#![deny(unsafe_code)]

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
    About, Button, Change, Control, Device, DeviceId, Direction, Hat, Labels, Pad, PadButton,
    Snapshot,
};
pub use feel::{Navigator, Repeat, radial_dead_zone};
#[cfg(feature = "haptic")]
pub use haptic::Haptic;
pub use latest::NoSticks;
#[cfg(all(
    any(test, feature = "virtual"),
    feature = "sdl",
    not(target_family = "wasm")
))]
pub use puppet::Puppet;

/// All sticks and pads that are plugged in. Dropping it closes them.
pub struct Sticks {
    latest: Latest,
    #[allow(dead_code, reason = "held for its drop, which ends the thread")]
    owner: owner::Owner,
}

impl Sticks {
    /// Starts to look for devices, which takes some ms; those that are there already appear within the first snapshot.
    /// No device is no error. Where SDL is left out none is ever found; a browser shows pads once one of their buttons was pressed.
    pub fn open() -> Result<Sticks, NoSticks> {
        let latest = Latest::default();
        Ok(Sticks {
            owner: owner::Owner::start(latest.clone())?,
            latest,
        })
    }

    /// What all devices say now; at most 2 ms old, 100 ms while no device is there, unless a driver holds SDL up. Costs a
    /// lock and a count.
    pub fn snapshot(&self) -> Arc<Snapshot> {
        #[cfg(target_family = "wasm")]
        self.owner.look();
        self.latest.get()
    }
}

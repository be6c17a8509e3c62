//! A device that can be felt: where forces go on their way to the thread that owns SDL.

use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, Weak};
use std::time::Instant;

use force_feedback::{Ability, Gone, LENGTH, Output, Sink};

use crate::held::{Held, Slot, lock};
use crate::latest::Latest;
use crate::owner::{Hub, Order};
use crate::{DeviceId, Sticks};

/// A device to be felt, for `force_feedback`. Dropping it lets go of the device, unless it was taken hold of anew since; so
/// have one at a time of each, but for the moment in which one follows another. Forces overtake each other: only the
/// latest is on its way.
pub struct Haptic {
    id: DeviceId,
    latest: Latest,
    orders: Weak<Sender<Order>>,
    slot: Arc<Mutex<Slot>>,
}

impl Sticks {
    /// Takes hold of a device to be felt. What it can do is known some ms later; until then, and if it is not there, that
    /// is nothing.
    pub fn haptic(&self, id: DeviceId) -> Haptic {
        let haptic = Haptic {
            id,
            latest: self.latest.clone(),
            orders: self.owner.orders(),
            slot: Arc::new(Mutex::new(Slot {
                ability: Ability::Nothing,
                wish: None,
            })),
        };
        let slot = haptic.slot.clone();
        haptic.order(move |hub| {
            let sdl = hub.sdl;
            if let Some((open, held)) = hub.held(id) {
                lock(&slot).ability = held.take_hold(sdl, open);
                held.holder = Arc::downgrade(&slot);
            }
        });
        haptic
    }
}

impl Haptic {
    fn order(&self, act: impl FnOnce(&mut Hub<'_>) + Send + 'static) -> Option<()> {
        self.orders.upgrade()?.send(Box::new(act)).ok()
    }
}

impl Sink for Haptic {
    fn ability(&self) -> Ability {
        lock(&self.slot).ability
    }

    fn aim(&mut self) -> Result<[f32; 2], Gone> {
        let snapshot = self.latest.get();
        snapshot
            .device(self.id)
            .map(|device| device.aim())
            .ok_or(Gone)
    }

    fn play(&mut self, output: Output) -> Result<(), Gone> {
        let wish = (output, Instant::now());
        let is_on_its_way = lock(&self.slot).wish.replace(wish).is_some();
        if is_on_its_way {
            return Ok(());
        }
        let (id, slot) = (self.id, self.slot.clone());
        self.order(move |hub| {
            let wish = lock(&slot).wish.take();
            // A process that was stopped for a while finds one on its way that nobody means any more.
            let fresh = wish.filter(|(_, since)| since.elapsed() < LENGTH);
            if let (Some((output, _)), Some((open, held))) = (fresh, hub.held(id)) {
                held.play(open, output);
            }
        })
        .ok_or(Gone)
    }
}

impl Drop for Haptic {
    fn drop(&mut self) {
        let (id, slot) = (self.id, self.slot.clone());
        // If the thread has ended, the device was let go.
        let _ = self.order(move |hub| {
            if let Some((open, held)) = hub.held(id) {
                held.let_rest(open);
                if held.holder.as_ptr() == Arc::as_ptr(&slot) {
                    *held = Held::default();
                }
            }
        });
    }
}

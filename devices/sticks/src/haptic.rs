//! Force-feedback sink of a device. It sends outputs to the thread that owns SDL.

use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, Weak};
use std::time::Instant;

use force_feedback::{Ability, Gone, OUTPUT_DURATION, Output, Sink};

use crate::held::{Feedback, Slot, lock};
use crate::latest::Latest;
use crate::owner::{Hub, Order};
use crate::{DeviceId, Sticks};

/// Device as a sink of `force_feedback`. Dropping the sink releases the device, unless a newer sink of the
/// device exists. A device may have two sinks only while one replaces the other. A new output replaces an
/// output that was not sent yet.
pub struct Haptic {
    id: DeviceId,
    latest: Latest,
    orders: Weak<Sender<Order>>,
    slot: Arc<Mutex<Slot>>,
}

impl Sticks {
    /// Returns the sink of a device. The ability of the device becomes known a few ms later. Until then, and
    /// always for a missing device, the ability is [`Ability::Nothing`].
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

    fn stick_position(&mut self) -> Result<[f32; 2], Gone> {
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
            // Drops an output that is too old, because the process was stopped for a while.
            let fresh = wish.filter(|(_, since)| since.elapsed() < OUTPUT_DURATION);
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
        // Sending fails if the thread has ended, and then the device is already released.
        let _ = self.order(move |hub| {
            if let Some((open, held)) = hub.held(id) {
                held.let_rest(open);
                if held.holder.as_ptr() == Arc::as_ptr(&slot) {
                    *held = Feedback::default();
                }
            }
        });
    }
}

//! A device that can be felt: where forces go on their way to the thread that owns SDL.

use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use force_feedback::{Ability, Gone, LENGTH, Output, Sink};

use crate::owner::{Hub, Order};
use crate::sdl::motors::Motors;
use crate::sdl::{Open, Sdl};
use crate::{DeviceId, Latest, Sticks};

/// After this time a force that goes on is started again. Some drivers, and wheels of Moza, let only a start prolong it,
/// and no change of its level; to start it with each change would be felt.
const START_AGAIN: Duration = Duration::from_millis(150);

/// Makers, by their USB numbers, whose devices need forces without an end: they drop those that have one. Then this
/// thread is the one that ends them. 0x346e is Moza; what is known of its bases is in PCSX2's pull requests 11906, 11915.
const ENDLESS: [u16; 1] = [0x346e];

/// A device to be felt, for `force_feedback`. Dropping it lets go of the device, unless it was taken hold of anew since; so
/// have one at a time of each, but for the moment in which one follows another. Forces overtake each other: only the
/// latest is on its way.
pub struct Haptic {
    id: DeviceId,
    latest: Latest,
    orders: Weak<Sender<Order>>,
    slot: Arc<Mutex<Slot>>,
}

struct Slot {
    ability: Ability,
    /// What is on its way, and since when.
    wish: Option<(Output, Instant)>,
}

/// What can be felt of a device, on the thread. It is taken hold of when it is first asked for.
#[derive(Default)]
pub struct Held<'sdl> {
    body: Option<Body<'sdl>>,
    /// Of whoever took hold of it last.
    holder: Weak<Mutex<Slot>>,
    /// When the last was told that did something.
    told: Option<Instant>,
    started: Option<Instant>,
}

enum Body<'sdl> {
    Motors(Motors<'sdl>),
    Rumble,
    Nothing,
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

impl<'sdl> Held<'sdl> {
    fn take_hold(&mut self, sdl: &'sdl Sdl, open: &Open<'sdl>) -> Ability {
        let is_endless = ENDLESS.contains(&open.model().0);
        let length = (!is_endless).then_some(LENGTH.as_millis() as u32);
        let body = self
            .body
            .get_or_insert_with(|| match sdl.motors(open, length) {
                Some(motors) => Body::Motors(motors),
                None if open.can_rumble() => Body::Rumble,
                None => Body::Nothing,
            });
        match body {
            Body::Motors(_) => Ability::Force,
            Body::Rumble => Ability::Rumble,
            Body::Nothing => Ability::Nothing,
        }
    }

    /// A device that does not take it goes on or ends by itself; nobody could do more about it.
    fn play(&mut self, open: &Open<'sdl>, output: Output) {
        let now = Instant::now();
        let is_over = |since: Option<Instant>| since.is_none_or(|since| now - since >= START_AGAIN);
        let levels = output.levels();
        match (&self.body, output) {
            (Some(Body::Motors(motors)), Output::Force(_)) => {
                let anew = is_over(self.started) && !output.is_zero();
                motors.push(levels, anew);
                if anew {
                    self.started = Some(now);
                }
            }
            (Some(Body::Rumble), Output::Rumble { .. }) => {
                let [low, high] = levels.map(|level| 2 * level.unsigned_abs());
                open.rumble(low, high, LENGTH.as_millis() as u32);
            }
            _ => {}
        }
        self.told = (!output.is_zero()).then_some(now);
    }

    /// Ends what was told too long ago, where the device does not.
    pub fn expire(&mut self, open: &Open<'sdl>) {
        if self.told.is_some_and(|told| told.elapsed() >= LENGTH) {
            self.let_rest(open);
        }
    }

    fn let_rest(&mut self, open: &Open<'sdl>) {
        let ability = match self.body {
            Some(Body::Rumble) => Ability::Rumble,
            _ => Ability::Force,
        };
        self.play(open, Output::zero(ability));
    }
}

fn lock(slot: &Mutex<Slot>) -> MutexGuard<'_, Slot> {
    slot.lock().unwrap_or_else(PoisonError::into_inner)
}

//! What can be felt of a device, on the thread that owns SDL.

use std::sync::{Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use force_feedback::{Ability, LENGTH, Output};

use crate::sdl::motors::Motors;
use crate::sdl::{Open, Sdl};

/// After this time a force that goes on is started again. Some drivers, and wheels of Moza, let only a start prolong it,
/// and no change of its level; to start it with each change would be felt.
const START_AGAIN: Duration = Duration::from_millis(150);

/// Makers, by their USB numbers, whose devices need forces without an end: they drop those that have one. Then this
/// thread is the one that ends them. 0x346e is Moza; what is known of its bases is in PCSX2's pull requests 11906, 11915.
const ENDLESS: [u16; 1] = [0x346e];

pub struct Slot {
    pub ability: Ability,
    /// What is on its way, and since when.
    pub wish: Option<(Output, Instant)>,
}

/// What can be felt of a device, on the thread. It is taken hold of when it is first asked for.
#[derive(Default)]
pub struct Held<'sdl> {
    body: Option<Body<'sdl>>,
    /// Of whoever took hold of it last.
    pub holder: Weak<Mutex<Slot>>,
    /// When the last was told that did something.
    told: Option<Instant>,
    started: Option<Instant>,
}

enum Body<'sdl> {
    Motors(Motors<'sdl>),
    Rumble,
    Nothing,
}

impl<'sdl> Held<'sdl> {
    pub fn take_hold(&mut self, sdl: &'sdl Sdl, open: &Open<'sdl>) -> Ability {
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
    pub fn play(&mut self, open: &Open<'sdl>, output: Output) {
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

    pub fn let_rest(&mut self, open: &Open<'sdl>) {
        let ability = match self.body {
            Some(Body::Rumble) => Ability::Rumble,
            _ => Ability::Force,
        };
        self.play(open, Output::zero(ability));
    }
}

pub fn lock(slot: &Mutex<Slot>) -> MutexGuard<'_, Slot> {
    slot.lock().unwrap_or_else(PoisonError::into_inner)
}

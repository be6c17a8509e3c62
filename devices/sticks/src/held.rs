//! Feedback state of a device, on the thread that owns SDL.

use std::sync::{Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use force_feedback::{Ability, OUTPUT_DURATION, Output};

use crate::sdl::motors::Motors;
use crate::sdl::{OpenDevice, Sdl};

/// Interval at which a continuing force is started again. Some drivers, and Moza wheels, prolong a force only
/// when it is started again, not when its level changes. A restart at each change of level would be felt.
const START_AGAIN: Duration = Duration::from_millis(150);

/// USB vendor ids of devices that ignore the length of effects, so the thread that owns SDL must end the
/// effects. 0x346e is Moza; the behaviour of its bases is documented in the pull requests 11906 and 11915 of
/// PCSX2.
const ENDLESS: [u16; 1] = [0x346e];

pub struct Slot {
    pub ability: Ability,
    /// Output to be sent next, and the time at which it was requested.
    pub wish: Option<(Output, Instant)>,
}

/// Feedback state of a device. The motors of the device are opened at the first request.
#[derive(Default)]
pub struct Feedback<'sdl> {
    body: Option<Body<'sdl>>,
    /// Slot of the latest sink of the device.
    pub holder: Weak<Mutex<Slot>>,
    /// Time of the last nonzero output; `None` while the output is zero.
    told: Option<Instant>,
    /// Time of the last start of a force.
    started: Option<Instant>,
}

enum Body<'sdl> {
    Motors(Motors<'sdl>),
    Rumble,
    Nothing,
}

impl<'sdl> Feedback<'sdl> {
    pub fn take_hold(&mut self, sdl: &'sdl Sdl, open: &OpenDevice<'sdl>) -> Ability {
        let is_endless = ENDLESS.contains(&open.model().0);
        let length = (!is_endless).then_some(OUTPUT_DURATION.as_millis() as u32);
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

    /// Plays an output. Errors are ignored, because the effect ends without further calls.
    pub fn play(&mut self, open: &OpenDevice<'sdl>, output: Output) {
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
                open.rumble(low, high, OUTPUT_DURATION.as_millis() as u32);
            }
            _ => {}
        }
        self.told = (!output.is_zero()).then_some(now);
    }

    /// Ends an output that was not repeated in time. Needed for devices that ignore the length of effects.
    pub fn expire(&mut self, open: &OpenDevice<'sdl>) {
        if self
            .told
            .is_some_and(|told| told.elapsed() >= OUTPUT_DURATION)
        {
            self.let_rest(open);
        }
    }

    pub fn let_rest(&mut self, open: &OpenDevice<'sdl>) {
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

//! All of it for one device, a step at a time.

use crate::{
    Ability, Chain, Coupling, Give, Mail, OLDEST, Output, Settings, State, Stop, Watchdog,
};
use std::time::Duration;

/// Contact forces are not believed to be larger than this along an axis [N].
const MOST: f32 = 1e6;

/// What one hand feels.
#[derive(Clone, Copy, Debug, Default)]
pub struct Feel {
    coupling: Coupling,
    give: Give,
    chain: Chain,
    before: Option<Duration>,
}

/// What came out of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Felt {
    /// What the device is to be told.
    pub output: Output,
    /// What there would be to feel [N], before it is made safe.
    pub newtons: [f32; 2],
    /// Why there is nothing, if something forbids it.
    pub silent: Option<Stop>,
}

impl Feel {
    /// Something tore; 1 is as large as a tear gets.
    pub fn tear(&mut self, size: f32) {
        self.give.tear(size);
    }

    /// What the device is to be told at the time `now`, while it leans to `aim`. A stop works at once, past the slew limit:
    /// to let go of a hand does not jerk it.
    pub fn step(
        &mut self,
        watchdog: &Watchdog,
        mail: &Mail,
        (aim, ability): ([f32; 2], Ability),
        settings: &Settings,
        now: Duration,
    ) -> Felt {
        let state = match watchdog.pass(mail, now) {
            Ok(state) => state,
            Err(stop) => return self.rest(ability, stop),
        };
        let settings = &settings.bounded();
        let mut duration = self
            .before
            .map_or(Duration::ZERO, |before| now.saturating_sub(before));
        if duration > OLDEST {
            // The thread was held up, as in a process that was stopped. Its hand has long been let go, and is elsewhere.
            *self = Self::default();
            duration = Duration::ZERO;
        }
        self.before = Some(now);
        let duration = duration.as_secs_f32();
        let newtons = match (sane(state.contact, MOST), sane(aim, 1.0)) {
            (Some(contact), Some(aim)) if ability == Ability::Force => {
                let state = State { contact, ..state };
                self.coupling.step(&state, aim, settings, duration)
            }
            (Some(contact), _) if ability != Ability::Force => contact,
            _ => [0.0; 2],
        };
        let given = self.give.step(newtons, duration);
        let output = match ability {
            Ability::Force => {
                let force = self.chain.step(given, settings, duration);
                Output::Force(settings.calibration.apply(force))
            }
            Ability::Rumble => {
                let force = self.chain.step(newtons, settings, duration);
                Output::Rumble {
                    low: force[0].hypot(force[1]).min(settings.clamp),
                    high: (self.give.left() * settings.strength).min(settings.clamp),
                }
            }
            Ability::Nothing => Output::zero(ability),
        };
        Felt {
            output,
            newtons,
            silent: None,
        }
    }

    /// Stops at once and forgets what was.
    pub fn rest(&mut self, ability: Ability, why: Stop) -> Felt {
        *self = Self::default();
        Felt {
            output: Output::zero(ability),
            newtons: [0.0; 2],
            silent: Some(why),
        }
    }
}

/// Both within these bounds, if they are numbers.
fn sane(both: [f32; 2], most: f32) -> Option<[f32; 2]> {
    let are_numbers = both.iter().all(|k| !k.is_nan());
    are_numbers.then(|| both.map(|k| k.clamp(-most, most)))
}

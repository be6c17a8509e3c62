//! Force calculation of one device, one step at a time: from the command of the game to the output.

use crate::{
    Ability, Chain, Command, Coupling, MAX_STATE_AGE, Output, Settings, State, Stop, TearFeedback,
    Watchdog,
};
use std::time::Duration;

/// Largest accepted contact force per axis [N].
const MOST: f32 = 1e6;

/// Force calculation of one device: watchdog, coupling, tear feedback and safety chain.
#[derive(Clone, Copy, Debug, Default)]
pub struct ForceController {
    coupling: Coupling,
    give: TearFeedback,
    chain: Chain,
    before: Option<Duration>,
}

/// Result of a step of [`ForceController`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepOutput {
    /// Output for the device.
    pub output: Output,
    /// Force before the safety chain [N].
    pub newtons: [f32; 2],
    /// Reason why no force is output; `None` while forces are allowed.
    pub silent: Option<Stop>,
}

impl ForceController {
    /// Reports a tear with a size from 0 to 1.
    pub fn tear(&mut self, size: f32) {
        self.give.tear(size);
    }

    /// Returns the output at the time `now` for the stick position `aim`. A stop sets the force to zero at
    /// once, without the slew limit, because a vanishing force does not jerk the hand.
    pub fn step(
        &mut self,
        watchdog: &Watchdog,
        mail: &Command,
        (aim, ability): ([f32; 2], Ability),
        settings: &Settings,
        now: Duration,
    ) -> StepOutput {
        let state = match watchdog.pass(mail, now) {
            Ok(state) => state,
            Err(stop) => return self.rest(ability, stop),
        };
        let settings = &settings.bounded();
        let mut duration = self
            .before
            .map_or(Duration::ZERO, |before| now.saturating_sub(before));
        if duration > MAX_STATE_AGE {
            // The thread was delayed, for example because the process was stopped. The stick may have moved
            // meanwhile, so the force ramps up from zero again.
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
        StepOutput {
            output,
            newtons,
            silent: None,
        }
    }

    /// Resets the calculation and returns a zero output, with the reason `why`.
    pub fn rest(&mut self, ability: Ability, why: Stop) -> StepOutput {
        *self = Self::default();
        StepOutput {
            output: Output::zero(ability),
            newtons: [0.0; 2],
            silent: Some(why),
        }
    }
}

/// Clamps both components to ±`most`. Returns `None` if one of them is NaN.
fn sane(both: [f32; 2], most: f32) -> Option<[f32; 2]> {
    let are_numbers = both.iter().all(|k| !k.is_nan());
    are_numbers.then(|| both.map(|k| k.clamp(-most, most)))
}

//! From newtons to what a device may be told.

use crate::Settings;

/// How long the force takes to come up after the first that is worth feeling [s].
const ARMING: f32 = 1.0;
/// From this on a force is worth feeling [full forces].
const WORTH: f32 = 0.01;
/// A step counts as no longer than this [s]: a thread that was held up must not make up for it with a jerk.
const LONGEST: f32 = 0.01;

/// Gain → soft clip → slew limit → clamp → check. Along both axes, at most one full force.
#[derive(Clone, Copy, Debug, Default)]
pub struct Chain {
    /// How far it is armed, 0 to 1; none before the first force.
    armed: Option<f32>,
    /// What it said last [full forces].
    force: [f32; 2],
}

impl Chain {
    /// Forgets the last force and has to be armed again. The next step starts from zero.
    pub fn rest(&mut self) {
        *self = Self::default();
    }

    /// What the stick is to be pushed with [full forces] when the simulation pushes with `newtons`, `duration` [s] after
    /// the last step. `settings` must be [bounded](Settings::bounded).
    pub fn step(&mut self, newtons: [f32; 2], settings: &Settings, duration: f32) -> [f32; 2] {
        // Compared this way round, a duration that is no number is none.
        let duration = if duration > 0.0 {
            duration.min(LONGEST)
        } else {
            0.0
        };
        let gain = settings.strength / settings.full;
        let wish = soft_clip(finite(newtons).map(|k| k * gain));
        let armed = self.arm(wish, duration);
        let most = settings.slew * duration;
        for (force, wish) in self.force.iter_mut().zip(wish) {
            let wish = (wish * armed).clamp(-settings.clamp, settings.clamp);
            let next = *force + (wish - *force).clamp(-most, most);
            *force = next.clamp(-settings.clamp, settings.clamp);
        }
        // Nothing above can break this; it is the last door, and nobody else's.
        self.force = finite(self.force);
        self.force
    }

    fn arm(&mut self, wish: [f32; 2], duration: f32) -> f32 {
        match &mut self.armed {
            None if wish[0].hypot(wish[1]) > WORTH => self.armed = Some(0.0),
            None => {}
            Some(armed) => *armed = (*armed + duration / ARMING).min(1.0),
        }
        self.armed.unwrap_or(0.0)
    }
}

/// Almost the same if it is small, and shorter than 1 however long it is. The direction stays.
fn soft_clip(force: [f32; 2]) -> [f32; 2] {
    let longer = force[0].hypot(force[1]).hypot(1.0);
    finite(force.map(|k| k / longer))
}

/// Nothing, unless both are numbers.
fn finite(force: [f32; 2]) -> [f32; 2] {
    if force.iter().all(|k| k.is_finite()) {
        force
    } else {
        [0.0; 2]
    }
}

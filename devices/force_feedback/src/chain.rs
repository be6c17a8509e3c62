//! Converts newtons to a safe device force.

use crate::Settings;

/// Duration of the ramp-up of forces after a reset [s]. The ramp-up begins with the first noticeable force.
const ARMING: f32 = 1.0;
/// Force from which the ramp-up begins: the smallest noticeable force [full forces].
const WORTH: f32 = 0.01;
/// Upper limit of the duration of a step [s]. Without it, the force would jump after a delay of the thread.
const LONGEST: f32 = 0.01;

/// Safety chain: gain → soft clip → slew limit → clamp → finite check. Handles the x and the y axis; the
/// output per axis is at most one full force.
#[derive(Clone, Copy, Debug, Default)]
pub struct Chain {
    /// Progress of the ramp-up, 0 to 1; `None` before the first noticeable force.
    armed: Option<f32>,
    /// Output of the last step, per axis [full forces].
    force: [f32; 2],
}

impl Chain {
    /// Resets the chain: the next step starts from zero and ramps up again.
    pub fn rest(&mut self) {
        *self = Self::default();
    }

    /// Returns the force on the stick [full forces] for the force `newtons` [N] of the simulation, `duration`
    /// [s] after the last step. `settings` must be [bounded](Settings::bounded).
    pub fn step(&mut self, newtons: [f32; 2], settings: &Settings, duration: f32) -> [f32; 2] {
        // Comparisons with NaN are false, so a NaN duration becomes 0.
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
        // Guards against errors in the code above, which should never give a non-finite value.
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

/// Soft clip: keeps small forces almost unchanged. Large forces keep their direction and get a length below
/// 1.
fn soft_clip(force: [f32; 2]) -> [f32; 2] {
    let longer = force[0].hypot(force[1]).hypot(1.0);
    finite(force.map(|k| k / longer))
}

/// Returns zero unless both components are finite.
fn finite(force: [f32; 2]) -> [f32; 2] {
    if force.iter().all(|k| k.is_finite()) {
        force
    } else {
        [0.0; 2]
    }
}

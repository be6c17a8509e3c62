//! How a device is built in, found out by pushing it a little.
//!
//! Each motor pushes both ways, gently and for no longer than it takes to see where the stick goes. A hand that moves the
//! stick meanwhile would have to go along with all four pushes to be taken for the motors.

use crate::{Calibration, Settings};

/// Which way the motors push in turn [full forces].
const PUSHES: [[f32; 2]; 4] = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
/// The strongest push [full forces].
const MOST: f32 = 0.4;
/// Over this time a push becomes as strong as it gets [s].
const RISE: f32 = 1.5;
/// Between two pushes the stick comes to rest [s].
const REST: f32 = 0.5;
/// A stick that was moved so far has been moved far enough [ways from the middle to the rim].
const FAR: f32 = 0.25;

/// Pushes a device and watches where its stick goes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Measurement {
    /// How many pushes are over.
    done: usize,
    /// Since the last was over [s].
    time: f32,
    /// Where the stick was when this one began, and how far the others moved it.
    start: [f32; 2],
    moves: [[f32; 2]; PUSHES.len()],
}

/// How far a measurement has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measured {
    /// Push the stick with this [full forces], with [`Manner::Yields`](crate::Manner::Yields) and
    /// [`Measurement::SETTINGS`], and tell where it is.
    Pushing([f32; 2]),
    /// It is known. None if that is not clear: somebody held the stick, or nothing pushed it.
    Known(Option<Calibration>),
}

impl Measurement {
    /// What a device is measured with: as if it were built in as usual, and never strongly. `full` is 1 N, so that full
    /// forces and newtons are the same.
    pub const SETTINGS: Settings = Settings {
        strength: 1.0,
        full: 1.0,
        stiffness: 0.0,
        slew: 10.0,
        clamp: MOST,
        calibration: Calibration::USUAL,
    };

    /// What to do now that the stick leans to `aim`, `duration` [s] after the last step.
    pub fn step(&mut self, aim: [f32; 2], duration: f32) -> Measured {
        let Some(push) = PUSHES.get(self.done) else {
            return Measured::Known(self.conclusion());
        };
        self.time += duration;
        if self.time < REST {
            self.start = aim;
            return Measured::Pushing([0.0; 2]);
        }
        let moved = [0, 1].map(|axis| aim[axis] - self.start[axis]);
        let strength = MOST * (self.time - REST) / RISE;
        if strength < MOST && moved[0].hypot(moved[1]) < FAR {
            return Measured::Pushing(push.map(|k| k * strength));
        }
        self.moves[self.done] = moved;
        self.done += 1;
        self.time = 0.0;
        Measured::Pushing([0.0; 2])
    }

    /// How much of it is over, 0 to 1.
    pub fn progress(&self) -> f32 {
        let this = (self.time / (REST + RISE)).min(1.0);
        ((self.done as f32 + this) / PUSHES.len() as f32).min(1.0)
    }

    fn conclusion(&self) -> Option<Calibration> {
        let [right, left, up, down] = self.moves;
        let moves = [[right, left], [up, down]].map(|[there, back]| {
            let half = |sign: f32| [0, 1].map(|axis| 0.5 * (there[axis] + sign * back[axis]));
            let ([x, y], [lost_x, lost_y]) = (half(-1.0), half(1.0));
            // What went the same way both times was no motor.
            let is_clear = lost_x.hypot(lost_y) < 0.5 * x.hypot(y);
            is_clear.then_some([x, y])
        });
        let [Some(x), Some(y)] = moves else {
            return None;
        };
        Calibration::measured([x, y])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Ability, Feel, Mail, Manner, Output, State, Watchdog};
    use std::time::Duration;

    /// Measures a light stick with a soft spring, told through all of `Feel`, whose motors are built in so; `hand` is what
    /// somebody adds to where it leans.
    fn measure(
        built: impl Fn([f32; 2]) -> [f32; 2],
        hand: impl Fn(f32) -> [f32; 2],
    ) -> Option<Calibration> {
        let (mut measurement, mut feel) = (Measurement::default(), Feel::default());
        let (mut at, mut speed) = ([0.0f32; 2], [0.0f32; 2]);
        let mut contact = [0.0; 2];
        for step in 0..4000 {
            let now = Duration::from_millis(4 * step);
            let added = hand(now.as_secs_f32());
            let aim = [0, 1].map(|axis| (at[axis] + added[axis]).clamp(-1.0, 1.0));
            if step % 4 == 0 {
                match measurement.step(aim, 0.016) {
                    Measured::Pushing(push) => contact = push,
                    Measured::Known(calibration) => return calibration,
                }
            }
            let manner = Manner::Yields;
            let wish = Ok(State { contact, manner });
            let mail = Mail { wish, at: now };
            let (lean, watchdog) = ((aim, Ability::Force), Watchdog::default());
            let felt = feel.step(&watchdog, &mail, lean, &Measurement::SETTINGS, now);
            let Output::Force(force) = felt.output else {
                panic!("it was asked for a force")
            };
            assert!(force.iter().all(|k| k.abs() <= MOST));
            let force = built(force);
            for axis in 0..2 {
                speed[axis] += 0.004 * (40.0 * force[axis] - 30.0 * at[axis] - 8.0 * speed[axis]);
                at[axis] += 0.004 * speed[axis];
            }
        }
        panic!("it never ends")
    }

    #[test]
    fn it_finds_out_how_a_stick_is_built_in() {
        for swap in [false, true] {
            for invert in [[false, false], [true, false], [false, true], [true, true]] {
                let built = |[x, y]: [f32; 2]| {
                    let sign = |axis: usize| if invert[axis] { -1.0 } else { 1.0 };
                    let along = [sign(0) * x, sign(1) * y];
                    if swap { [along[1], along[0]] } else { along }
                };
                let found = measure(built, |_| [0.0; 2]).expect("nobody is in its way");
                assert_eq!((found.swap, found.invert), (swap, invert));
                // What it found makes the stick go where it is pushed.
                let push = [0.3, -0.7];
                assert_eq!(built(found.apply(push)), push);
            }
        }
    }

    #[test]
    fn it_does_not_guess() {
        let usual = |force| force;
        assert_eq!(measure(|_| [0.0; 2], |_| [0.0; 2]), None, "no motor");
        assert_eq!(measure(|[x, _]| [x, x], |_| [0.0; 2]), None, "one motor");
        assert_eq!(measure(|_| [0.0; 2], |time| [0.2 * time, 0.0]), None);
        assert_eq!(measure(usual, |time| [0.4 * time, 0.1 * time]), None);
    }
}

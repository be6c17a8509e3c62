//! How a device is built in, found out by pushing it a little.
//!
//! Each motor pushes both ways, gently and for no longer than it takes to see where the stick goes; then all of that again.
//! A push begins only when the stick is still, and one that moves before it can have been pushed begins anew. A hand that
//! plays with the stick meanwhile would have to wait eight times and then go along, twice in the same way.

use crate::{Calibration, Settings};

/// Which way the motors push in turn [full forces].
const PUSHES: [[f32; 2]; 4] = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
/// How often all of them are tried.
const ROUNDS: usize = 2;
/// The strongest push, and what moves no stick [full forces].
const MOST: f32 = 0.4;
const LEAST: f32 = 0.03;
/// Over this time a push becomes as strong as it gets [s].
const RISE: f32 = 1.5;
/// Before a push the stick is still for so long [s].
const REST: f32 = 0.5;
/// It is still while it stays so near to a place, and has been moved far enough when it is so far from it [ways from the
/// middle to the rim].
const NEAR: f32 = 0.04;
const FAR: f32 = 0.25;
/// After this time nobody waits any more [s].
const PATIENCE: f32 = 45.0;

/// Pushes a device and watches where its stick goes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Measurement {
    /// How many pushes are over.
    done: usize,
    /// Since this push, or the rest before it, began [s], and since all of it did.
    time: f32,
    all: f32,
    /// Where the stick was when this push began, and how far the others moved it.
    start: [f32; 2],
    moves: [[f32; 2]; ROUNDS * PUSHES.len()],
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
        self.all += duration;
        if self.done == self.moves.len() || self.all > PATIENCE {
            return Measured::Known(self.conclusion());
        }
        self.time += duration;
        let moved = [0, 1].map(|axis| aim[axis] - self.start[axis]);
        let way = moved[0].hypot(moved[1]);
        let strength = MOST * (self.time - REST) / RISE;
        let rests = strength < LEAST;
        if rests && way > NEAR {
            (self.start, self.time) = (aim, 0.0);
        } else if !rests && (strength >= MOST || way >= FAR) {
            self.moves[self.done] = moved;
            self.done += 1;
            (self.start, self.time) = (aim, 0.0);
        } else if strength > 0.0 {
            let push = PUSHES[self.done % PUSHES.len()];
            return Measured::Pushing(push.map(|k| k * strength));
        }
        Measured::Pushing([0.0; 2])
    }

    /// How much of it is over, 0 to 1.
    pub fn progress(&self) -> f32 {
        let this = (self.time / (REST + RISE)).min(1.0);
        ((self.done as f32 + this) / self.moves.len() as f32).min(1.0)
    }

    fn conclusion(&self) -> Option<Calibration> {
        if self.done < self.moves.len() {
            return None;
        }
        let (first, second) = self.moves.split_at(PUSHES.len());
        let (first, second) = (of_one_round(first)?, of_one_round(second)?);
        (first == second).then_some(first)
    }
}

/// What the four pushes of a round tell.
fn of_one_round(moves: &[[f32; 2]]) -> Option<Calibration> {
    let of_motor = |there: [f32; 2], back: [f32; 2]| {
        let half = |sign: f32| [0, 1].map(|axis| 0.5 * (there[axis] + sign * back[axis]));
        let long = |[x, y]: [f32; 2]| x.hypot(y);
        let (pushed, lost) = (half(-1.0), half(1.0));
        // What went the same way both times was no motor. A stick that lies at its rim can go one way only.
        let is_at_rim = long(there).min(long(back)) < 2.0 * NEAR;
        (is_at_rim || long(lost) < 0.5 * long(pushed)).then_some(pushed)
    };
    let [right, left, up, down] = moves else {
        return None;
    };
    Calibration::measured([of_motor(*right, *left)?, of_motor(*up, *down)?])
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
        for step in 0..15_000 {
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
    fn a_limp_stick_that_lies_at_its_rim_is_measured_too() {
        for lies in [[0.9, 0.0], [-0.8, 0.8], [0.0, -1.0]] {
            let mut measurement = Measurement::default();
            let mut at = lies;
            let found = loop {
                match measurement.step(at, 0.016) {
                    Measured::Pushing([x, y]) => {
                        // It goes where it is pushed and stays there.
                        at = [at[0] - 0.1 * y, at[1] + 0.1 * x].map(|k: f32| k.clamp(-1.0, 1.0));
                    }
                    Measured::Known(found) => break found.expect("nobody is in its way"),
                }
            };
            assert_eq!((found.swap, found.invert), (true, [false, true]));
        }
    }

    /// A hand that stirs, or that waits for each push and then goes its own way.
    #[test]
    fn a_hand_that_plays_with_the_stick_is_not_taken_for_its_motors() {
        for rate in 1..60 {
            for phase in 0..12 {
                let (rate, phase) = (0.25 * rate as f32, 0.5 * phase as f32);
                let stir = |time: f32| {
                    let (sin, cos) = (rate * time + phase).sin_cos();
                    [0.7 * cos, 0.7 * sin]
                };
                let dead = |_: [f32; 2]| [0.0; 2];
                assert_eq!(measure(dead, stir), None, "{rate} {phase}");
                let step = |time: f32| stir((rate * time).floor());
                assert_eq!(measure(dead, step), None, "{rate} {phase}");
            }
        }
    }

    #[test]
    fn it_does_not_guess() {
        let usual = |force| force;
        assert_eq!(measure(|_| [0.0; 2], |_| [0.0; 2]), None, "no motor");
        assert_eq!(measure(|[x, _]| [x, x], |_| [0.0; 2]), None, "one motor");
        assert_eq!(measure(|_| [0.0; 2], |time| [0.2 * time, 0.0]), None);
        assert_eq!(
            measure(usual, |time| [0.9 * (3.0 * time).sin(), 0.1 * time]),
            None
        );
    }
}

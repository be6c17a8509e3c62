//! Finds the mounting of the motors of a device: pushes the stick a little and observes its movement.
//!
//! Each motor pushes in both directions, gently and only until the stick has moved enough. A second round
//! repeats all pushes and must give the same result. A push begins only after the stick was still for a
//! while. If the stick moves before the push is strong enough to move it, the waiting time starts again. A
//! hand could fake a result only by imitating a motor in all eight pushes, after waiting for each of them.

use crate::{Calibration, Settings};

/// Directions of the four pushes of a round, in order [full forces].
const PUSHES: [[f32; 2]; 4] = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
/// Number of rounds. Each round consists of all [`PUSHES`].
const ROUNDS: usize = 2;
/// Force at the end of a push, if the stick has not moved enough before [full forces].
const MOST: f32 = 0.4;
/// Force below which the push itself moves no stick [full forces]. Earlier movements come from a hand.
const LEAST: f32 = 0.03;
/// Time over which a push ramps up [s].
const RISE: f32 = 1.5;
/// Time for which the stick must be still before a push [s].
const REST: f32 = 0.5;
/// Largest movement of a stick that counts as still, as a share of the travel from the middle to the rim.
const NEAR: f32 = 0.04;
/// Movement of a stick that ends a push, as a share of the travel from the middle to the rim.
const FAR: f32 = 0.25;
/// Maximum duration of a measurement [s].
const PATIENCE: f32 = 45.0;

/// Measurement of the mounting of a device's motors, one step at a time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Measurement {
    /// Number of completed pushes.
    done: usize,
    /// Time since the start of the current push, including the wait before it [s].
    time: f32,
    /// Time since the start of the measurement [s].
    all: f32,
    /// Stick position at the start of the current push.
    start: [f32; 2],
    /// Stick movement of each completed push, as a share of the travel from the middle to the rim.
    moves: [[f32; 2]; ROUNDS * PUSHES.len()],
}

/// Next action of a measurement, or its result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measured {
    /// Push the stick with this force [full forces], with [`StickMode::OpenLoop`](crate::StickMode::OpenLoop) and
    /// [`Measurement::SETTINGS`], and report its position.
    Pushing([f32; 2]),
    /// Measured calibration. `None` if the result is unclear, for example because the stick was held or no
    /// motor pushed.
    Known(Option<Calibration>),
}

impl Measurement {
    /// Settings for a measurement: default mounting and a low force limit. `full` is 1 N, so that a force in
    /// newtons has the same number in full forces.
    pub const SETTINGS: Settings = Settings {
        strength: 1.0,
        full: 1.0,
        stiffness: 0.0,
        slew: 10.0,
        clamp: MOST,
        calibration: Calibration::IDENTITY,
    };

    /// Returns the next action for the stick position `aim`. `duration` is the time since the last step [s].
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

    /// Returns the progress of the measurement, 0 to 1.
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

/// Returns the calibration from the stick movements of one round, or `None` if they are unclear.
fn of_one_round(moves: &[[f32; 2]]) -> Option<Calibration> {
    let of_motor = |there: [f32; 2], back: [f32; 2]| {
        let half = |sign: f32| [0, 1].map(|axis| 0.5 * (there[axis] + sign * back[axis]));
        let long = |[x, y]: [f32; 2]| x.hypot(y);
        let (pushed, lost) = (half(-1.0), half(1.0));
        // Opposite pushes of a motor cause opposite movements, so a common movement comes from a hand.
        // Accepts a stick at its rim, which can move in only one of the directions.
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
    use crate::{Ability, Command, ForceController, Output, State, StickMode, Watchdog};
    use std::time::Duration;

    /// Measures a simulated light stick with a soft spring, through all of `ForceController`. `built` maps
    /// motor forces to stick forces; `hand` is added to the stick position.
    fn measure(
        built: impl Fn([f32; 2]) -> [f32; 2],
        hand: impl Fn(f32) -> [f32; 2],
    ) -> Option<Calibration> {
        let (mut measurement, mut feel) = (Measurement::default(), ForceController::default());
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
            let manner = StickMode::OpenLoop;
            let wish = Ok(State { contact, manner });
            let mail = Command { wish, at: now };
            let (lean, watchdog) = ((aim, Ability::Force), Watchdog::default());
            let felt = feel.step(&watchdog, &mail, lean, &Measurement::SETTINGS, now);
            let Output::Force(force) = felt.output else {
                panic!("the output is not a force")
            };
            assert!(force.iter().all(|k| k.abs() <= MOST));
            let force = built(force);
            for axis in 0..2 {
                speed[axis] += 0.004 * (40.0 * force[axis] - 30.0 * at[axis] - 8.0 * speed[axis]);
                at[axis] += 0.004 * speed[axis];
            }
        }
        panic!("the measurement does not end")
    }

    #[test]
    fn measurement_finds_swapped_and_inverted_axes() {
        for swap in [false, true] {
            for invert in [[false, false], [true, false], [false, true], [true, true]] {
                let built = |[x, y]: [f32; 2]| {
                    let sign = |axis: usize| if invert[axis] { -1.0 } else { 1.0 };
                    let along = [sign(0) * x, sign(1) * y];
                    if swap { [along[1], along[0]] } else { along }
                };
                let found = measure(built, |_| [0.0; 2]).expect("the stick moves freely");
                assert_eq!((found.swap, found.invert), (swap, invert));
                // After calibration, the stick must move in the direction of the force.
                let push = [0.3, -0.7];
                assert_eq!(built(found.apply(push)), push);
            }
        }
    }

    #[test]
    fn measurement_works_for_a_limp_stick_at_its_rim() {
        for lies in [[0.9, 0.0], [-0.8, 0.8], [0.0, -1.0]] {
            let mut measurement = Measurement::default();
            let mut at = lies;
            let found = loop {
                match measurement.step(at, 0.016) {
                    Measured::Pushing([x, y]) => {
                        // The stick moves with the push and stays where it was pushed.
                        at = [at[0] - 0.1 * y, at[1] + 0.1 * x].map(|k: f32| k.clamp(-1.0, 1.0));
                    }
                    Measured::Known(found) => break found.expect("the stick moves freely"),
                }
            };
            assert_eq!((found.swap, found.invert), (true, [false, true]));
        }
    }

    /// Tests a hand that moves all the time, and one that waits for each push and then moves as it likes.
    #[test]
    fn measurement_fails_when_a_hand_moves_the_stick() {
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
    fn measurement_fails_without_clear_motors() {
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

//! Interpretation of stick input: pure functions of values and time.

use crate::{Button, Device, DeviceId, Direction};

/// Timer that repeats a held direction, as keyboards repeat keys.
#[derive(Clone, Debug, Default)]
pub struct Repeat {
    held: Option<Direction>,
    /// Time until the next repetition of the held direction [s].
    left: f32,
}

/// Navigation of a menu with a device. Each press of the d-pad or hat, and each push of the stick, moves one
/// step. A held direction repeats the step.
#[derive(Clone, Debug, Default)]
pub struct Navigator {
    device: Option<DeviceId>,
    hat: [Button; Direction::ALL.len()],
    lean: Option<Direction>,
    repeat: Repeat,
}

/// Applies radial dead zones in the middle and at the rim of a stick. Up to the length `inner` (usually 0.1 to
/// 0.2) the result is 0, because a stick jitters there or does not return to 0. From `outer` (usually 0.95) on
/// the result has length 1, because few sticks reach their full length. Between the zones the length grows
/// linearly, and the direction is kept. A dead zone per axis would make the stick snap to the axes. Non-finite
/// input gives 0.
pub fn radial_dead_zone(stick: [f32; 2], inner: f32, outer: f32) -> [f32; 2] {
    let length = (stick[0] * stick[0] + stick[1] * stick[1]).sqrt();
    if !length.is_finite() || length <= inner || length == 0.0 {
        return [0.0; 2];
    }
    let wanted = if length < outer {
        (length - inner) / (outer - inner)
    } else {
        1.0
    };
    stick.map(|component| component * (wanted / length))
}

impl Direction {
    /// Returns the direction of a stick, given its previous direction `before`. Starting a direction needs a
    /// larger deflection than keeping it. So neither a trembling hand nor a diagonal makes the direction
    /// flicker.
    pub fn of(stick: [f32; 2], before: Option<Direction>) -> Option<Direction> {
        const BEGINS: f32 = 0.6;
        const ENDS: f32 = 0.4;
        let along = |direction: Direction| {
            let [x, y] = direction.vector();
            x * stick[0] + y * stick[1]
        };
        let strongest = Direction::ALL
            .into_iter()
            .max_by(|a, b| along(*a).total_cmp(&along(*b)));
        before
            .filter(|before| along(*before) >= ENDS)
            .or(strongest.filter(|strongest| along(*strongest) >= BEGINS))
    }
}

impl Repeat {
    /// Delay before the first repetition [s]. With a shorter one a slow finger moves two steps; a longer one
    /// feels unresponsive.
    pub const DELAY: f32 = 0.4;
    /// Interval between repetitions [s].
    pub const INTERVAL: f32 = 0.12;

    /// Returns whether the held direction repeats now, `seconds` after the last call. The start of holding a
    /// direction is not a repetition. A call gives at most one repetition, so that a slow frame does not run
    /// through a menu.
    pub fn step(&mut self, held: Option<Direction>, seconds: f32) -> bool {
        if held.is_none() || held != self.held {
            self.held = held;
            self.left = Repeat::DELAY;
            return false;
        }
        self.left -= seconds;
        let due = self.left <= 0.0;
        if due {
            self.left = Repeat::INTERVAL;
        }
        due
    }
}

impl Navigator {
    /// Returns the steps of the focus to take now, `seconds` after the last call. The first call with a
    /// device returns no step, so that the button press with which a player joins chooses nothing.
    pub fn step(&mut self, device: &Device, seconds: f32) -> Vec<Direction> {
        let hat = Direction::ALL.map(|direction| device.hat(direction));
        if self.device != Some(device.id) {
            *self = Navigator {
                device: Some(device.id),
                hat,
                lean: Direction::of(device.aim(), None),
                repeat: Repeat::default(),
            };
            return Vec::new();
        }

        let mut steps = Vec::new();
        for direction in Direction::ALL {
            let presses = hat[direction as usize].presses_since(self.hat[direction as usize]);
            steps.extend((0..presses).map(|_| direction));
        }
        let lean = Direction::of(device.aim(), self.lean);
        steps.extend(lean.filter(|_| lean != self.lean));

        let down = Direction::ALL
            .into_iter()
            .find(|direction| hat[*direction as usize].down);
        let held = down.or(lean);
        if self.repeat.step(held, seconds) && steps.is_empty() {
            steps.extend(held);
        }
        (self.hat, self.lean) = (hat, lean);
        steps
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DeviceInfo;

    #[test]
    fn dead_zone_is_round_and_keeps_the_direction() {
        assert_eq!(radial_dead_zone([0.1, -0.1], 0.15, 0.95), [0.0, 0.0]);
        assert_eq!(radial_dead_zone([0.15, 0.0], 0.15, 0.95), [0.0, 0.0]);
        near(radial_dead_zone([0.55, 0.0], 0.15, 0.95), [0.5, 0.0]);
        near(radial_dead_zone([0.0, -1.0], 0.15, 0.95), [0.0, -1.0]);
        near(
            radial_dead_zone([1.0, 1.0], 0.15, 0.95),
            [0.5_f32.sqrt(); 2],
        );
        let [x, y] = radial_dead_zone([0.3, 0.4], 0.1, 0.9);
        near([x / y, 0.0], [0.75, 0.0]);
        near([(x * x + y * y).sqrt(), 0.0], [0.5, 0.0]);
    }

    #[test]
    fn dead_zone_is_continuous_at_both_ends() {
        near(radial_dead_zone([0.1501, 0.0], 0.15, 0.95), [0.0, 0.0]);
        near(radial_dead_zone([0.9499, 0.0], 0.15, 0.95), [1.0, 0.0]);
    }

    #[test]
    fn non_finite_input_is_at_rest() {
        for broken in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(radial_dead_zone([broken, 0.5], 0.1, 0.9), [0.0; 2]);
            assert_eq!(radial_dead_zone([0.5, broken], 0.1, 0.9), [0.0; 2]);
        }
        assert_eq!(Direction::of([f32::NAN; 2], None), None);
        assert_eq!(radial_dead_zone([0.0; 2], 0.0, 0.0), [0.0; 2]);
        near(radial_dead_zone([0.5, 0.0], 0.5, 0.5), [0.0, 0.0]);
    }

    #[test]
    fn direction_has_hysteresis() {
        assert_eq!(Direction::of([0.0, 0.5], None), None);
        assert_eq!(Direction::of([0.0, 0.7], None), Some(Direction::Up));
        assert_eq!(
            Direction::of([0.0, 0.5], Some(Direction::Up)),
            Some(Direction::Up)
        );
        assert_eq!(Direction::of([0.0, 0.3], Some(Direction::Up)), None);
        assert_eq!(
            Direction::of([0.8, 0.6], Some(Direction::Up)),
            Some(Direction::Up)
        );
        assert_eq!(
            Direction::of([0.95, 0.3], Some(Direction::Up)),
            Some(Direction::Right)
        );
        assert_eq!(
            Direction::of([0.0, -1.0], Some(Direction::Up)),
            Some(Direction::Down)
        );
    }

    #[test]
    fn repeat_begins_after_a_delay() {
        let mut repeat = Repeat::default();
        let at: Vec<_> = (0..10)
            .map(|_| repeat.step(Some(Direction::Up), 0.11))
            .collect();
        let wanted = [
            false, false, false, false, true, false, true, false, true, false,
        ];
        assert_eq!(
            at, wanted,
            "first after 0.4 s, then at the first call past 0.12 s"
        );
        assert!(
            !repeat.step(Some(Direction::Down), 0.5),
            "another direction starts a new delay"
        );
        assert!(!repeat.step(None, 0.5));
        assert!(!repeat.step(Some(Direction::Down), 0.5));
        assert!(repeat.step(Some(Direction::Down), 60.0));
        assert!(
            !repeat.step(Some(Direction::Down), 0.01),
            "a frame of a minute is one step"
        );
    }

    #[test]
    fn navigator_steps_once_per_push_and_repeats_while_held() {
        let (mut navigator, mut stick) = (Navigator::default(), stick(1));
        let mut steps = Vec::new();
        for tick in 0..60 {
            stick.axes[1] = if (5..50).contains(&tick) { 1.0 } else { 0.0 };
            steps.extend(
                navigator
                    .step(&stick, 1.0 / 60.0)
                    .into_iter()
                    .map(|step| (tick, step)),
            );
        }
        let ticks: Vec<_> = steps.iter().map(|(tick, _)| *tick).collect();
        assert_eq!(
            ticks,
            [5, 29, 37, 45],
            "0.4 s, then every 0.12 s or the tick after it"
        );
        assert!(
            steps.iter().all(|(_, step)| *step == Direction::Down),
            "towards the player is down"
        );
    }

    #[test]
    fn navigator_counts_all_taps_between_two_calls() {
        let (mut navigator, mut stick) = (Navigator::default(), stick(1));
        navigator.step(&stick, 0.0);
        for direction in [Direction::Left, Direction::Left, Direction::Up] {
            let button = stick.hats[0].button_mut(direction);
            button.press();
            button.down = false;
        }
        let wanted = [Direction::Up, Direction::Left, Direction::Left];
        assert_eq!(navigator.step(&stick, 0.016), wanted);
        assert!(navigator.step(&stick, 0.016).is_empty());
    }

    #[test]
    fn navigator_ignores_the_first_call_of_another_device() {
        let (mut navigator, mut one, mut two) = (Navigator::default(), stick(1), stick(2));
        navigator.step(&one, 0.016);
        two.axes[0] = 1.0;
        two.hats[0].button_mut(Direction::Right).press();
        assert!(navigator.step(&two, 0.016).is_empty());
        assert!(
            navigator.step(&two, 0.016).is_empty(),
            "the state of the device is unchanged"
        );
        one.axes[0] = -1.0;
        assert!(navigator.step(&one, 0.016).is_empty());
    }

    fn stick(id: u32) -> Device {
        Device::at_rest(DeviceId(id), DeviceInfo::default(), 2, 0, 1)
    }

    fn near(is: [f32; 2], wanted: [f32; 2]) {
        let close = |index: usize| (is[index] - wanted[index]).abs() < 1e-3;
        assert!(close(0) && close(1), "{is:?} is not {wanted:?}");
    }
}

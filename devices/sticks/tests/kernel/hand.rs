//! Forces that a kernel device plays for a sequence of driver commands, and checks of such a sequence.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use force_feedback::{OUTPUT_DURATION, Settings};

use crate::uinput::{Effect, Told, What};

const TO_THE_RIGHT: u16 = 0xc000;
const AWAY: u16 = 0x8000;
/// Interval at which a continuing force is started again.
const START_AGAIN: Duration = Duration::from_millis(150);
/// Tolerance for the time between two commands: their delays differ on a slow machine.
const LATE: Duration = Duration::from_millis(30);

/// Settings with low limits, so that a violation is visible despite the tolerance `LATE`.
pub fn settings() -> Settings {
    Settings {
        slew: *Settings::SLEW.start(),
        clamp: 0.35,
        strength: 1.0,
        ..Settings::default()
    }
}

#[derive(Default)]
struct Hand(BTreeMap<i16, Motor>);

struct Motor {
    effect: Effect,
    started: Option<Instant>,
}

impl Hand {
    fn feel(&mut self, told: &Told) {
        match told.what {
            What::Upload(effect) => {
                let motor = self.0.entry(effect.id).or_insert(Motor {
                    effect,
                    started: None,
                });
                motor.effect = effect;
            }
            What::Play { id, times } => {
                let motor = self.0.get_mut(&id).expect("a missing effect is played");
                motor.started = (times > 0).then_some(told.at);
            }
            What::Erase { id } => {
                self.0.remove(&id).expect("a missing effect is erased");
            }
            What::Autocentre(_) | What::Gain(_) => {}
        }
    }

    /// Returns the force at a time [full forces]: x to the right, y away from the player.
    fn force(&self, at: Instant) -> [f32; 2] {
        let mut force = [0.0; 2];
        for motor in self.0.values().filter(|motor| motor.plays(at)) {
            let level = f32::from(motor.effect.level) / 32767.0;
            match motor.effect.direction {
                TO_THE_RIGHT => force[0] += level,
                AWAY => force[1] += level,
                other => panic!("unexpected direction {other:#x}"),
            }
        }
        force
    }
}

impl Motor {
    fn plays(&self, at: Instant) -> bool {
        let Effect { length, .. } = self.effect;
        self.started
            .is_some_and(|started| length.is_zero() || at - started < length)
    }
}

/// Returns the force at the time `at`. For a time in the future, assumes that no further commands arrive.
pub fn force_at(told: &[Told], at: Instant) -> [f32; 2] {
    let mut hand = Hand::default();
    for told in told.iter().take_while(|told| told.at <= at) {
        hand.feel(told);
    }
    hand.force(at)
}

/// Returns the force right after each command, in order.
pub fn forces(told: &[Told]) -> Vec<[f32; 2]> {
    let mut hand = Hand::default();
    let force = |told: &Told| {
        hand.feel(told);
        hand.force(told.at)
    };
    told.iter().map(force).collect()
}

/// Returns the time since which the force is zero. `None` while it is nonzero, or if there never was a force.
pub fn quiet_since(told: &[Told]) -> Option<Instant> {
    let last_loud = forces(told).iter().rposition(|force| *force != [0.0; 2])?;
    told.get(last_loud + 1).map(|told| told.at)
}

/// Checks the driver commands of one line of `force_feedback`. The centring spring must be off, and there
/// must be two effects of finite length with constant directions. A continuing force must be restarted in
/// time and not more often, and the levels must keep the limits of the settings.
pub fn check(told: &[Told]) {
    let centred = told
        .iter()
        .position(|told| told.what == What::Autocentre(0));
    let first = told
        .iter()
        .position(|told| matches!(told.what, What::Upload(_)));
    assert!(
        centred < first && centred.is_some(),
        "autocentre is not turned off first"
    );

    let mut motors: BTreeMap<i16, Vec<Told>> = BTreeMap::new();
    for told in told {
        match told.what {
            What::Upload(Effect { id, .. }) | What::Play { id, .. } | What::Erase { id } => {
                motors.entry(id).or_default().push(*told);
            }
            What::Autocentre(strength) => assert_eq!(strength, 0),
            What::Gain(_) => {}
        }
    }
    let directions: Vec<u16> = motors.values().map(|told| check_motor(told)).collect();
    assert_eq!(directions, [TO_THE_RIGHT, AWAY]);
}

/// Checks the driver commands of one effect and returns the direction of the effect.
fn check_motor(told: &[Told]) -> u16 {
    let effects: Vec<(Instant, Effect)> = told
        .iter()
        .filter_map(|told| match told.what {
            What::Upload(effect) => Some((told.at, effect)),
            _ => None,
        })
        .collect();
    let settings = settings();
    let direction = effects[0].1.direction;
    for (_, effect) in &effects {
        assert_eq!(effect.direction, direction);
        assert_eq!(
            (effect.length, effect.delay),
            (OUTPUT_DURATION, Duration::ZERO)
        );
    }
    let levels: Vec<(Instant, f32)> = effects
        .iter()
        .map(|(at, effect)| (*at, f32::from(effect.level) / 32767.0))
        .collect();
    for many in levels.windows(5) {
        // Unchanged levels are not sent. The force may therefore have kept the first level until the second
        // was sent.
        let (from, before, (at, to)) = (many[0].1, many[1].0, many[4]);
        let most = settings.slew * (at - before + LATE).as_secs_f32();
        // A change to zero is a stop, which is exempt from the slew limit.
        let is_slow = to == 0.0 || (to - from).abs() <= most;
        assert!(is_slow, "from {from} to {to} in {:?}", at - before);
        assert!(to.abs() <= settings.clamp + 1e-4, "{to}");
    }

    let mut starts: Vec<Instant> = Vec::new();
    let mut rested = true;
    for told in told {
        match told.what {
            What::Upload(effect) => rested |= effect.level == 0,
            What::Play { times, .. } => {
                assert_eq!(times, 1);
                if let Some(before) = starts.last() {
                    assert!(
                        rested || told.at - *before < OUTPUT_DURATION,
                        "a push ended too early"
                    );
                }
                rested = false;
                starts.push(told.at);
            }
            _ => {}
        }
    }
    for four in starts.windows(4) {
        let time = four[3] - four[0] + LATE;
        assert!(time >= 3 * START_AGAIN, "started four times in {time:?}");
    }
    direction
}

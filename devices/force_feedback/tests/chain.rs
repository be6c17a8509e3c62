//! The safety chain with arbitrary input.

use fastrand::Rng;
use force_feedback::{
    Ability, Calibration, Command, ForceController, Output, Settings, State, StickMode, Watchdog,
};
use force_feedback::{Chain, MAX_STIFFNESS};
use std::time::Duration;

/// Returns an arbitrary float, special values more often than by chance.
fn number(rng: &mut Rng) -> f32 {
    match rng.u8(..12) {
        0 => f32::NAN,
        1 => f32::INFINITY,
        2 => f32::NEG_INFINITY,
        3 => f32::MAX,
        4 => -f32::MIN_POSITIVE,
        5 => f32::from_bits(rng.u32(..)),
        6 => 0.0,
        _ => 400.0 * (rng.f32() - 0.5),
    }
}

fn settings(rng: &mut Rng) -> Settings {
    let mut any = |usual: f32| match rng.u8(..8) {
        0 => number(rng),
        _ => usual * 2.0 * rng.f32(),
    };
    Settings {
        strength: any(0.8),
        full: any(100.0),
        stiffness: any(MAX_STIFFNESS),
        slew: any(30.0),
        clamp: any(0.8),
        calibration: Calibration {
            swap: any(1.0) > 1.0,
            invert: [any(1.0) > 1.0, any(1.0) > 1.0],
            gain: [any(1.0), any(1.0)],
        },
    }
}

#[test]
fn chain_keeps_slew_and_clamp_for_arbitrary_forces() {
    let mut rng = Rng::with_seed(4);
    let mut strongest = 0.0f32;
    for history in 0..10_000 {
        let settings = settings(&mut rng).bounded();
        let mut chain = Chain::default();
        let mut before = [0.0; 2];
        let mut newtons = [0.0; 2];
        for step in 0..100 {
            if rng.u8(..3) == 0 {
                newtons = [number(&mut rng), number(&mut rng)];
            }
            let duration = match rng.u8(..20) {
                0 => number(&mut rng),
                1 => 0.0,
                _ => 0.02 * rng.f32(),
            };
            let force = chain.step(newtons, &settings, duration);
            let told = settings.calibration.apply(force);
            for axis in 0..2 {
                let what = || format!("history {history}, step {step}: {force:?} after {before:?}");
                assert!(force[axis].abs() <= settings.clamp, "{}", what());
                assert!(told[axis].abs() <= settings.clamp, "{}", what());
                let most = settings.slew * if duration > 0.0 { duration } else { 0.0 };
                let jump = (force[axis] - before[axis]).abs();
                assert!(jump <= most * 1.0001 + 1e-7, "{jump}, {most}, {}", what());
                strongest = strongest.max(force[axis].abs());
            }
            before = force;
        }
    }
    assert!(
        strongest > 0.5,
        "the strongest force is too weak: {strongest}"
    );
}

/// The same limits hold through `ForceController`, for arbitrary states and stick positions.
#[test]
fn controller_keeps_slew_and_clamp_for_arbitrary_states() {
    let mut rng = Rng::with_seed(5);
    for _history in 0..2000 {
        let settings = settings(&mut rng);
        let bounded = settings.bounded();
        let (watchdog, mut feel) = (Watchdog::default(), ForceController::default());
        let mut now = Duration::ZERO;
        let mut before = [0.0; 2];
        for _step in 0..100 {
            let state = State {
                contact: [number(&mut rng), number(&mut rng)],
                manner: if rng.bool() {
                    StickMode::Position
                } else {
                    StickMode::Velocity
                },
            };
            let mail = Command {
                wish: Ok(state),
                at: now,
            };
            let aim = [0.0; 2].map(|_| match rng.u8(..10) {
                0 => number(&mut rng),
                _ => 2.0 * rng.f32() - 1.0,
            });
            if rng.u8(..9) == 0 {
                feel.tear(number(&mut rng));
            }
            let felt = feel.step(&watchdog, &mail, (aim, Ability::Force), &settings, now);
            let Output::Force(force) = felt.output else {
                panic!("the output is not a force")
            };
            for axis in 0..2 {
                assert!(force[axis].abs() <= bounded.clamp);
                let jump = (force[axis] - before[axis]).abs();
                assert!(jump <= bounded.slew * 0.004 * 1.001 + 1e-7, "{jump}");
            }
            before = force;
            now += Duration::from_millis(4);
        }
    }
}

#[test]
fn controller_recovers_from_nan() {
    let settings = Settings::default();
    let (watchdog, mut feel) = (Watchdog::default(), ForceController::default());
    let mut felt = None;
    for step in 0..1000u32 {
        let odd = if step == 300 { f32::NAN } else { -100.0 };
        let lean = if step == 500 {
            f32::NAN
        } else {
            step.min(700) as f32 / 700.0
        };
        let now = Duration::from_millis(4) * step;
        let mail = Command {
            wish: Ok(State {
                contact: [odd, 0.0],
                manner: StickMode::Position,
            }),
            at: now,
        };
        felt = Some(feel.step(
            &watchdog,
            &mail,
            ([lean, 0.0], Ability::Force),
            &settings,
            now,
        ));
    }
    let felt = felt.expect("there were steps");
    assert!(
        matches!(felt.output, Output::Force([x, _]) if x < -0.05),
        "{felt:?}"
    );
}

#[test]
fn first_force_ramps_up() {
    let settings = Settings::default();
    let mut chain = Chain::default();
    for step in 0..=250 {
        let [force, _] = chain.step([1000.0, 0.0], &settings, 0.004);
        let time = step as f32 * 0.004;
        assert!(force <= time + 0.01, "{force} after {time} s");
    }
    let [force, _] = chain.step([1000.0, 0.0], &settings, 0.004);
    assert!(force > 0.8, "{force}");
    chain.rest();
    assert_eq!(chain.step([1000.0, 0.0], &settings, 0.004), [0.0; 2]);
}

#[test]
fn chain_gives_zero_without_strength() {
    let settings = Settings {
        strength: 0.0,
        ..Settings::default()
    };
    let mut chain = Chain::default();
    for _step in 0..1000 {
        assert_eq!(chain.step([1e9, -1e9], &settings, 0.004), [0.0; 2]);
    }
}

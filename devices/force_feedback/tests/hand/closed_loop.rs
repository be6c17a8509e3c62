//! Closed-loop tests of sticks in simulated hands: no setting makes a stick oscillate.

use crate::body::Disc;
use crate::stick::{Other, Play, Stick, Trace, Wall, play};
use force_feedback::{Calibration, MAX_STIFFNESS, Settings};

/// Measured consumer sticks, held loosely, normally and firmly, and a strong stick with a fast driver. Each
/// row, at the fingertip: mass [kg], damping [N s/m], grip [N/m], full force [N], travel [m], longest delay
/// [ms].
const STICKS: [(f64, f64, f64, f64, f64, u32); 5] = [
    (0.15, 1.5, 5.0, 7.0, 0.05, 20),
    (0.15, 1.5, 30.0, 7.0, 0.05, 20),
    (0.4, 4.0, 120.0, 7.0, 0.05, 20),
    (1.0, 15.0, 500.0, 7.0, 0.05, 20),
    (0.6, 6.0, 200.0, 40.0, 0.07, 5),
];

fn sticks() -> impl Iterator<Item = Stick> {
    STICKS
        .into_iter()
        .flat_map(|(mass, damping, grip, full, travel, longest)| {
            let delays = [1, 5, 10, 20].into_iter().filter(move |ms| *ms <= longest);
            delays.map(move |ms| Stick {
                mass,
                damping,
                grip,
                full,
                travel,
                delay: f64::from(ms) * 1e-3,
            })
        })
}

/// Simulates a player who moves into the obstacle, knocks hard against the stick and then holds still. In
/// velocity mode, the player releases the stick after a while, because holding it would increase the force.
fn knock(stick: &Stick, other: &mut dyn Other, how: &Play) -> Trace {
    let full = stick.full;
    play(
        stick,
        other,
        how,
        &|time| {
            let lets_go = how.steers && time > 3.0;
            [if lets_go { 0.0 } else { (time - 0.3).min(0.5) }, 0.0]
        },
        &|time| match time {
            2.0..2.02 => [2.0 * full, full],
            _ => [0.0; 2],
        },
    )
}

fn check_calm(stick: &Stick, how: &Play, trace: &Trace) {
    let what = || format!("{stick:?}, {how:?}");
    let last = trace.force.len() - how.rate as usize;
    for axis in 0..2 {
        let of = || trace.force[last..].iter().map(|force| force[axis]);
        let swing = of().fold(f32::MIN, f32::max) - of().fold(f32::MAX, f32::min);
        assert!(swing < 0.01, "the force oscillates by {swing}: {}", what());
    }
    // Unit of energy: work of a full force along the travel of the stick [J].
    let unit = stick.full * stick.travel;
    let moves = trace.kinetic[last..].iter().copied().fold(0.0, f64::max);
    assert!(
        moves < 1e-4 * unit,
        "the stick moves, {moves} J: {}",
        what()
    );
    // After the knock the energy must decrease.
    let window = how.rate as usize / 2;
    let quiet = (if how.steers { 3.1 } else { 2.1 }) * f64::from(how.rate);
    let mut before = f64::INFINITY;
    for part in trace.kinetic[quiet as usize..].chunks(window) {
        let energy = part.iter().copied().fold(0.0, f64::max);
        let grows = energy > before.max(1e-3 * unit);
        assert!(!grows, "{energy} J after {before} J: {}", what());
        before = energy;
    }
}

#[test]
fn stick_at_a_wall_does_not_oscillate() {
    let mut strongest = 0.0f32;
    for stick in sticks() {
        for (strength, clamp, gain) in [(1.0, 1.0, 1.0), (0.3, 1.0, 0.5), (1.0, 0.1, 1.0)] {
            let calibration = Calibration {
                gain: [1.0, gain],
                ..Calibration::IDENTITY
            };
            for stiffness in [0.1 * MAX_STIFFNESS, 0.5 * MAX_STIFFNESS, f32::INFINITY] {
                for slew in [0.0, 30.0, 1000.0] {
                    let settings = Settings {
                        strength,
                        clamp,
                        stiffness,
                        slew,
                        calibration,
                        ..Settings::default()
                    };
                    // Each wall is tested with another rate, frame length and scale, to cover many
                    // combinations.
                    for (wall, full, rate, frame, steers, reach) in [
                        (100.0, 1.0, 125, 1, false, 1.0),
                        (100.0, 1000.0, 125, 3, true, 3.0),
                        (500.0, 100.0, 250, 3, false, 1.0),
                        (500.0, 500.0, 125, 1, true, 0.3),
                        (5e3, 1000.0, 125, 1, false, 1.6),
                        (5e3, 100.0, 250, 1, true, 1.0),
                        (5e4, 100.0, 125, 3, false, 1.0),
                        (5e4, 1000.0, 250, 1, false, 1.0),
                        (5e4, 1.0, 125, 3, true, 3.0),
                    ] {
                        let settings = Settings { full, ..settings };
                        let how = Play {
                            settings,
                            rate,
                            frame,
                            steers,
                            reach,
                            seconds: 6.0,
                        };
                        let trace = knock(&stick, &mut Wall::new(wall, 20.0), &how);
                        check_calm(&stick, &how, &trace);
                        let force = trace.force.iter().map(|force| -force[0]);
                        strongest = force.fold(strongest, f32::max);
                    }
                }
            }
        }
    }
    assert!(strongest > 0.3, "the wall is felt too weakly: {strongest}");
}

#[test]
fn stick_at_a_soft_body_does_not_oscillate() {
    let mut strongest = 0.0f32;
    for stick in sticks() {
        for (young, full, frame, steers, reach) in [
            (1000.0, 100.0, 1, false, 1.0),
            (5000.0, 1000.0, 3, false, 1.0),
            (20_000.0, 500.0, 1, false, 1.6),
            (5000.0, 100.0, 1, true, 3.0),
        ] {
            for hardness in [0.3 * MAX_STIFFNESS, MAX_STIFFNESS] {
                let settings = Settings {
                    strength: 1.0,
                    clamp: 1.0,
                    full,
                    stiffness: hardness,
                    ..Settings::default()
                };
                let how = Play {
                    settings,
                    rate: 125,
                    frame,
                    steers,
                    reach,
                    // The body itself needs some seconds until it has come to rest.
                    seconds: 12.0,
                };
                let trace = knock(&stick, &mut Disc::new(young, f32::INFINITY), &how);
                check_calm(&stick, &how, &trace);
                let force = trace.force.iter().map(|force| -force[0]);
                strongest = force.fold(strongest, f32::max);
            }
        }
    }
    assert!(strongest > 0.1, "the body is felt too weakly: {strongest}");
}

/// Tests that a device with differently mounted motors feels the same after calibration.
#[test]
fn calibration_undoes_swapped_and_inverted_motors() {
    for (swap, invert) in [
        (false, [false, false]),
        (false, [true, false]),
        (true, [false, true]),
        (true, [true, true]),
    ] {
        let built = Calibration {
            swap,
            invert,
            ..Calibration::default()
        };
        // Simulates the mounting of the motors, with a stronger y motor. The calibration must undo this
        // mapping.
        let moves = |[x, y]: [f32; 2]| {
            let [x, y] = [0, 1].map(|axis| [x, y][axis] * if invert[axis] { -0.1 } else { 0.1 });
            if swap {
                [y + 0.01, 2.0 * x]
            } else {
                [x, 2.0 * y + 0.01]
            }
        };
        let measured = Calibration::measured([moves([1.0, 0.0]), moves([0.0, 1.0])]);
        assert_eq!(measured, Some(built));
        for wish in [[1.0, 0.0], [0.0, 1.0], [-0.5, 0.25]] {
            let moved = moves(built.apply(wish));
            assert!(
                (0..2).all(|axis| moved[axis] * wish[axis] >= 0.0),
                "{built:?}"
            );
        }
    }
    for unclear in [[[0.1, 0.0], [0.1, 0.0]], [[0.0; 2]; 2], [[f32::NAN; 2]; 2]] {
        assert_eq!(Calibration::measured(unclear), None);
    }
}

/// Tests random hands and sticks with at least some damping: a damping ratio of at least 0.25, and damping ×
/// travel / full force of at least 8 ms.
#[test]
fn random_damped_sticks_settle() {
    let mut rng = fastrand::Rng::with_seed(4);
    let mut between = |low: f64, high: f64| low * (high / low).powf(rng.f64());
    let mut tried = 0;
    while tried < 400 {
        let stick = Stick {
            mass: between(0.08, 1.5),
            damping: between(1.0, 15.0),
            grip: between(3.0, 800.0),
            full: between(2.0, 12.0),
            travel: between(0.03, 0.08),
            delay: between(0.001, 0.02),
        };
        let ratio = 0.5 * stick.damping / (stick.grip * stick.mass).sqrt();
        if ratio < 0.25 || stick.damping * stick.travel < 0.008 * stick.full {
            continue;
        }
        tried += 1;
        let settings = Settings {
            strength: 1.0,
            clamp: 1.0,
            full: between(1.0, 1000.0) as f32,
            slew: between(10.0, 100.0) as f32,
            ..Settings::default()
        };
        let how = Play {
            settings,
            rate: between(125.0, 250.0) as u32,
            frame: between(1.0, 4.9) as u32,
            steers: false,
            reach: 1.0,
            seconds: 6.0,
        };
        let stiffness = between(100.0, 50_000.0);
        let is_body = tried % 8 == 0;
        let trace = if is_body {
            knock(&stick, &mut Disc::new(0.4 * stiffness, f32::INFINITY), &how)
        } else {
            knock(&stick, &mut Wall::new(stiffness as f32, 20.0), &how)
        };
        let second = how.rate as usize;
        let [before, now] = [2, 1].map(|ago| {
            let from = trace.force.len() - ago * second;
            let part = &trace.force[from..from + second];
            let swings = [0, 1].map(|axis| {
                let of = || part.iter().map(|force| force[axis]);
                of().fold(f32::MIN, f32::max) - of().fold(f32::MAX, f32::min)
            });
            swings[0].max(swings[1])
        });
        // Tolerates more movement of the stick with a soft body: a body in a corner may still move a little.
        let most = if is_body { 0.025 } else { 0.01 };
        let is_calm = now < most || now < 0.9 * before;
        assert!(is_calm, "{now} after {before}: {stick:?}, {how:?}");
    }
}

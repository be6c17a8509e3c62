//! Tests of the forces from a simulated soft body: they are steady at rest and never jump.

use crate::body::Disc;
use crate::stick::Other;
use force_feedback::{
    Ability, Command, ForceController, Output, Settings, State, StickMode, Watchdog,
};
use fuwafuwa::Event;
use std::time::Duration;

/// Update rate of the device [Hz], equal to the substep rate of the simulation.
const RATE: u32 = 960;

/// Returns the forces on a stick at 960 Hz for a given stick motion, and the number of split nodes.
fn feel(disc: &mut Disc, manner: StickMode, lean: impl Fn(f32) -> f32) -> (Vec<[f32; 2]>, usize) {
    let (watchdog, mut feel) = (Watchdog::default(), ForceController::default());
    let mut mail = Command::default();
    let (mut forces, mut torn) = (Vec::new(), 0);
    for step in 0..4 * RATE {
        let now = Duration::from_secs(1) * step / RATE;
        let aim = [lean(now.as_secs_f32()), 0.0];
        if step.is_multiple_of(RATE / 60) {
            let (_, contact) = disc.tick(aim);
            let state = State { contact, manner };
            mail = Command {
                wish: Ok(state),
                at: now,
            };
            for event in disc.world.events() {
                if matches!(event, Event::NodeSplit { .. }) {
                    torn += 1;
                    feel.tear(0.5);
                }
            }
        }
        let lean = (aim, Ability::Force);
        let felt = feel.step(&watchdog, &mail, lean, &Settings::default(), now);
        let Output::Force(force) = felt.output else {
            panic!("the output is not a force")
        };
        forces.push(force);
    }
    (forces, torn)
}

#[test]
fn force_of_a_body_at_rest_is_steady() {
    for manner in [StickMode::Position, StickMode::Velocity] {
        for young in [1000.0, 5000.0, 20_000.0] {
            let mut disc = Disc::new(young, f32::INFINITY);
            let (forces, _) = feel(&mut disc, manner, |time| (0.5 * time - 0.4).min(0.3));
            let rest = &forces[3 * RATE as usize..];
            let mean = rest.iter().map(|force| force[0]).sum::<f32>() / rest.len() as f32;
            assert!(
                mean < -0.02,
                "the mean force is too weak: {mean}, {young} Pa, {manner:?}"
            );
            for force in rest {
                let off = (force[0] - mean).hypot(force[1]);
                assert!(
                    off < 0.02 * -mean,
                    "{force:?} of {mean}, {young} Pa, {manner:?}"
                );
            }
        }
    }
}

#[test]
fn tears_cause_no_force_jump() {
    let slew = Settings::default().slew;
    for manner in [StickMode::Position, StickMode::Velocity] {
        let mut disc = Disc::new(5000.0, 0.05);
        let (forces, torn) = feel(&mut disc, manner, |time| (0.8 * time - 0.4).min(0.9));
        assert!(torn > 10, "only {torn} tears");
        let strongest = forces.iter().map(|force| -force[0]).fold(0.0, f32::max);
        assert!(
            strongest > 0.05,
            "the strongest force is too weak: {strongest}"
        );
        for pair in forces.windows(2) {
            let jumps = [0, 1].map(|axis| (pair[1][axis] - pair[0][axis]).abs());
            let most = slew / RATE as f32 * 1.001;
            assert!(jumps.iter().all(|jump| *jump <= most), "{jumps:?}");
        }
    }
}

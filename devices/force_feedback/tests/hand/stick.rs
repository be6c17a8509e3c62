//! A simulated stick in a simulated hand, in closed loop with all of `ForceController` and an obstacle.

use force_feedback::{
    Ability, Command, ForceController, Output, Settings, State, StepOutput, StickMode, Stop,
    Watchdog,
};
use std::collections::VecDeque;
use std::time::Duration;

/// One tick of the simulation [s].
pub const TICK: f64 = 1.0 / 60.0;
/// Time step of the stick [s].
const STEP: f64 = 0.25e-3;

/// Stick and the hand that holds it. Lengths and forces are measured at the grip.
#[derive(Clone, Copy, Debug)]
pub struct Stick {
    pub mass: f64,
    /// Damping of hinge and hand [N s/m].
    pub damping: f64,
    /// Stiffness of the hand around its target [N/m].
    pub grip: f64,
    /// Full force of the motors [N].
    pub full: f64,
    /// Travel from the middle to the rim [m].
    pub travel: f64,
    /// Delay between computing a force and feeling it [s].
    pub delay: f64,
}

/// Obstacle against which the simulated hand pushes.
pub trait Other {
    /// Runs a tick in which the simulated hand is pulled towards `goal` [m]. Returns its position [m] and the
    /// contact force [N].
    fn tick(&mut self, goal: [f32; 2]) -> ([f32; 2], [f32; 2]);
}

/// Settings of a simulated run.
#[derive(Clone, Copy, Debug)]
pub struct Play {
    pub settings: Settings,
    pub rate: u32,
    /// Number of simulation ticks per frame of the game.
    pub frame: u32,
    /// Whether the stick gives a velocity instead of a position, see [`StickMode::Velocity`].
    pub steers: bool,
    /// Distance of the simulated hand from the middle when the stick is at its rim [m]. If the stick gives a
    /// velocity: half the top speed of the simulated hand [m/s].
    pub reach: f32,
    pub seconds: f64,
}

/// Recorded values of a run, one entry per device update.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    pub force: Vec<[f32; 2]>,
    /// Kinetic energy of the stick [J].
    pub kinetic: Vec<f64>,
}

/// Runs a stick. The hand pulls it towards the position `wish(time)`, −1 to 1, and disturbs it with the force
/// `nudge(time)` [N].
pub fn play(
    stick: &Stick,
    other: &mut dyn Other,
    play: &Play,
    wish: &dyn Fn(f64) -> [f64; 2],
    nudge: &dyn Fn(f64) -> [f64; 2],
) -> Trace {
    let (watchdog, mut feel) = (Watchdog::default(), ForceController::default());
    let mut mail = Command::default();
    let (mut place, mut velocity) = (wish(0.0).map(|k| k * stick.travel), [0.0f64; 2]);
    let delay = (stick.delay / STEP).round() as usize;
    let mut wire: VecDeque<[f32; 2]> = vec![[0.0; 2]; delay].into();
    let mut force = [0.0f32; 2];
    let mut goal = [0.0f32; 2];
    let (mut next_frame, mut next_update) = (0.0, 0.0);
    let mut trace = Trace::default();
    let steps = (play.seconds / STEP) as usize;
    for step in 0..steps {
        let time = step as f64 * STEP;
        // Rounds the stick position to 10 bits per axis, as in consumer sticks.
        let aim =
            place.map(|k| ((k / stick.travel).clamp(-1.0, 1.0) * 512.0).round() as f32 / 512.0);
        if time >= next_frame {
            let mut felt = ([0.0; 2], [0.0; 2]);
            for _tick in 0..play.frame {
                for axis in 0..2 {
                    if play.steers {
                        let hand = felt.0[axis];
                        goal[axis] += aim[axis] * 2.0 * play.reach * TICK as f32;
                        if felt.0 != [0.0; 2] {
                            goal[axis] = goal[axis].clamp(hand - 0.4, hand + 0.4);
                        }
                    } else {
                        goal[axis] = play.reach * aim[axis];
                    }
                }
                felt = other.tick(goal);
            }
            let manner = if play.steers {
                StickMode::Velocity
            } else {
                StickMode::Position
            };
            mail = Command {
                wish: Ok(State {
                    contact: felt.1,
                    manner,
                }),
                at: Duration::from_secs_f64(time),
            };
            next_frame += f64::from(play.frame) * TICK;
        }
        if time >= next_update {
            let now = Duration::from_secs_f64(time);
            let StepOutput { output, silent, .. } =
                feel.step(&watchdog, &mail, (aim, Ability::Force), &play.settings, now);
            assert_ne!(silent, Some(Stop::Stale), "a frame takes too long");
            let Output::Force(told) = output else {
                panic!("the output is not a force")
            };
            force = told;
            trace.force.push(force);
            let kinetic: f64 = velocity.iter().map(|v| 0.5 * stick.mass * v * v).sum();
            trace.kinetic.push(kinetic);
            next_update += 1.0 / f64::from(play.rate);
        }
        wire.push_back(force);
        let arrived = wire.pop_front().expect("the delay line is not empty");
        let (wish, nudge) = (wish(time), nudge(time));
        for axis in 0..2 {
            let motor = f64::from(arrived[axis]) * stick.full;
            let grip = stick.grip * (wish[axis] * stick.travel - place[axis]);
            // Models the rim as a spring, because the time step is too long for a hard stop.
            let beyond = place[axis].abs() - stick.travel;
            let rim = if beyond > 0.0 {
                -(5e4 * beyond * place[axis].signum() + 20.0 * velocity[axis])
            } else {
                0.0
            };
            let sum = motor + grip + rim + nudge[axis] - stick.damping * velocity[axis];
            velocity[axis] += sum / stick.mass * STEP;
            place[axis] += velocity[axis] * STEP;
        }
    }
    trace
}

/// Wall at x = 0 and a simulated hand with the default coupling.
#[derive(Clone, Copy, Debug)]
pub struct Wall {
    /// Stiffness of the wall [N/m].
    pub stiffness: f32,
    /// Damping of the wall [N s/m].
    pub damping: f32,
    hand: [f32; 2],
    velocity: [f32; 2],
    goal: [f32; 2],
}

impl Wall {
    pub fn new(stiffness: f32, damping: f32) -> Self {
        Self {
            stiffness,
            damping,
            hand: [-0.3, 0.0],
            velocity: [0.0; 2],
            goal: [-0.3, 0.0],
        }
    }
}

impl Other for Wall {
    fn tick(&mut self, goal: [f32; 2]) -> ([f32; 2], [f32; 2]) {
        let (mass, spring) = (2.0f32, 3000.0f32);
        let damper = 2.0 * 0.9 * (mass * spring).sqrt();
        let substeps = 32;
        let duration = TICK as f32 / substeps as f32;
        let speed = [0, 1].map(|axis| (goal[axis] - self.goal[axis]) / TICK as f32);
        let mut contact = [0.0; 2];
        for _substep in 0..substeps {
            let bears = (self.stiffness * self.hand[0] + self.damping * self.velocity[0]).max(0.0);
            let wall = if self.hand[0] > 0.0 { bears } else { 0.0 };
            contact[0] -= wall / substeps as f32;
            let push = [-wall, 0.0];
            let forces = [0, 1].map(|axis| {
                let stretch = self.goal[axis] + speed[axis] * duration - self.hand[axis];
                let slip = speed[axis] - self.velocity[axis];
                push[axis] + spring * stretch + damper * slip
            });
            let step = |from: [f32; 2], rate: [f32; 2]| {
                [0, 1].map(|axis| from[axis] + rate[axis] * duration)
            };
            self.goal = step(self.goal, speed);
            self.velocity = step(self.velocity, forces.map(|force| force / mass));
            self.hand = step(self.hand, self.velocity);
        }
        (self.hand, contact)
    }
}

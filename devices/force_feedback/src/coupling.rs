//! Virtual coupling [Colgate 1995] between a stick and the simulated hand, evaluated at the rate of the
//! device.
//!
//! A spring and a damper connect the *current* stick position to a **proxy**: F = K (proxy − stick) + B Δv.
//! Along the contact force the proxy stays fixed while the spring force is at most the contact force.
//! Otherwise the proxy slips towards the stick until the two forces are equal. Across the contact force it
//! always slips. In free space the proxy follows the stick and there is no force. At a wall the proxy stops;
//! on a soft body it slips as far as the body yields; when the body tears, it slips at once.
//!
//! ```text
//!      stick ──/\/\/\── proxy ──▐slips at the contact force▌── ground
//!            ──[ B  ]──
//! ```
//!
//! **Why no spring to the simulated hand itself?** The simulation reports at most 60 times a second, with a
//! delay. A spring to an old hand position would become harder and softer with the frame times, and its
//! moving end could push. Here the simulation only sets the force at which the proxy slips. A spring with a
//! slider is dissipative for every such limit, even a late or noisy one, because slip is always in the
//! direction of the pull. (The set of allowed pulls, from zero to the contact force, is convex and contains
//! zero. The actual pull is the one nearest to the spring force.)
//!
//! **Damper.** Up to T ≈ 20 ms pass in driver and cable between computing a force and feeling it, plus half
//! an update. A spring with delay T acts like one with an additional damper −K T, and B = `LEAD` · K
//! compensates for that damper. K is limited to [`MAX_STIFFNESS`](crate::MAX_STIFFNESS): up to this
//! stiffness, hinge and hand dissipate more than the remaining negative damping, and the delayed damper
//! causes no oscillation of its own. `tests/hand/closed_loop.rs` lists the sticks for which this holds. A
//! stick with less damping in hinge and hand (damping × travel / full force below 8 ms) and a delay of 20 ms
//! can still oscillate a little.
//!
//! **Damping across the contact force.** The contact direction changes while the hand slides over a round
//! surface, and it arrives late. The spring can then excite sideways oscillation, which only the damper
//! dissipates.
//!
//! **The cost:** nothing pushes a hand that holds still. The player only gets back the energy put in, which
//! is a sound rule for a toy in public. In [`StickMode::Velocity`] the proxy is fixed in the middle, so there
//! approaching bodies are felt.

use crate::Settings;

/// Ratio of damping to stiffness [s]: 20 ms of driver and cable, half an update, and the lag [`SPEED`] of the
/// stick velocity.
const LEAD: f32 = 0.035;
/// Time constant of the low-pass filter for the stick velocity [s]. A larger value delays the damping force.
/// With a smaller value, players feel the steps of a coarse axis.
const SPEED: f32 = 0.008;
/// Time constant of the low-pass filter for the contact force [s]: one tick. Without the filter, players feel
/// the tick rate as a hum.
const TICK: f32 = 0.016;
/// Contact force from which the damper has its full strength; below, its strength grows linearly [full
/// forces].
const TOUCHING: f32 = 0.02;

/// Last state reported by the simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Sum of the contact forces on the simulated hand, averaged over the last tick [N]. The axes are those
    /// of the stick: x to the right, y away from the player.
    pub contact: [f32; 2],
    /// Meaning of the stick position for the simulated hand.
    pub manner: StickMode,
}

/// Meaning of the stick position for the simulated hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StickMode {
    /// The stick position sets the hand's position. In free space the proxy follows the stick.
    Position,
    /// The stick position sets the hand's velocity. The proxy stays in the middle of the stick's travel.
    Velocity,
    /// Passes the contact force on unchanged and ignores the stick position. Only for a
    /// [`Measurement`](crate::Measurement). Motors of unknown mounting may push in the wrong direction, and
    /// then a force that depends on the stick position could oscillate.
    OpenLoop,
}

/// Virtual coupling of one device: spring, damper and slipping proxy. The head of this module explains it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Coupling {
    /// Values of the last step; `None` before the first step.
    memory: Option<Memory>,
}

#[derive(Clone, Copy, Debug)]
struct Memory {
    /// Last stick position, −1 to 1 per axis.
    aim: [f32; 2],
    /// Stick position after the low-pass filter, −1 to 1 per axis.
    slow_aim: [f32; 2],
    /// Filtered contact force [full forces].
    contact: [f32; 2],
    /// Spring force on the stick [full forces].
    pull: [f32; 2],
}

impl Coupling {
    /// Resets the coupling: the next step starts with the proxy at the stick.
    pub fn rest(&mut self) {
        self.memory = None;
    }

    /// Returns the force on the stick [N] for the stick position `aim`: x to the right, y away from the
    /// player, each −1 to 1. `duration` is the time since the last step [s].
    pub fn step(
        &mut self,
        state: &State,
        aim: [f32; 2],
        settings: &Settings,
        duration: f32,
    ) -> [f32; 2] {
        let memory = self.memory.get_or_insert(Memory {
            aim,
            slow_aim: aim,
            contact: [0.0; 2],
            pull: [0.0; 2],
        });
        let contact = state.contact.map(|k| k / settings.full);
        approach(&mut memory.contact, contact, duration / (TICK + duration));
        let bears = length(memory.contact);
        let along = memory.contact.map(|k| k / bears.max(f32::MIN_POSITIVE));

        let spring = settings.stiffness;
        let moved = [0, 1].map(|axis| aim[axis] - memory.aim[axis]);
        memory.aim = aim;
        let pull = match state.manner {
            StickMode::Position => dot(memory.pull, along) - spring * dot(moved, along),
            StickMode::Velocity => -spring * dot(aim, along),
            StickMode::OpenLoop => return state.contact,
        };
        let pull = pull.clamp(0.0, bears);
        memory.pull = along.map(|k| k * pull);

        let late = [0, 1].map(|axis| aim[axis] - memory.slow_aim[axis]);
        let share = duration / (SPEED + duration);
        approach(&mut memory.slow_aim, aim, share);
        let damper = spring * LEAD * (bears / TOUCHING).min(1.0);
        let drag = late.map(|k| damper * k / (SPEED + duration));
        // A contact can only push. If damper and spring together would pull along the contact force, removes
        // that part.
        let back = (dot(drag, along) - pull).max(0.0);
        [0, 1].map(|axis| (memory.pull[axis] - drag[axis] + back * along[axis]) * settings.full)
    }
}

/// Feedback of a tear: reduces the force for a moment, in addition to the drop of the contact force. The
/// feedback never increases a force, so it cannot push the player.
#[derive(Clone, Copy, Debug, Default)]
pub struct TearFeedback(f32);

impl TearFeedback {
    /// Time over which the feedback of the largest tear fades out [s].
    pub const TIME: f32 = 0.06;
    /// Fraction by which the largest tear reduces the force.
    const DEPTH: f32 = 0.7;

    /// Reports a tear with a size from 0 to 1; 1 causes the strongest feedback.
    pub fn tear(&mut self, size: f32) {
        self.0 = self.0.max(size.clamp(0.0, 1.0));
    }

    /// Returns `force`, reduced by the feedback. `duration` is the time since the last step [s].
    pub fn step(&mut self, force: [f32; 2], duration: f32) -> [f32; 2] {
        self.0 = (self.0 - duration / Self::TIME).max(0.0);
        force.map(|k| k * (1.0 - Self::DEPTH * self.0))
    }

    /// Returns the remaining strength of the tear feedback, 0 to 1.
    pub fn left(&self) -> f32 {
        self.0
    }
}

fn approach(from: &mut [f32; 2], to: [f32; 2], share: f32) {
    for (from, to) in from.iter_mut().zip(to) {
        *from += (to - *from) * share;
    }
}

fn dot(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

fn length(of: [f32; 2]) -> f32 {
    of[0].hypot(of[1])
}

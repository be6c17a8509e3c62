//! The virtual coupling [Colgate 1995] between a stick and the simulation's hand, evaluated at the rate of the device.
//!
//! A spring and a damper lead from where the stick points *now* to a **proxy**, F = K (proxy − stick) + B Δv. The proxy
//! stays where it is while the simulation's hand is pushed at least as strongly as the spring would pull, and else slips
//! after the stick until the spring pulls no more than that; across the push it always slips. In free space it is where
//! the stick is, and nothing is felt; at a wall it stops; a soft body lets it slip as far as it gives way; when that
//! tears, it slips at once.
//!
//! ```text
//!      stick ──/\/\/\── proxy ──▐slips at the contact force▌── ground
//!            ──[ B  ]──
//! ```
//!
//! **Why not a spring to the hand itself?** The simulation speaks 60 times a second at best, and late. A spring to where
//! the hand was then is hard or loose as frames come and go, and its far end, moving late, can push. Here the simulation
//! only says how much the slider bears, and a spring on a slider takes out energy whatever that is, however late or rough
//! it comes: slipping is always in the direction of the pull. (The set of pulls that it bears, from none to the contact
//! force, is convex and holds zero; the pull is the nearest to what the spring wants.)
//!
//! **Why the damper.** From a push to its being felt pass up to T ≈ 20 ms of driver and wire, and half an update. A
//! spring that answers T late has a damper of −K T in it. B = `LEAD` · K makes up for that, and K ends at [`HARDEST`](crate::HARDEST),
//! where what is left is less than what hinge and hand take out, and where a damper that answers late does not yet swing
//! by itself. `tests/hand/closed_loop.rs` has the sticks that this is good for; one that takes out less than they do by
//! hinge and hand (damping × travel / full force below 8 ms) and answers 20 ms late can still swing a little.
//!
//! **Why it drags across the push too.** The direction of a contact turns as the hand slides over what is round, and comes
//! late. Nothing else would take out the swing to the sides that this can feed from the spring.
//!
//! **What is given up for it:** nothing pushes a hand that holds still. It only ever gets back what it put in, which for
//! a toy in public is not the worst of rules. A stick that steers has its proxy in the middle, and does feel what comes.

use crate::Settings;

/// The damper of the coupling over its spring [s]; about what lies between a push and its being felt.
const LEAD: f32 = 0.03;
/// Over this time the speed of the stick is taken [s]. Longer lags, shorter feels the steps of a coarse axis.
const SPEED: f32 = 0.008;
/// Over this time the contact force is smoothed [s]: one tick, which would else be felt as a hum.
const TICK: f32 = 0.016;
/// From this contact force on the damper is there in full [full forces].
const TOUCHING: f32 = 0.02;

/// What the simulation said last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// With what everything that the hand touches pushes it, averaged over the last tick [N]. x to the right, y away from
    /// the player, like the stick.
    pub contact: [f32; 2],
    /// What the stick means to the hand.
    pub manner: Manner,
}

/// What it means that a stick leans.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// It points at a place.
    CellIndexing,
    /// It says how fast to go. Its proxy never leaves the middle.
    Steers,
    /// Nothing: it is pushed, whatever it does. For a [`Measurement`](crate::Measurement), and for nothing that depends on
    /// where the stick is, since that could swing.
    Yields,
}

/// A spring, a damper and a slider.
#[derive(Clone, Copy, Debug, Default)]
pub struct Coupling {
    /// None at the start.
    memory: Option<Memory>,
}

#[derive(Clone, Copy, Debug)]
struct Memory {
    /// Where the stick pointed, and the same smoothed.
    aim: [f32; 2],
    slow_aim: [f32; 2],
    /// The smoothed contact force [full forces].
    contact: [f32; 2],
    /// How the spring pulls the stick [full forces].
    pull: [f32; 2],
}

impl Coupling {
    /// Forgets what was.
    pub fn rest(&mut self) {
        self.memory = None;
    }

    /// What the stick is to be pushed with [N], `duration` [s] after the last step, while it leans to `aim`: x to the
    /// right, y away from the player, each -1 to 1.
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
            Manner::CellIndexing => dot(memory.pull, along) - spring * dot(moved, along),
            Manner::Steers => -spring * dot(aim, along),
            Manner::Yields => return state.contact,
        };
        let pull = pull.clamp(0.0, bears);
        memory.pull = along.map(|k| k * pull);

        let late = [0, 1].map(|axis| aim[axis] - memory.slow_aim[axis]);
        let share = duration / (SPEED + duration);
        approach(&mut memory.slow_aim, aim, share);
        let damper = spring * LEAD * (bears / TOUCHING).min(1.0);
        let drag = late.map(|k| damper * k / (SPEED + duration));
        // What touches pushes, and never pulls.
        let back = (dot(drag, along) - pull).max(0.0);
        [0, 1].map(|axis| (memory.pull[axis] - drag[axis] + back * along[axis]) * settings.full)
    }
}

/// How a tear is felt, beside what it does to the contact force: what was pushed against gives way for a moment. It takes
/// from a force and never adds to one, so it cannot push anybody.
#[derive(Clone, Copy, Debug, Default)]
pub struct Give(f32);

impl Give {
    /// How long a tear is felt [s].
    pub const TIME: f32 = 0.06;
    /// What the largest tear takes of a force.
    const DEPTH: f32 = 0.7;

    /// Something tore; 1 is as large as a tear gets.
    pub fn tear(&mut self, size: f32) {
        self.0 = self.0.max(size.clamp(0.0, 1.0));
    }

    /// The force that is left after `duration` [s] more.
    pub fn step(&mut self, force: [f32; 2], duration: f32) -> [f32; 2] {
        self.0 = (self.0 - duration / Self::TIME).max(0.0);
        force.map(|k| k * (1.0 - Self::DEPTH * self.0))
    }

    /// How much of the tear is left, 0 to 1.
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

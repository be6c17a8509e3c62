//! The spring between where the stick points and where the simulation's hand is: the virtual coupling of
//! [Colgate 1995], evaluated at the rate of the device.
//!
//! **Why it is stable.** From a push to what is felt of it pass up to T ≈ 20 ms of driver and wire, and half an update. A
//! spring that answers T late is a spring with a damper of −K T. So the coupling has a damper of its own, `LEAD` · K with
//! `LEAD` ≈ T, and K ends at [`HARDEST`]: what is left of −K T then is less than what the hinges of a stick take out, and
//! a damper that answers late does not yet swing by itself. Where the simulation's hand is comes late too, but that helps:
//! a spring whose far end follows late drags. So places are smoothed and never guessed ahead. The velocity of that hand
//! is not asked for: an old place only holds, an old velocity would go on pushing.

use crate::Settings;

/// The stiffest that a coupling may be [full forces / way of the stick from its middle to its rim]. `tests/closed_loop.rs`
/// has the sticks that this is good for.
pub const HARDEST: f32 = 1.0;
/// The damper of the coupling over its spring [s]. About as long as what lies between a push and its being felt.
const LEAD: f32 = 0.02;
/// Over this time the speed of the stick is taken [s]. Longer lags, shorter feels the steps of a coarse axis.
const SPEED: f32 = 0.008;
/// Over this time the places of the simulation's hand are smoothed [s]: one tick, which would else be heard as a hum.
const PLACES: f32 = 0.016;
/// Over this time a touch is felt or lost [s].
const TOUCH: f32 = 0.02;
/// From this contact force on the hand touches something for good [full forces].
const TOUCHING: f32 = 0.02;

/// What the simulation said last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Where the hand is [m].
    pub hand: [f32; 2],
    /// With what everything that it touches pushes it, averaged over the last tick [N]. Nothing is felt while this is 0.
    pub contact: [f32; 2],
    /// What the stick means to it.
    pub manner: Manner,
}

/// What it means that a stick leans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Manner {
    /// It points at a place.
    Places {
        /// Where it points while it is upright [m].
        middle: [f32; 2],
        /// How far from there it points while it leans all the way along x and y [m].
        reach: [f32; 2],
    },
    /// It says how fast to go. Leaning towards what resists is resisted as much.
    Steers,
}

/// A spring and a damper between stick and hand.
#[derive(Clone, Copy, Debug, Default)]
pub struct Coupling {
    memory: Option<Memory>,
}

/// Everything smoothed.
#[derive(Clone, Copy, Debug)]
struct Memory {
    hand: [f32; 2],
    contact: [f32; 2],
    /// How much it touches, 0 to 1.
    touch: f32,
    stretch: [f32; 2],
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
        let strength = length(state.contact) / settings.full;
        let memory = self.memory.get_or_insert(Memory {
            hand: state.hand,
            contact: state.contact,
            touch: 0.0,
            stretch: [f32::NAN; 2],
        });
        let share = |time: f32| duration / (time + duration);
        let full = match state.manner {
            Manner::Places { .. } => TOUCHING,
            Manner::Steers => 1.0,
        };
        approach(&mut memory.hand, state.hand, share(PLACES));
        approach(&mut memory.contact, state.contact, share(TOUCH));
        memory.touch += ((strength / full).min(1.0) - memory.touch) * share(TOUCH);
        let (stretch, reach) = memory.stretch(&state.manner, aim);
        if memory.stretch[0].is_nan() {
            memory.stretch = stretch;
        }
        let before = memory.stretch;
        approach(&mut memory.stretch, stretch, share(SPEED));
        [0, 1].map(|axis| {
            let hardest = HARDEST * settings.full / reach[axis].abs().max(f32::MIN_POSITIVE);
            let stiffness = memory.touch * settings.stiffness.min(hardest);
            let speed = (stretch[axis] - before[axis]) / (SPEED + duration);
            stiffness * (stretch[axis] + LEAD * speed)
        })
    }
}

impl Memory {
    /// From where the stick points to where the hand is, and how long the way of the stick is on each axis [m].
    fn stretch(&self, manner: &Manner, aim: [f32; 2]) -> ([f32; 2], [f32; 2]) {
        match manner {
            Manner::Places { middle, reach } => {
                let stretch =
                    [0, 1].map(|axis| self.hand[axis] - middle[axis] - reach[axis] * aim[axis]);
                (stretch, *reach)
            }
            Manner::Steers => {
                let along = self.contact.map(|k| k / length(self.contact).max(1e-9));
                let lean = (-aim[0] * along[0] - aim[1] * along[1]).max(0.0);
                (along.map(|k| k * lean), [1.0; 2])
            }
        }
    }
}

/// How a tear is felt: what was pushed against gives way for a moment. It takes from a force and never adds to one, so
/// it cannot push anybody.
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

fn length(of: [f32; 2]) -> f32 {
    of[0].hypot(of[1])
}

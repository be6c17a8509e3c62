//! One contact: what it may do to the velocities of its two sides.

use crate::dim::{Dim, inner};
use crate::solve::Row;
use crate::touch::Impulse;
use crate::vector::{minus, plus, scaled};

/// How much of the last substep's impulse a row starts from: 1 is unstable, 0 never comes to rest. With 0.8 and 0.95 the scene
/// `pile` sleeps after 5.9 and 8.2 s in place of 4.9, with 0.5 and 1 not within 10, and towers of ten boxes lean in all of them.
const WARM_START: f32 = 0.9;
/// How much of an overlap is pushed out in a substep, and how fast at most [m/s] [Catto 2023]. More throws apart what
/// was forced together; less lets heaps sink into each other. Half of the share lets stacks lean twice as far, twice as much
/// lets towers of ten boxes lean by a fifth of a box; twice the speed throws dust that began inside a body out at 1.7 m/s.
const PUSH_OUT: f32 = 0.2;
pub const PUSH_OUT_SPEED: f32 = 0.5;

/// A contact matters when the gap closes to so many voxels within so many substeps: one, and half of another, for
/// other contacts may make it close faster. Half and twice the voxels stack, heap and squeeze alike.
pub const CLOSE: f32 = 0.05;
pub const AHEAD: f32 = 1.5;

/// One contact in one substep.
#[derive(Copy, Clone, Debug)]
pub struct Contact {
    pub normal: Row,
    /// [m]
    pub gap: f32,
    /// The approach along the normal may not be less than this [m/s].
    pub least: f32,
    /// One over the speed that a unit of impulse gives [kg].
    pub inertia: f32,
    pub friction: f32,
    pub pressed: f32,
    pub dragged: Row,
    /// Place of its pair in the list.
    pub pair: u32,
}

impl Contact {
    #[inline(always)]
    pub fn new(normal: Row, gap: f32, duration: f32, inertia: f32, friction: f32) -> Self {
        let least = if gap > 0.0 {
            -gap / duration
        } else {
            (-PUSH_OUT * gap / duration).min(PUSH_OUT_SPEED)
        };
        Self {
            normal,
            gap,
            least,
            inertia,
            friction,
            pressed: 0.0,
            dragged: [0.0; 4],
            pair: 0,
        }
    }

    /// The same, starting from what passed between the two sides so far.
    #[inline(always)]
    pub fn known_as<D: Dim>(mut self, pair: usize, impulse: &Impulse) -> Self {
        self.pair = pair as u32;
        if impulse.pressed > 0.0 {
            self.pressed = WARM_START * impulse.pressed;
            let along = inner::<D>(impulse.dragged, self.normal);
            let dragged = minus(impulse.dragged, scaled(self.normal, along));
            self.dragged = scaled(dragged, WARM_START);
        }
        self
    }

    /// Whether it neither presses nor has to, at this motion: most that are merely close do not.
    #[inline(always)]
    pub fn is_idle<D: Dim>(&self, relative: Row) -> bool {
        self.pressed == 0.0 && inner::<D>(relative, self.normal) >= self.least
    }

    /// What it starts from.
    pub fn start(&self) -> Row {
        plus(scaled(self.normal, self.pressed), self.dragged)
    }

    /// The change of impulse on the first side [N s], which moves at `relative` [m/s] as seen from
    /// the second.
    #[inline(always)]
    pub fn solve<D: Dim>(&mut self, relative: Row) -> Row {
        self.solve_across::<D>(relative, self.inertia)
    }

    /// The same for sides that turn: across the normal they yield otherwise, `across` [kg].
    #[inline(always)]
    pub fn solve_across<D: Dim>(&mut self, relative: Row, across: f32) -> Row {
        let approach = inner::<D>(relative, self.normal);
        let pressed = (self.pressed + (self.least - approach) * self.inertia).max(0.0);
        let slip = minus(relative, scaled(self.normal, approach));
        let mut dragged = minus(self.dragged, scaled(slip, across));
        let (held, wanted) = (self.friction * pressed, inner::<D>(dragged, dragged));
        if wanted > held * held {
            dragged = scaled(dragged, held / wanted.sqrt());
        }
        let press = scaled(self.normal, pressed - self.pressed);
        let change = plus(press, minus(dragged, self.dragged));
        self.pressed = pressed;
        self.dragged = dragged;
        change
    }

    /// As [`Contact::solve`], along the normal only, and without the push out of an overlap.
    #[inline(always)]
    pub fn relax<D: Dim>(&mut self, relative: Row) -> Row {
        let approach = inner::<D>(relative, self.normal);
        let pressed = (self.pressed - approach * self.inertia).max(0.0);
        let change = scaled(self.normal, pressed - self.pressed);
        self.pressed = pressed;
        change
    }

    pub fn was_pushed_out(&self) -> bool {
        self.gap < 0.0 && self.pressed > 0.0
    }
}

impl Impulse {
    /// They do not touch any more.
    #[inline(always)]
    pub fn release(&mut self) {
        // Most never did; what does not press does not drag.
        if self.pressed > 0.0 {
            (self.pressed, self.dragged) = (0.0, [0.0; 4]);
        }
    }

    pub fn note(&mut self, contact: &Contact) {
        self.pressed = contact.pressed;
        self.dragged = contact.dragged;
        self.total += contact.pressed;
    }
}

/// Whether a contact may matter in this substep: it overlaps, or will if nothing is done. What is not
/// finite touches nothing, so that it spoils nothing else.
pub fn is_close(gap: f32, approach: f32, size: f32, duration: f32) -> bool {
    approach.is_finite() && gap + AHEAD * duration * approach.min(0.0) < CLOSE * size
}

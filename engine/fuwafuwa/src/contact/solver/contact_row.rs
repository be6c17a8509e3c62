//! A contact as a solver row.

use crate::contact::broad_phase::Impulse;
use crate::foundation::dim::{Dim, inner};
use crate::soft_body::element_forces::Row;

/// Warm-starting factor, applied to the impulses of the last substep. A factor of 1 is unstable; with 0,
/// heaps never settle.
const WARM_START: f32 = 0.9;
/// Share of an overlap that is resolved per substep [Catto 2023]. A larger value throws overlapping bodies
/// apart; a smaller one lets heaps sink into each other.
const PUSH_OUT: f32 = 0.2;
/// Maximum speed at which an overlap is resolved [m/s].
pub const PUSH_OUT_SPEED: f32 = 0.5;

/// Gap below which a contact is active [voxels], now or within `AHEAD` substeps at the present speed.
pub const CLOSE: f32 = 0.05;
/// Number of substeps for which the gap is extrapolated to decide whether a contact is active. The extra half
/// substep allows for other contacts that make the gap close faster.
pub const AHEAD: f32 = 1.5;

/// Contact in one substep.
#[derive(Copy, Clone, Debug)]
pub struct Contact {
    /// Unit normal from the second side to the first.
    pub normal: Row,
    /// Distance of the two sides along the normal [m], negative if they overlap.
    pub gap: f32,
    /// Lower limit of the relative velocity along the normal, which the solver enforces [m/s]. A negative
    /// value allows an approach.
    pub min_normal_velocity: f32,
    /// Effective mass along the normal [kg].
    pub effective_mass: f32,
    /// Effective mass for friction [kg]: at most that of any tangent direction. It differs from
    /// `effective_mass` for sides that turn.
    pub tangent_mass: f32,
    /// Coulomb friction coefficient.
    pub friction: f32,
    /// Accumulated impulse along the normal in this substep [N s], at least 0.
    pub normal_impulse: f32,
    /// Accumulated friction impulse on the first side in this substep [N s].
    pub friction_impulse: Row,
    /// Index of the contact's pair in the list of the broad phase, `NodePairs::list` or `SpherePairs::list`.
    pub pair: u32,
}

impl Contact {
    #[inline(always)]
    pub fn new(normal: Row, gap: f32, duration: f32, effective_mass: f32, friction: f32) -> Self {
        let least = if gap > 0.0 {
            -gap / duration
        } else {
            (-PUSH_OUT * gap / duration).min(PUSH_OUT_SPEED)
        };
        Self {
            normal,
            gap,
            min_normal_velocity: least,
            effective_mass,
            tangent_mass: effective_mass,
            friction,
            normal_impulse: 0.0,
            friction_impulse: Row::ZERO,
            pair: 0,
        }
    }

    /// Returns the contact with the index of its pair in the broad phase and with a warm start from the
    /// impulse of that pair.
    #[inline(always)]
    pub fn with_warm_start<D: Dim>(mut self, pair: usize, impulse: &Impulse) -> Self {
        self.pair = pair as u32;
        if impulse.normal_impulse > 0.0 {
            self.normal_impulse = WARM_START * impulse.normal_impulse;
            let along = inner::<D>(impulse.friction_impulse, self.normal);
            let friction_impulse = impulse.friction_impulse - self.normal * along;
            self.friction_impulse = friction_impulse * WARM_START;
        }
        self
    }

    /// Returns the contact with an own effective mass for friction [kg].
    #[inline(always)]
    pub fn with_tangent_mass(self, tangent_mass: f32) -> Self {
        Self {
            tangent_mass,
            ..self
        }
    }

    /// Returns whether the contact can be skipped in this iteration: it has no normal impulse and requires
    /// none at this relative velocity. This is true for most contacts that do not touch yet.
    #[inline(always)]
    pub fn is_idle<D: Dim>(&self, relative: Row) -> bool {
        self.normal_impulse == 0.0 && inner::<D>(relative, self.normal) >= self.min_normal_velocity
    }

    /// Returns the warm-start impulse [N s].
    pub fn start(&self) -> Row {
        self.normal * self.normal_impulse + self.friction_impulse
    }

    /// Returns the change of impulse on the first side [N s], given its velocity relative to the second side
    /// [m/s].
    #[inline(always)]
    pub fn solve<D: Dim>(&mut self, relative: Row) -> Row {
        let approach = inner::<D>(relative, self.normal);
        let normal_impulse = (self.normal_impulse
            + (self.min_normal_velocity - approach) * self.effective_mass)
            .max(0.0);
        let slip = relative - self.normal * approach;
        let mut friction_impulse = self.friction_impulse - slip * self.tangent_mass;
        let (held, wanted) = (
            self.friction * normal_impulse,
            inner::<D>(friction_impulse, friction_impulse),
        );
        if wanted > held * held {
            friction_impulse *= held / wanted.sqrt();
        }
        let change_along = self.normal * (normal_impulse - self.normal_impulse);
        let change = change_along + (friction_impulse - self.friction_impulse);
        self.normal_impulse = normal_impulse;
        self.friction_impulse = friction_impulse;
        change
    }

    /// Like [`Contact::solve`], but brings the relative velocity along the normal to 0. Friction is limited by
    /// the remaining normal impulse: the part that resolved an overlap must not brake.
    #[inline(always)]
    pub fn relax<D: Dim>(&mut self, relative: Row) -> Row {
        let approach = inner::<D>(relative, self.normal);
        let normal_impulse = (self.normal_impulse - approach * self.effective_mass).max(0.0);
        let mut change = self.normal * (normal_impulse - self.normal_impulse);
        self.normal_impulse = normal_impulse;
        let held = self.friction * normal_impulse;
        let friction = inner::<D>(self.friction_impulse, self.friction_impulse);
        if friction > held * held {
            let kept = self.friction_impulse * (held / friction.sqrt());
            change += kept - self.friction_impulse;
            self.friction_impulse = kept;
        }
        change
    }

    pub fn was_pushed_out(&self) -> bool {
        self.gap < 0.0 && self.normal_impulse > 0.0
    }
}

impl Impulse {
    /// Clears the impulses after the two sides have separated.
    #[inline(always)]
    pub fn clear(&mut self) {
        // Writes only if there is an impulse to clear: most pairs never touched. Without a normal impulse
        // there is no friction impulse.
        if self.normal_impulse > 0.0 {
            (self.normal_impulse, self.friction_impulse) = (0.0, Row::ZERO);
        }
    }

    pub fn store(&mut self, contact: &Contact) {
        self.normal_impulse = contact.normal_impulse;
        // A snapshot restores 0 where friction without a normal impulse is −0.
        self.friction_impulse = contact.friction_impulse + Row::ZERO;
        self.total += contact.normal_impulse;
    }
}

/// Returns whether a contact is active in this substep: its gap is below `CLOSE` times `size` [m], or may
/// become so within `AHEAD` substeps. A contact with a non-finite approach speed is inactive, so that the
/// value cannot spread.
pub fn is_close(gap: f32, approach: f32, size: f32, duration: f32) -> bool {
    approach.is_finite() && gap + AHEAD * duration * approach.min(0.0) < CLOSE * size
}

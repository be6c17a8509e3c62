//! Impulses of pins, springs and ropes.

use super::JointKind;
use super::JointState;
use super::attached_anchor::AnchorState;
use super::joint_end::Woken;
use crate::contact::rest_speeds::RestSpeeds;
use crate::foundation::dim::Dim;
use crate::rigid_body::RigidBodies;
use crate::soft_body::SoftBodies;
use glam::Vec3;

/// Warm-starting factor of pins and springs, equal to that of contacts. With other values, a heavy body at
/// the end of a chain of pins swings more.
const WARM_START: f32 = 0.9;
/// Share of the position error of pins and ropes that is corrected per substep, equal to the share of an
/// overlap that contacts resolve. Twice this value is unstable.
const CORRECTION_SHARE: f32 = 0.2;
/// Maximum speed at which a position error is corrected [m/s].
const MAX_CORRECTION_SPEED: f32 = 2.0;
/// Length by which a pin or rope must be stretched to wake a sleeper [m]. Smaller stretches are not visible.
const WAKE_STRETCH: f32 = 0.002;
/// Relative change of a spring's force that wakes a sleeper. The force must change by this share plus the
/// stiffness times [`WAKE_STRETCH`].
const WAKE_SHARE: f32 = 0.02;

impl JointState {
    /// Begins a substep: adds the sleepers to wake to `woken`, and applies the warm-start impulse. Returns
    /// false if an anchor no longer exists.
    pub(super) fn start<D: Dim>(
        &mut self,
        bodies: &mut SoftBodies<D>,
        rigids: &mut RigidBodies,
        rest: RestSpeeds,
        woken: &mut Woken,
    ) -> bool {
        let [Some(first), Some(second)] = self.anchor_states(bodies, rigids) else {
            return false;
        };
        let waking = rest.wake_speed(WAKE_STRETCH);
        let is_strained = self.is_strained((first.at - second.at).length());
        for (own, other, anchor) in [(first, second, 0), (second, first, 1)] {
            if own.is_asleep && (is_strained || other.velocity.length() > waking) {
                self.attached[anchor].wake(bodies, woken);
            }
        }
        self.impulse = match self.kind {
            JointKind::Pin => self.impulse * WARM_START,
            JointKind::Spring { .. } => direction(first.at - second.at)
                .map_or(Vec3::ZERO, |(_, way)| {
                    way * (WARM_START * self.impulse.dot(way))
                }),
            JointKind::Rope { .. } => Vec3::ZERO,
        };
        self.apply_impulse(bodies, rigids, self.impulse);
        true
    }

    /// Returns whether the joint must wake sleeping bodies if the distance of its anchors is `distance` [m].
    fn is_strained(&self, distance: f32) -> bool {
        match self.kind {
            JointKind::Pin => distance > WAKE_STRETCH,
            JointKind::Rope { length } => distance > length + WAKE_STRETCH,
            JointKind::Spring {
                stiffness, length, ..
            } => {
                let pull = stiffness * (distance - length).abs();
                let force = self.force();
                (pull - force).abs() > WAKE_SHARE * force + stiffness * WAKE_STRETCH
            }
        }
    }

    /// Applies one solver iteration; corrects position errors, too, if `corrects` is true.
    pub(super) fn solve<D: Dim>(
        &mut self,
        bodies: &mut SoftBodies<D>,
        rigids: &mut RigidBodies,
        duration: f32,
        corrects: bool,
    ) {
        let [Some(first), Some(second)] = self.anchor_states(bodies, rigids) else {
            return;
        };
        let apart = first.at - second.at;
        let relative = first.velocity - second.velocity;
        let inverse_mass =
            [0, 1, 2].map(|row: usize| first.inverse_mass[row] + second.inverse_mass[row]);
        let impulse = match self.kind {
            JointKind::Pin => {
                let correction = if corrects {
                    correction_velocity(apart, duration)
                } else {
                    Vec3::ZERO
                };
                impulse_for::<D>(&inverse_mass, -(relative + correction))
            }
            // If `corrects` is false, this pass removes the velocity of position corrections. Springs make no
            // position corrections.
            JointKind::Spring { .. } if !corrects => Vec3::ZERO,
            JointKind::Spring {
                stiffness,
                damping,
                length: rest,
            } => {
                let spring = [stiffness, damping, rest];
                self.spring(apart, relative, &inverse_mass, spring, duration)
            }
            JointKind::Rope { length } => {
                self.rope(apart, relative, &inverse_mass, length, duration, corrects)
            }
        };
        if impulse.is_finite() {
            self.impulse += impulse;
            self.apply_impulse(bodies, rigids, impulse);
        }
    }

    /// Returns the change of the impulse of an implicit spring in one iteration [Catto 2011].
    ///
    /// The accumulated impulse is λ = −(k x + k h v' + c v') h, with the stiffness k, the damping c, the
    /// elongation x, the substep h, and the relative velocity v' after the substep. With the softness γ =
    /// 1/(h (c + h k)) this reads v' + h k γ x + γ λ = 0. An iteration solves this equation for the change of
    /// λ. Without the term γ λ, every iteration would add the whole impulse again.
    fn spring(
        &self,
        apart: Vec3,
        relative: Vec3,
        inverse_mass: &[Vec3; 3],
        [stiffness, damping, rest]: [f32; 3],
        duration: f32,
    ) -> Vec3 {
        let Some((distance, way)) = direction(apart) else {
            return Vec3::ZERO;
        };
        let softness = 1.0 / (duration * (damping + duration * stiffness));
        let push = (distance - rest) * duration * stiffness * softness;
        let accumulated = softness * self.impulse.dot(way);
        let under = inverse_mass_along(inverse_mass, way) + softness;
        way * (-(relative.dot(way) + push + accumulated) / under)
    }

    /// Returns the change of the impulse of a rope in one iteration. A rope pulls and never pushes.
    fn rope(
        &self,
        apart: Vec3,
        relative: Vec3,
        inverse_mass: &[Vec3; 3],
        length: f32,
        duration: f32,
        corrects: bool,
    ) -> Vec3 {
        let Some((distance, way)) = direction(apart) else {
            return Vec3::ZERO;
        };
        let along_rope = inverse_mass_along(inverse_mass, way);
        if along_rope <= 0.0 || !corrects && distance < length {
            return Vec3::ZERO;
        }
        let beyond = distance - length;
        let wanted = match (corrects, beyond > 0.0) {
            (false, _) => 0.0,
            (true, true) => -(CORRECTION_SHARE * beyond / duration).min(MAX_CORRECTION_SPEED),
            (true, false) => -beyond / duration,
        };
        let accumulated = self.impulse.dot(way);
        let change = (wanted - relative.dot(way)) / along_rope;
        way * ((accumulated + change).min(0.0) - accumulated)
    }

    /// Returns whether at least one of the two anchors can move.
    pub(super) fn can_move<D: Dim>(&self, bodies: &SoftBodies<D>, rigids: &RigidBodies) -> bool {
        let anchors = self.anchor_states(bodies, rigids).into_iter().flatten();
        let mut rows = anchors.flat_map(|anchor| anchor.inverse_mass);
        rows.any(|row| row != Vec3::ZERO)
    }

    fn anchor_states<D: Dim>(
        &self,
        bodies: &SoftBodies<D>,
        rigids: &RigidBodies,
    ) -> [Option<AnchorState>; 2] {
        self.attached
            .each_ref()
            .map(|anchor| anchor.state(bodies, rigids))
    }

    fn apply_impulse<D: Dim>(
        &self,
        bodies: &mut SoftBodies<D>,
        rigids: &mut RigidBodies,
        impulse: Vec3,
    ) {
        self.attached[0].apply_impulse(bodies, rigids, impulse);
        self.attached[1].apply_impulse(bodies, rigids, -impulse);
    }
}

/// Returns the velocity at which a pin corrects the position error `apart` [m/s].
fn correction_velocity(apart: Vec3, duration: f32) -> Vec3 {
    let correction = apart * (CORRECTION_SHARE / duration);
    let speed = correction.length();
    match speed > MAX_CORRECTION_SPEED {
        true => correction * (MAX_CORRECTION_SPEED / speed),
        false => correction,
    }
}

/// Returns the length and direction of a vector; `None` for a zero vector.
fn direction(apart: Vec3) -> Option<(f32, Vec3)> {
    let distance = apart.length();
    (distance > 1e-6).then(|| (distance, apart * (1.0 / distance)))
}

/// Returns the inverse effective mass along a unit direction [1/kg].
fn inverse_mass_along(inverse_mass: &[Vec3; 3], way: Vec3) -> f32 {
    way.dot(inverse_mass.map(|row| row.dot(way)).into())
}

/// Returns the impulse [N s] that changes the relative velocity of the anchors by `velocity` [m/s]; 0 if
/// neither anchor can move.
fn impulse_for<D: Dim>(inverse_mass: &[Vec3; 3], velocity: Vec3) -> Vec3 {
    let [x, y, mut z] = *inverse_mass;
    // In 2D the third row of the matrix is 0; a unit row makes the matrix invertible.
    if D::N == 2 {
        z = Vec3::Z;
    }
    let under = x.dot(y.cross(z));
    if under <= 0.0 {
        return Vec3::ZERO;
    }
    // Columns of the inverse matrix, times the determinant `under`.
    let columns = [y.cross(z), z.cross(x), x.cross(y)];
    let sum = (0..D::N).fold(Vec3::ZERO, |sum, axis| sum + columns[axis] * velocity[axis]);
    sum * (1.0 / under)
}

//! Callbacks during a tick.

use crate::error::Error;
use crate::foundation::arena::RigidBodyHandle;
use crate::rigid_body::shape::Vector;
use crate::rigid_body::{Reaction, RigidBodies};

/// Callbacks during a tick; none by default. See [`World::step_with`](crate::World::step_with).
#[derive(Default)]
pub struct Hooks<'a> {
    /// External acceleration field, added to gravity: acceleration [m/s²] at a world-space position [m]. It
    /// acts on everything that is awake. Non-finite values are ignored.
    pub field: Option<&'a dyn Fn(Vector) -> Vector>,
    /// Called at the end of each substep.
    pub after_substep: Option<&'a mut dyn FnMut(&Substep<'_>)>,
}

/// State of the world after a substep.
pub struct Substep<'a> {
    /// Index of the substep within the tick, from 0.
    pub number: u32,
    /// Length of the substep [s].
    pub duration: f32,
    rigids: &'a RigidBodies,
}

impl<'a> Substep<'a> {
    pub(super) fn new(number: u32, duration: f32, rigids: &'a RigidBodies) -> Self {
        Self {
            number,
            duration,
            rigids,
        }
    }

    /// Returns the force and torque on a rigid body in this substep, for force feedback at the substep rate.
    /// Zero for fixed rigid bodies.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn reaction(&self, hand: RigidBodyHandle) -> Result<Reaction, Error> {
        let hand = self.rigids.get(hand)?;
        Ok(hand.reactions().last().copied().unwrap_or_default())
    }

    /// Returns the position of a rigid body [m].
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn position(&self, hand: RigidBodyHandle) -> Result<Vector, Error> {
        Ok(self.rigids.get(hand)?.position())
    }
}

/// Returns a radial field around `centre` [m], for [`Hooks::field`]. It attracts with `strength` [m/s²] up to
/// the distance `reach` [m], and falls with the square of the distance beyond. A negative strength repels.
/// Within a hundredth of the reach the field fades to 0. A reach that is not positive and finite gives a zero
/// field.
///
/// ```
/// use fuwafuwa::field_around;
///
/// let planet = field_around([0.0; 3], 9.81, 2.0);
/// assert_eq!(planet([4.0, 0.0, 0.0]), [-9.81 / 4.0, 0.0, 0.0]);
/// assert_eq!(planet([0.0; 3]), [0.0; 3]);
/// ```
pub fn field_around(centre: Vector, strength: f32, reach: f32) -> impl Fn(Vector) -> Vector {
    move |at| {
        let apart = centre - at;
        let distance = apart.length();
        let far = reach / distance.max(reach);
        let near = (100.0 * distance / reach).min(1.0);
        let share = match distance > 0.0 && reach > 0.0 && reach.is_finite() {
            true => strength * far * far * near / distance,
            false => 0.0,
        };
        apart * share
    }
}

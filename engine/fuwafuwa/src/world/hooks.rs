//! Callbacks during a tick.

use crate::error::Error;
use crate::foundation::arena::RigidBodyHandle;
use crate::foundation::dim::{Dim, DimVector};
use crate::rigid_body::{Reaction, RigidBodies};
use std::marker::PhantomData;

/// Callbacks during a tick; none by default. See [`World::step_with`](crate::World::step_with). With the feature
/// `parallel`, several threads may call `field` at the same time and in any order, so it must depend on the position
/// only. One thread at a time calls `after_substep`.
pub struct Hooks<'a, D: Dim> {
    /// External acceleration field, added to gravity: acceleration [m/s²] at a world-space position [m]. It
    /// acts on soft bodies and dynamic rigid bodies that are awake. Non-finite values are ignored.
    pub field: Option<&'a (dyn Fn(D::Vector) -> D::Vector + Sync)>,
    /// Called at the end of each substep.
    pub after_substep: Option<&'a mut AfterSubstep<'a, D>>,
}

impl<D: Dim> Default for Hooks<'_, D> {
    fn default() -> Self {
        Self {
            field: None,
            after_substep: None,
        }
    }
}

/// Callback after a substep, see [`Hooks::after_substep`].
pub type AfterSubstep<'a, D> = dyn FnMut(&Substep<'_, D>) + Send + 'a;

/// State of the world after a substep.
pub struct Substep<'a, D: Dim> {
    /// Index of the substep within the tick, from 0.
    pub number: u32,
    /// Length of the substep [s].
    pub duration: f32,
    rigids: &'a RigidBodies,
    dim: PhantomData<D>,
}

impl<'a, D: Dim> Substep<'a, D> {
    pub(super) fn new(number: u32, duration: f32, rigids: &'a RigidBodies) -> Self {
        Self {
            number,
            duration,
            rigids,
            dim: PhantomData,
        }
    }

    /// Returns the force and torque on a rigid body in this substep, for force feedback at the substep rate.
    /// For a fixed rigid body, both are 0.
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn reaction(&self, body: RigidBodyHandle) -> Result<Reaction<D>, Error> {
        let last = self.rigids.get(body)?.reactions().last();
        Ok(last.map(Reaction::from).unwrap_or_default())
    }

    /// Returns the position of a rigid body [m].
    ///
    /// # Errors
    /// [`Error::InvalidHandle`] if the handle is stale.
    pub fn position(&self, body: RigidBodyHandle) -> Result<D::Vector, Error> {
        Ok(D::Vector::from_vec3(self.rigids.get(body)?.position()))
    }
}

/// Returns a radial acceleration field for [`Hooks::field`]. Up to the distance `reach` [m] from `centre` [m], it
/// accelerates towards the centre by `strength` [m/s²]; a negative strength repels. Beyond the reach, the
/// acceleration falls with the inverse square of the distance. Closer to the centre than a hundredth of the
/// reach, it fades to 0. If the reach is not positive and finite, the field is 0 everywhere.
///
/// ```
/// use fuwafuwa::{Vec2, field_around};
///
/// let planet = field_around(Vec2::ZERO, 9.81, 2.0);
/// assert_eq!(planet(Vec2::new(4.0, 0.0)), Vec2::new(-9.81 / 4.0, 0.0));
/// assert_eq!(planet(Vec2::ZERO), Vec2::ZERO);
/// ```
pub fn field_around<V: DimVector>(centre: V, strength: f32, reach: f32) -> impl Fn(V) -> V {
    move |point| {
        let apart = centre - point;
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

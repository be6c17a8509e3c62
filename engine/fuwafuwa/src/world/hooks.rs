//! What a program has to say while a tick passes.

use crate::handle::{Gone, RigidId};
use crate::rigid::{Reaction, Rigids};
use crate::shape::Vector;

/// What a program has to say while a tick passes; nothing by [`Default`]. See
/// [`World::step_with`](crate::World::step_with).
#[derive(Default)]
pub struct Hooks<'a> {
    /// What pulls on all that is awake besides gravity: an acceleration [m/s²] for each place [m]. One that is not finite
    /// pulls nothing.
    pub field: Option<&'a dyn Fn(Vector) -> Vector>,
    /// Called at the end of each substep.
    pub after_substep: Option<&'a mut dyn FnMut(&Substep<'_>)>,
}

/// A substep that has passed.
pub struct Substep<'a> {
    /// Which of the tick, from 0.
    pub number: u32,
    /// How long it was [s].
    pub duration: f32,
    rigids: &'a Rigids,
}

impl<'a> Substep<'a> {
    pub(super) fn new(number: u32, duration: f32, rigids: &'a Rigids) -> Self {
        Self {
            number,
            duration,
            rigids,
        }
    }

    /// What a hand felt in it: force and torque, for a stick that is told more often than once a tick.
    ///
    /// # Errors
    /// [`Gone`] when there is no such hand.
    pub fn reaction(&self, hand: RigidId) -> Result<Reaction, Gone> {
        let hand = self.rigids.get(hand)?;
        Ok(hand.reactions().last().copied().unwrap_or_default())
    }

    /// Where a hand is now [m].
    ///
    /// # Errors
    /// [`Gone`] when there is no such hand.
    pub fn position(&self, hand: RigidId) -> Result<Vector, Gone> {
        Ok(self.rigids.get(hand)?.position())
    }
}

/// A field that pulls towards a place [m], or away from it where `strength` [m/s²] is negative: with that strength up to
/// `reach` [m], and with the square of the distance less beyond; within a hundredth of the reach it fades to nothing. Where
/// the reach is not positive and finite it pulls nothing.
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
        let apart = [0, 1, 2].map(|axis: usize| centre[axis] - at[axis]);
        let distance = apart.iter().map(|k| k * k).sum::<f32>().sqrt();
        let far = reach / distance.max(reach);
        let near = (100.0 * distance / reach).min(1.0);
        let share = match distance > 0.0 && reach > 0.0 && reach.is_finite() {
            true => strength * far * far * near / distance,
            false => 0.0,
        };
        apart.map(|k| k * share)
    }
}

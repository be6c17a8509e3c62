//! Validation of rigid bodies.

use super::inertia::Inertia;
use super::reach::is_within_reach;
use super::{MotionType, RigidState};
use crate::error::{Error, require};
#[cfg(feature = "serde")]
use crate::foundation::dim::{Dim, turning};
#[cfg(feature = "serde")]
use crate::rigid_body::shape::Shape;
use crate::rigid_body::solid::Solid;
#[cfg(feature = "serde")]
use crate::rigid_body::solid::flat;

impl RigidState {
    /// Checks every field.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names the first field that is out of range.
    pub fn check(&self) -> Result<(), Error> {
        let positions = [
            ("position", self.position),
            ("target_position", self.target_at_tick_end),
            ("target_position", self.target_now),
            ("position", self.position_before),
        ];
        for (field, position) in positions {
            let expected = "within 1e6 m of the origin";
            require(is_within_reach(position), field, expected, position)?;
        }
        let velocities = [
            ("velocity", self.velocity),
            ("angular_velocity", self.angular_velocity),
        ];
        for (field, velocity) in velocities {
            require(velocity.is_finite(), field, "finite", velocity)?;
        }
        let rotations = [
            ("rotation", self.rotation),
            ("rotation", self.rotation_before),
            ("target_rotation", self.target_rotation),
        ];
        for (field, rotation) in rotations {
            let quaternion = rotation.quaternion();
            require(rotation.is_unit(), field, "of length 1", quaternion)?;
        }
        let timer = self.sleep_timer;
        require(timer >= 0.0, "sleep_timer", "0 or more", timer)?;
        self.local_shape.check()?;
        let is_moved = self.shape
            == self
                .local_shape
                .rotated(self.rotation)
                .translated(self.position);
        let expected = "the local shape, rotated and translated to the pose";
        require(is_moved, "shape", expected, self.shape)?;
        check_friction(self.friction)?;
        check_restitution(self.restitution)?;
        check_motion_type(self.motion_type, &self.local_shape, self.inertia.as_ref())
    }

    /// Returns whether a body from a snapshot is valid in a world of dimension `D`: its fields are in range,
    /// and in 2D it lies in the plane.
    #[cfg(feature = "serde")]
    pub(crate) fn is_sound<D: Dim>(&self) -> bool {
        self.check().is_ok() && self.clone().seen_in::<D>() == *self
    }

    /// Returns the body restricted to dimension `D`, with derived fields recomputed: in 2D, third coordinates
    /// become 0 and rotations keep only the part about the third axis.
    #[cfg(feature = "serde")]
    fn seen_in<D: Dim>(mut self) -> Self {
        self.local_shape = Shape::<D>::of(&self.local_shape).solid();
        let positions = [
            &mut self.position,
            &mut self.target_at_tick_end,
            &mut self.target_now,
        ];
        let others = [
            &mut self.position_before,
            &mut self.velocity,
            &mut self.settled_at,
        ];
        for vector in positions.into_iter().chain(others) {
            *vector = flat::<D>(*vector);
        }
        let rotations = [&mut self.rotation_before, &mut self.target_rotation];
        for rotation in rotations.into_iter().chain([&mut self.rotation]) {
            *rotation = rotation.seen_in::<D>();
        }
        self.angular_velocity = turning::<D>(self.angular_velocity);
        self.clear_unused_motion();
        self.inertia = self.motion_type.inertia::<D>(&self.local_shape);
        self.move_to(self.position, self.rotation);
        self
    }
}

pub(crate) fn check_friction(friction: f32) -> Result<(), Error> {
    within("friction", friction, 0.0, f32::MAX, "0 or more, and finite")
}

pub(crate) fn check_restitution(restitution: f32) -> Result<(), Error> {
    within("restitution", restitution, 0.0, 1.0, "0 to 1")
}

/// Checks the parameters of a motion type, and whether a body of this type may have the shape `local_shape`.
/// `inertia` is the inertia of this shape if the type is dynamic, otherwise `None`.
pub(super) fn check_motion_type(
    motion_type: MotionType,
    local_shape: &Solid,
    inertia: Option<&Inertia>,
) -> Result<(), Error> {
    let (tiny, huge) = (f32::MIN_POSITIVE, f32::MAX);
    if motion_type != MotionType::Fixed {
        let is_bounded = local_shape.bounds().into_iter().all(is_within_reach);
        let expected = "bounded, within 1e6 m of its position";
        require(is_bounded, "shape", expected, local_shape)?;
    }
    match motion_type {
        MotionType::Fixed | MotionType::Kinematic => Ok(()),
        MotionType::Dynamic { mass } => {
            within("mass", mass, 1e-6, 1e6, "1e-6 to 1e6 kg")?;
            let [low, high] = local_shape.bounds();
            let is_centred = (low + high).length() <= 1e-3 * (high - low).length();
            require(
                is_centred,
                "shape",
                "centred on its local origin",
                local_shape,
            )?;
            let is_sound = inertia.is_none_or(|inertia| inertia.is_sound());
            let expected = "of a size at which the moments of inertia are finite and positive";
            require(is_sound, "shape", expected, local_shape)
        }
        MotionType::Coupled {
            mass,
            stiffness,
            damping,
            max_force,
        } => {
            within("mass", mass, 1e-6, 1e6, "1e-6 to 1e6 kg")?;
            within("stiffness", stiffness, tiny, huge, "positive and finite")?;
            within("damping", damping, tiny, 10.0, "positive, at most 10")?;
            within("max_force", max_force, tiny, f32::INFINITY, "positive")
        }
    }
}

fn within(
    field: &'static str,
    given: f32,
    low: f32,
    high: f32,
    expected: &'static str,
) -> Result<(), Error> {
    require(given >= low && given <= high, field, expected, given)
}

//! Validation of rigid bodies.

use super::invalid::{BadRigid, is_within_reach, require};
use super::{MotionType, RigidBody};
use crate::math::rotation::Rotation;

impl RigidBody {
    /// Checks every field.
    ///
    /// # Errors
    /// [`BadRigid`] names the first field that is out of range.
    pub fn check(&self) -> Result<(), BadRigid> {
        let within = |field, k: f32, low: f32, high: f32, expected| {
            require(k >= low && k <= high, field, expected)
        };
        let (tiny, huge) = (f32::MIN_POSITIVE, f32::MAX);
        let positions = [
            ("position", self.position),
            ("goal", self.goal),
            ("goal", self.goal_before),
            ("position", self.position_before),
        ];
        for (field, position) in positions {
            require(
                is_within_reach(position),
                field,
                "within 1e6 m of the origin",
            )?;
        }
        require(self.velocity.is_finite(), "velocity", "finite")?;
        require(
            self.angular_velocity.is_finite(),
            "angular velocity",
            "finite",
        )?;
        let rotations = [self.rotation, self.rotation_before, self.rotation_goal];
        let are_rotations = rotations.into_iter().all(Rotation::is_unit);
        require(are_rotations, "rotation", "of length 1")?;
        require(self.sleep_timer >= 0.0, "sleep timer", "0 or more")?;
        self.form.check()?;
        let is_moved = self.shape == self.form.rotated(self.rotation).translated(self.position);
        let expected = "the local shape, rotated and translated to the pose";
        require(is_moved, "shape", expected)?;
        within(
            "friction",
            self.friction,
            0.0,
            huge,
            "0 or more, and finite",
        )?;
        within("restitution", self.restitution, 0.0, 1.0, "0 to 1")?;
        if self.motion_type != MotionType::Fixed {
            let ends = self.form.bounds().into_iter().all(is_within_reach);
            require(ends, "shape", "bounded, within 1e6 m of its position")?;
        }
        match self.motion_type {
            MotionType::Fixed | MotionType::Kinematic => Ok(()),
            MotionType::Dynamic { mass } => {
                within("mass", mass, 1e-6, 1e6, "1e-6 to 1e6 kg")?;
                let [low, high] = self.form.bounds();
                let off = (low + high).length() <= 1e-3 * (high - low).length();
                require(off, "shape", "one with its middle at the origin")?;
                let is_sound = self.inertia.is_none_or(|inertia| inertia.is_sound());
                require(
                    is_sound,
                    "shape",
                    "neither too small nor too large to be turned",
                )
            }
            MotionType::Coupled {
                mass,
                stiffness,
                damping,
                limit,
            } => {
                within("mass", mass, 1e-6, 1e6, "1e-6 to 1e6 kg")?;
                within("stiffness", stiffness, tiny, huge, "positive and finite")?;
                within("damping", damping, tiny, 10.0, "positive, at most 10")?;
                within("limit", limit, tiny, f32::INFINITY, "positive")
            }
        }
    }
}

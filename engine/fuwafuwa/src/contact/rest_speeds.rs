//! Speeds at which objects count as at rest, and at which they wake others.

/// Time of free fall [s] in which a body becomes as fast as the oscillations that the solver leaves in a body
/// at rest. With three quarters of it, the slowest of 30 bodies of default damping falls asleep after 11 s
/// instead of 9 s.
const FALL_TIME: f32 = 0.004;
/// Share of the speed after [`FALL_TIME`] at which an object at rest may drift. It limits the error of a body
/// that approaches its equilibrium slowly, under any gravity; see `fuwafuwa check slow`. With a third of the
/// share, a tower of ten rigid boxes, whose contacts creep by 1 cm/s, does not fall asleep. With a larger share,
/// a body at 2 cm/s on a floor without friction falls asleep.
const DRIFT_SHARE: f32 = 0.315;
/// Drift at most [sizes/s]. It applies to bodies of voxels below 4 cm, which would otherwise move visibly. With
/// two thirds of it, the crumbs of the scene `pile` take 13 s to fall asleep.
const MAX_DRIFT_RATE: f32 = 0.3;
/// Drift that counts as none in any case [sizes/s]: one voxel in 17 minutes. It exceeds the motion that
/// rounding causes in a body at rest.
const MIN_DRIFT_RATE: f32 = 0.001;
/// Share of a size by which an object may still travel before air drag stops it, and count as at rest.
const STOPPING_SHARE: f32 = 0.1;
/// Ratio between the speed that wakes a sleeper and the sleep speed. With a lower ratio, a heap would keep
/// itself awake.
const WAKING: f32 = 5.0;

/// Speeds at which objects count as at rest, and at which they wake others, in a world with a given gravity and
/// air drag. All speeds grow with gravity, because all motion under gravity does. Without gravity and drag they
/// are nearly 0, because nothing would stop a moving body.
///
/// The methods take a size [m]: the width of a voxel, or a quarter of the inradius of a rigid body.
#[derive(Copy, Clone, Debug)]
pub struct RestSpeeds {
    /// Gravity [m/s²].
    pub gravity: f32,
    /// Air drag [1/s].
    pub drag: f32,
}

impl RestSpeeds {
    /// Returns the speed below which an object may be at rest [m/s], as root mean square over its mass.
    /// `gravity_scale` is that of the body.
    pub fn sleep_speed(self, gravity_scale: f32, size: f32) -> f32 {
        self.fall_speed() * gravity_scale.abs() + self.least(size)
    }

    /// Returns the speed below which the centre of an object at rest drifts [m/s], averaged over half a second.
    pub fn drift_speed(self, gravity_scale: f32, size: f32) -> f32 {
        let drift = DRIFT_SHARE * self.fall_speed() * gravity_scale.abs();
        drift.min(MAX_DRIFT_RATE * size) + self.least(size)
    }

    /// Returns the speed above which a moving object wakes a sleeper that it touches [m/s].
    pub fn wake_speed(self, size: f32) -> f32 {
        WAKING * self.sleep_speed(1.0, size)
    }

    fn fall_speed(self) -> f32 {
        FALL_TIME * self.gravity
    }

    fn least(self, size: f32) -> f32 {
        (MIN_DRIFT_RATE + STOPPING_SHARE * self.drag) * size
    }
}

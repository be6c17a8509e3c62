//! Maps of the world by which items are moved.

use super::{flat, rounded};
use fuwafuwa::{Rotation, Vec3};
use fuwafuwa_scenes::scene::{BallText, BoxText, CapsuleText};
use std::f32::consts::{PI, TAU};

/// Smallest and largest width of a thing [m].
pub(super) const SIZES: [f32; 2] = [0.01, 8.0];

/// Smallest and largest factor of a single stretch.
pub(super) const FACTORS: [f32; 2] = [0.01, 100.0];

/// Limit of the coordinates of the centre of a stretch or a rotation [m].
pub(super) const FARTHEST_CENTRE: f32 = 100.0;

/// Limit of the coordinates of points that hold to things [m].
const FARTHEST: f32 = 1000.0;

/// Map of the world.
#[derive(Copy, Clone, Debug)]
pub(super) enum Motion {
    /// Translation [m].
    Shift(Vec3),
    /// Stretch about a point.
    Stretch {
        about: Vec3,
        /// Factor on each axis.
        factors: Vec3,
        /// Factor for sizes that have no axis, such as radii.
        one: f32,
    },
    /// Rotation about a point.
    Turn {
        about: Vec3,
        rotation: Rotation,
        /// Angle about the third axis in 2D [rad].
        angle: f32,
    },
}

/// Motion of one item.
#[derive(Copy, Clone, Debug)]
pub(super) struct Moved {
    pub(super) motion: Motion,
    /// Translation after the motion, which keeps the item within reach [m].
    pub(super) back: Vec3,
    pub(super) dim: u8,
}

impl Motion {
    /// Returns a position after the motion [m].
    pub(super) fn mapped(&self, point: Vec3) -> Vec3 {
        match *self {
            Self::Shift(by) => point + by,
            Self::Stretch { about, factors, .. } => about + (point - about) * factors,
            Self::Turn {
                about, rotation, ..
            } => about + rotation.apply(point - about),
        }
    }
}

impl Moved {
    /// Returns a position after the motion [m].
    pub(super) fn mapped(&self, point: Vec3) -> Vec3 {
        self.motion.mapped(point) + self.back
    }

    /// Moves a position [m].
    pub(super) fn point(&self, point: &mut [f32; 3]) {
        let to = flat(self.dim, self.mapped(Vec3::from(*point)));
        set(point, to);
    }

    /// Maps a displacement [m].
    pub(super) fn displacement(&self, vector: &mut [f32; 3]) {
        match self.motion {
            Motion::Shift(_) => {}
            Motion::Stretch { factors, .. } => {
                set(vector, flat(self.dim, Vec3::from(*vector) * factors));
            }
            Motion::Turn { rotation, .. } => {
                set(vector, flat(self.dim, rotation.apply(Vec3::from(*vector))));
            }
        }
    }

    /// Turns a vector and keeps its length, for example a direction or a velocity.
    pub(super) fn direction(&self, vector: &mut [f32; 3]) {
        if let Motion::Turn { rotation, .. } = self.motion {
            let turned = rotation.apply(Vec3::from(*vector));
            // Short vectors keep all their digits.
            let digits = if turned.length() > 0.1 { 1e6 } else { 1e9 };
            let rounded = turned.to_array().map(|k| round_to(k, digits));
            if turned.is_finite() {
                *vector = flat(self.dim, Vec3::from(rounded)).to_array();
            }
        }
    }

    /// Turns an angular velocity, which in 2D stays as it is.
    pub(super) fn angular_velocity(&self, vector: &mut [f32; 3]) {
        if self.dim == 3 {
            self.direction(vector);
        }
    }

    /// Stretches half the width of a box on each axis [m], or exchanges its widths if the rotation is nearest to quarter
    /// turns.
    pub(super) fn half(&self, half: &mut [f32; 3]) {
        let axes = 0..usize::from(self.dim);
        match self.motion {
            Motion::Shift(_) => {}
            Motion::Stretch { factors, .. } => {
                for axis in axes {
                    let [low, high] = SIZES.map(|width| 0.5 * width);
                    scale(&mut half[axis], factors[axis], low, high);
                }
            }
            Motion::Turn { rotation, .. } => {
                if let Some(target) = permutation(rotation) {
                    let old = *half;
                    for axis in axes {
                        half[target[axis]] = old[axis];
                    }
                }
            }
        }
    }

    /// Stretches a radius [m].
    pub(super) fn radius(&self, radius: &mut f32) {
        let [low, high] = SIZES.map(|width| 0.5 * width);
        self.length(radius, low, high);
    }

    /// Stretches a length, which stays between `low` and `high` [m].
    pub(super) fn length(&self, length: &mut f32, low: f32, high: f32) {
        if let Motion::Stretch { one, .. } = self.motion {
            scale(length, one, low, high);
        }
    }

    /// Composes a rotation vector with the motion. `None` stands for no rotation.
    pub(super) fn rotation_vector(&self, vector: Option<[f32; 3]>) -> Option<[f32; 3]> {
        let Motion::Turn {
            rotation, angle, ..
        } = self.motion
        else {
            return vector;
        };
        let before = Vec3::from(vector.unwrap_or_default());
        let after = match self.dim {
            2 => Vec3::Z * wrapped(before.z + angle),
            _ => Rotation::about(before, before.length())
                .then(rotation)
                .scaled_axis(),
        };
        let after = after.to_array().map(|k| round_to(k, 1e6));
        (after != [0.0; 3]).then_some(after)
    }

    /// Returns whether the motion turns axes onto axes.
    pub(super) fn keeps_axes(&self) -> bool {
        match self.motion {
            Motion::Turn { rotation, .. } => {
                let is_axis = |axis: Vec3| axis.abs().max_element() > 1.0 - 1e-6;
                rotation.axes().into_iter().all(is_axis)
            }
            _ => true,
        }
    }

    pub(super) fn boxed(&self, text: &mut BoxText) {
        self.point(&mut text.centre);
        self.half(&mut text.half);
    }

    pub(super) fn ball(&self, text: &mut BallText) {
        self.point(&mut text.centre);
        self.radius(&mut text.radius);
    }

    pub(super) fn capsule(&self, text: &mut CapsuleText) {
        let before = length_of(text);
        self.point(&mut text.from);
        self.point(&mut text.to);
        shorten(text, before);
        self.radius(&mut text.radius);
    }

    /// Maps a capsule that is given relative to the place of its item.
    pub(super) fn local_capsule(&self, text: &mut CapsuleText) {
        let before = length_of(text);
        self.displacement(&mut text.from);
        self.displacement(&mut text.to);
        shorten(text, before);
        self.radius(&mut text.radius);
    }
}

fn length_of(text: &CapsuleText) -> f32 {
    Vec3::from(text.from).distance(Vec3::from(text.to))
}

/// Shortens a capsule to the maximum length, or to its length `before` [m] if that was longer.
fn shorten(text: &mut CapsuleText, before: f32) {
    let (length, most) = (length_of(text), before.max(SIZES[1]));
    if length > most {
        let ends = [text.from, text.to].map(Vec3::from);
        let middle = (ends[0] + ends[1]) * 0.5;
        let share = most / length;
        set(&mut text.from, middle + (ends[0] - middle) * share);
        set(&mut text.to, middle + (ends[1] - middle) * share);
    }
}

/// Sets the coordinates that differ, rounded. Coordinates that stay keep all their digits.
pub(super) fn set(numbers: &mut [f32; 3], to: Vec3) {
    for axis in 0..3 {
        if numbers[axis] != to[axis] && to[axis].is_finite() {
            numbers[axis] = rounded(to[axis].clamp(-FARTHEST, FARTHEST));
        }
    }
}

/// Multiplies a length by a factor. The result stays between `low` and `high`, or between the former length and these.
pub(super) fn scale(length: &mut f32, factor: f32, low: f32, high: f32) {
    let (before, after) = (*length, rounded(*length * factor));
    if factor != 1.0 && before.is_finite() && after.is_finite() {
        *length = after.clamp(before.min(low), before.max(high));
    }
}

/// Rounds a number to a multiple of 1 / `digits`.
fn round_to(number: f32, digits: f64) -> f32 {
    ((f64::from(number) * digits).round() / digits) as f32 + 0.0
}

/// Returns an angle between −π and π [rad].
fn wrapped(angle: f32) -> f32 {
    PI - (PI - angle).rem_euclid(TAU)
}

/// Returns for each axis the axis nearest to it after the rotation. `None` if two axes have the same one.
fn permutation(rotation: Rotation) -> Option<[usize; 3]> {
    let mut target = [0; 3];
    for (axis, turned) in rotation.axes().into_iter().enumerate() {
        let turned = turned.abs();
        // Prefers to leave a width as it is.
        let is_own = turned[axis] > turned.max_element() - 1e-3;
        target[axis] = if is_own { axis } else { turned.max_position() };
    }
    let [x, y, z] = target;
    (x != y && y != z && z != x).then_some(target)
}

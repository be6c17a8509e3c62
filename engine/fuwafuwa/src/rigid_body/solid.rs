//! Internal form of shapes, with signed distances.
//!
//! The same solids serve 2D and 3D. In 2D all third coordinates are 0, and boxes are unbounded along the third axis.

mod manifold;
mod oriented_box;
mod solid_distance;
mod solid_ray;

use crate::error::{Error, require};
use crate::foundation::dim::Dim;
use crate::foundation::hash::hash_state;
use crate::math::rotation::Rotation;
use glam::Vec3;

/// Lower and upper corner of an axis-aligned box [m].
pub type Bounds = [Vec3; 2];

/// [`Shape`](super::shape::Shape) with three coordinates in both dimensions.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Solid {
    /// Half-space bounded by a plane (in 2D a line). The solid side is opposite to the normal.
    HalfSpace {
        /// Outward unit normal.
        normal: Vec3,
        /// Signed distance of the surface from the origin along the normal [m].
        offset: f32,
    },
    /// Axis-aligned box.
    Box {
        /// Centre [m].
        centre: Vec3,
        /// Half extents [m]; in 2D the third one is `f32::MAX`, for unbounded.
        half: Vec3,
    },
    /// Oriented box.
    OrientedBox {
        /// Centre [m].
        centre: Vec3,
        /// Half extents along the local axes [m]; in 2D the third one is `f32::MAX`, for unbounded.
        half: Vec3,
        /// Rotation from local to world axes.
        rotation: Rotation,
    },
    /// Capsule: all points within `radius` of a segment.
    Capsule {
        /// First end point of the segment [m].
        from: Vec3,
        /// Second end point of the segment [m].
        to: Vec3,
        /// Radius [m].
        radius: f32,
    },
    /// Ball; in 2D a disc.
    Ball {
        /// Centre [m].
        centre: Vec3,
        /// Radius [m].
        radius: f32,
    },
}

hash_state! {
    enum Solid {
        HalfSpace { normal, offset },
        Box { centre, half },
        OrientedBox { centre, half, rotation },
        Capsule { from, to, radius },
        Ball { centre, radius },
    }
}

impl Solid {
    /// Returns the half-space with an outward normal of any length and its surface through `point` [m].
    pub fn half_space(normal: Vec3, point: Vec3) -> Self {
        let normal = normal * (1.0 / normal.length());
        let offset = normal.dot(point);
        Self::HalfSpace { normal, offset }
    }

    /// Checks that all numbers are finite, sizes positive, and normals and rotations normalised.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names the first invalid field.
    pub fn check(&self) -> Result<(), Error> {
        let finite = |field, v: Vec3| require(v.is_finite(), field, "finite", v);
        let is_positive = |k: f32| k.is_finite() && k > 0.0;
        let positive = |field, k: f32| require(is_positive(k), field, "positive and finite", k);
        match *self {
            Self::HalfSpace { normal, offset } => {
                require(offset.is_finite(), "offset", "finite", offset)?;
                let is_unit = (normal.length() - 1.0).abs() < 1e-3;
                require(is_unit, "normal", "of length 1", normal)
            }
            Self::Box { centre, half } => {
                finite("centre", centre)?;
                let is_positive = half.to_array().into_iter().all(is_positive);
                require(is_positive, "half", "positive and finite", half)
            }
            Self::OrientedBox {
                centre,
                half,
                rotation,
            } => {
                Self::Box { centre, half }.check()?;
                let quaternion = rotation.quaternion();
                require(rotation.is_unit(), "rotation", "of length 1", quaternion)
            }
            Self::Capsule { from, to, radius } => {
                finite("from", from)?;
                finite("to", to)?;
                positive("radius", radius)
            }
            Self::Ball { centre, radius } => {
                finite("centre", centre)?;
                positive("radius", radius)
            }
        }
    }

    /// Returns the radius of the largest ball that fits into the solid [m]; infinite for a half-space.
    pub fn inner_radius(&self) -> f32 {
        match *self {
            Self::HalfSpace { .. } => f32::INFINITY,
            Self::Box { half, .. } | Self::OrientedBox { half, .. } => half.min_element(),
            Self::Capsule { radius, .. } | Self::Ball { radius, .. } => radius,
        }
    }

    /// Returns the signed distance of a point from the surface [m], negative inside, and the outward unit
    /// normal at the nearest point of the surface.
    // Inlined, because a call would pass the point through memory, which takes as long as the computation.
    #[inline(always)]
    pub fn distance(&self, point: Vec3) -> (f32, Vec3) {
        match *self {
            Self::HalfSpace { normal, offset } => (normal.dot(point) - offset, normal),
            Self::Box { centre, half } => distance_from_box(point - centre, half),
            Self::OrientedBox {
                centre,
                half,
                rotation,
            } => distance_from_turned(point - centre, half, rotation),
            Self::Capsule { from, to, radius } => {
                let (axis, reach) = (to - from, point - from);
                let along = axis.dot(reach) / axis.dot(axis).max(1e-12);
                let nearest = axis * along.clamp(0.0, 1.0);
                let (distance, normal) = away(reach - nearest);
                (distance - radius, normal)
            }
            Self::Ball { centre, radius } => {
                let (distance, normal) = away(point - centre);
                (distance - radius, normal)
            }
        }
    }

    /// Returns the axis-aligned bounding box [m]; infinite for a half-space. The bounding box of a 2D box has
    /// thickness 0 along the third axis, although the box itself is unbounded along this axis.
    pub fn bounds(&self) -> Bounds {
        let around = |from: Vec3, to: Vec3, half: Vec3| {
            let low = [0, 1, 2].map(|axis: usize| from[axis].min(to[axis]) - half[axis]);
            let high = [0, 1, 2].map(|axis: usize| from[axis].max(to[axis]) + half[axis]);
            [low.into(), high.into()]
        };
        match *self {
            Self::HalfSpace { .. } => [Vec3::splat(f32::NEG_INFINITY), Vec3::splat(f32::INFINITY)],
            Self::Box { centre, half } => around(
                centre,
                centre,
                half.map(|k| if k == f32::MAX { 0.0 } else { k }),
            ),
            Self::OrientedBox {
                centre,
                half,
                rotation,
            } => {
                let axes = rotation.axes();
                let reach = |axis: usize| {
                    let own = (0..3).map(|own| reach_of(axes[own][axis], half[own]));
                    own.sum::<f32>()
                };
                around(centre, centre, [0, 1, 2].map(reach).into())
            }
            Self::Capsule { from, to, radius } => around(from, to, Vec3::splat(radius)),
            Self::Ball { centre, radius } => around(centre, centre, Vec3::splat(radius)),
        }
    }

    /// Returns the shape translated by the vector `by` [m].
    pub fn translated(self, by: Vec3) -> Self {
        match self {
            Self::HalfSpace { normal, offset } => Self::HalfSpace {
                normal,
                offset: offset + normal.dot(by),
            },
            Self::Box { centre, half } => Self::Box {
                centre: centre + by,
                half,
            },
            Self::OrientedBox {
                centre,
                half,
                rotation,
            } => Self::OrientedBox {
                centre: centre + by,
                half,
                rotation,
            },
            Self::Capsule { from, to, radius } => Self::Capsule {
                from: from + by,
                to: to + by,
                radius,
            },
            Self::Ball { centre, radius } => Self::Ball {
                centre: centre + by,
                radius,
            },
        }
    }
}

impl Solid {
    /// Returns the shape rotated about the origin.
    #[must_use]
    pub fn rotated(self, by: Rotation) -> Self {
        if by == Rotation::NONE {
            return self;
        }
        match self {
            Self::HalfSpace { normal, offset } => Self::HalfSpace {
                normal: by.apply(normal),
                offset,
            },
            Self::Box { centre, half } => Self::OrientedBox {
                centre: by.apply(centre),
                half,
                rotation: by,
            },
            Self::OrientedBox {
                centre,
                half,
                rotation,
            } => Self::OrientedBox {
                centre: by.apply(centre),
                half,
                rotation: rotation.then(by),
            },
            Self::Capsule { from, to, radius } => Self::Capsule {
                from: by.apply(from),
                to: by.apply(to),
                radius,
            },
            Self::Ball { centre, radius } => Self::Ball {
                centre: by.apply(centre),
                radius,
            },
        }
    }
}

/// Returns the signed distance of a point from a rotated box around the origin [m], and the outward normal,
/// see [`distance_from_box`]. Not inlined: rotated boxes are rare, and the code would slow down the common
/// shapes.
#[inline(never)]
fn distance_from_turned(point: Vec3, half: Vec3, rotation: Rotation) -> (f32, Vec3) {
    let own = rotation.inverse().apply(point);
    let (distance, normal) = distance_from_box(own, half);
    (distance, rotation.apply(normal))
}

/// Returns the length of a half extent [m] of a box projected onto a world axis. `cosine` belongs to the
/// angle between the box axis and the world axis. Returns 0 for the unbounded third axis of a 2D box.
fn reach_of(cosine: f32, half: f32) -> f32 {
    match half == f32::MAX {
        true => 0.0,
        false => cosine.abs() * half,
    }
}

/// Restricts a vector to dimension `D`: in 2D its third coordinate becomes 0.
pub(crate) fn flat<D: Dim>(mut vector: Vec3) -> Vec3 {
    if D::N == 2 {
        vector.z = 0.0;
    }
    vector
}

/// Returns the length and the direction of a vector; for a zero vector, the direction is +y.
#[inline]
fn away(v: Vec3) -> (f32, Vec3) {
    let distance = v.length();
    if distance > 1e-9 {
        (distance, v * (1.0 / distance))
    } else {
        (0.0, Vec3::Y)
    }
}

/// Returns the signed distance of a point from a box around the origin [m], and the outward normal. For a
/// point inside, both refer to the nearest face; for a point outside, to the nearest point of the box.
#[inline]
fn distance_from_box(at: Vec3, half: Vec3) -> (f32, Vec3) {
    let beyond = [0, 1, 2].map(|k: usize| at[k].abs() - half[k]);
    let sign = |k: usize| if at[k] < 0.0 { -1.0 } else { 1.0 };
    if beyond.iter().all(|&k| k <= 0.0) {
        let side = (0..3).fold(0, |side, k| if beyond[k] > beyond[side] { k } else { side });
        let mut normal = Vec3::ZERO;
        normal[side] = sign(side);
        return (beyond[side], normal);
    }
    away([0, 1, 2].map(|k| beyond[k].max(0.0) * sign(k)).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_returns_signed_distance_and_normal() {
        let wall = Solid::Box {
            centre: Vec3::X,
            half: Vec3::new(0.5, 2.0, 9.0),
        };
        assert_eq!(wall.distance(Vec3::Y), (0.5, Vec3::NEG_X));
        let (gap, normal) = wall.distance(Vec3::new(0.75, 0.0, 0.0));
        assert_eq!((gap, normal), (-0.25, Vec3::NEG_X));
        let (gap, _) = wall.distance(Vec3::new(1.5 + 3.0, 2.0 + 4.0, 0.0));
        assert_eq!(gap, 5.0);
        let bar = Solid::Capsule {
            from: Vec3::ZERO,
            to: Vec3::new(2.0, 0.0, 0.0),
            radius: 0.5,
        };
        assert_eq!(bar.distance(Vec3::new(1.0, 2.0, 0.0)), (1.5, Vec3::Y));
        assert_eq!(bar.distance(Vec3::new(5.0, 0.0, 4.0)).0, 4.5);
        let floor = Solid::half_space(Vec3::new(0.0, 2.0, 0.0), Vec3::new(7.0, 1.0, 0.0));
        assert_eq!(floor.distance(Vec3::new(0.0, 0.5, 0.0)), (-0.5, Vec3::Y));
    }

    #[test]
    fn check_names_the_invalid_field() {
        let ball = Solid::Ball {
            centre: Vec3::ZERO,
            radius: -1.0,
        };
        let error = Error::parameter("radius", "positive and finite", -1.0);
        assert_eq!(ball.check(), Err(error));
        let nowhere = Solid::half_space(Vec3::ZERO, Vec3::ZERO);
        assert!(nowhere.check().is_err());
    }
}

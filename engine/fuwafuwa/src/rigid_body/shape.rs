//! Shapes of rigid bodies: half-spaces, boxes, capsules, balls.

use crate::error::Error;
use crate::foundation::dim::{Dim, DimVector};
use crate::math::rotation::Rotation;
use crate::rigid_body::solid::Solid;
use glam::Vec3;

/// Shape of a rigid body, or of the region of a query. In 2D a half-space is bounded by a line, a box is a
/// rectangle, a ball a disc, and a capsule a bar with round ends.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = ""))]
pub enum Shape<D: Dim> {
    /// Half-space bounded by a plane. The solid side is opposite to the normal.
    HalfSpace {
        /// Outward unit normal.
        normal: D::Vector,
        /// Signed distance of the surface from the origin along the normal [m].
        offset: f32,
    },
    /// Axis-aligned box.
    Box {
        /// Centre [m].
        centre: D::Vector,
        /// Half extents [m].
        half: D::Vector,
    },
    /// Oriented box.
    OrientedBox {
        /// Centre [m].
        centre: D::Vector,
        /// Half extents along the local axes [m].
        half: D::Vector,
        /// Rotation from local to world axes.
        rotation: Rotation,
    },
    /// Capsule: all points within `radius` of a segment.
    Capsule {
        /// First end point of the segment [m].
        from: D::Vector,
        /// Second end point of the segment [m].
        to: D::Vector,
        /// Radius [m].
        radius: f32,
    },
    /// Ball.
    Ball {
        /// Centre [m].
        centre: D::Vector,
        /// Radius [m].
        radius: f32,
    },
}

impl<D: Dim> Shape<D> {
    /// Returns the half-space with an outward normal of any length and its surface through `point` [m].
    pub fn half_space(normal: D::Vector, point: D::Vector) -> Self {
        let solid = Solid::half_space(normal.to_vec3(), point.to_vec3());
        Self::of(&solid)
    }

    /// Returns a box around the origin with half extents [m].
    pub fn cuboid(half: D::Vector) -> Self {
        let centre = D::Vector::ZERO;
        Self::Box { centre, half }
    }

    /// Returns a ball around the origin with a radius [m].
    pub fn ball(radius: f32) -> Self {
        let centre = D::Vector::ZERO;
        Self::Ball { centre, radius }
    }

    /// Returns all points within `radius` [m] of the segment between two points [m].
    pub fn capsule(from: D::Vector, to: D::Vector, radius: f32) -> Self {
        Self::Capsule { from, to, radius }
    }

    /// Checks that all numbers are finite, sizes positive, and normals and rotations normalised.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names the first invalid field.
    pub fn check(&self) -> Result<(), Error> {
        self.solid().check()
    }

    /// Returns the signed distance of a point from the surface [m], negative inside, and the outward unit
    /// normal at the nearest point of the surface.
    pub fn distance(&self, point: D::Vector) -> (f32, D::Vector) {
        let (distance, normal) = self.solid().distance(point.to_vec3());
        (distance, D::Vector::from_vec3(normal))
    }

    /// Returns the lower and upper corner of the axis-aligned bounding box [m]; infinite for a half-space.
    pub fn bounds(&self) -> [D::Vector; 2] {
        self.solid().bounds().map(D::Vector::from_vec3)
    }

    /// Returns the radius of the largest ball that fits into the shape [m].
    pub fn inradius(&self) -> f32 {
        self.solid().inner_radius()
    }

    /// Returns the shape translated by the vector `by` [m].
    #[must_use]
    pub fn translated(self, by: D::Vector) -> Self {
        Self::of(&self.solid().translated(by.to_vec3()))
    }

    /// Returns the shape rotated about the origin. In 2D only the part of the rotation about the third axis
    /// is applied.
    #[must_use]
    pub fn rotated(self, by: Rotation) -> Self {
        Self::of(&self.solid().rotated(by.seen_in::<D>()))
    }

    /// Converts the shape to three coordinates. In 2D, boxes become unbounded along the third axis, so that
    /// no contact pushes out of the plane.
    pub(crate) fn solid(&self) -> Solid {
        let half_extents = |half: D::Vector| match D::N {
            2 => half.to_vec3().with_z(f32::MAX),
            _ => half.to_vec3(),
        };
        match *self {
            Self::HalfSpace { normal, offset } => Solid::HalfSpace {
                normal: normal.to_vec3(),
                offset,
            },
            Self::Box { centre, half } => Solid::Box {
                centre: centre.to_vec3(),
                half: half_extents(half),
            },
            Self::OrientedBox {
                centre,
                half,
                rotation,
            } => Solid::OrientedBox {
                centre: centre.to_vec3(),
                half: half_extents(half),
                rotation: rotation.seen_in::<D>(),
            },
            Self::Capsule { from, to, radius } => Solid::Capsule {
                from: from.to_vec3(),
                to: to.to_vec3(),
                radius,
            },
            Self::Ball { centre, radius } => Solid::Ball {
                centre: centre.to_vec3(),
                radius,
            },
        }
    }

    /// Converts a solid to a shape with the coordinates of dimension `D`; inverse of [`Shape::solid`].
    pub(crate) fn of(solid: &Solid) -> Self {
        let flat = |vector: Vec3| D::Vector::from_vec3(vector);
        match *solid {
            Solid::HalfSpace { normal, offset } => Self::HalfSpace {
                normal: flat(normal),
                offset,
            },
            Solid::Box { centre, half } => Self::Box {
                centre: flat(centre),
                half: flat(half),
            },
            Solid::OrientedBox {
                centre,
                half,
                rotation,
            } => Self::OrientedBox {
                centre: flat(centre),
                half: flat(half),
                rotation,
            },
            Solid::Capsule { from, to, radius } => Self::Capsule {
                from: flat(from),
                to: flat(to),
                radius,
            },
            Solid::Ball { centre, radius } => Self::Ball {
                centre: flat(centre),
                radius,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foundation::dim::{Dim2, Dim3};
    use glam::Vec2;

    #[test]
    fn distance_of_rectangle_ignores_third_axis() {
        let wall = Shape::<Dim2>::cuboid(Vec2::new(0.5, 2.0)).translated(Vec2::X);
        assert_eq!(wall.distance(Vec2::new(0.0, 1.0)), (0.5, Vec2::NEG_X));
        assert_eq!(wall.distance(Vec2::new(4.5, 6.0)).0, 5.0);
        assert_eq!(wall.inradius(), 0.5);
        assert_eq!(wall.bounds(), [Vec2::new(0.5, -2.0), Vec2::new(1.5, 2.0)]);
    }

    #[test]
    fn solid_and_back_is_the_same_shape() {
        let rotation = Rotation::about(Vec3::ONE, 0.4);
        let shapes: [Shape<Dim3>; 5] = [
            Shape::half_space(Vec3::new(0.0, 2.0, 0.0), Vec3::Y),
            Shape::cuboid(Vec3::ONE),
            Shape::cuboid(Vec3::ONE).rotated(rotation),
            Shape::capsule(Vec3::X, Vec3::Y, 0.5),
            Shape::ball(0.5).translated(Vec3::Z),
        ];
        for shape in shapes {
            assert_eq!(Shape::of(&shape.solid()), shape);
        }
    }

    #[test]
    fn check_names_the_invalid_field() {
        let error = Error::parameter("radius", "positive and finite", -1.0);
        assert_eq!(Shape::<Dim3>::ball(-1.0).check(), Err(error));
        let nowhere = Shape::<Dim2>::half_space(Vec2::ZERO, Vec2::ZERO);
        assert!(nowhere.check().is_err());
    }
}

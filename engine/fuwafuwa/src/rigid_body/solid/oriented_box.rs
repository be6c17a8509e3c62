//! Boxes with their axes, and the separating-axis test [Gottschalk 1996].

use super::Solid;
use crate::math::rotation::Rotation;
use glam::Vec3;

/// Bias of the separating-axis test, as a share of the smallest half extent of both boxes. A face axis of the
/// second box is chosen only if its separation exceeds that of the first box's best face axis by more than
/// the bias. An edge axis must exceed the best face axis of both boxes by more than the bias. Faces are
/// preferred because they give more contact points. The bias keeps resting boxes from switching between axes.
const AXIS_BIAS: f32 = 0.01;

/// Box with its centre, half extents and axes.
#[derive(Copy, Clone, Debug)]
pub struct OrientedBox {
    pub centre: Vec3,
    pub half: Vec3,
    pub axes: [Vec3; 3],
    /// Number of bounded axes: 2 in 2D, otherwise 3.
    pub axis_count: usize,
}

/// Axis of largest separation, or of smallest overlap, of two boxes.
#[derive(Copy, Clone, Debug)]
pub struct Separation {
    /// Separation [m], negative if the boxes overlap.
    pub gap: f32,
    /// Unit normal from the second box to the first.
    pub normal: Vec3,
    pub feature: SeparatingFeature,
}

/// Faces or edges of the boxes that define a separating axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum SeparatingFeature {
    /// Face of the first box, perpendicular to the box axis with this index.
    First(usize),
    /// Face of the second box, perpendicular to the box axis with this index.
    Second(usize),
    /// One edge of each box, parallel to the box axis with this index; the first index is of the first box.
    Edges(usize, usize),
}

impl OrientedBox {
    /// Converts an axis-aligned or oriented box; `None` for other shapes.
    pub fn of(shape: &Solid) -> Option<Self> {
        let (centre, half, rotation) = match *shape {
            Solid::Box { centre, half } => (centre, half, Rotation::NONE),
            Solid::OrientedBox {
                centre,
                half,
                rotation,
            } => (centre, half, rotation),
            _ => return None,
        };
        let axis_count = if half[2] == f32::MAX { 2 } else { 3 };
        Some(Self {
            centre,
            half,
            axes: rotation.axes(),
            axis_count,
        })
    }

    /// Returns the half extent of the box along the unit direction `way` [m].
    pub fn reach(&self, way: Vec3) -> f32 {
        let own = (0..self.axis_count).map(|axis| self.axes[axis].dot(way).abs() * self.half[axis]);
        own.sum()
    }

    /// Returns the corner with a number from 0: bit `k` selects the positive side of axis `k`.
    pub fn corner(&self, number: usize) -> Vec3 {
        (0..self.axis_count).fold(self.centre, |at, axis| {
            let sign = if number >> axis & 1 == 1 { 1.0 } else { -1.0 };
            at + self.axes[axis] * (sign * self.half[axis])
        })
    }

    /// Returns the number of corners: 4 in 2D, otherwise 8.
    pub fn corner_count(&self) -> usize {
        1 << self.axis_count
    }

    /// Returns the axis along which two boxes are separated most, or overlap least.
    pub fn separation(&self, other: &Self) -> Separation {
        let apart = self.centre - other.centre;
        let along = |way: Vec3, feature: SeparatingFeature| {
            let distance = apart.dot(way);
            let normal = if distance < 0.0 { -way } else { way };
            let gap = distance.abs() - self.reach(way) - other.reach(way);
            Separation {
                gap,
                normal,
                feature,
            }
        };
        let larger =
            |best: Separation, next: Separation| if next.gap > best.gap { next } else { best };
        let none = Separation {
            gap: f32::NEG_INFINITY,
            normal: Vec3::Y,
            feature: SeparatingFeature::First(1),
        };
        let sizes = |cuboid: &Self| cuboid.half.to_array().into_iter().take(cuboid.axis_count);
        let sizes = sizes(self).chain(sizes(other));
        let bias = AXIS_BIAS * sizes.fold(f32::MAX, f32::min);
        let first =
            (0..self.axis_count).map(|axis| along(self.axes[axis], SeparatingFeature::First(axis)));
        let second = (0..other.axis_count)
            .map(|axis| along(other.axes[axis], SeparatingFeature::Second(axis)));
        let (first, second) = (first.fold(none, larger), second.fold(none, larger));
        let best = match second.gap > first.gap + bias {
            true => second,
            false => first,
        };
        if self.axis_count == 2 {
            return best;
        }
        let mut edges = none;
        for (own, others) in (0..9).map(|pair| (pair / 3, pair % 3)) {
            let way = self.axes[own].cross(other.axes[others]);
            let squared = way.dot(way);
            // Skips parallel edges: if they separate two boxes, a face axis separates the boxes, too.
            if squared > 1e-6 {
                let way = way * (1.0 / squared.sqrt());
                edges = larger(edges, along(way, SeparatingFeature::Edges(own, others)));
            }
        }
        match edges.gap > best.gap + bias {
            true => edges,
            false => best,
        }
    }
}

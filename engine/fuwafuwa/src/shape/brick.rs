//! A box with its axes, and how two of them lie to each other: by separating axes [Gottschalk 1996].

use super::{Shape, Vector};
use crate::rotation::Rotation;
use crate::vector::{cross, dot, minus, plus, scaled};

/// An axis of the second box is taken only when it parts two boxes by so much of their size more than one of the first, and
/// one across two edges only when by as much more than both: what lies still keeps its points, and faces have more of them.
/// With none towers of ten boxes lean by a quarter of a box; with a thousandth and with a tenth they stand.
const BEHIND: f32 = 0.01;

/// A box, and the axes that it has.
#[derive(Copy, Clone, Debug)]
pub struct Brick {
    pub centre: Vector,
    pub half: Vector,
    pub axes: [Vector; 3],
    /// 2, where it has no ends on the third axis, or 3.
    pub axis_count: usize,
}

/// The axis along which two boxes are furthest apart, or overlap least.
#[derive(Copy, Clone, Debug)]
pub struct Separation {
    /// [m], negative where they overlap.
    pub gap: f32,
    /// From the second to the first, of length 1.
    pub normal: Vector,
    pub side: Side,
}

/// What an axis is of.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Side {
    /// A face of the first, across this axis of it.
    First(usize),
    /// A face of the second.
    Second(usize),
    /// An edge of each, along these axes.
    Edges(usize, usize),
}

impl Brick {
    /// The box that a shape is, if it is one.
    pub fn of(shape: &Shape) -> Option<Self> {
        let (centre, half, rotation) = match *shape {
            Shape::Box { centre, half } => (centre, half, Rotation::NONE),
            Shape::OrientedBox {
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

    /// How far it reaches from its middle along a direction [m].
    pub fn reach(&self, way: Vector) -> f32 {
        let own =
            (0..self.axis_count).map(|axis| dot(self.axes[axis], way).abs() * self.half[axis]);
        own.sum()
    }

    /// The corner that is so many, by the bits of its number on the upper side of each axis.
    pub fn corner(&self, number: usize) -> Vector {
        (0..self.axis_count).fold(self.centre, |at, axis| {
            let sign = if number >> axis & 1 == 1 { 1.0 } else { -1.0 };
            plus(at, scaled(self.axes[axis], sign * self.half[axis]))
        })
    }

    /// How many corners it has.
    pub fn corner_count(&self) -> usize {
        1 << self.axis_count
    }

    /// How it lies to another.
    pub fn separation(&self, other: &Self) -> Separation {
        let apart = minus(self.centre, other.centre);
        let along = |way: Vector, side: Side| {
            let distance = dot(apart, way);
            let normal = if distance < 0.0 {
                scaled(way, -1.0)
            } else {
                way
            };
            let gap = distance.abs() - self.reach(way) - other.reach(way);
            Separation { gap, normal, side }
        };
        let larger =
            |best: Separation, next: Separation| if next.gap > best.gap { next } else { best };
        let none = Separation {
            gap: f32::NEG_INFINITY,
            normal: [0.0, 1.0, 0.0],
            side: Side::First(1),
        };
        let sizes = [self, other].map(|brick| &brick.half[..brick.axis_count]);
        let sizes = sizes.into_iter().flatten().copied();
        let behind = BEHIND * sizes.fold(f32::MAX, f32::min);
        let first = (0..self.axis_count).map(|axis| along(self.axes[axis], Side::First(axis)));
        let second = (0..other.axis_count).map(|axis| along(other.axes[axis], Side::Second(axis)));
        let (first, second) = (first.fold(none, larger), second.fold(none, larger));
        let best = match second.gap > first.gap + behind {
            true => second,
            false => first,
        };
        if self.axis_count == 2 {
            return best;
        }
        let mut edges = none;
        for (own, others) in (0..9).map(|pair| (pair / 3, pair % 3)) {
            let way = cross(self.axes[own], other.axes[others]);
            let squared = dot(way, way);
            // Edges that are parallel part nothing that faces do not.
            if squared > 1e-6 {
                let way = scaled(way, 1.0 / squared.sqrt());
                edges = larger(edges, along(way, Side::Edges(own, others)));
            }
        }
        match edges.gap > best.gap + behind {
            true => edges,
            false => best,
        }
    }
}

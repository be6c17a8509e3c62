//! The way that a contact sphere is expected to take, and whether two of them come close.

use super::pair::MARGIN;
use super::sphere::SphereId;
use crate::solve::Row;
use crate::vector::{dot, minus, plus, scaled};

/// How far a sphere may stray from its path, in voxels: more makes longer lists, less more looks.
/// With half of it `diced` takes some 5 % less and `tear-3d` some 4 % longer; with twice as much both take some 10 % longer
/// once they tear.
pub const STRAY: f32 = 0.35;

/// A path goes on by this share as its sphere went on since its last one began, and else as it goes now: what swings
/// comes back, and strays less so. With half of it `tear-3d` takes 8 % longer until it tears, with 1 most ticks of `diced`
/// take as much longer before it tears.
const AS_BEFORE: f32 = 0.8;

/// The way of a sphere while its pairs hold: a straight line.
#[derive(Copy, Clone, Debug, Default)]
pub struct Path {
    /// Where it was, or would have been, when all were looked for [m].
    pub from: Row,
    /// [m/s]
    pub velocity: Row,
}

impl Path {
    /// Where it is so long [s] after all were looked for [m].
    #[inline(always)]
    pub fn at(&self, time: f32) -> Row {
        plus(self.from, scaled(self.velocity, time))
    }
}

/// Where a path was laid.
#[derive(Copy, Clone, Debug)]
pub struct Start {
    /// [m]
    pub at: Row,
    /// As seen from when all were looked for [s]; no number if there was no path before.
    pub time: f32,
}

impl Start {
    pub const UNKNOWN: Self = Self {
        at: [0.0; 4],
        time: f32::NAN,
    };

    /// How fast a sphere is expected to go on that is here now [m], goes so fast [m/s], and began its last path at this
    /// start: mostly as it went since.
    pub fn expected(&self, here: Row, now: f32, velocity: Row) -> Row {
        let passed = now - self.time;
        if passed > 0.0 {
            let mean = scaled(minus(here, self.at), 1.0 / passed);
            plus(scaled(mean, AS_BEFORE), scaled(velocity, 1.0 - AS_BEFORE))
        } else {
            velocity
        }
    }
}

/// A stretch of time since all were looked for: its middle and half its length [s].
#[derive(Copy, Clone, Debug, Default)]
pub struct Span {
    pub middle: f32,
    pub half: f32,
}

/// A sphere on its path, with all that says whether it makes a pair with another one: side by side
/// with those around it, that is read fast.
#[derive(Copy, Clone, Debug)]
pub struct Traveller {
    pub path: Path,
    /// Half the length of its path at the most, as seen from the frame [m].
    pub sweep: f32,
    pub radius: f32,
    pub sphere: SphereId,
    pub asleep: bool,
}

impl Traveller {
    /// Whether the two come close in a span of time.
    #[inline(always)]
    pub fn meets(&self, other: &Self, span: Span) -> bool {
        let closing = minus(self.path.velocity, other.path.velocity);
        let apart = minus(self.path.from, other.path.from);
        let apart = plus(apart, scaled(closing, span.middle));
        let reach = widened(self.radius + other.radius);
        // Most are too far apart whichever way they go; what is no number is near nothing.
        let furthest = reach + self.sweep + other.sweep;
        let is_near = dot(apart, apart) <= furthest * furthest;
        if !is_near || self.asleep && other.asleep {
            return false;
        }
        // Where they come closest, as seen from the middle of the span.
        let time = -dot(apart, closing) / dot(closing, closing).max(f32::MIN_POSITIVE);
        let time = time.clamp(-span.half, span.half);
        let apart = plus(apart, scaled(closing, time));
        dot(apart, apart) <= reach * reach
    }
}

/// How close two paths must come for a pair, whose spheres touch at this distance [m].
#[inline(always)]
pub fn widened(touching: f32) -> f32 {
    (1.0 + MARGIN + 2.0 * STRAY) * touching
}

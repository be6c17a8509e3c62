//! Where a body tore a short while ago: nothing there gives way again before the waves have passed.

use crate::dim::Point;

/// Lattice steps around a release that cool down after it: half as far as a wave goes while they do. With 1 `tear-3d` has 2.5 times
/// as many releases, with 4 a fifth fewer.
const REACH: i32 = 2;

/// Where releases happened a short while ago: their surroundings cool down.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cooldowns {
    /// Lattice points and for how much longer they cool down [s].
    points: Vec<(Point, f32)>,
    /// Rounds so far.
    pub rounds: u32,
}

impl Cooldowns {
    /// Lets a round of some time pass [s].
    pub fn pass(&mut self, duration: f32) {
        self.rounds = self.rounds.wrapping_add(1);
        self.points.retain_mut(|(_, left)| {
            *left -= duration;
            *left > 0.0
        });
    }

    /// From now on the surroundings of some points cool down for a time [s].
    pub fn start(&mut self, points: impl Iterator<Item = Point>, duration: f32) {
        self.points.extend(points.map(|at| (at, duration)));
    }

    /// The points that it knows.
    #[cfg(feature = "serde")]
    pub fn points(&self) -> impl Iterator<Item = Point> + '_ {
        self.points.iter().map(|&(at, _)| at)
    }

    /// Whether a point cools down.
    pub fn covers(&self, at: Point) -> bool {
        self.points.iter().any(|&(point, _)| is_near(at, point))
    }
}

/// Whether a release at one point disturbs the other one.
pub fn is_near(a: Point, b: Point) -> bool {
    (0..3).all(|axis| (a[axis] - b[axis]).abs() <= REACH)
}

//! Cooldowns after releases: no node nearby fails again before the stress waves have passed.

use crate::foundation::dim::Point;
use crate::foundation::hash::hash_state;

/// Distance from a release within which nodes cool down, in lattice steps: half the distance that a wave
/// travels during the cooldown.
const REACH: i32 = 2;

/// Recent releases, around which nodes cool down.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cooldowns {
    /// Lattice points, and their remaining cooldown [s].
    points: Vec<(Point, f32)>,
    /// Number of fracture rounds up to now.
    pub rounds: u32,
}

hash_state! { struct Cooldowns { points, rounds } }

impl Cooldowns {
    /// Advances by one round of `duration` [s].
    pub fn pass(&mut self, duration: f32) {
        self.rounds = self.rounds.wrapping_add(1);
        self.points.retain_mut(|(_, left)| {
            *left -= duration;
            *left > 0.0
        });
    }

    /// Starts a cooldown of `duration` [s] around some points.
    pub fn start(&mut self, points: impl Iterator<Item = Point>, duration: f32) {
        self.points.extend(points.map(|at| (at, duration)));
    }

    /// Returns the points with a running cooldown.
    #[cfg(feature = "serde")]
    pub fn points(&self) -> impl Iterator<Item = Point> + '_ {
        self.points.iter().map(|&(at, _)| at)
    }

    /// Whether a point is near a point with a running cooldown.
    pub fn covers(&self, at: Point) -> bool {
        self.points.iter().any(|&(point, _)| is_near(at, point))
    }
}

/// Whether a release at one point disturbs the other point.
pub fn is_near(a: Point, b: Point) -> bool {
    (0..3).all(|axis| (a[axis] - b[axis]).abs() <= REACH)
}

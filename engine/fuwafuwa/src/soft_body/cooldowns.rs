//! Cooldowns after releases: nodes near a release cannot fail again before its stress waves have passed.

use crate::foundation::dim::Point;
use crate::foundation::hash::hash_state;

/// Distance along each axis, in lattice steps, within which a release starts the cooldown of nodes. A wave
/// travels twice this distance during the cooldown.
const REACH: i32 = 2;

/// Lattice points of recent releases, near which nodes cannot fail.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cooldowns {
    /// Lattice points of recent releases, each with its remaining cooldown [s].
    points: Vec<(Point, f32)>,
    /// Number of fracture rounds since the body was created; wraps around. A fracture round tests the
    /// breakable nodes.
    pub rounds: u32,
}

hash_state! { struct Cooldowns { points, rounds } }

impl Cooldowns {
    /// Advances all cooldowns by one fracture round of `duration` [s], and removes those that have ended.
    pub fn pass(&mut self, duration: f32) {
        self.rounds = self.rounds.wrapping_add(1);
        self.points.retain_mut(|(_, left)| {
            *left -= duration;
            *left > 0.0
        });
    }

    /// Starts a cooldown of `duration` [s] at each of `points`.
    pub fn start(&mut self, points: impl Iterator<Item = Point>, duration: f32) {
        self.points.extend(points.map(|at| (at, duration)));
    }

    /// Returns the lattice points with a running cooldown.
    #[cfg(feature = "serde")]
    pub fn points(&self) -> impl Iterator<Item = Point> + '_ {
        self.points.iter().map(|&(at, _)| at)
    }

    /// Returns whether a lattice point is so close to a recent release that a node there cannot fail now.
    pub fn covers(&self, at: Point) -> bool {
        self.points.iter().any(|&(point, _)| is_near(at, point))
    }
}

/// Returns whether two lattice points are at most `REACH` steps apart along each axis, so that a release at
/// one of them changes the stress at the other.
pub fn is_near(a: Point, b: Point) -> bool {
    (0..3).all(|axis| (a[axis] - b[axis]).abs() <= REACH)
}

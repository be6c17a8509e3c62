//! Cutaway that shows the inside of 3D bodies in the element view.

use std::f32::consts::TAU;

/// Smallest remaining share of a body while the cut moves by itself.
const LEAST: f32 = 0.4;
/// Period of the automatic movement [s].
const PERIOD: f32 = 9.0;
/// Smallest remaining share when a player moves the cut.
const FEWEST: f32 = 0.05;

/// Cutaway that shows the inside of 3D bodies in the element view.
#[derive(Copy, Clone, Debug, Default)]
pub struct Cutaway {
    /// Start of the automatic movement [s since the start of the game].
    since: f64,
    /// Remaining share of a body chosen by the player, 0 to 1; `None` while the cut moves by itself.
    wish: Option<f32>,
}

impl Cutaway {
    /// Starts the automatic movement with whole bodies.
    pub fn begin(time: f64) -> Self {
        Self {
            since: time,
            wish: None,
        }
    }

    /// Remaining share of a body, 0 to 1. `still` selects reduced motion: one half instead of the automatic
    /// movement.
    pub fn share(&self, time: f64, still: bool) -> f32 {
        let swing = 0.5 + 0.5 * (TAU * (time - self.since) as f32 / PERIOD).cos();
        let by_itself = if still {
            0.5
        } else {
            LEAST + (1.0 - LEAST) * swing
        };
        self.wish.unwrap_or(by_itself)
    }

    /// Cuts away the share `more` in addition and stops the automatic movement. A negative value shows more
    /// of the body.
    pub fn cut(&mut self, more: f32, time: f64, still: bool) {
        let share = self.share(time, still) - more;
        self.wish = Some(share.clamp(FEWEST, 1.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cutaway_moves_until_player_cuts() {
        let mut opening = Cutaway::begin(10.0);
        assert_eq!(opening.share(10.0, false), 1.0);
        assert!((opening.share(10.0 + 0.5 * f64::from(PERIOD), false) - LEAST).abs() < 1e-3);
        opening.cut(0.2, 10.0, false);
        assert_eq!(opening.share(13.0, false), 0.8);
        opening.cut(9.0, 13.0, false);
        assert_eq!(opening.share(99.0, false), FEWEST);
        assert_eq!(Cutaway::begin(0.0).share(3.0, true), 0.5);
    }
}

//! Cutaway that shows the inside of 3D bodies in the element view.

use std::f32::consts::TAU;

/// Smallest share of a 3D body that stays visible while the cutaway moves by itself.
const LEAST: f32 = 0.4;
/// Period of the cutaway's automatic movement [s].
const PERIOD: f32 = 9.0;
/// Smallest share of a 3D body that stays visible when a player moves the cutaway.
const FEWEST: f32 = 0.05;

/// Cutaway that shows the inside of 3D bodies in the element view.
#[derive(Copy, Clone, Debug, Default)]
pub struct Cutaway {
    /// Start of the cutaway's automatic movement, counted from the start of the game [s].
    since: f64,
    /// Visible share of a body that the player has chosen, 0 to 1. `None` while the cutaway moves by itself.
    wish: Option<f32>,
}

impl Cutaway {
    /// Starts the cutaway's automatic movement with whole bodies.
    pub fn begin(time: f64) -> Self {
        Self {
            since: time,
            wish: None,
        }
    }

    /// Visible share of a body, 0 to 1: the player's choice, otherwise that of the automatic movement. With
    /// reduced motion (`still`), one half replaces the automatic movement.
    pub fn share(&self, time: f64, still: bool) -> f32 {
        let swing = 0.5 + 0.5 * (TAU * (time - self.since) as f32 / PERIOD).cos();
        let by_itself = if still {
            0.5
        } else {
            LEAST + (1.0 - LEAST) * swing
        };
        self.wish.unwrap_or(by_itself)
    }

    /// Reduces the visible share of bodies by `more` and stops the cutaway's automatic movement. A negative
    /// `more` shows more of the bodies.
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

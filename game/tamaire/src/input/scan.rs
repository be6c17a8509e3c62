//! Play with one switch: what it can do is offered in turn, and pressing it takes what is offered.

use egui::Vec2;
use serde::{Deserialize, Serialize};
use std::f32::consts::TAU;

/// For how many steps the arrow goes around once.
const TURN: f32 = 5.0;

/// How fast one offer follows the other.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scanning {
    /// Nothing is offered: there is more than a switch.
    #[default]
    Off,
    /// Every two seconds.
    Slow,
    /// Every 1.2 s.
    Medium,
    /// Every 0.7 s.
    Quick,
}

impl Scanning {
    /// Whether anything is offered.
    pub fn is_on(self) -> bool {
        self != Self::Off
    }

    /// How long an offer lasts [s], if there are any.
    pub fn step(self) -> Option<f32> {
        match self {
            Self::Off => None,
            Self::Slow => Some(2.0),
            Self::Medium => Some(1.2),
            Self::Quick => Some(0.7),
        }
    }
}

/// What the switch does when it is pressed.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Offer {
    /// The hand goes this way for as long as it is pressed: to the right and away, 1 long.
    Way(Vec2),
    /// In space the hand rises for as long.
    Raise,
    /// It sinks.
    Lower,
    /// A rest.
    Pause,
}

/// What is offered in a round.
#[derive(Clone, Debug, Default)]
pub struct Scan {
    /// How far it has come around [steps].
    at: f32,
    /// Whether the switch was up: what brought the round up takes nothing in it.
    was_up: bool,
    is_taken: bool,
    is_known: bool,
}

impl Scan {
    /// Lets time pass with the switch pressed or not; one that stays is taken by one press and left by the next. Says
    /// whether a rest is asked for.
    pub fn pass(&mut self, is_pressed: bool, stays: bool, steps: f32, is_space: bool) -> bool {
        let is_new = is_pressed && self.was_up;
        self.was_up = !is_pressed;
        self.is_taken = match stays {
            true => self.is_taken ^ is_new,
            false => is_pressed && (self.is_taken || is_new),
        };
        self.is_known |= self.is_taken;
        if !self.is_taken {
            let others = if is_space { 3.0 } else { 1.0 };
            self.at = (self.at + steps) % (TURN + others);
        }
        is_new && self.is_taken && self.offer(is_space) == Offer::Pause
    }

    /// What is offered: each way around, beginning at the right, then whatever else there is.
    pub fn offer(&self, is_space: bool) -> Offer {
        match (self.at - TURN, is_space) {
            (after, _) if after < 0.0 => Offer::Way(Vec2::angled(TAU * self.at / TURN)),
            (after, true) if after < 1.0 => Offer::Raise,
            (after, true) if after < 2.0 => Offer::Lower,
            _ => Offer::Pause,
        }
    }

    /// Whether anything was taken yet.
    pub fn is_known(&self) -> bool {
        self.is_known
    }

    /// Begins with the first offer, once the switch was up; what is known stays so.
    pub fn start(&mut self) {
        *self = Self {
            is_known: self.is_known,
            ..Self::default()
        };
    }

    /// What of it is taken.
    pub fn taken(&self, is_space: bool) -> Option<Offer> {
        self.is_taken.then(|| self.offer(is_space))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_is_offered_in_turn() {
        for (is_space, others) in [
            (false, vec![Offer::Pause]),
            (true, vec![Offer::Raise, Offer::Lower, Offer::Pause]),
        ] {
            let mut scan = Scan::default();
            let mut seen = Vec::new();
            for _ in 0..(TURN as usize + others.len()) * 10 {
                match scan.offer(is_space) {
                    Offer::Way(way) => seen.push(way),
                    offer => assert_eq!(offer, others[(scan.at - TURN) as usize]),
                }
                assert!(!scan.pass(false, false, 0.1, is_space));
            }
            for quarter in [Vec2::X, Vec2::Y, -Vec2::X, -Vec2::Y] {
                assert!(seen.iter().any(|way| way.dot(quarter) > 0.99), "{quarter}");
            }
            assert!(scan.at < 0.1 || scan.at > TURN, "it begins again");
        }
    }

    #[test]
    fn what_is_taken_lasts_as_long_as_the_switch_is_pressed() {
        let mut scan = Scan::default();
        scan.pass(false, false, 2.0, false);
        let offer = scan.offer(false);
        for _ in 0..50 {
            scan.pass(true, false, 0.5, false);
            assert_eq!(scan.taken(false), Some(offer));
        }
        scan.pass(false, false, 0.5, false);
        assert_eq!(scan.taken(false), None);
        assert_ne!(scan.offer(false), offer);
    }

    #[test]
    fn a_switch_that_stays_is_left_by_the_next_press() {
        let mut scan = Scan::default();
        let mut taken = Vec::new();
        for is_pressed in [true, false, true, false, false, true, true, false] {
            scan.pass(is_pressed, true, 0.1, false);
            taken.push(scan.is_taken);
        }
        // The first press brought the round up.
        assert_eq!(taken, [false, false, true, true, true, false, false, false]);
    }

    #[test]
    fn a_rest_is_asked_for_once() {
        let mut scan = Scan::default();
        scan.pass(false, false, TURN + 0.5, false);
        assert!(scan.pass(true, false, 0.0, false));
        assert!(!scan.pass(true, false, 0.0, false));
    }
}

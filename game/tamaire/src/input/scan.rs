//! Scanning for play with one switch: actions are offered in turn, and a press of the switch selects the one
//! on offer.

use egui::Vec2;
use serde::{Deserialize, Serialize};
use std::f32::consts::TAU;

/// Number of scanning steps in which the offered direction turns around once.
const TURN: f32 = 5.0;

/// Speed of scanning.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scanning {
    /// No scanning.
    #[default]
    Off,
    /// One step every 2 s.
    Slow,
    /// One step every 1.2 s.
    Medium,
    /// One step every 0.7 s.
    Quick,
}

impl Scanning {
    /// Whether scanning is on.
    pub fn is_on(self) -> bool {
        self != Self::Off
    }

    /// Duration of a step [s], if scanning is on.
    pub fn step(self) -> Option<f32> {
        match self {
            Self::Off => None,
            Self::Slow => Some(2.0),
            Self::Medium => Some(1.2),
            Self::Quick => Some(0.7),
        }
    }
}

/// An action that a press of the switch selects.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum ScanAction {
    /// Moves the hand in a direction (right, away; unit length) while the switch is pressed.
    Move(Vec2),
    /// In 3D: raises the hand while the switch is pressed.
    Raise,
    /// In 3D: lowers the hand while the switch is pressed.
    Lower,
    /// Lets time run back while the switch is pressed.
    Rewind,
    /// Pauses the round.
    Pause,
}

/// State of scanning in a round.
#[derive(Clone, Debug, Default)]
pub struct Scan {
    /// Position in the cycle of offers [steps].
    at: f32,
    /// Whether the switch was up at the last call. Initially false, so that the press that started the round
    /// selects nothing.
    was_up: bool,
    is_taken: bool,
    is_known: bool,
}

impl Scan {
    /// Advances scanning by `steps`, with the switch pressed or not. With `stays`, one press selects and the
    /// next one ends the action; otherwise the action lasts while the switch is pressed. Returns whether a
    /// pause is requested.
    pub fn pass(&mut self, is_pressed: bool, stays: bool, steps: f32, is_space: bool) -> bool {
        let is_new = is_pressed && self.was_up;
        self.was_up = !is_pressed;
        self.is_taken = match stays {
            true => self.is_taken ^ is_new,
            false => is_pressed && (self.is_taken || is_new),
        };
        self.is_known |= self.is_taken;
        if !self.is_taken {
            let others = if is_space { 4.0 } else { 2.0 };
            self.at = (self.at + steps) % (TURN + others);
        }
        is_new && self.is_taken && self.offer(is_space) == ScanAction::Pause
    }

    /// Returns the current offer: first all directions, beginning at the right, then the other actions.
    pub fn offer(&self, is_space: bool) -> ScanAction {
        match (self.at - TURN, is_space) {
            (after, _) if after < 0.0 => ScanAction::Move(Vec2::angled(TAU * self.at / TURN)),
            (after, true) if after < 1.0 => ScanAction::Raise,
            (after, true) if after < 2.0 => ScanAction::Lower,
            (after, true) if after < 3.0 => ScanAction::Rewind,
            (after, false) if after < 1.0 => ScanAction::Rewind,
            _ => ScanAction::Pause,
        }
    }

    /// Whether the player has ever selected an offer.
    pub fn is_known(&self) -> bool {
        self.is_known
    }

    /// Restarts with the first offer. Selecting works only after the switch was up.
    pub fn start(&mut self) {
        *self = Self {
            is_known: self.is_known,
            ..Self::default()
        };
    }

    /// Returns the selected offer.
    pub fn taken(&self, is_space: bool) -> Option<ScanAction> {
        self.is_taken.then(|| self.offer(is_space))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_actions_are_offered_in_turn() {
        for (is_space, others) in [
            (false, vec![ScanAction::Rewind, ScanAction::Pause]),
            (
                true,
                vec![
                    ScanAction::Raise,
                    ScanAction::Lower,
                    ScanAction::Rewind,
                    ScanAction::Pause,
                ],
            ),
        ] {
            let mut scan = Scan::default();
            let mut seen = Vec::new();
            for _ in 0..(TURN as usize + others.len()) * 10 {
                match scan.offer(is_space) {
                    ScanAction::Move(way) => seen.push(way),
                    offer => assert_eq!(offer, others[(scan.at - TURN) as usize]),
                }
                assert!(!scan.pass(false, false, 0.1, is_space));
            }
            for quarter in [Vec2::X, Vec2::Y, -Vec2::X, -Vec2::Y] {
                assert!(seen.iter().any(|way| way.dot(quarter) > 0.99), "{quarter}");
            }
            assert!(scan.at < 0.1 || scan.at > TURN, "the cycle restarts");
        }
    }

    #[test]
    fn selected_action_lasts_while_switch_is_pressed() {
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
    fn next_press_ends_sticky_action() {
        let mut scan = Scan::default();
        let mut taken = Vec::new();
        for is_pressed in [true, false, true, false, false, true, true, false] {
            scan.pass(is_pressed, true, 0.1, false);
            taken.push(scan.is_taken);
        }
        // The first press started the round, so it selects no action.
        assert_eq!(taken, [false, false, true, true, true, false, false, false]);
    }

    #[test]
    fn pause_is_requested_once() {
        let mut scan = Scan::default();
        scan.pass(false, false, TURN + 1.5, false);
        assert!(scan.pass(true, false, 0.0, false));
        assert!(!scan.pass(true, false, 0.0, false));
    }
}

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
    /// In a playground: presses the tool, or lets it go.
    Tool,
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
    /// Whether the last call selected an offer.
    is_new: bool,
    is_known: bool,
}

impl Scan {
    /// Advances scanning by `steps`, with the switch pressed or not. With `stays`, one press selects and the
    /// next one ends the action; otherwise the action lasts while the switch is pressed. `others` are the actions that
    /// are offered after the directions.
    pub fn pass(&mut self, is_pressed: bool, stays: bool, steps: f32, others: &[ScanAction]) {
        let is_new = is_pressed && self.was_up;
        self.was_up = !is_pressed;
        self.is_taken = match stays {
            true => self.is_taken ^ is_new,
            false => is_pressed && (self.is_taken || is_new),
        };
        self.is_known |= self.is_taken;
        if !self.is_taken {
            self.at = (self.at + steps) % (TURN + others.len() as f32);
        }
        self.is_new = is_new && self.is_taken;
    }

    /// Returns the current offer: first all directions, beginning at the right, then the other actions.
    pub fn offer(&self, others: &[ScanAction]) -> ScanAction {
        let after = self.at - TURN;
        match others.get(after.max(0.0) as usize) {
            Some(&other) if after >= 0.0 => other,
            _ => ScanAction::Move(Vec2::angled(TAU * self.at / TURN)),
        }
    }

    /// Ends the selected action, so that scanning goes on.
    pub fn end(&mut self) {
        self.is_taken = false;
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
    pub fn taken(&self, others: &[ScanAction]) -> Option<ScanAction> {
        self.is_taken.then(|| self.offer(others))
    }

    /// Returns the offer that the last call of [`Self::pass`] has selected, once for each press.
    pub fn just_taken(&self, others: &[ScanAction]) -> Option<ScanAction> {
        self.taken(others).filter(|_| self.is_new)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OTHERS: [ScanAction; 2] = [ScanAction::Rewind, ScanAction::Pause];

    #[test]
    fn all_actions_are_offered_in_turn() {
        use ScanAction::{Lower, Pause, Raise, Rewind};
        for others in [&[Rewind, Pause][..], &[Raise, Lower, Rewind, Pause]] {
            let mut scan = Scan::default();
            let mut seen = Vec::new();
            for _ in 0..(TURN as usize + others.len()) * 10 {
                match scan.offer(others) {
                    ScanAction::Move(way) => seen.push(way),
                    offer => assert_eq!(offer, others[(scan.at - TURN) as usize]),
                }
                scan.pass(false, false, 0.1, others);
                assert_eq!(scan.just_taken(others), None);
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
        scan.pass(false, false, 2.0, &OTHERS);
        let offer = scan.offer(&OTHERS);
        for _ in 0..50 {
            scan.pass(true, false, 0.5, &OTHERS);
            assert_eq!(scan.taken(&OTHERS), Some(offer));
        }
        scan.pass(false, false, 0.5, &OTHERS);
        assert_eq!(scan.taken(&OTHERS), None);
        assert_ne!(scan.offer(&OTHERS), offer);
    }

    #[test]
    fn next_press_ends_sticky_action() {
        let mut scan = Scan::default();
        let mut taken = Vec::new();
        for is_pressed in [true, false, true, false, false, true, true, false] {
            scan.pass(is_pressed, true, 0.1, &OTHERS);
            taken.push(scan.is_taken);
        }
        // The first press started the round, so it selects no action.
        assert_eq!(taken, [false, false, true, true, true, false, false, false]);
    }

    #[test]
    fn pause_is_requested_once() {
        let mut scan = Scan::default();
        scan.pass(false, false, TURN + 1.5, &OTHERS);
        for expected in [Some(ScanAction::Pause), None] {
            scan.pass(true, false, 0.0, &OTHERS);
            assert_eq!(scan.just_taken(&OTHERS), expected);
        }
    }
}

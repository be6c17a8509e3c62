//! Staff access: a hidden entrance, and a PIN protected against guessing.

use super::config::Pin;
use sticks::{Device, PadButton};

/// Time for which the hidden corner or the buttons must be held to open the staff entrance [s].
pub const HELD: f32 = 3.0;
/// Fraction of [`HELD`] before which no progress is shown, so that an accidental touch does not reveal the
/// entrance.
const HESITATION: f32 = 0.3;
/// Number of wrong PINs after which the first pause begins.
const SLIPS: u32 = 3;
/// Length of the first pause [s]. Each further wrong PIN doubles the pause.
const PAUSE: f64 = 30.0;
/// Maximum length of a pause [s].
const LONGEST: f64 = 3600.0;
/// Time without a wrong PIN after which earlier wrong PINs are forgotten [s].
const FORGIVEN: f64 = 6.0 * 3600.0;

/// Pad buttons that open the entrance when held together.
const CHORD: [PadButton; 3] = [
    PadButton::LeftShoulder,
    PadButton::RightShoulder,
    PadButton::Start,
];
/// Buttons of a stick without a pad layout, counted from 0, that open the entrance when held together.
/// Buttons 0 and 1 are left out because visitors press them at once.
const STICK_CHORD: [usize; 2] = [2, 3];

/// Staff pages.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum StaffPage {
    /// Figures of the day.
    #[default]
    Today,
    /// Frame times and other health data of the stand.
    Health,
    /// Configuration of the stand.
    Settings,
    /// Confirmation to end the stand.
    End,
}

impl StaffPage {
    /// Pages in the navigation row, in this order.
    pub const ALL: [Self; 3] = [Self::Today, Self::Health, Self::Settings];
}

/// State of the hidden entrance and the PIN entry.
#[derive(Debug, Default)]
pub struct Entrance {
    /// Time for which the hidden corner or the buttons have been held [s].
    held: f32,
    /// Entered digits.
    pub entered: String,
    /// Number of wrong PINs since the last right one.
    wrong: u32,
    /// Time of the last wrong PIN [s on the stand's clock].
    wrong_at: f64,
    /// End of the pause [s on the stand's clock].
    closed_until: f64,
}

/// Result of entering a digit.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum PinResult {
    /// The PIN is not complete yet.
    GoesOn,
    /// The PIN was right.
    Right,
    /// The PIN was wrong.
    Wrong,
    /// The digit came during a pause and was ignored.
    TooEarly,
}

impl Entrance {
    /// Adds `seconds` [s] to the holding time, or resets the holding time if `is_held` is false. Returns
    /// whether the entrance opens.
    pub fn pass(&mut self, is_held: bool, seconds: f32) -> bool {
        self.held = if is_held { self.held + seconds } else { 0.0 };
        let opens = self.held > HELD;
        if opens {
            self.held = 0.0;
            self.entered.clear();
        }
        opens
    }

    /// Fraction of the holding time that has passed. `None` until the hold is clearly intended.
    pub fn held(&self) -> Option<f32> {
        let share = self.held / HELD;
        (share > HESITATION).then_some(share)
    }

    /// Remaining pause [s] at `now` [s on the stand's clock].
    pub fn pause(&self, now: f64) -> f64 {
        (self.closed_until - now).max(0.0)
    }

    /// Whether the last PIN was wrong and no new one has been begun.
    pub fn was_wrong(&self) -> bool {
        self.wrong > 0 && self.entered.is_empty()
    }

    /// Enters a digit at `now` [s on the stand's clock].
    pub fn enter(&mut self, digit: char, pin: &Pin, now: f64) -> PinResult {
        if self.pause(now) > 0.0 {
            return PinResult::TooEarly;
        }
        if now - self.wrong_at > FORGIVEN {
            self.wrong = 0;
        }
        self.entered.push(digit);
        if self.entered.len() < pin.0.len() {
            return PinResult::GoesOn;
        }
        if std::mem::take(&mut self.entered) == pin.0 {
            self.wrong = 0;
            return PinResult::Right;
        }
        self.wrong += 1;
        self.wrong_at = now;
        if self.wrong >= SLIPS {
            let doubled = PAUSE * f64::from(self.wrong - SLIPS).exp2();
            self.closed_until = now + doubled.min(LONGEST);
        }
        PinResult::Wrong
    }
}

/// Returns whether the chord is held: the buttons that open the entry for staff while they are held together.
pub fn is_chord(device: &Device) -> bool {
    let is_down = |index: &usize| device.buttons.get(*index).is_some_and(|button| button.down);
    match &device.pad {
        Some(pad) => CHORD.iter().all(|&button| pad.button(button).down),
        None => STICK_CHORD.iter().all(is_down),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pin() -> Pin {
        Pin("2004".into())
    }

    fn enter(entrance: &mut Entrance, digits: &str, now: f64) -> PinResult {
        let answers = digits
            .chars()
            .map(|digit| entrance.enter(digit, &pin(), now));
        answers.last().unwrap()
    }

    #[test]
    fn entrance_opens_after_uninterrupted_hold() {
        let mut entrance = Entrance::default();
        for _ in 0..10 {
            assert!(!entrance.pass(true, 2.9));
            assert!(!entrance.pass(false, 0.1));
        }
        assert!(!entrance.pass(true, 0.5));
        assert_eq!(entrance.held(), None, "a short touch reveals nothing");
        assert!(!entrance.pass(true, 2.4));
        assert!(entrance.held().is_some_and(|share| share > 0.9));
        assert!(entrance.pass(true, 0.2));
    }

    #[test]
    fn pauses_limit_guesses_to_40_a_day() {
        let mut entrance = Entrance::default();
        let (mut now, mut tried) = (0.0, 0);
        // An attacker tries for a whole day at full speed.
        while now < 86_400.0 {
            now += 1.0 + entrance.pause(now);
            assert_eq!(enter(&mut entrance, "1234", now), PinResult::Wrong);
            tried += 1;
        }
        assert!(tried < 40, "{tried}");
        now += entrance.pause(now) - 1.0;
        assert_eq!(enter(&mut entrance, "2004", now), PinResult::TooEarly);
        assert_eq!(enter(&mut entrance, "2004", now + 2.0), PinResult::Right);
        assert_eq!(entrance.pause(now + 2.0), 0.0);
    }

    #[test]
    fn one_wrong_pin_causes_no_pause() {
        let mut entrance = Entrance::default();
        assert_eq!(enter(&mut entrance, "200", 0.0), PinResult::GoesOn);
        assert_eq!(enter(&mut entrance, "5", 0.0), PinResult::Wrong);
        assert_eq!(enter(&mut entrance, "2004", 0.0), PinResult::Right);
    }
}

//! Who may look behind the stand: a hidden entrance, a number, and no guessing.

use super::config::Pin;
use sticks::{Device, PadButton};

/// The entrance opens when it is held for so long [s].
pub const HELD: f32 = 3.0;
/// Who only touched it is shown nothing: it is hidden for such a share of that time.
const HESITATION: f32 = 0.3;
/// So many wrong numbers are taken for slips of a finger; then there is a pause, twice as long after each further one.
const SLIPS: u32 = 3;
const PAUSE: f64 = 30.0;
const LONGEST: f64 = 3600.0;
/// After a quiet time of so long wrong ones are forgiven [s].
const FORGIVEN: f64 = 6.0 * 3600.0;

/// The buttons of a pad that open the entrance together.
const CHORD: [PadButton; 3] = [
    PadButton::LeftShoulder,
    PadButton::RightShoulder,
    PadButton::Start,
];
/// Those of a plain stick, counted from 0: not the two that every hand finds.
const STICK_CHORD: [usize; 2] = [2, 3];

/// What staff can look at.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum Page {
    /// What visitors did today.
    #[default]
    Today,
    /// How the stand is.
    Health,
    /// What the stand is like.
    Settings,
    /// Whether it is to end.
    End,
}

impl Page {
    /// Those that there is a way to from each other.
    pub const ALL: [Self; 3] = [Self::Today, Self::Health, Self::Settings];
}

/// The entrance.
#[derive(Debug, Default)]
pub struct Entrance {
    /// For how long it was held [s].
    held: f32,
    /// The digits that were entered.
    pub entered: String,
    /// How many numbers were wrong since the last right one.
    wrong: u32,
    /// When the last one was [s on the stand's clock].
    wrong_at: f64,
    /// Until when no number is looked at [s on the stand's clock].
    closed_until: f64,
}

/// What comes of a number.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Answer {
    /// It is not all there yet.
    GoesOn,
    /// It was right.
    Right,
    /// It was wrong.
    Wrong,
    /// It came in a pause.
    TooEarly,
}

impl Entrance {
    /// Lets time pass [s] in which it was held or not; whether it opens.
    pub fn pass(&mut self, is_held: bool, seconds: f32) -> bool {
        self.held = if is_held { self.held + seconds } else { 0.0 };
        let opens = self.held > HELD;
        if opens {
            self.held = 0.0;
            self.entered.clear();
        }
        opens
    }

    /// Which share of the time it has been held, once it is clear that it is held on purpose.
    pub fn held(&self) -> Option<f32> {
        let share = self.held / HELD;
        (share > HESITATION).then_some(share)
    }

    /// For how long no number is looked at [s], at a time on the stand's clock [s].
    pub fn pause(&self, now: f64) -> f64 {
        (self.closed_until - now).max(0.0)
    }

    /// Whether the last number was wrong, and none is being entered since.
    pub fn was_wrong(&self) -> bool {
        self.wrong > 0 && self.entered.is_empty()
    }

    /// A digit was entered, at a time on the stand's clock [s].
    pub fn enter(&mut self, digit: char, pin: &Pin, now: f64) -> Answer {
        if self.pause(now) > 0.0 {
            return Answer::TooEarly;
        }
        if now - self.wrong_at > FORGIVEN {
            self.wrong = 0;
        }
        self.entered.push(digit);
        if self.entered.len() < pin.0.len() {
            return Answer::GoesOn;
        }
        if std::mem::take(&mut self.entered) == pin.0 {
            self.wrong = 0;
            return Answer::Right;
        }
        self.wrong += 1;
        self.wrong_at = now;
        if self.wrong >= SLIPS {
            let doubled = PAUSE * f64::from(self.wrong - SLIPS).exp2();
            self.closed_until = now + doubled.min(LONGEST);
        }
        Answer::Wrong
    }
}

/// Whether the chord is held that opens the entrance.
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

    fn enter(entrance: &mut Entrance, digits: &str, now: f64) -> Answer {
        let answers = digits
            .chars()
            .map(|digit| entrance.enter(digit, &pin(), now));
        answers.last().unwrap()
    }

    #[test]
    fn the_entrance_opens_when_it_is_held_for_long_without_a_break() {
        let mut entrance = Entrance::default();
        for _ in 0..10 {
            assert!(!entrance.pass(true, 2.9));
            assert!(!entrance.pass(false, 0.1));
        }
        assert!(!entrance.pass(true, 0.5));
        assert_eq!(entrance.held(), None, "a touch shows nothing");
        assert!(!entrance.pass(true, 2.4));
        assert!(entrance.held().is_some_and(|share| share > 0.9));
        assert!(entrance.pass(true, 0.2));
    }

    #[test]
    fn nobody_gets_in_by_guessing() {
        let mut entrance = Entrance::default();
        let (mut now, mut tried) = (0.0, 0);
        // Who sits there for a day, as fast as it goes.
        while now < 86_400.0 {
            now += 1.0 + entrance.pause(now);
            assert_eq!(enter(&mut entrance, "1234", now), Answer::Wrong);
            tried += 1;
        }
        assert!(tried < 40, "{tried}");
        now += entrance.pause(now) - 1.0;
        assert_eq!(enter(&mut entrance, "2004", now), Answer::TooEarly);
        assert_eq!(enter(&mut entrance, "2004", now + 2.0), Answer::Right);
        assert_eq!(entrance.pause(now + 2.0), 0.0);
    }

    #[test]
    fn staff_may_slip() {
        let mut entrance = Entrance::default();
        assert_eq!(enter(&mut entrance, "200", 0.0), Answer::GoesOn);
        assert_eq!(enter(&mut entrance, "5", 0.0), Answer::Wrong);
        assert_eq!(enter(&mut entrance, "2004", 0.0), Answer::Right);
    }
}

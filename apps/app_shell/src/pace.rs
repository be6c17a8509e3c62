//! How many ticks a frame plays: as many as time has passed, as far as the machine can bear them.
//!
//! Where it cannot, the round goes slower, evenly: a frame then plays one tick and is shown, instead of more and more
//! of them in longer and longer frames. What was missed is not caught up on.

use fuwafuwa::TICK;

/// Ticks in a frame take no longer than this together, but for the first [s]: with the time to draw, a frame then
/// lasts a thirtieth of a second or so.
const BUDGET: f64 = 0.025;
/// After a long frame no more ticks than this are caught up on.
const MOST_TICKS: u32 = 6;
/// By this share the expected cost of a tick follows that of the last one: one hitch changes little.
const ADAPTS: f64 = 0.1;

/// How many ticks a frame plays.
#[derive(Clone, Debug, Default)]
pub struct Pace {
    /// Time that has passed and was not played yet [s].
    owed: f64,
    /// What a tick is expected to cost [s].
    cost: f64,
    /// In this frame: ticks, and what they cost [s].
    ticks: u32,
    spent: f64,
}

impl Pace {
    /// A frame begins, `seconds` after the last one.
    pub fn begin(&mut self, seconds: f64) {
        self.owed += seconds;
        (self.ticks, self.spent) = (0, 0.0);
    }

    /// Nothing is owed any more.
    pub fn forget(&mut self) {
        self.owed = 0.0;
    }

    /// Whether the frame is to play one more tick, which is then to be [noted](Self::note).
    pub fn is_due(&mut self) -> bool {
        let tick = f64::from(TICK);
        if self.owed < tick {
            return false;
        }
        let is_first = self.ticks == 0;
        let bears = self.ticks < MOST_TICKS && self.spent + self.cost <= BUDGET;
        if is_first || bears {
            self.owed -= tick;
            return true;
        }
        // The next frame begins with a tick, and no more is made up for.
        self.owed = tick;
        false
    }

    /// What a tick costs [s], as far as is known.
    pub fn cost(&self) -> f64 {
        self.cost
    }

    /// A tick was played, and cost so much [s].
    pub fn note(&mut self, cost: f64) {
        self.ticks += 1;
        self.spent += cost;
        let share = if self.cost == 0.0 { 1.0 } else { ADAPTS };
        self.cost += share * (cost - self.cost);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How a minute of it looks: frames a second, the longest frame [s], and ticks played of those that should be.
    struct Seen {
        frames: f64,
        longest: f64,
        speed: f64,
        /// By how much the ticks of single seconds differ, as a share.
        uneven: f64,
    }

    /// A clock that goes on by what ticks and pictures cost [s]; a screen shows `rate` pictures a second at most.
    fn minute(tick: f64, picture: f64, rate: f64) -> Seen {
        let (mut pace, mut now, mut last) = (Pace::default(), 0.0f64, 0.0f64);
        let (mut frames, mut longest) = (0, 0.0f64);
        let mut by_second = vec![0u32; 60];
        while now < 60.0 {
            let began = now;
            pace.begin(now - last);
            last = now;
            while pace.is_due() {
                // Costs swing by a fifth, as they do when bodies are torn.
                let cost = tick * (1.0 + 0.2 * (37.0 * now).sin());
                now += cost;
                pace.note(cost);
                by_second[(now as usize).min(59)] += 1;
            }
            now += picture;
            now = now.max(began + 1.0 / rate);
            frames += 1;
            longest = longest.max(now - began);
        }
        let ticks: u32 = by_second.iter().sum();
        let whole = &by_second[1..59];
        let (least, most) = (whole.iter().min(), whole.iter().max());
        let uneven = f64::from(most.unwrap() - least.unwrap()) / (f64::from(ticks) / 60.0);
        Seen {
            frames: f64::from(frames) / 60.0,
            longest,
            speed: f64::from(ticks) / 3600.0,
            uneven,
        }
    }

    #[test]
    fn what_takes_too_long_makes_the_game_slower_evenly_and_never_jerky() {
        let mut before: Option<Seen> = None;
        for cost in 2..=60 {
            let seen = minute(1e-3 * f64::from(cost), 3e-3, 60.0);
            let told = format!(
                "{cost} ms a tick: {:.1} frames/s, {:.1} ms the longest, {:.0} % of the speed, {:.0} % uneven",
                seen.frames,
                1e3 * seen.longest,
                100.0 * seen.speed,
                100.0 * seen.uneven
            );
            // As fast as it should go while there is time for it.
            if cost <= 12 {
                assert!(seen.speed > 0.98 && seen.frames > 45.0, "{told}");
            }
            // Else it takes what there is: no time goes by idly, and a frame is a tick and its picture.
            let cost = 1e-3 * f64::from(cost);
            assert!(seen.longest < (1.25 * cost).max(BUDGET) + 4e-3, "{told}");
            assert!(
                seen.speed > 0.9 * (f64::from(TICK) / (cost + 3e-3)).min(1.0),
                "{told}"
            );
            assert!(seen.uneven < 0.15, "{told}");
            // No cliff.
            if let Some(before) = before {
                assert!(seen.speed > 0.85 * before.speed, "{told}");
                assert!(seen.frames > 0.75 * before.frames, "{told}");
            }
            before = Some(seen);
        }
    }

    #[test]
    fn a_fast_screen_and_a_slow_picture_change_no_speed() {
        for (picture, rate) in [(1e-3, 144.0), (3e-3, 50.0), (15e-3, 60.0), (25e-3, 60.0)] {
            let seen = minute(4e-3, picture, rate);
            assert!(
                (seen.speed - 1.0).abs() < 0.02,
                "{picture} {rate}: {}",
                seen.speed
            );
        }
    }

    #[test]
    fn a_hitch_is_not_caught_up_on() {
        let mut pace = Pace::default();
        pace.begin(5.0);
        let mut played = 0;
        while pace.is_due() {
            pace.note(1e-4);
            played += 1;
        }
        assert_eq!(played, MOST_TICKS);
        pace.begin(0.0);
        assert!(pace.is_due(), "one tick is owed at the most");
        pace.note(1e-4);
        assert!(!pace.is_due());
    }
}

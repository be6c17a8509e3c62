//! Number of ticks for each frame: real time, limited by the speed of the machine.
//!
//! On a slow machine the simulation slows down evenly: each frame plays one tick and is shown. Missed time is
//! dropped, because catching up would need ever more ticks in ever longer frames.

use fuwafuwa::DEFAULT_TICK;

/// Time limit for all ticks of a frame together [s]; the first tick is always played. Including the time to
/// draw, a frame then takes about 1/30 s.
const BUDGET: f64 = 0.025;
/// Maximum number of ticks in a frame, for example after a long frame.
const MOST_TICKS: u32 = 6;
/// Smoothing factor of the expected cost of a tick, 0 to 1. A small value keeps a single slow tick from
/// changing the estimate much.
const ADAPTS: f64 = 0.1;

/// Scheduler of the ticks of each frame.
#[derive(Clone, Debug, Default)]
pub struct Pace {
    /// Real time that has passed but is not simulated yet [s].
    owed: f64,
    /// Expected cost of a tick [s]; 0 = not measured yet.
    cost: f64,
    /// Number of ticks played in this frame.
    ticks: u32,
    /// Total computing time of the ticks of this frame [s].
    spent: f64,
}

impl Pace {
    /// Begins a frame, `seconds` after the previous one.
    pub fn begin(&mut self, seconds: f64) {
        self.owed += seconds;
        (self.ticks, self.spent) = (0, 0.0);
    }

    /// Drops the real time that is not simulated yet.
    pub fn forget(&mut self) {
        self.owed = 0.0;
    }

    /// Returns whether another tick is due in this frame. If so, the caller must play the tick and report its
    /// computing time with [`Self::note`].
    pub fn is_due(&mut self) -> bool {
        let tick = f64::from(DEFAULT_TICK);
        if self.owed < tick {
            return false;
        }
        let is_first = self.ticks == 0;
        let bears = self.ticks < MOST_TICKS && self.spent + self.cost <= BUDGET;
        if is_first || bears {
            self.owed -= tick;
            return true;
        }
        // Keeps the time of one tick for the next frame and drops all other missed time.
        self.owed = tick;
        false
    }

    /// Expected computing time of a tick [s]; 0 before the first tick.
    pub fn cost(&self) -> f64 {
        self.cost
    }

    /// Computing time of all ticks of the last frame [s].
    pub fn spent(&self) -> f64 {
        self.spent
    }

    /// Reports a played tick and its computing time [s].
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

    /// Result of a simulated minute.
    struct Seen {
        /// Frames per second.
        frames: f64,
        /// Longest frame [s].
        longest: f64,
        /// Simulated time divided by real time.
        speed: f64,
        /// Difference between the most and the fewest ticks in one second of the minute, relative to the
        /// mean.
        uneven: f64,
    }

    /// Simulates a minute of frames. A tick takes `tick` [s] to compute and a frame `picture` [s] to draw;
    /// the screen shows at most `rate` frames per second.
    fn minute(tick: f64, picture: f64, rate: f64) -> Seen {
        let (mut pace, mut now, mut last) = (Pace::default(), 0.0f64, 0.0f64);
        let (mut frames, mut longest) = (0, 0.0f64);
        let mut by_second = vec![0u32; 60];
        while now < 60.0 {
            let began = now;
            pace.begin(now - last);
            last = now;
            while pace.is_due() {
                // The cost of a tick varies by a fifth, as it does when bodies are torn.
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
    fn pace_slows_down_evenly_if_ticks_are_expensive() {
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
            // Ticks that fit into the frames must run at full speed.
            if cost <= 12 {
                assert!(seen.speed > 0.98 && seen.frames > 45.0, "{told}");
            }
            // If the ticks do not fit into the frames, a frame must take no longer than one tick and its
            // drawing.
            let cost = 1e-3 * f64::from(cost);
            assert!(seen.longest < (1.25 * cost).max(BUDGET) + 4e-3, "{told}");
            assert!(
                seen.speed > 0.9 * (f64::from(DEFAULT_TICK) / (cost + 3e-3)).min(1.0),
                "{told}"
            );
            assert!(seen.uneven < 0.15, "{told}");
            // A tick that costs 1 ms more must not make speed or frame rate drop suddenly.
            if let Some(before) = before {
                assert!(seen.speed > 0.85 * before.speed, "{told}");
                assert!(seen.frames > 0.75 * before.frames, "{told}");
            }
            before = Some(seen);
        }
    }

    #[test]
    fn pace_is_independent_of_frame_rate() {
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
    fn pace_drops_missed_time_after_long_frame() {
        let mut pace = Pace::default();
        pace.begin(5.0);
        let mut played = 0;
        while pace.is_due() {
            pace.note(1e-4);
            played += 1;
        }
        assert_eq!(played, MOST_TICKS);
        pace.begin(0.0);
        assert!(pace.is_due(), "one tick is kept after a long frame");
        pace.note(1e-4);
        assert!(!pace.is_due());
    }
}

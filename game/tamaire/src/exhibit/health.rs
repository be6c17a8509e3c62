//! Frame times of a stand.

use std::collections::VecDeque;

/// Number of frames in the statistics: about one minute at 60 frames per second.
const FRAMES: usize = 4040;

/// Durations of the last frames.
#[derive(Clone, Debug, Default)]
pub struct FrameTimes(VecDeque<f32>);

impl FrameTimes {
    /// Adds a frame that took `seconds` [s].
    pub fn note(&mut self, seconds: f32) {
        if self.0.len() == FRAMES {
            self.0.pop_front();
        }
        self.0.push_back(seconds);
    }

    /// Returns the frame time that `percent` % of the frames did not exceed [s]. `None` before the first
    /// frame.
    pub fn percentile(&self, percent: usize) -> Option<f32> {
        let mut all: Vec<f32> = self.0.iter().copied().collect();
        all.sort_by(f32::total_cmp);
        let last = all.len().checked_sub(1)?;
        all.get(last * percent.min(100) / 100).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_cover_recent_frames_only() {
        let mut times = FrameTimes::default();
        assert_eq!(times.percentile(50), None);
        (0..FRAMES).for_each(|_| times.note(7.0));
        (0..101)
            .cycle()
            .take(101 * 50)
            .for_each(|frame: u8| times.note(frame.into()));
        assert_eq!(times.0.len(), FRAMES);
        assert_eq!(
            [0, 50, 99, 100].map(|percent| times.percentile(percent).unwrap()),
            [0.0, 50.0, 99.0, 100.0]
        );
    }
}

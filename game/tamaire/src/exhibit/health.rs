//! How smoothly a stand runs.

use std::collections::VecDeque;

/// So many frames are remembered, a minute or so.
const FRAMES: usize = 4040;

/// How long the last frames took.
#[derive(Clone, Debug, Default)]
pub struct FrameTimes(VecDeque<f32>);

impl FrameTimes {
    /// A frame took so long [s].
    pub fn note(&mut self, seconds: f32) {
        if self.0.len() == FRAMES {
            self.0.pop_front();
        }
        self.0.push_back(seconds);
    }

    /// Of a hundred frames so many took no longer than this [s]; nothing before the first.
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
    fn frames_are_told_by_their_share() {
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

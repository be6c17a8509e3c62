//! Slack: the distance that a point may move away from its anchor or predicted path until its pairs are searched again.

use crate::math::row::Row;

/// Result of comparing the deviations of points with their slack.
pub struct SlackTest<K> {
    /// Points that deviate by more than their slack.
    pub exceeded: Vec<K>,
    /// Least slack that is left to the other points [m]; infinite without other points.
    pub spare: f32,
}

impl<K: Copy> SlackTest<K> {
    /// Tests `points`. `deviation` returns the deviation of a point and its slack [m], or `None` for a point whose pairs
    /// have never been searched.
    #[inline(always)]
    pub fn of_points(points: &[K], deviation: impl Fn(K) -> Option<(Row, f32)>) -> Self {
        let (mut exceeded, mut spare) = (Vec::new(), f32::INFINITY);
        for &point in points {
            let Some((deviation, slack)) = deviation(point) else {
                continue;
            };
            let squared = deviation.dot(deviation);
            if squared > slack * slack {
                exceeded.push(point);
            } else {
                spare = smaller(spare, slack - squared.sqrt());
            }
        }
        Self { exceeded, spare }
    }
}

/// Returns the smaller of two numbers; `a` if `b` is NaN.
pub fn smaller(a: f32, b: f32) -> f32 {
    if b < a { b } else { a }
}

//! Numbers that summarize others.

/// Returns a quantile of numbers in ascending order: the smallest number that at least `share` (0 to 1) of the
/// numbers do not exceed. If exactly this share does not exceed it, returns the mean of the number and the next
/// one, so that the median of two numbers is their mean. `None` without numbers.
///
/// ```
/// assert_eq!(output::quantile(&[1.0, 4.0], 0.5), Some(2.5));
/// assert_eq!(output::quantile(&[1.0, 4.0, 9.0], 0.5), Some(4.0));
/// ```
pub fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let place = share * sorted.len() as f64;
    // The tolerance allows for rounding of the product.
    let is_between = (place - place.round()).abs() < 1e-9;
    let (low, high) = match is_between {
        true => (place.round() as usize, place.round() as usize + 1),
        false => (place.ceil() as usize, place.ceil() as usize),
    };
    let at = |rank: usize| sorted[rank.saturating_sub(1).min(last)];
    Some(0.5 * (at(low) + at(high)))
}

#[cfg(test)]
mod tests {
    use super::quantile;

    #[test]
    fn quantile_has_known_values() {
        let tens: Vec<f64> = (1..=10).map(f64::from).collect();
        for (share, expected) in [
            (0.0, 1.0),
            (0.04, 1.0),
            (0.1, 1.5),
            (0.25, 3.0),
            (0.3, 3.5),
            (0.5, 5.5),
            (0.75, 8.0),
            (0.9, 9.5),
            (0.99, 10.0),
            (1.0, 10.0),
        ] {
            assert_eq!(quantile(&tens, share), Some(expected), "{share}");
        }
        assert_eq!(quantile(&[], 0.5), None);
        assert_eq!(quantile(&[3.0], 0.5), Some(3.0));
        assert_eq!(quantile(&[1.0, 4.0, 6.0, 9.0], 0.5), Some(5.0));
    }
}

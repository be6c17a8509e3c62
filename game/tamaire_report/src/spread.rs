//! Quantiles, histograms and confidence intervals.

use crate::figures::{Bin, Times};
use output::quantile;

/// Maximum number of bins with an upper limit. One more bin holds all longer times.
const MOST_BINS: f64 = 15.0;
/// Possible widths of a bin [s].
const WIDTHS: [f64; 8] = [2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 300.0, 1800.0];

/// Returns the median, rounded to a thousandth. For an even count, the mean of the two middle values.
pub fn median(mut numbers: Vec<f64>) -> Option<f64> {
    numbers.sort_by(f64::total_cmp);
    quantile(&numbers, 0.5).map(thousandth)
}

/// Returns the quantiles and the histogram of times [s].
pub fn times(mut seconds: Vec<f64>) -> Times {
    seconds.sort_by(f64::total_cmp);
    let quantiles = [0.1, 0.25, 0.5, 0.75, 0.9].map(|share| quantile(&seconds, share));
    let quantiles = quantiles.iter().copied().collect::<Option<Vec<f64>>>();
    let Some(most) = quantile(&seconds, 0.95) else {
        return Times::default();
    };
    let fits = |width: &&f64| most < MOST_BINS * **width;
    let width = WIDTHS.iter().find(fits).unwrap_or(&WIDTHS[7]);
    let last = ((most / width) as usize + 1).min(MOST_BINS as usize);
    let mut bins: Vec<Bin> = (0..=last)
        .map(|k| Bin {
            from: k as f64 * width,
            to: (k < last).then_some((k + 1) as f64 * width),
            visits: 0,
        })
        .collect();
    for time in &seconds {
        bins[((time / width) as usize).min(last)].visits += 1;
    }
    let quantiles = quantiles.and_then(|all| all.try_into().ok());
    Times {
        visits: seconds.len() as u64,
        quantiles: quantiles.map(|all: [f64; 5]| all.map(thousandth)),
        bins,
    }
}

/// Rounds to a thousandth. Further digits of times in single precision are meaningless.
pub fn thousandth(number: f64) -> f64 {
    (1000.0 * number).round() / 1000.0
}

/// Returns the 95 % confidence interval of the share `some / all` [Wilson 1927].
pub fn interval(some: u64, all: u64) -> [f64; 2] {
    const Z: f64 = 1.96;
    let n = all.max(1) as f64;
    let share = some as f64 / n;
    let middle = share + Z * Z / (2.0 * n);
    let half = Z * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
    [-half, half].map(|half| ((middle + half) / (1.0 + Z * Z / n)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_an_even_count_is_the_mean_of_the_middle() {
        assert_eq!(median(vec![]), None);
        assert_eq!(median(vec![3.0]), Some(3.0));
        assert_eq!(median(vec![4.0, 1.0]), Some(2.5));
        assert_eq!(median(vec![9.0, 1.0, 4.0]), Some(4.0));
        assert_eq!(times(vec![10.0, 30.0]).quantiles.unwrap()[2], 20.0);
    }

    #[test]
    fn times_fall_into_exactly_one_bin() {
        for scale in [0.0, 0.01, 1.0, 7.0, 100.0, 1e4, 1e9] {
            let seconds: Vec<f64> = (0..100).map(|k| scale * f64::from(k * k) / 1e4).collect();
            let times = times(seconds.clone());
            assert_eq!(times.bins.iter().map(|bin| bin.visits).sum::<u64>(), 100);
            assert!(times.bins.len() <= 16);
            for bin in &times.bins {
                let is_in = |time: &&f64| bin.from <= **time && bin.to.is_none_or(|to| **time < to);
                assert_eq!(bin.visits, seconds.iter().filter(is_in).count() as u64);
            }
        }
    }

    #[test]
    fn interval_is_wide_for_few_visits() {
        // Interval for 10 of 20, compared with published tables.
        let [low, high] = interval(10, 20);
        assert!(
            (low - 0.299).abs() < 0.001 && (high - 0.701).abs() < 0.001,
            "{low} {high}"
        );
        assert_eq!(interval(0, 0), [0.0, interval(0, 0)[1]]);
        let [low, high] = interval(5000, 10_000);
        assert!((low - 0.49).abs() < 0.001 && (high - 0.51).abs() < 0.001);
    }
}

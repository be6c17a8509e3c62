//! Boundary-value problems of slender rods: ordinary differential equations by the classical Runge–Kutta method,
//! and roots by bisection.

/// Number of integration steps. Half as many change the references of the checks by less than 1e-9.
const STEPS: usize = 400;
/// Number of bisections. The interval shrinks below the spacing of `f64`.
const BISECTIONS: usize = 60;

/// Integrates y' = `rate`(x, y) from 0 to `length`, beginning with `state`.
pub fn integrate<const N: usize>(
    mut state: [f64; N],
    length: f64,
    rate: impl Fn(f64, [f64; N]) -> [f64; N],
) -> [f64; N] {
    let step = length / STEPS as f64;
    let ahead = |state: [f64; N], by: f64, rate: [f64; N]| {
        std::array::from_fn::<f64, N, _>(|k| state[k] + by * rate[k])
    };
    for index in 0..STEPS {
        let x = index as f64 * step;
        let first = rate(x, state);
        let second = rate(x + 0.5 * step, ahead(state, 0.5 * step, first));
        let third = rate(x + 0.5 * step, ahead(state, 0.5 * step, second));
        let fourth = rate(x + step, ahead(state, step, third));
        for k in 0..N {
            state[k] += step / 6.0 * (first[k] + 2.0 * (second[k] + third[k]) + fourth[k]);
        }
    }
    state
}

/// Returns the root of a function that has different signs at `low` and `high`.
pub fn root(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
    let is_positive = of(low) > 0.0;
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if (of(middle) > 0.0) == is_positive {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_of_a_swing_takes_the_time_of_the_cosine() {
        let at = |time| integrate([1.0, 0.0], time, |_, [x, v]| [v, -x])[0];
        let quarter = root(1.0, 2.0, at);
        assert!(
            (quarter - std::f64::consts::FRAC_PI_2).abs() < 1e-9,
            "{quarter}"
        );
    }
}

//! Break of a bar under tension.

use crate::soft_body::element_law::Elasticity;
use crate::soft_body::hyperelasticity::{self, StressLaw};
use glam::DVec3;

/// State in which a bar breaks under tension.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct TensileBreak {
    /// Stretch: length divided by the original length.
    pub stretch: f64,
    /// True (Cauchy) stress [Pa]: force per area of the stretched cross section.
    pub true_stress: f64,
}

impl TensileBreak {
    /// Returns the state in which the force per original area of a bar reaches `nominal` [Pa].
    pub(super) fn at(elasticity: Elasticity, law: StressLaw, nominal: f64) -> Self {
        let stress = |stretch| nominal_stress(elasticity, law, stretch)[0];
        let [mut low, mut high] = [1.0, 2.0];
        while stress(high) < nominal && high < 1e6 {
            [low, high] = [high, 2.0 * high];
        }
        let stretch = bisect(low, high, |stretch| stress(stretch) < nominal);
        let [nominal, area] = nominal_stress(elasticity, law, stretch);
        Self {
            stretch,
            true_stress: nominal / area,
        }
    }
}

/// Returns the force per original area [Pa] of a bar with free sides at a stretch, and its cross section divided by the
/// original one.
fn nominal_stress(elasticity: Elasticity, law: StressLaw, stretch: f64) -> [f64; 2] {
    let Some(factors) = law.factors() else {
        // The corotational law is linear in the stretch, and so is the width.
        let strain = stretch - 1.0;
        let width = (1.0 - elasticity.poisson * strain).max(0.0);
        return [elasticity.young * strain, width * width];
    };
    let stress = |width: f64| {
        let rows = [[stretch, 0.0, 0.0], [0.0, width, 0.0], [0.0, 0.0, width]];
        let stress = hyperelasticity::stress(elasticity, factors, &rows.map(DVec3::from));
        [stress[0].x, stress[1].y]
    };
    // The sides are free: a bar that is too narrow is pressed there.
    let width = bisect(0.0, 1.0, |width| stress(width)[1] < 0.0);
    [stress(width)[0], width * width]
}

/// Returns the place between `low` and `high` up to which a condition holds.
fn bisect(mut low: f64, mut high: f64, is_below: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match is_below(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    0.5 * (low + high)
}

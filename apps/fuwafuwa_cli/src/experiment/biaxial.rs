//! Rubber stretched along two axes: a law fitted to uniaxial tension alone, and to all tests.
//!
//! ```text
//!     equibiaxial ↑            pure shear
//!            ┌────┐           ═════════════  held
//!         ←  │    │  →        ↑           ↑
//!            └────┘           ═════════════
//!              ↓
//! ```
//!
//! Rubber with 8 % sulphur: L. R. G. Treloar, Transactions of the Faraday Society 40 (1944). Isoprene rubber: S. Kawabata
//! et al., Macromolecules 14 (1981), [doi:10.1021/ma50002a032](https://doi.org/10.1021/ma50002a032).
//!
//! The law of Yeoh depends on the first invariant of the strain only. Rubber also depends, weakly, on the second, which
//! grows most in equibiaxial tension. A law fitted to uniaxial tension alone therefore gives too little stress in
//! equibiaxial tension, by 10 to 22 %, and in pure shear, by 5 to 8 %. The ends of Kawabata's curves are exceptions, by +1 and
//! +6 %: there, the law is used at invariants beyond those of its fit. These rows are for comparison. The
//! law that is fitted to all three tests misses them by 2 to 7 % of their largest stress. The engine must give the stress of
//! this law. It misses the bound of 2 % in equibiaxial tension, because the law keeps the volume: by Hooke's law, a Poisson's
//! ratio of 0.49 lowers the stress at small strains by 0.7 % in uniaxial tension, 2.0 % in pure shear and 2.6 % in
//! equibiaxial tension.

use super::uniaxial::{computed, fit_rows};
use super::{Bound, Record, Role, Row, Setup, patch};
use crate::check::parallel;
use crate::material::fit::{self, Fit, Law, Mode, Sample};
use crate::plot::{Curve, Plot, Points};
use crate::report::{Progress, digits};
use anyhow::Result;
use std::time::Instant;

/// Tests of a rubber, with their tables.
const RUBBERS: [(&str, [&str; 3]); 2] = [
    (
        "Treloar's rubber",
        [
            include_str!("data/treloar_uniaxial.csv"),
            include_str!("data/treloar_equibiaxial.csv"),
            include_str!("data/treloar_pure_shear.csv"),
        ],
    ),
    (
        "Kawabata's rubber",
        [
            include_str!("data/kawabata_uniaxial.csv"),
            include_str!("data/kawabata_equibiaxial.csv"),
            include_str!("data/kawabata_pure_shear.csv"),
        ],
    ),
];
const MODES: [(Mode, &str); 3] = [
    (Mode::Uniaxial, "uniaxial"),
    (Mode::Equibiaxial, "equibiaxial"),
    (Mode::PureShear, "pure shear"),
];

/// Returns the points of the three tests of a rubber.
fn tests(tables: [&str; 3]) -> Result<[Vec<Sample>; 3]> {
    let mut all = [const { Vec::new() }; 3];
    for ((points, table), (mode, name)) in all.iter_mut().zip(tables).zip(MODES) {
        let curve = fit::parse(name, table)?;
        *points = { curve.into_iter().filter(|(_, stress)| *stress != 0.0) }
            .map(|(stretch, stress)| Sample {
                mode,
                stretch,
                stress,
            })
            .collect();
    }
    Ok(all)
}

/// Stretches blocks of both rubbers, with both fits.
pub fn experiment(progress: &Progress) -> Result<Record> {
    let mut cases = Vec::new();
    for (name, tables) in RUBBERS {
        let tests = tests(tables)?;
        for is_whole in [false, true] {
            let samples = if is_whole {
                tests.concat()
            } else {
                tests[0].clone()
            };
            cases.push((name, is_whole, Fit::to(Law::Yeoh, &samples)?, tests.clone()));
        }
    }
    let found = parallel::each(&cases, progress, |(_, _, fit, tests)| {
        let start = Instant::now();
        let stresses: Result<Vec<Vec<f64>>> = { tests.iter() }
            .map(|points| computed(fit, points))
            .collect();
        Ok((stresses?, start.elapsed().as_secs_f64()))
    })?;
    let mut record = Record::default();
    for ((name, is_whole, fit, tests), (found, seconds)) in cases.iter().zip(found) {
        let mut plot = Plot {
            x: "stretch".into(),
            y: "engineering stress [MPa]".into(),
            ..Plot::default()
        };
        let basis = if *is_whole {
            "all tests"
        } else {
            "uniaxial test"
        };
        for (index, (_, mode)) in MODES.into_iter().enumerate() {
            let (points, stresses) = (&tests[index], &found[index]);
            let case = format!("{name}, {mode}, law of {basis}");
            match *is_whole {
                true => {
                    let rows = fit_rows(&case, fit, points, stresses, seconds);
                    record.rows.extend(rows);
                }
                false if index > 0 => {
                    let rows = predictions(&case, points, stresses, seconds);
                    record.rows.extend(rows);
                }
                false => {}
            }
            let measured = points.iter().map(|one| (one.stretch, 1e-6 * one.stress));
            let computed =
                { points.iter().zip(stresses) }.map(|(one, stress)| (one.stretch, 1e-6 * stress));
            plot.curves.push(Curve::new(measured).named(mode));
            plot.points.push(Points::new(mode, computed));
        }
        plot.x = format!("stretch: {name}, law of {basis}");
        record.plots.push(plot);
    }
    Ok(record)
}

/// Returns the stresses at the point in the middle of a curve and at its end.
fn predictions(case: &str, points: &[Sample], stresses: &[f64], seconds: f64) -> Vec<Row> {
    let last = points.len() - 1;
    let row = |index: usize| Row {
        case: format!(
            "{case}, engineering stress at stretch {} [MPa]",
            digits(points[index].stretch)
        ),
        role: Role::Prediction,
        reference: Some(1e-6 * points[index].stress),
        spread: None,
        computed: 1e-6 * stresses[index],
        bound: Bound::None,
        setup: Setup {
            n: patch::ACROSS,
            substeps: None,
            seconds,
        },
    };
    [last / 2, last].map(row).into()
}

#[cfg(test)]
mod tests_of_fits {
    use super::*;

    #[test]
    fn fits_of_all_tests_are_those_of_an_independent_fit() {
        // C₁, C₂ and C₃ [Pa] by scipy with the same weights.
        for ((_, tables), constants) in RUBBERS
            .into_iter()
            .zip([[1.895e5, -1542.0, 40.88], [1.979e5, -4602.0, 182.0]])
        {
            let fit = Fit::to(Law::Yeoh, &tests(tables).unwrap().concat()).unwrap();
            let fitted =
                [0.5, 0.5 * fit.second, 0.5 * fit.third].map(|one| one * fit.shear_modulus);
            for (fitted, scipy) in fitted.into_iter().zip(constants) {
                assert!((fitted / scipy - 1.0).abs() < 0.02, "{fitted} {scipy}");
            }
        }
    }
}

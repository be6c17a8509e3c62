//! Plots of checks, as SVG.

use std::ops::RangeInclusive;

/// Number of points of a sampled curve.
const SAMPLES: usize = 60;

/// Measured points upon curves of theory or of another reference.
#[derive(Clone, Debug, Default)]
pub struct Plot {
    /// Quantity along the horizontal axis, with its unit in brackets.
    pub x: String,
    /// Quantity along the vertical axis, with its unit in brackets.
    pub y: String,
    /// Curves of the reference.
    pub curves: Vec<Curve>,
    /// Measured points.
    pub points: Vec<Points>,
    /// Allowed range of the vertical axis, drawn as a band.
    pub band: Option<RangeInclusive<f64>>,
    /// Whether the horizontal and the vertical axis are logarithmic.
    pub is_log: [bool; 2],
}

/// Curve of a reference.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Name in the legend; empty if the curve is not listed.
    pub name: String,
    /// Points of the curve.
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    /// Returns a curve without a name through points.
    pub fn new(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self {
            name: String::new(),
            points: points.into_iter().collect(),
        }
    }

    /// Returns a curve without a name of a function over a range.
    pub fn sampled(range: RangeInclusive<f64>, of: impl Fn(f64) -> f64) -> Self {
        let (start, end) = (*range.start(), *range.end());
        Self::new((0..=SAMPLES).map(|k| {
            let x = start + (end - start) * k as f64 / SAMPLES as f64;
            (x, of(x))
        }))
    }

    /// Returns the curve with a name.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..self
        }
    }
}

/// Measured points with the same mark.
#[derive(Clone, Debug)]
pub struct Points {
    /// Name in the legend.
    pub name: String,
    /// Measured points.
    pub points: Vec<(f64, f64)>,
}

impl Points {
    /// Returns points with a name.
    pub fn new(name: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self {
            name: name.into(),
            points: points.into_iter().collect(),
        }
    }
}

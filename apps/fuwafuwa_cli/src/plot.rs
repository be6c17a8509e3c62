//! Plots of checks, as SVG.

use crate::report::{Outcome, digits};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;
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

    /// Adds a point to the series with a name, or begins this series.
    pub fn add(series: &mut Vec<Self>, name: String, point: (f64, f64)) {
        match series.iter_mut().find(|points| points.name == name) {
            Some(points) => points.points.push(point),
            None => series.push(Self::new(name, [point])),
        }
    }
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn Error>>;

/// Units of coordinates in the file per pixel, so that rounding to whole units leaves curves smooth.
const UNITS: i32 = 4;
/// Width of a picture.
const WIDTH: i32 = px(900);
/// Height of a plot with axes.
const HEIGHT: i32 = px(340);
/// Left and right edge of a plot with axes, and margins above and below.
const FRAME: [i32; 4] = [px(84), px(640), px(16), px(56)];
/// Left and right edge of a plot of deviations.
const DEVIATIONS: [i32; 2] = [px(44), px(324)];
/// Upper edge of a plot of deviations.
const TOP: i32 = px(10);
/// Deviation at the edges of a plot of deviations. Larger ones are drawn there.
const EDGE: f64 = 1.5;
/// Number of rows up to which a plot of deviations names its rows.
const NAMED_ROWS: usize = 70;
/// Height of a row, with and without its name.
const ROW: [i32; 2] = [px(16), px(4)];
/// Font sizes: 13 and 11 px, in the unit of the crate plotters.
const LETTERS: [f64; 2] = [13.0 * 1.24 * UNITS as f64, 11.0 * 1.24 * UNITS as f64];
/// Approximate number of intervals between the marks of an axis.
const INTERVALS: f64 = 6.0;

const INK: RGBColor = RGBColor(0x33, 0x33, 0x33);
const GRID: RGBColor = RGBColor(0xDD, 0xDD, 0xDD);
const BAND: RGBColor = RGBColor(0xE3, 0xEF, 0xE3);
const RED: RGBColor = RGBColor(0xC8, 0x2A, 0x2A);
/// Colours of curves and points, distinguishable by colour-blind readers \[Okabe and Ito\].
const COLOURS: [RGBColor; 6] = [
    RGBColor(0x00, 0x72, 0xB2),
    RGBColor(0xD5, 0x5E, 0x00),
    RGBColor(0x00, 0x9E, 0x73),
    RGBColor(0xCC, 0x79, 0xA7),
    RGBColor(0x56, 0xB4, 0xE9),
    RGBColor(0xE6, 0x9F, 0x00),
];

/// Draws plots below each other, as SVG.
pub fn svg_of_plots(plots: &[Plot]) -> String {
    svg(HEIGHT * plots.len() as i32, |area| {
        for (index, plot) in plots.iter().enumerate() {
            plot.draw(area, HEIGHT * index as i32)?;
        }
        Ok(())
    })
}

/// Draws the deviation of each outcome from its reference, in units of its bound, as SVG. Outcomes without a bound
/// are left out.
pub fn svg_of_deviations(outcomes: &[Outcome]) -> String {
    let rows: Vec<(usize, &Outcome, f64)> = { outcomes.iter().enumerate() }
        .filter_map(|(index, outcome)| Some((index + 1, outcome, outcome.deviation()?)))
        .collect();
    let is_named = rows.len() <= NAMED_ROWS;
    let pitch = if is_named { ROW[0] } else { ROW[1] };
    let bottom = TOP + pitch * rows.len() as i32;
    svg(bottom + px(48), |area| {
        let [left, right] = match is_named {
            true => DEVIATIONS,
            false => [DEVIATIONS[0], WIDTH - DEVIATIONS[0]],
        };
        let x = |deviation: f64| {
            let share = (deviation.clamp(-EDGE, EDGE) + EDGE) / (2.0 * EDGE);
            left + (share * f64::from(right - left)).round() as i32
        };
        let band = [(x(-1.0), TOP), (x(1.0), bottom)];
        area.draw(&Rectangle::new(band, BAND.filled()))?;
        for at in [-1.0, 0.0, 1.0] {
            line(area, [(x(at), TOP), (x(at), bottom)], &GRID, 1)?;
            write(
                area,
                &at.to_string(),
                (x(at), bottom + px(5)),
                HPos::Center,
                0,
            )?;
        }
        line(area, [(left, bottom), (right, bottom)], &INK, 1)?;
        let title = "deviation / bound";
        write(
            area,
            title,
            ((left + right) / 2, bottom + px(24)),
            HPos::Center,
            0,
        )?;
        for (row, &(number, outcome, deviation)) in rows.iter().enumerate() {
            let y = TOP + pitch * row as i32 + pitch / 2;
            let colour = if outcome.pass == Some(false) {
                RED
            } else {
                COLOURS[0]
            };
            let radius = px(if is_named { 4 } else { 2 });
            area.draw(&Circle::new((x(deviation), y), radius, colour.filled()))?;
            if is_named || number == 1 || number % 20 == 0 {
                write(
                    area,
                    &number.to_string(),
                    (left - px(8), y - px(7)),
                    HPos::Right,
                    1,
                )?;
            }
            if is_named {
                write(
                    area,
                    &outcome.case,
                    (right + px(12), y - px(7)),
                    HPos::Left,
                    1,
                )?;
            }
        }
        Ok(())
    })
}

impl Plot {
    /// Draws the plot with its upper edge at `top`.
    fn draw(&self, area: &Area, top: i32) -> Drawn {
        let [left, right, above, below] = FRAME;
        let (high, low) = (top + above, top + HEIGHT - below);
        let curves = self.curves.iter().flat_map(|curve| &curve.points);
        let points = self.points.iter().flat_map(|points| &points.points);
        let values: Vec<(f64, f64)> = curves.chain(points).copied().collect();
        let band = self
            .band
            .iter()
            .flat_map(|band| [*band.start(), *band.end()]);
        let x_axis = Axis::around(values.iter().map(|value| value.0), self.is_log[0]);
        let y_axis = Axis::around(
            values.iter().map(|value| value.1).chain(band),
            self.is_log[1],
        );
        let x = |value: f64| left + (x_axis.share(value) * f64::from(right - left)).round() as i32;
        let y = |value: f64| low - (y_axis.share(value) * f64::from(low - high)).round() as i32;
        if let Some(band) = &self.band {
            let corners = [(left, y(*band.end())), (right, y(*band.start()))];
            area.draw(&Rectangle::new(corners, BAND.filled()))?;
        }
        for mark in x_axis.marks() {
            line(area, [(x(mark), high), (x(mark), low)], &GRID, 1)?;
            write(area, &digits(mark), (x(mark), low + px(5)), HPos::Center, 0)?;
        }
        for mark in y_axis.marks() {
            line(area, [(left, y(mark)), (right, y(mark))], &GRID, 1)?;
            write(
                area,
                &digits(mark),
                (left - px(8), y(mark) - px(8)),
                HPos::Right,
                0,
            )?;
        }
        let frame = [
            (left, high),
            (right, high),
            (right, low),
            (left, low),
            (left, high),
        ];
        area.draw(&PathElement::new(frame, INK.stroke_width(UNITS as u32)))?;
        write(
            area,
            &self.x,
            ((left + right) / 2, low + px(26)),
            HPos::Center,
            0,
        )?;
        let upwards = letters(0)
            .transform(FontTransform::Rotate270)
            .pos(Pos::new(HPos::Center, VPos::Top));
        area.draw(&Text::new(
            self.y.clone(),
            (px(8), (high + low) / 2),
            upwards,
        ))?;
        // Curves and points of the same name share a colour and a row of the legend.
        let names = self.curves.iter().map(|curve| &curve.name);
        let mut legend: Vec<&str> = Vec::new();
        for name in names.chain(self.points.iter().map(|points| &points.name)) {
            if !legend.contains(&name.as_str()) && !name.is_empty() {
                legend.push(name);
            }
        }
        let row_of = |name: &str| legend.iter().position(|one| *one == name).unwrap_or(0);
        for curve in &self.curves {
            let row = row_of(&curve.name);
            let path: Vec<_> = curve.points.iter().map(|&(a, b)| (x(a), y(b))).collect();
            let colour = COLOURS[row % COLOURS.len()];
            area.draw(&PathElement::new(
                path,
                colour.stroke_width(2 * UNITS as u32),
            ))?;
            if !curve.name.is_empty() {
                let y = high + px(8 + 20 * row as i32);
                line(area, [(right + px(14), y), (right + px(42), y)], &colour, 2)?;
            }
        }
        for points in &self.points {
            let row = row_of(&points.name);
            for &(a, b) in &points.points {
                mark(area, (x(a), y(b)), row)?;
            }
            mark(area, (right + px(28), high + px(8 + 20 * row as i32)), row)?;
        }
        for (row, name) in legend.iter().enumerate() {
            write(
                area,
                name,
                (right + px(50), high + px(20 * row as i32)),
                HPos::Left,
                0,
            )?;
        }
        Ok(())
    }
}

/// Axis of a plot.
#[derive(Copy, Clone, Debug)]
struct Axis {
    low: f64,
    high: f64,
    is_log: bool,
}

impl Axis {
    /// Returns an axis that contains some values, with some room at both ends. A linear axis begins at 0 if the
    /// smallest value is positive and close to 0.
    fn around(values: impl Iterator<Item = f64> + Clone, is_log: bool) -> Self {
        // A logarithmic axis shows positive values only.
        let shown = values.filter(move |&value| !is_log || value > 0.0);
        let scaled = shown.map(|value| if is_log { value.log10() } else { value });
        let low = scaled.clone().fold(f64::INFINITY, f64::min);
        let high = scaled.fold(f64::NEG_INFINITY, f64::max);
        let room = match high > low {
            true => 0.05 * (high - low),
            false => 0.05 * high.abs().max(1e-3),
        };
        let starts_at_zero = !is_log && low > -1e-6 * high && low < 0.3 * high;
        Self {
            low: if starts_at_zero { 0.0 } else { low - room },
            high: high + room,
            is_log,
        }
    }

    /// Returns the place of a value, from 0 to 1.
    fn share(self, value: f64) -> f64 {
        let scaled = if self.is_log { value.log10() } else { value };
        (scaled - self.low) / (self.high - self.low)
    }

    /// Returns the values with a mark.
    fn marks(self) -> Vec<f64> {
        if self.is_log {
            let factors: &[f64] = if self.high - self.low > 2.5 {
                &[1.0]
            } else {
                &[1.0, 2.0, 5.0]
            };
            let decades = self.low.floor() as i32..=self.high.ceil() as i32;
            return decades
                .flat_map(|decade| {
                    factors
                        .iter()
                        .map(move |factor| factor * 10f64.powi(decade))
                })
                .filter(|mark| (0.0..=1.0).contains(&self.share(*mark)))
                .collect();
        }
        let rough = (self.high - self.low) / INTERVALS;
        let decade = 10f64.powi(rough.log10().floor() as i32);
        let factors = [1.0, 2.0, 5.0, 10.0];
        let step = { factors.iter().map(|factor| factor * decade) }
            .find(|step| *step >= rough)
            .unwrap_or(rough);
        let marks = (self.low / step).ceil() as i64..=(self.high / step).floor() as i64;
        marks.map(|k| k as f64 * step).collect()
    }
}

/// Draws a mark. Rows of the legend differ in shape and colour.
fn mark(area: &Area, at: (i32, i32), row: usize) -> Drawn {
    let style = COLOURS[row % COLOURS.len()];
    match row % 3 {
        0 => area.draw(&Circle::new(at, px(4), style.filled()))?,
        1 => area.draw(&TriangleMarker::new(at, px(6), style.filled()))?,
        _ => {
            let half = px(4);
            let corners = [(at.0 - half, at.1 - half), (at.0 + half, at.1 + half)];
            area.draw(&Rectangle::new(corners, style.filled()))?;
        }
    }
    Ok(())
}

fn line(area: &Area, ends: [(i32, i32); 2], colour: &RGBColor, width: u32) -> Drawn {
    area.draw(&PathElement::new(
        ends,
        colour.stroke_width(width * UNITS as u32),
    ))?;
    Ok(())
}

/// Draws a text with its upper edge at `at`. `side` aligns the text horizontally, and `size` selects one of
/// [`LETTERS`].
fn write(area: &Area, text: &str, at: (i32, i32), side: HPos, size: usize) -> Drawn {
    let style = letters(size).pos(Pos::new(side, VPos::Top));
    area.draw(&Text::new(text.to_string(), at, style))?;
    Ok(())
}

fn letters(size: usize) -> TextStyle<'static> {
    ("sans-serif", LETTERS[size]).into_font().color(&INK)
}

fn svg(height: i32, draw: impl FnOnce(&Area) -> Drawn) -> String {
    let mut text = String::new();
    {
        let size = (WIDTH as u32, height as u32);
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        area.fill(&WHITE)
            .expect("drawing into a string cannot fail");
        draw(&area).expect("drawing into a string cannot fail");
        area.present().expect("drawing into a string cannot fail");
    }
    // The picture has its size in pixels, and coordinates in smaller units.
    let fine = format!("width=\"{WIDTH}\" height=\"{height}\" ");
    let [wide, high] = [WIDTH, height].map(|units| units / UNITS);
    text.replacen(&fine, &format!("width=\"{wide}\" height=\"{high}\" "), 1) + "\n"
}

/// Converts pixels to units of coordinates.
const fn px(pixels: i32) -> i32 {
    pixels * UNITS
}

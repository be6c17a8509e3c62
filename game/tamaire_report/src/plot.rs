//! SVG plots for the page.

use crate::figures::Heat;
use crate::room::{ObjectKind, Stroke};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;

/// Width of a plot [px]. Narrow enough that its text is legible on a phone.
const WIDTH: u32 = 440;
/// Height of a column plot [px].
const HEIGHT: u32 = 270;
/// Font size in units of the crate plotters; appears as 14 px.
const LETTERS: f64 = 14.0 * 1.24;
const INK: RGBColor = RGBColor(0x4A, 0x36, 0x34);
const LINE: RGBColor = RGBColor(0xE6, 0xD8, 0xC8);
/// Outline of pale areas.
const EDGE: RGBColor = RGBColor(0xC2, 0xAD, 0x98);
const WOOD: RGBColor = RGBColor(0x92, 0x7A, 0x70);

/// Colours of the cells of a map, from short to long times.
const SHADES: [RGBColor; 6] = [
    RGBColor(0xFD, 0xE6, 0xCF),
    RGBColor(0xFB, 0xC9, 0xA6),
    RGBColor(0xF5, 0x9C, 0x80),
    RGBColor(0xE8, 0x6A, 0x60),
    RGBColor(0xB0, 0x3E, 0x4B),
    RGBColor(0x5E, 0x1F, 0x35),
];

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn Error>>;

/// Fill of an area. The fills also differ by pattern, for colour-blind readers.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Fill {
    /// Plain red: rounds won by squeezing, or visits in a plot of visits.
    Squeeze,
    /// Blue with stripes: rounds won by tearing bits off the body.
    Shave,
    /// Yellow with dots: rounds won by a mix of squeezing and shaving.
    Mix,
    /// Pale with an outline: rounds not won, or all rounds in the plot by hour.
    Pale,
}

impl Fill {
    /// All fills in the order of [`crate::figures::Wins::parts`].
    pub const ALL: [Self; 4] = [Self::Squeeze, Self::Shave, Self::Mix, Self::Pale];

    /// Returns the colour that the crate plotters draws, and the SVG paint that replaces this colour in the
    /// page.
    fn colour(self) -> (RGBColor, &'static str) {
        match self {
            Self::Squeeze => (RGBColor(0xF0, 0x6C, 0x62), "#F06C62"),
            Self::Shave => (RGBColor(0x2F, 0x6F, 0x9F), "url(#stripes)"),
            Self::Mix => (RGBColor(0xF3, 0xC9, 0x69), "url(#dots)"),
            Self::Pale => (RGBColor(0xEE, 0xE2, 0xD2), "#EEE2D2"),
        }
    }

    /// Returns a filled rectangle, with an outline if the fill is pale.
    fn rectangles<C: Clone>(self, corners: [C; 2]) -> Vec<Rectangle<C>> {
        let filled = Rectangle::new(corners.clone(), self.colour().0.filled());
        let edge = (self == Self::Pale).then(|| Rectangle::new(corners, EDGE));
        [filled].into_iter().chain(edge).collect()
    }

    /// Returns the SVG paint, which works only if the page contains [`PATTERNS`].
    pub fn paint(self) -> &'static str {
        self.colour().1
    }

    /// Returns the SVG paint of the outline.
    pub fn edge(self) -> &'static str {
        if self == Self::Pale {
            "#C2AD98"
        } else {
            "none"
        }
    }
}

/// SVG patterns of [`Fill`], included once in a page.
pub const PATTERNS: &str = r##"<svg width="0" height="0" style="position:absolute" aria-hidden="true"><defs>
<pattern id="stripes" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)"><rect width="7" height="7" fill="#2F6F9F"/><rect width="2.2" height="7" fill="#BFDDF0"/></pattern>
<pattern id="dots" width="8" height="8" patternUnits="userSpaceOnUse"><rect width="8" height="8" fill="#F3C969"/><circle cx="2" cy="2" r="1.3" fill="#7A5310"/><circle cx="6" cy="6" r="1.3" fill="#7A5310"/></pattern>
</defs></svg>
"##;

/// Column plot, grouped or stacked.
#[derive(Debug)]
pub struct Columns<'a> {
    /// Label of each column; empty labels are not drawn.
    pub labels: Vec<String>,
    /// Whether labels stand at the left edge of their column, as for times, or at its centre.
    pub is_edge: bool,
    /// Fill and heights of each series.
    pub series: Vec<(Fill, Vec<u64>)>,
    /// Whether the series are stacked.
    pub is_stacked: bool,
    /// Titles of the horizontal and the vertical axis.
    pub axes: [&'a str; 2],
    /// Vertical line: its distance from the left edge in columns, and its label.
    pub mark: Option<(f64, String)>,
}

impl Columns<'_> {
    /// Returns the plot as SVG.
    pub fn svg(&self) -> String {
        svg(HEIGHT, |area| self.draw(area))
    }

    fn draw(&self, area: &Area) -> Drawn {
        let count = self.labels.len();
        let heights = |k: usize| self.series.iter().map(move |(_, heights)| heights[k]);
        let top = (0..count).map(|k| match self.is_stacked {
            true => heights(k).sum::<u64>(),
            false => heights(k).max().unwrap_or(0),
        });
        let top = top.max().unwrap_or(0).max(1);
        let mut chart = ChartBuilder::on(area)
            .margin_top(22)
            .margin_right(14)
            .margin_bottom(22)
            .x_label_area_size(22)
            .y_label_area_size(66)
            .build_cartesian_2d(0.0..count as f64, 0..top + top.div_ceil(16))?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .disable_x_axis()
            .bold_line_style(LINE)
            .light_line_style(TRANSPARENT)
            .axis_style(WOOD)
            .y_labels(5)
            .y_label_formatter(&|k| grouped(*k))
            .y_desc(self.axes[1])
            .axis_desc_style(letters(LETTERS))
            .label_style(letters(LETTERS))
            .draw()?;
        for (s, (fill, heights)) in self.series.iter().enumerate() {
            let wide = 0.84
                / if self.is_stacked {
                    1.0
                } else {
                    self.series.len() as f64
                };
            for (k, &height) in heights
                .iter()
                .enumerate()
                .filter(|(_, height)| **height > 0)
            {
                let below: u64 = self.series[..s].iter().map(|(_, heights)| heights[k]).sum();
                let (left, low) = match self.is_stacked {
                    true => (0.08, below),
                    false => (0.08 + s as f64 * wide, 0),
                };
                let left = k as f64 + left;
                let corners = [(left, low), (left + wide, low + height)];
                chart.draw_series(fill.rectangles(corners))?;
            }
        }
        let floor = [(0.0, 0), (count as f64, 0)];
        chart.draw_series([PathElement::new(floor, WOOD)])?;
        let shift = if self.is_edge { 0.0 } else { 0.5 };
        for (k, label) in self
            .labels
            .iter()
            .enumerate()
            .filter(|(_, label)| !label.is_empty())
        {
            let (x, y) = chart.backend_coord(&(k as f64 + shift, 0));
            write(area, label, (x, y + 8), HPos::Center)?;
        }
        if let Some((at, text)) = &self.mark {
            let line = [(*at, 0), (*at, top + top.div_ceil(16))];
            chart.draw_series([PathElement::new(line, INK.stroke_width(2))])?;
            let (x, y) = chart.backend_coord(&line[1]);
            let (side, away) = match *at > 0.6 * count as f64 {
                true => (HPos::Right, -6),
                false => (HPos::Left, 6),
            };
            write(area, text, (x + away, y - 12), side)?;
        }
        let (x, _) = chart.backend_coord(&(0.5 * count as f64, 0));
        write(area, self.axes[0], (x, HEIGHT as i32 - 20), HPos::Center)
    }
}

/// Returns a plot with one bar of full width per row, divided into the shares of the row's four results. The
/// label of a row stands above its bar.
pub fn shares(rows: &[(String, [u64; 4])], axis: &str) -> String {
    const ROW: u32 = 46;
    let height = 50 + ROW * rows.len() as u32;
    svg(height, |area| {
        let count = rows.len() as f64;
        let mut chart = ChartBuilder::on(area)
            .margin_left(12)
            .margin_right(20)
            .margin_bottom(26)
            .x_label_area_size(24)
            .build_cartesian_2d(0.0..100.0, 0.0..count)?;
        chart
            .configure_mesh()
            .disable_y_mesh()
            .disable_y_axis()
            .bold_line_style(LINE)
            .light_line_style(TRANSPARENT)
            .axis_style(WOOD)
            .x_labels(5)
            .x_label_formatter(&|k| format!("{k:.0}%"))
            .label_style(letters(LETTERS))
            .draw()?;
        for (k, (label, parts)) in rows.iter().enumerate() {
            let foot = count - 1.0 - k as f64;
            let (x, y) = chart.backend_coord(&(0.0, foot + 0.76));
            write(area, label, (x, y - 6), HPos::Left)?;
            let all = parts.iter().sum::<u64>().max(1) as f64;
            let mut left = 0.0;
            for (fill, &part) in Fill::ALL.into_iter().zip(parts) {
                let wide = 100.0 * part as f64 / all;
                let corners = [(left, foot + 0.08), (left + wide, foot + 0.56)];
                if part > 0 {
                    chart.draw_series(fill.rectangles(corners))?;
                }
                if wide >= 9.0 {
                    let middle = chart.backend_coord(&(left + 0.5 * wide, foot + 0.56));
                    write(
                        area,
                        &format!("{wide:.0}%"),
                        (middle.0, middle.1 + 4),
                        HPos::Center,
                    )?;
                }
                left += wide;
            }
        }
        let (x, _) = chart.backend_coord(&(50.0, 0.0));
        write(area, axis, (x, height as i32 - 22), HPos::Center)
    })
}

/// Returns a map of the hand positions and the objects in the room of a level.
pub fn map(heat: &Heat, strokes: &[Stroke], axes: [&str; 2]) -> String {
    let rows = heat.seconds.len() / heat.columns.max(1);
    let [wide, high] = [heat.columns, rows].map(|count| count as f32 * heat.cell);
    let inner = WIDTH - 66 - 14;
    // The height is limited, because a room may be long and narrow.
    let height = (inner as f32 * high / wide).clamp(60.0, 900.0);
    let scale = inner as f32 / wide;
    let [low, far] = [heat.low, [heat.low[0] + wide, heat.low[1] + high]];
    // A map seen from above is flipped, so that points nearer to the player are drawn lower.
    let sign = if heat.axes[1] == 1 { 1.0 } else { -1.0 };
    let flip = |[x, y]: [f32; 2]| (x, sign * y);
    let vertical = if sign > 0.0 {
        low[1]..far[1]
    } else {
        -far[1]..-low[1]
    };
    svg(height as u32 + 22 + 26 + 10, |area| {
        let mut chart = ChartBuilder::on(area)
            .margin_top(10)
            .margin_right(14)
            .margin_bottom(26)
            .x_label_area_size(22)
            .y_label_area_size(66)
            .build_cartesian_2d(low[0]..far[0], vertical)?;
        chart
            .configure_mesh()
            .disable_mesh()
            .axis_style(WOOD)
            .x_labels(7)
            .y_labels(5)
            .x_label_formatter(&|k| format!("{k:.1}"))
            .y_label_formatter(&|k| format!("{:.1}", sign * k + 0.0))
            .y_desc(axes[1])
            .axis_desc_style(letters(LETTERS))
            .label_style(letters(LETTERS))
            .draw()?;
        for (row, first, last, shade) in runs(heat) {
            let corner = |column: usize, row: usize| {
                let at = [column, row].map(|k| k as f32 * heat.cell);
                flip([low[0] + at[0], low[1] + at[1]])
            };
            let corners = [corner(first, row), corner(last + 1, row + 1)];
            chart.draw_series([Rectangle::new(corners, SHADES[shade].filled())])?;
        }
        for stroke in strokes {
            let points: Vec<(f32, f32)> = stroke.points.iter().copied().map(flip).collect();
            let (colour, hairline) = match stroke.of {
                ObjectKind::Obstacle => (WOOD.mix(0.55), 1),
                ObjectKind::Basket => (INK.mix(0.9), 2),
                ObjectKind::Body => (INK.mix(0.55), 1),
            };
            let width = ((stroke.width * scale) as u32).max(hairline);
            chart.draw_series([PathElement::new(points, colour.stroke_width(width))])?;
        }
        let (x, y) = chart.backend_coord(&flip([
            0.5 * (low[0] + far[0]),
            if sign > 0.0 { low[1] } else { far[1] },
        ]));
        write(area, axes[0], (x, y + 26), HPos::Center)
    })
}

/// Merges adjacent cells of the same shade within a row. Returns the row, the first and the last column, and
/// the shade of each run. Cells without time are left out.
fn runs(heat: &Heat) -> Vec<(usize, usize, usize, usize)> {
    let most = heat.seconds.iter().copied().fold(0.0, f64::max);
    let shade = |seconds: f64| {
        let share = (seconds / most).sqrt() * SHADES.len() as f64;
        (seconds > 0.0).then_some((share as usize).min(SHADES.len() - 1))
    };
    let mut runs: Vec<(usize, usize, usize, usize)> = Vec::new();
    for (cell, &seconds) in heat.seconds.iter().enumerate() {
        let (row, column) = (cell / heat.columns, cell % heat.columns);
        let Some(shade) = shade(seconds) else {
            continue;
        };
        match runs.last_mut() {
            Some(last) if last.0 == row && last.2 + 1 == column && last.3 == shade => {
                last.2 = column
            }
            _ => runs.push((row, column, column, shade)),
        }
    }
    runs
}

/// Formats a number with commas between thousands.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

fn letters(size: f64) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&INK)
}

/// Draws a text with its upper edge at `at`. `side` aligns the text horizontally.
fn write(area: &Area, text: &str, at: (i32, i32), side: HPos) -> Drawn {
    let style = letters(LETTERS).pos(Pos::new(side, VPos::Top));
    area.draw(&Text::new(text.to_string(), at, style))?;
    Ok(())
}

fn svg(height: u32, draw: impl FnOnce(&Area) -> Drawn) -> String {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, (WIDTH, height)).into_drawing_area();
        draw(&area).expect("drawing into a string cannot fail");
        area.present().expect("drawing into a string cannot fail");
    }
    for fill in [Fill::Shave, Fill::Mix] {
        let (RGBColor(red, green, blue), paint) = fill.colour();
        let told = format!("fill=\"#{red:02X}{green:02X}{blue:02X}\"");
        text = text.replace(&told, &format!("fill=\"{paint}\""));
    }
    // Removes the fixed size from the SVG, so that the plot takes the available width.
    let size = format!("width=\"{WIDTH}\" height=\"{height}\" ");
    text.replacen(&size, "", 1)
}

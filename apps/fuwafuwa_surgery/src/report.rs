//! Report of a procedure: a table of all ticks (CSV), plots (SVG), and a summary.

use crate::measures::{PieceVolume, Sample, strongest_force};
use crate::procedure::Procedure;
use fuwafuwa::DEFAULT_TICK;
use plotters::prelude::*;
use std::error::Error;
use std::fmt::Write;

/// Header line of the table.
pub const HEADER: &str = "tick,seconds,tool,x_mm,y_mm,z_mm,force_x_n,force_y_n,force_z_n,peak_n,\
torque_x_mnm,torque_y_mnm,torque_z_mnm,area_mm2,work_mj,path_mm,released,pieces,grips";

/// Disclaimer on every output.
pub const NO_DEVICE: &str = "Not a medical device: for demonstration and teaching only, not for diagnosis, planning or treatment.";

/// Size of the plots [px].
const SIZE: (u32, u32) = (900, 760);
/// Maximum number of points of a plotted line. More points would not be visible at the size of the plots.
const POINTS: usize = 1500;
/// Maximum number of labels along an axis.
const LABELS: usize = 10;
const INK: RGBColor = RGBColor(0x4A, 0x36, 0x34);
const LINE: RGBColor = RGBColor(0xE6, 0xD8, 0xC8);
const RED: RGBColor = RGBColor(0xC8, 0x3A, 0x3A);
const BLUE: RGBColor = RGBColor(0x2F, 0x6F, 0x9F);

/// Returns the table of all ticks, one per line.
pub fn csv(samples: &[Sample]) -> String {
    let mut text = String::from(HEADER);
    text.push('\n');
    for (tick, sample) in samples.iter().enumerate() {
        let [x, y, z] = (1000.0 * sample.at).to_array();
        let [fx, fy, fz] = sample.force.to_array();
        let [tx, ty, tz] = (1000.0 * sample.torque).to_array();
        let seconds = seconds(tick);
        let tool = sample.tool.name().to_lowercase();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{},{seconds:.4},{tool},{x:.3},{y:.3},{z:.3},{fx:.4},{fy:.4},{fz:.4},{:.4},{tx:.4},{ty:.4},{tz:.4},\
             {:.3},{:.4},{:.3},{},{},{}",
            tick + 1,
            sample.peak,
            1e6 * sample.area,
            1e3 * sample.work,
            1e3 * sample.path,
            sample.released,
            sample.pieces,
            u8::from(sample.grips),
        );
    }
    text
}

/// Plots force, cut area, knife path and pieces over time, as SVG.
///
/// # Errors
/// Error of the plotting library.
pub fn svg(samples: &[Sample]) -> Result<String, Box<dyn Error>> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let area = area.titled(NO_DEVICE, ("sans-serif", 15).into_font().color(&INK))?;
        let parts = area.split_evenly((3, 1));
        let of = |value: fn(&Sample) -> f64| line(samples, value);
        let force = [
            (
                "mean per tick",
                RED,
                of(|sample| f64::from(sample.force.length())),
            ),
            ("peak", LINE, of(|sample| f64::from(sample.peak))),
        ];
        draw(&parts[0], "force on the tool [N]", &force, false)?;
        let cut = [
            ("area [mm²]", RED, of(|sample| 1e6 * sample.area)),
            (
                "path of the knife in tissue [mm]",
                BLUE,
                of(|sample| 1e3 * sample.path),
            ),
        ];
        draw(&parts[1], "cut", &cut, false)?;
        let pieces = [("pieces", BLUE, of(|sample| f64::from(sample.pieces)))];
        draw(&parts[2], "pieces", &pieces, true)?;
        area.present()?;
    }
    Ok(text)
}

/// Returns the points of a plot as (seconds, value). In long procedures each point is the maximum of several
/// ticks.
fn line(samples: &[Sample], value: fn(&Sample) -> f64) -> Vec<(f64, f64)> {
    let step = samples.len().div_ceil(POINTS).max(1);
    let points = samples.chunks(step).enumerate();
    let point = |(index, some): (usize, &[Sample])| {
        let most = some.iter().map(value).fold(0.0, f64::max);
        (f64::from(seconds(index * step)), most)
    };
    points.map(point).collect()
}

/// Line of a plot: name, colour and points (seconds, value).
type Line<'a> = (&'a str, RGBColor, Vec<(f64, f64)>);

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn draw(
    area: &Area<'_>,
    title: &str,
    lines: &[Line<'_>],
    is_count: bool,
) -> Result<(), Box<dyn Error>> {
    let points = || lines.iter().flat_map(|(.., points)| points);
    let long = points().map(|point| point.0).fold(1.0, f64::max);
    let high = points().map(|point| point.1).fold(0.0, f64::max);
    // The legend of several lines has room above them.
    let room = if lines.len() > 1 { 1.5 } else { 1.1 };
    let high = if high > 0.0 { room * high } else { 1.0 };
    // Limits the labels of a count to whole numbers.
    let labels = match is_count {
        true => (high as usize).min(LABELS - 1) + 1,
        false => LABELS,
    };
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(34)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..long, 0.0..high)?;
    chart
        .configure_mesh()
        .bold_line_style(LINE)
        .light_line_style(TRANSPARENT)
        .axis_style(INK)
        .x_desc("seconds")
        .y_desc(title)
        .y_labels(labels)
        .y_label_formatter(&label)
        .x_label_formatter(&label)
        .label_style(("sans-serif", 14).into_font().color(&INK))
        .draw()?;
    // Draws the lines in reverse order, so that the first line is on top.
    for (name, colour, points) in lines.iter().rev() {
        let style = colour.stroke_width(2);
        chart
            .draw_series([PathElement::new(points.clone(), style)])?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
    }
    if lines.len() > 1 {
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.8))
            .border_style(LINE)
            .label_font(("sans-serif", 13).into_font().color(&INK))
            .draw()?;
    }
    Ok(())
}

/// Formats a number without trailing zeros.
fn label(value: &f64) -> String {
    ((1e4 * value).round() / 1e4).to_string()
}

/// Returns the time at the end of a tick [s]. The first tick has index 0.
fn seconds(tick: usize) -> f32 {
    (tick + 1) as f32 * DEFAULT_TICK
}

/// Returns a summary of the procedure in a few lines.
pub fn summary(procedure: &Procedure, parts: &[PieceVolume]) -> String {
    let last = procedure.samples().last().copied().unwrap_or_default();
    let strongest = strongest_force(procedure.samples());
    let mut text = format!(
        "{}: {:.1} s, strongest force {strongest:.2} N (for at least two ticks), {:.0} mm² cut over {:.0} mm with {:.1} mJ, {} nodes released\n",
        procedure.case().name,
        procedure.ticks() as f32 * DEFAULT_TICK,
        1e6 * last.area,
        1e3 * last.path,
        1e3 * last.work,
        last.released,
    );
    for (number, part) in parts.iter().enumerate().take(8) {
        let materials = part.by_material.iter().enumerate();
        let materials = materials.filter(|(_, millilitres)| **millilitres > 0.0);
        let materials =
            materials.map(|(k, millilitres)| format!("{:.1} of {}", millilitres, k + 1));
        let materials: Vec<String> = materials.collect();
        let _ = writeln!(
            text,
            "piece {}: {:.1} ml (by material: {})",
            number + 1,
            part.millilitres,
            materials.join(", ")
        );
    }
    if parts.len() > 8 {
        let rest: f64 = parts[8..].iter().map(|part| part.millilitres).sum();
        let _ = writeln!(text, "{} more pieces: {rest:.2} ml", parts.len() - 8);
    }
    text + NO_DEVICE
}

//! Measured curves as CSV.

use super::LEAST_POINTS;
use crate::report::digits;
use anyhow::{Result, bail, ensure};

/// Returns the stretches and engineering stresses [Pa] of a curve in a CSV file. The name of the file is for errors.
///
/// # Errors
/// The file, the line and the column at fault, what was expected there and what was found.
pub fn parse(name: &str, text: &str) -> Result<Vec<(f64, f64)>> {
    let mut header: Option<(f64, f64)> = None;
    let mut curve: Vec<(f64, f64)> = Vec::new();
    for (number, line) in text.lines().enumerate() {
        // Some programs begin a file with a byte order mark.
        let line = line.trim_start_matches('\u{feff}').trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let line = format!("{name}, line {}", number + 1);
        let [strain, stress] = cells[..] else {
            bail!(
                "{line}: expected 2 columns separated by a comma, found {}",
                cells.len()
            );
        };
        let Some((rest, unit)) = header else {
            header = Some((stretch_at_rest(&line, strain)?, unit_of(&line, stress)?));
            continue;
        };
        let stretch = number_at(&line, 1, strain)? + 1.0 - rest;
        let stress = unit * number_at(&line, 2, stress)?;
        ensure!(
            stretch > 0.0,
            "{line}, column 1: expected a {}, found {strain}",
            match rest == 1.0 {
                true => "stretch above 0",
                false => "strain above -1",
            }
        );
        if let Some((before, _)) = curve.last() {
            ensure!(
                stretch > *before,
                "{line}, column 1: expected a number above {}, that of the line before, found {strain}",
                digits(before - 1.0 + rest)
            );
        }
        curve.push((stretch, stress));
    }
    ensure!(
        header.is_some(),
        "{name}: expected a header such as `strain,stress_pa`, found nothing"
    );
    let count = curve.iter().filter(|(_, stress)| *stress != 0.0).count();
    ensure!(
        count >= LEAST_POINTS,
        "{name}: expected at least {LEAST_POINTS} points with a stress other than 0, found {count}"
    );
    Ok(curve)
}

/// Returns the number in the first column of an unstretched specimen.
fn stretch_at_rest(line: &str, title: &str) -> Result<f64> {
    match title {
        "strain" => Ok(0.0),
        "stretch" => Ok(1.0),
        _ => bail!("{line}, column 1: expected the header `strain` or `stretch`, found `{title}`"),
    }
}

/// Returns the unit of the second column [Pa].
fn unit_of(line: &str, title: &str) -> Result<f64> {
    match title {
        "stress_pa" => Ok(1.0),
        "stress_kpa" => Ok(1e3),
        "stress_mpa" => Ok(1e6),
        _ => bail!(
            "{line}, column 2: expected the header `stress_pa`, `stress_kpa` or `stress_mpa`, found `{title}`"
        ),
    }
}

fn number_at(line: &str, column: usize, cell: &str) -> Result<f64> {
    let number = cell.parse::<f64>().ok().filter(|number| number.is_finite());
    let Some(number) = number else {
        bail!("{line}, column {column}: expected a finite number, found `{cell}`");
    };
    Ok(number)
}

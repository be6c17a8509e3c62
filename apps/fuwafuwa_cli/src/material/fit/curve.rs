//! Measured curves as CSV.

use super::LEAST_POINTS;
use anyhow::{Context, Result, bail, ensure};
use fuwafuwa_scenes::disk;
use fuwafuwa_scenes::import::FileType;
use std::path::Path;

/// Names of the first column, with the number of an unstretched specimen.
const STRAINS: [(&str, f64); 2] = [("strain", 0.0), ("stretch", 1.0)];
/// Names of the second column, with the unit [Pa].
const STRESSES: [(&str, f64); 3] = [("stress_pa", 1.0), ("stress_kpa", 1e3), ("stress_mpa", 1e6)];

/// Measured curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Stretches, each larger than the one before, and engineering stresses [Pa].
    pub points: Vec<(f64, f64)>,
    /// What was ignored, averaged or looks like a mistake.
    pub notes: Vec<String>,
}

/// Columns of a file.
struct Columns {
    count: usize,
    strain: usize,
    stress: usize,
    /// Number in the strain column of an unstretched specimen.
    rest: f64,
    /// Unit of the stress [Pa].
    unit: f64,
}

/// Reads a text file of at most `most` bytes.
///
/// # Errors
/// Errors of the system, and the type of a file that is no text.
pub fn read_text(path: &Path, most: u64) -> Result<String> {
    let name = || path.display().to_string();
    let bytes = disk::read_bytes(path, most).with_context(name)?;
    let found = FileType::of(&bytes);
    let text = String::from_utf8(bytes).ok();
    text.filter(|_| found.is_plain_text() || found == FileType::Empty)
        .with_context(|| format!("{}: expected a CSV text in UTF-8, found {found}", name()))
}

/// Returns the stretches and engineering stresses [Pa] of a curve in a CSV file. The name of the file is for errors.
///
/// # Errors
/// Those of [`Curve::parse`].
pub fn parse(name: &str, text: &str) -> Result<Vec<(f64, f64)>> {
    Ok(Curve::parse(name, text)?.points)
}

impl Curve {
    /// Returns the curve in a CSV file, sorted by stretch. Stresses at equal stretches are averaged.
    ///
    /// # Errors
    /// The file, the line and the column at fault, what was expected there and what was found.
    pub fn parse(name: &str, text: &str) -> Result<Self> {
        let mut header: Option<Columns> = None;
        let mut points: Vec<(f64, f64)> = Vec::new();
        let mut notes = Vec::new();
        for (number, line) in text.lines().enumerate() {
            // Some programs begin a file with a byte order mark.
            let line = line.trim_start_matches('\u{feff}').trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let cells: Vec<&str> = line.split(',').map(str::trim).collect();
            let place = format!("{name}, line {}", number + 1);
            let Some(columns) = &header else {
                let columns = Columns::of(&place, line, &cells)?;
                if columns.count > 2 {
                    notes.push(format!(
                        "of {} columns, `{}` and `{}` are used",
                        columns.count, cells[columns.strain], cells[columns.stress]
                    ));
                }
                header = Some(columns);
                continue;
            };
            ensure!(
                cells.len() == columns.count,
                "{place}: expected {} columns separated by a comma, as in the header, found {}{}",
                columns.count,
                cells.len(),
                match cells.len() > columns.count {
                    true => "; decimals require a point, not a comma",
                    false => other_separator(line),
                }
            );
            let strain = cells[columns.strain];
            let stretch = number_at(&place, columns.strain, strain)? + 1.0 - columns.rest;
            let stress = columns.unit * number_at(&place, columns.stress, cells[columns.stress])?;
            ensure!(
                stretch > 0.0,
                "{place}, column {}: expected a {}, found {strain}",
                columns.strain + 1,
                match columns.rest == 1.0 {
                    true => "stretch above 0",
                    false => "strain above -1",
                }
            );
            points.push((stretch, stress));
        }
        let Some(columns) = header else {
            bail!("{name}: expected a header such as `strain,stress_pa`, found nothing");
        };
        notes.extend(doubt(&columns, &points));
        let turns = turns(&points);
        if turns > 0 {
            notes.push(format!(
                "the strain turns back {turns} times: all points count as one curve, loading and unloading alike"
            ));
        }
        let points = sorted(points, &mut notes);
        let count = points.iter().filter(|(_, stress)| *stress != 0.0).count();
        ensure!(
            count >= LEAST_POINTS,
            "{name}: expected at least {LEAST_POINTS} points with a stress other than 0, found {count}"
        );
        Ok(Self { points, notes })
    }
}

impl Columns {
    /// Reads the header.
    fn of(place: &str, line: &str, cells: &[&str]) -> Result<Self> {
        let found = match cells.len() {
            1 => format!("`{line}`{}", other_separator(line)),
            _ => cells
                .iter()
                .map(|cell| format!("`{cell}`"))
                .collect::<Vec<_>>()
                .join(", "),
        };
        let column = |names: &[(&str, f64)]| -> Result<(usize, f64)> {
            let known = cells.iter().enumerate().filter_map(|(index, cell)| {
                let (_, value) = names.iter().find(|(name, _)| name == cell)?;
                Some((index, *value))
            });
            let known: Vec<_> = known.collect();
            let [one] = known[..] else {
                let names: Vec<_> = names.iter().map(|(name, _)| format!("`{name}`")).collect();
                bail!(
                    "{place}: expected a header with one column {}, found {found}",
                    names.join(" or ")
                );
            };
            Ok(one)
        };
        let (strain, rest) = column(&STRAINS)?;
        let (stress, unit) = column(&STRESSES)?;
        Ok(Self {
            count: cells.len(),
            strain,
            stress,
            rest,
            unit,
        })
    }
}

/// Returns the separator of a line without commas, for an error; empty if there is none.
fn other_separator(line: &str) -> &'static str {
    match (line.contains(';'), line.contains('\t')) {
        (true, _) => {
            ", separated by semicolons: replace them by commas, and decimal commas by points"
        }
        (false, true) => {
            ", separated by tabs: replace them by commas, and decimal commas by points"
        }
        _ => "",
    }
}

/// Returns why the strains look like another quantity.
fn doubt(columns: &Columns, points: &[(f64, f64)]) -> Option<String> {
    let strains = || points.iter().map(|(stretch, _)| stretch - 1.0);
    let largest = strains().fold(0.0, f64::max);
    let first = strains().next()?;
    let is_strain = columns.rest == 0.0;
    if largest > 20.0 {
        return Some(format!(
            "the largest strain is {largest}: expected 0.5 for an extension by 50 %, not a percentage"
        ));
    }
    let is_stretch = (0.9..1.1).contains(&first) && strains().all(|strain| strain >= 0.9);
    if is_strain && is_stretch {
        return Some(format!(
            "the first strain is {first}: if the column is the stretch, call it `stretch`"
        ));
    }
    (!is_strain && first < -0.8).then(|| {
        format!(
            "the first stretch is {}: if the column is the strain, call it `strain`",
            first + 1.0
        )
    })
}

/// Returns the number of points after which the strain changes its direction.
fn turns(points: &[(f64, f64)]) -> usize {
    let changes = points.windows(2).map(|pair| pair[1].0 - pair[0].0);
    let rising: Vec<bool> = changes
        .filter(|change| *change != 0.0)
        .map(|change| change > 0.0)
        .collect();
    rising.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

/// Returns the points in the order of their stretches, with the mean stress at each.
fn sorted(mut points: Vec<(f64, f64)>, notes: &mut Vec<String>) -> Vec<(f64, f64)> {
    points.sort_by(|one, other| one.0.total_cmp(&other.0));
    let groups = points.chunk_by(|one, other| one.0 == other.0);
    let repeated = groups.clone().filter(|group| group.len() > 1).count();
    if repeated > 0 {
        notes.push(format!(
            "{repeated} strains occur more than once: their stresses are averaged"
        ));
    }
    groups
        .map(|group| {
            let sum: f64 = group.iter().map(|(_, stress)| stress).sum();
            (group[0].0, sum / group.len() as f64)
        })
        .collect()
}

fn number_at(place: &str, column: usize, cell: &str) -> Result<f64> {
    let number = cell.parse::<f64>().ok().filter(|number| number.is_finite());
    let Some(number) = number else {
        bail!(
            "{place}, column {}: expected a finite number, found `{cell}`",
            column + 1
        );
    };
    Ok(number)
}

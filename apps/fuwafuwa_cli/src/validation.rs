//! Report of checks: a Markdown file, and a picture of each check in a folder beside it.
//!
//! The report has the same bytes at every run and on any number of threads: it contains no time, and numbers with few
//! digits. Standard libraries with another sine or exponential function may change the last digit of a reference.

use crate::plot::{svg_of_deviations, svg_of_plots};
use crate::report::{Findings, Outcome, Standing, digits};
use anyhow::{Context, Result, ensure};
use clap::ValueEnum;
use std::fs;
use std::path::{Path, PathBuf};

/// Share of a bound below which deviations from 0 are reported as an upper limit: they are rounding errors.
const NOTHING: f64 = 1e-3;
/// Relative difference that rounding may cause.
const ROUNDING: f64 = 1e-9;

/// Findings of a check with its description.
#[derive(Clone, Debug)]
pub struct Section {
    /// Name of the check on the command line.
    pub name: String,
    /// Description of the check, with the source of its reference.
    pub about: String,
    /// Kinds of its references; `None` if the report does not list them.
    pub sources: Option<String>,
    /// Results of the check.
    pub findings: Findings,
}

/// Names of checks on the command line, with names for several of them.
pub trait Suite: ValueEnum + PartialEq + 'static {
    /// Name for all checks.
    const ALL: Self;
    /// Name for the checks that take some seconds each.
    const QUICK: Self;
    /// Checks that [`Suite::QUICK`] leaves out.
    const LONG: &'static [Self];

    /// Returns whether the choice of this name includes a check.
    fn includes(&self, check: &Self) -> bool {
        match self {
            choice if *choice == Self::ALL => true,
            choice if *choice == Self::QUICK => !Self::LONG.contains(check),
            choice => choice == check,
        }
    }

    /// Returns the name on the command line.
    fn name(&self) -> String {
        let value = self.to_possible_value();
        value.map_or(String::new(), |value| value.get_name().to_owned())
    }

    /// Returns the description on the command line.
    fn about(&self) -> String {
        let value = self.to_possible_value();
        let about = value.as_ref().and_then(|value| value.get_help());
        // The command line strips the full stop at the end.
        about.map_or(String::new(), |about| format!("{about}."))
    }

    /// Returns the section of the report for a check, without the kinds of its references.
    fn section(&self, findings: Findings) -> Section {
        Section {
            name: self.name(),
            about: self.about(),
            sources: None,
            findings,
        }
    }

    /// Checks before a run that its report can be written, or that the report to compare with exists.
    ///
    /// # Errors
    /// If only a part of the report would be written, or the path of the file at fault and the error of the system.
    fn check_report(&self, path: &Path, page: &Page, compare: bool) -> Result<()> {
        if compare {
            fs::metadata(path).with_context(|| path.display().to_string())?;
            return Ok(());
        }
        let Page { command, kind, .. } = page;
        ensure!(
            *self == Self::ALL,
            "writing a report needs `{command} all`: it has a section for each {kind}. With --compare, any {kind} is \
             possible"
        );
        check_output(path)?;
        check_output(&path.with_extension("").join("picture.svg"))
    }
}

/// Checks that a file can be written, and creates its folder. An existing file is unchanged.
///
/// # Errors
/// The path of the file and the error of the system.
pub fn check_output(path: &Path) -> Result<()> {
    create_folder(path)?;
    // The draft is dropped without a trace.
    output::Draft::begin(path).with_context(|| path.display().to_string())?;
    Ok(())
}

/// Creates the folder of a file if it is missing.
fn create_folder(path: &Path) -> Result<()> {
    let folder = path.parent();
    if let Some(folder) = folder.filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    Ok(())
}

/// File of a report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReportFile {
    /// Path of the file.
    pub path: PathBuf,
    /// Content of the file.
    pub text: String,
}

/// Introduction of a report.
#[derive(Copy, Clone, Debug)]
pub struct Page {
    /// Heading.
    pub title: &'static str,
    /// Text below the heading.
    pub about: &'static str,
    /// Word for a section.
    pub kind: &'static str,
    /// Heading of the column with the values of the engine.
    pub value: &'static str,
    /// Command that writes the report.
    pub command: &'static str,
}

/// Writes a report whose Markdown file has the given path, or compares it with the files on the disk and prints the
/// differences. Returns whether there are differences.
///
/// # Errors
/// The path of the file at fault and the error of the system.
pub fn report(
    path: &Path,
    page: &Page,
    sections: &[Section],
    is_complete: bool,
    compare: bool,
) -> Result<bool> {
    let files = files(path, page, sections);
    if !compare {
        write(&files)?;
        return Ok(false);
    }
    let differences = differences(&files, is_complete);
    differences.iter().for_each(output::warn);
    Ok(!differences.is_empty())
}

/// Returns the files of the report whose Markdown file has the given path.
pub fn files(path: &Path, page: &Page, sections: &[Section]) -> Vec<ReportFile> {
    let folder = path.with_extension("");
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let mut files = vec![ReportFile {
        path: path.to_path_buf(),
        text: markdown(&name, page, sections),
    }];
    files.extend(sections.iter().map(|section| ReportFile {
        path: folder.join(format!("{}.svg", section.name)),
        text: picture(&section.findings),
    }));
    files
}

/// Writes the files that differ from those on the disk. Creates the folder of the pictures if it is missing.
///
/// # Errors
/// The path of the file at fault and the error of the system.
pub fn write(files: &[ReportFile]) -> Result<()> {
    for ReportFile { path, text } in files {
        if fs::read(path).is_ok_and(|found| found == text.as_bytes()) {
            continue;
        }
        create_folder(path)?;
        output::write(path, text.as_bytes()).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

/// Returns the differences of the files from those on the disk, as messages: the section of each changed line of the
/// Markdown file, and each picture. Unless the report is complete, its table of contents and the sections that only the
/// file on the disk has are not compared.
pub fn differences(files: &[ReportFile], is_complete: bool) -> Vec<String> {
    let mut differences = Vec::new();
    for ReportFile { path, text } in files {
        let name = path.display();
        match fs::read_to_string(path) {
            Ok(found) if found == *text => {}
            Ok(found) if path.extension().is_some_and(|extension| extension == "svg") => {
                let count = changed(&found, text, true).len();
                differences.push(format!("{name}: {count} lines of the picture differ"));
            }
            Ok(found) => {
                let lines = changed(&found, text, is_complete).into_iter();
                differences.extend(lines.map(|line| format!("{name}: {line}")));
            }
            Err(error) => differences.push(format!("{name}: {error}")),
        }
    }
    differences
}

/// Returns a message for each line of `text` that differs from `found`. Lines are compared within their sections. Unless
/// `text` is complete, what stands before its first section is not compared, and further sections of `found` are allowed.
fn changed(found: &str, text: &str, is_complete: bool) -> Vec<String> {
    let [found, mut text] = [found, text].map(sections_of);
    if !is_complete {
        text.remove(0);
    }
    let mut messages = Vec::new();
    for (heading, lines) in &text {
        let Some((_, old)) = found.iter().find(|(name, _)| name == heading) else {
            messages.push(format!("the section \"{heading}\" is missing"));
            continue;
        };
        for index in 0..lines.len().max(old.len()) {
            let [line, old] = [lines, old].map(|lines| lines.get(index).copied().unwrap_or(""));
            if line != old {
                messages.push(format!(
                    "{heading}: expected \"{old}\", measured \"{line}\""
                ));
            }
        }
    }
    let surplus = found
        .iter()
        .filter(|(name, _)| is_complete && text.iter().all(|(heading, _)| heading != name));
    messages.extend(surplus.map(|(name, _)| format!("the section \"{name}\" belongs to no check")));
    messages
}

/// Splits a text at its headings of second order. The first section has an empty heading.
fn sections_of(text: &str) -> Vec<(&str, Vec<&str>)> {
    let mut sections = vec![("", Vec::new())];
    for line in text.lines() {
        match line.strip_prefix("## ") {
            Some(heading) => sections.push((heading, Vec::new())),
            None => sections
                .last_mut()
                .expect("there is a first section")
                .1
                .push(line),
        }
    }
    sections
}

fn markdown(folder: &str, page: &Page, sections: &[Section]) -> String {
    let Page {
        title,
        about,
        value,
        ..
    } = page;
    let summary = match sections.iter().any(|section| section.sources.is_some()) {
        true => format!(
            "{}\n\n{}",
            misses(sections),
            sourced_summary(page, sections)
        ),
        false => summary(page, sections),
    };
    let mut text = format!("# {title}\n\n{about}\n\n{summary}");
    for section in sections {
        let Section {
            name,
            about,
            findings,
            ..
        } = section;
        text += &format!("\n## {name}\n\n{about}\n\n![{name}]({folder}/{name}.svg)\n\n",);
        text += &format!(
            "| # | case | {value} | reference | bound | passed |\n| --- | --- | --- | --- | --- | --- |\n"
        );
        for (index, outcome) in findings.outcomes.iter().enumerate() {
            text += &row(index + 1, outcome);
        }
    }
    text
}

/// Returns the table of the sections with the numbers of their outcomes.
fn summary(page: &Page, sections: &[Section]) -> String {
    let kind = page.kind;
    let mut text =
        format!("| {kind} | values | passed | for comparison |\n| --- | --- | --- | --- |\n");
    for Section { name, findings, .. } in sections {
        let count = |pass| {
            let outcomes = findings.outcomes.iter();
            outcomes.filter(|outcome| outcome.pass == pass).count()
        };
        let (passed, failed, shown) = (count(Some(true)), count(Some(false)), count(None));
        text += &format!(
            "| [{name}](#{name}) | {} | {passed} of {} | {shown} |\n",
            findings.outcomes.len(),
            passed + failed
        );
    }
    text
}

/// As [`summary`], with the kinds of the references. Calibrations do not count as passed, and known misses count as not
/// passed.
fn sourced_summary(page: &Page, sections: &[Section]) -> String {
    let kind = page.kind;
    let mut text = format!(
        "| {kind} | reference | passed | calibrations | without a bound, largest deviation |\n\
         | --- | --- | --- | --- | --- |\n"
    );
    for Section {
        name,
        sources,
        findings,
        ..
    } in sections
    {
        let [mut tests, mut passed, mut calibrations] = [0; 3];
        let mut shown = Vec::new();
        for outcome in &findings.outcomes {
            match (outcome.standing, outcome.pass) {
                (Standing::Calibration, _) => calibrations += 1,
                (Standing::Test, None) => shown.push(outcome),
                (Standing::Test | Standing::KnownMiss, pass) => {
                    tests += 1;
                    passed += usize::from(pass == Some(true));
                }
            }
        }
        let deviations = shown.iter().filter_map(|outcome| {
            let reference = outcome.reference.filter(|reference| *reference != 0.0)?;
            Some((outcome.value / reference - 1.0).abs())
        });
        let largest = deviations.reduce(f64::max);
        let largest = largest.map_or(String::new(), |largest| {
            format!(", {:.0} %", 100.0 * largest)
        });
        text += &format!(
            "| [{name}](#{name}) | {} | {passed} of {tests} | {calibrations} | {}{largest} |\n",
            sources.as_deref().unwrap_or("–"),
            shown.len()
        );
    }
    text
}

/// Returns the sentence with the rows that lie outside of their bound.
fn misses(sections: &[Section]) -> String {
    let rows = sections
        .iter()
        .filter_map(|Section { name, findings, .. }| {
            let outcomes = findings.outcomes.iter().enumerate();
            let missed = outcomes.filter(|(_, outcome)| {
                outcome.pass == Some(false) || outcome.standing == Standing::KnownMiss
            });
            let numbers: Vec<String> = missed.map(|(index, _)| (index + 1).to_string()).collect();
            (!numbers.is_empty()).then(|| format!("[{name}](#{name}) {}", numbers.join(", ")))
        });
    let rows: Vec<String> = rows.collect();
    match rows.is_empty() {
        true => "No row lies outside of its bound.".into(),
        false => format!("Rows outside of their bound: {}.", rows.join("; ")),
    }
}

/// Returns the row of an outcome in the table of its check.
fn row(number: usize, outcome: &Outcome) -> String {
    let reference = outcome.reference.map_or("–".into(), digits);
    let passed = match (outcome.pass, outcome.standing) {
        (Some(true), _) => "yes",
        (Some(false), _) => "**no**",
        (None, Standing::KnownMiss) => "**no**, known",
        (None, _) => "*for comparison*",
    };
    format!(
        "| {number} | {} | {} | {reference} | {} | {passed} |\n",
        outcome.case.replace('|', "\\|"),
        measured(outcome),
        bound(outcome)
    )
}

/// Formats a measured value.
fn measured(outcome: &Outcome) -> String {
    let unit = match (outcome.low, outcome.high) {
        (Some(low), Some(high)) if low < 0.0 => 0.5 * (high - low),
        (None, Some(high)) => high,
        _ => 0.0,
    };
    let least = NOTHING * unit;
    match outcome.value.abs() < least {
        true => format!("< {}", digits(least)),
        false => digits(outcome.value),
    }
}

/// Formats the bound of an outcome: as a deviation if the reference is in the middle of the allowed range.
fn bound(outcome: &Outcome) -> String {
    let is_middle = |reference: f64, low: f64, high: f64| {
        (0.5 * (low + high) - reference).abs() <= ROUNDING * (high - low).max(reference.abs())
    };
    match (outcome.reference, outcome.low, outcome.high) {
        (Some(reference), Some(low), Some(high)) if is_middle(reference, low, high) => {
            let half = 0.5 * (high - low);
            let share = digits(100.0 * half / reference.abs());
            match reference == 0.0 || half == 0.0 {
                true => format!("± {}", digits(half)),
                false => format!("± {share} %"),
            }
        }
        (_, Some(low), Some(high)) => format!("{} to {}", digits(low), digits(high)),
        (_, None, Some(high)) => format!("≤ {}", digits(high)),
        (_, Some(low), None) => format!("≥ {}", digits(low)),
        (_, None, None) => "–".into(),
    }
}

fn picture(findings: &Findings) -> String {
    match findings.plots.is_empty() {
        true => svg_of_deviations(&findings.outcomes),
        false => svg_of_plots(&findings.plots),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: Page = Page {
        title: "Validation",
        about: "Checks.",
        kind: "check",
        value: "measured",
        command: "check",
    };

    fn section(name: &str, value: f64) -> Section {
        let outcome = Outcome::near("twice two".into(), value, 4.0, 0.08);
        Section {
            name: name.into(),
            about: "Products must be right.".into(),
            sources: None,
            findings: vec![outcome].into(),
        }
    }

    #[test]
    fn changed_row_is_named_with_its_section() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.md");
        let written = files(&path, &PAGE, &[section("product", 4.01)]);
        write(&written).unwrap();
        assert!(differences(&written, true).is_empty());
        let found = differences(&files(&path, &PAGE, &[section("product", 4.02)]), true);
        assert!(
            found[0].contains("product: expected \"| 1 | twice two | 4.01 | 4 | ± 2 % | yes |\""),
            "{found:?}"
        );
        assert!(
            found[0].contains("measured \"| 1 | twice two | 4.02 |"),
            "{found:?}"
        );
    }

    #[test]
    fn bound_is_a_range_unless_the_reference_is_in_its_middle() {
        let of = |reference, low, high| {
            let outcome = Outcome::within("speed".into(), 0.46, low..=high);
            bound(&Outcome {
                reference: Some(reference),
                ..outcome
            })
        };
        assert_eq!(of(1.0, 0.9, 1.1), "± 10 %");
        assert_eq!(of(0.0, -0.1, 0.1), "± 0.1");
        assert_eq!(of(1.0, 0.0, 1.0), "0 to 1");
        assert_eq!(of(0.0, 0.0, 0.5), "0 to 0.5");
        assert_eq!(of(1.0, f64::NEG_INFINITY, 1.0), "≤ 1");
    }

    #[test]
    fn deviation_is_that_from_the_reference() {
        let of = |value, reference, low, high| {
            let outcome = Outcome::within("speed".into(), value, low..=high);
            let outcome = Outcome {
                reference: Some(reference),
                ..outcome
            };
            outcome.deviation().unwrap()
        };
        assert!((of(0.05, 0.0, 0.0, 0.5) - 0.1).abs() < 1e-12);
        assert!((of(0.4, 1.0, 0.0, 1.0) + 0.6).abs() < 1e-12);
        assert!((of(1.2, 1.0, 0.0, 1.0) - 0.2).abs() < 1e-12);
        assert!((of(-0.2, 0.0, 0.0, 0.5) + 0.4).abs() < 1e-12);
        assert!((of(53.0, 45.0, 35.0, 55.0) - 0.8).abs() < 1e-12);
    }

    #[test]
    fn summary_counts_neither_calibrations_nor_known_misses_as_passed() {
        let outcome = |standing, pass| Outcome {
            standing,
            pass,
            ..Outcome::near("speed".into(), 1.5, 1.0, 1.0)
        };
        let section = Section {
            sources: Some("laboratory".into()),
            findings: vec![
                outcome(Standing::Calibration, Some(true)),
                outcome(Standing::Test, Some(true)),
                outcome(Standing::KnownMiss, None),
                outcome(Standing::Test, Some(false)),
                outcome(Standing::Test, None),
            ]
            .into(),
            ..section("swing", 4.0)
        };
        let text = markdown("report", &PAGE, &[section]);
        assert!(
            text.contains("| laboratory | 1 of 3 | 1 | 1, 50 % |"),
            "{text}"
        );
        assert!(
            text.contains("of their bound: [swing](#swing) 3, 4."),
            "{text}"
        );
        assert!(text.contains("**no**, known"), "{text}");
    }

    #[test]
    fn output_that_cannot_be_written_is_refused_before_the_run() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new").join("report.md");
        check_output(&path).unwrap();
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 0);
        let file = folder.path().join("file");
        fs::write(&file, "text").unwrap();
        let error = check_output(&file.join("report.md")).unwrap_err();
        assert!(error.to_string().contains("file"), "{error}");
        check_output(&file).unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"text");
    }

    #[test]
    fn part_of_a_report_is_compared_with_its_own_sections() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.md");
        write(&files(
            &path,
            &PAGE,
            &[section("sum", 4.01), section("product", 4.01)],
        ))
        .unwrap();
        let part = |value| files(&path, &PAGE, &[section("product", value)]);
        assert!(differences(&part(4.01), false).is_empty());
        let complete = differences(&part(4.01), true);
        let last = complete.last().unwrap();
        assert!(last.contains("\"sum\" belongs to no check"), "{complete:?}");
        // The changed row, and the picture.
        assert_eq!(differences(&part(4.02), false).len(), 2);
        let other = files(&path, &PAGE, &[section("quotient", 4.01)]);
        let missing = differences(&other, false);
        assert!(
            missing[0].contains("\"quotient\" is missing"),
            "{missing:?}"
        );
    }

    #[test]
    fn unchanged_files_are_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.md");
        let written = files(&path, &PAGE, &[section("product", 4.01)]);
        write(&written).unwrap();
        let time = |file: &ReportFile| fs::metadata(&file.path).unwrap().modified().unwrap();
        let before: Vec<_> = written.iter().map(time).collect();
        write(&written).unwrap();
        assert_eq!(written.iter().map(time).collect::<Vec<_>>(), before);
    }

    #[test]
    fn numbers_have_four_digits() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (0.123456, "0.1235"),
            (123456.0, "1.235e5"),
            (7.8e-7, "7.8e-7"),
            (-66.104, "-66.1"),
        ] {
            assert_eq!(digits(value), text);
        }
    }
}

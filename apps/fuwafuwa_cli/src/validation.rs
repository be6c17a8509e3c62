//! Report of checks: a Markdown file, and a picture of each check in a folder beside it.
//!
//! The report has the same bytes at every run and on any number of threads: it contains no time, and numbers with few
//! digits. Standard libraries with another sine or exponential function may change the last digit of a reference.

use crate::plot::{svg_of_deviations, svg_of_plots};
use crate::report::{Findings, Outcome, digits};
use anyhow::{Context, Result};
use std::fs;
use std::path::{Path, PathBuf};

/// Share of a bound below which deviations from 0 are reported as an upper limit: they are rounding errors.
const NOTHING: f64 = 1e-3;

/// Findings of a check with its description.
#[derive(Clone, Debug)]
pub struct Section {
    /// Name of the check on the command line.
    pub name: String,
    /// Description of the check, with the source of its reference.
    pub about: String,
    /// Results of the check.
    pub findings: Findings,
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
        if let Some(folder) = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty())
        {
            fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
        }
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
    let Page { title, about, kind } = page;
    let mut text = format!(
        "# {title}\n\n{about}\n\n\
         | {kind} | values | passed | for comparison |\n| --- | --- | --- | --- |\n",
    );
    for Section { name, findings, .. } in sections {
        let count = |pass| {
            findings
                .outcomes
                .iter()
                .filter(|outcome| outcome.pass == pass)
                .count()
        };
        let (passed, failed, shown) = (count(Some(true)), count(Some(false)), count(None));
        text += &format!(
            "| [{name}](#{name}) | {} | {passed} of {} | {shown} |\n",
            findings.outcomes.len(),
            passed + failed
        );
    }
    for section in sections {
        let Section {
            name,
            about,
            findings,
        } = section;
        text += &format!("\n## {name}\n\n{about}\n\n![{name}]({folder}/{name}.svg)\n\n",);
        text += "| # | case | measured | reference | bound | passed |\n| --- | --- | --- | --- | --- | --- |\n";
        for (index, outcome) in findings.outcomes.iter().enumerate() {
            text += &row(index + 1, outcome);
        }
    }
    text
}

/// Returns the row of an outcome in the table of its check.
fn row(number: usize, outcome: &Outcome) -> String {
    let reference = outcome.reference.map_or("–".into(), digits);
    let passed = match outcome.pass {
        Some(true) => "yes",
        Some(false) => "**no**",
        None => "*for comparison*",
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

/// Formats the bound of an outcome.
fn bound(outcome: &Outcome) -> String {
    match (outcome.reference, outcome.low, outcome.high) {
        (Some(reference), Some(low), Some(high)) => {
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
    };

    fn section(name: &str, value: f64) -> Section {
        let outcome = Outcome::near("twice two".into(), value, 4.0, 0.08);
        Section {
            name: name.into(),
            about: "Products must be right.".into(),
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

//! Errors of scenes, with their position in the file.

use crate::import::{ImportError, ImportNote};
use fuwafuwa::{Dim, DimVector, Vec3};
use std::collections::BTreeMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Reason why a scene could not be read or built.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// No scene or file has this name.
    #[error("there is no scene or file {name:?}; the scenes are {known}")]
    Unknown {
        /// Name that was requested.
        name: String,
        /// Names of the built-in scenes.
        known: String,
    },
    /// The file cannot be read.
    #[error("{path}: {source}")]
    File {
        /// Path of the file.
        path: String,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The text does not have the structure of a scene.
    #[error("{name}{}: {reason}", in_line(line))]
    Text {
        /// Name of the scene or file.
        name: String,
        /// Line of the error, if the parser gives one.
        line: Option<usize>,
        /// Text that was found, and what was expected.
        reason: String,
    },
    /// A value is invalid.
    #[error("{name}{}: {field}: {reason}", in_line(line))]
    Build {
        /// Name of the scene or file.
        name: String,
        /// Line of the field, if the scene was read from a text.
        line: Option<usize>,
        /// Path of the field; entries of lists are numbered from 1.
        field: String,
        /// Value that was found, and what was expected.
        reason: String,
    },
    /// The picture or model of a body cannot be imported.
    #[error("{name}{}: {field}: {error}", in_line(line))]
    Shape {
        /// Name of the scene or file.
        name: String,
        /// Line of the field, if the scene was read from a text.
        line: Option<usize>,
        /// Path of the field; entries of lists are numbered from 1.
        field: String,
        /// Error of the import: file, position, and what was expected.
        error: Box<ImportError>,
    },
}

impl SceneError {
    /// Converts an error of the TOML parser.
    pub(super) fn of_text(name: &str, text: &str, error: &toml::de::Error) -> Self {
        let mut message = shortened(error.message(), 400);
        for (type_name, words) in IN_WORDS {
            message = message.replace(type_name, words);
        }
        if let Some((before, after)) = message.split_once("expected struct ") {
            let after = after.trim_start_matches(|letter: char| letter.is_ascii_alphanumeric());
            message = format!("{before}expected a table{after}");
        }
        // If a field is missing from the top level of the text, the span of the error is empty and names no
        // line.
        let span = error.span().filter(|span| span.end > 0);
        let line = span.map(|span| line_of(&line_starts(text), span.start));
        let reason = match line.and_then(|line| text.lines().nth(line - 1)) {
            Some(found) => format!("{}: {message}", shortened(found.trim(), 80)),
            None => message,
        };
        let name = name.into();
        Self::Text { name, line, reason }
    }
}

/// Plain words for Rust types in messages of the TOML parser.
const IN_WORDS: [(&str, &str); 8] = [
    (
        "invalid type: unit variant, expected newtype variant",
        "expected a name with values, as in { yeoh = [0.01, 0.0001] }, found a name alone",
    ),
    (
        "invalid type: newtype variant, expected unit variant",
        "expected a name alone, as in \"neo_hookean\", found a name with values",
    ),
    ("expected u8", "expected a whole number from 0 to 255"),
    ("expected u32", "expected a whole number of 0 or more"),
    ("expected usize", "expected a whole number of 0 or more"),
    ("expected f32", "expected a number"),
    ("expected f64", "expected a number"),
    (
        "map, expected a sequence",
        "a table, expected a list of them, as in [[body]]",
    ),
];

/// Returns at most `most` characters of a text, with an ellipsis if it is longer.
pub fn shortened(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.into(),
    }
}

/// Returns the byte offset of the beginning of each line.
fn line_starts(text: &str) -> Vec<usize> {
    let after = text.match_indices('\n').map(|(place, _)| place + 1);
    std::iter::once(0).chain(after).collect()
}

fn line_of(starts: &[usize], place: usize) -> usize {
    starts.partition_point(|&start| start <= place)
}

fn in_line(line: &Option<usize>) -> String {
    line.map_or(String::new(), |line| format!(", line {line}"))
}

/// An invalid value: path of the field, as in `body.2.n`, and reason.
#[derive(Debug)]
pub(super) struct FieldError {
    path: String,
    reason: Reason,
}

#[derive(Debug)]
enum Reason {
    Text(String),
    Import(Box<ImportError>),
}

impl FieldError {
    pub(super) fn new(field: &str, reason: impl ToString) -> Self {
        let (path, reason) = (field.into(), Reason::Text(reason.to_string()));
        Self { path, reason }
    }

    /// Converts an error of the engine. An error without a parameter is attributed to `field`.
    pub(super) fn engine(field: &str, error: fuwafuwa::Error) -> Self {
        match error {
            fuwafuwa::Error::InvalidParameter {
                field,
                expected,
                given,
            } => Self::new(&field, format!("expected {expected}, found {given}")),
            error => Self::new(field, error),
        }
    }

    /// Creates the error of a file that cannot be imported.
    pub(super) fn file(error: ImportError) -> Self {
        let (path, reason) = ("file".into(), Reason::Import(Box::new(error)));
        Self { path, reason }
    }

    /// Prefixes the path of the field with entry `index` of a list, counted from 0.
    pub(super) fn inside(self, list: &str, index: usize) -> Self {
        let path = format!("{list}.{}.{}", index + 1, self.path);
        Self { path, ..self }
    }

    /// Prefixes the path of the field with a table.
    pub(super) fn under(self, table: &str) -> Self {
        let path = format!("{table}.{}", self.path);
        Self { path, ..self }
    }
}

/// Returns the reason why a number of an entry in a list of `count` entries is wrong.
pub(super) fn expected_number(count: usize, found: impl std::fmt::Display) -> String {
    match count {
        0 => format!("expected no number, because the scene has none of these, found {found}"),
        1 => format!("expected 1, found {found}"),
        _ => format!("expected 1 to {count}, found {found}"),
    }
}

/// Returns an error for `field` unless `good`.
pub(super) fn require(good: bool, field: &str, reason: impl ToString) -> Result<(), FieldError> {
    good.then_some(())
        .ok_or_else(|| FieldError::new(field, reason))
}

/// Converts a vector of a scene file. Requires finite components, and in 2D a third component of 0.
pub(super) fn vector_of<D: Dim>(field: &str, numbers: [f32; 3]) -> Result<D::Vector, FieldError> {
    let finite = numbers.iter().all(|k| k.is_finite());
    let found = format!("found {numbers:?}");
    require(finite, field, format!("expected finite numbers, {found}"))?;
    let flat = numbers[D::N..].iter().all(|&k| k == 0.0);
    let expected = "expected 0 for the third axis of a world with dim = 2";
    require(flat, field, format!("{expected}, {found}"))?;
    Ok(D::Vector::from_vec3(Vec3::from(numbers)))
}

/// Source of a scene: its name, the line numbers of its values, and notes on its files. All origins compare
/// equal, because they are not part of a scene's content.
#[derive(Clone, Debug, Default)]
pub(super) struct Origin {
    pub(super) name: String,
    /// Line numbers by path, as in `body.2.n`.
    lines: BTreeMap<String, usize>,
    /// Notes on the files that were embedded.
    pub(super) notes: Vec<ImportNote>,
}

impl PartialEq for Origin {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Origin {
    /// Finds the lines of all values in a text.
    pub(super) fn of(name: &str, text: &str) -> Self {
        let mut origin = Self::named(name);
        if let Ok(table) = DeTable::parse(text) {
            origin.note_table("", table.get_ref(), &line_starts(text));
        }
        origin
    }

    pub(super) fn named(name: &str) -> Self {
        Self {
            name: name.into(),
            ..Self::default()
        }
    }

    pub(super) fn error(&self, wrong: FieldError) -> SceneError {
        // A value that is missing from the text is reported at the line of the table that should contain it.
        let mut path = wrong.path.as_str();
        let line = loop {
            match (self.lines.get(path), path.rsplit_once('.')) {
                (Some(&line), _) => break Some(line),
                (None, Some((above, _))) => path = above,
                (None, None) => break None,
            }
        };
        let name = match self.name.as_str() {
            "" => "scene",
            name => name,
        };
        let (name, field) = (name.into(), shortened(&in_words(&wrong.path), 100));
        match wrong.reason {
            Reason::Text(reason) => SceneError::Build {
                name,
                line,
                field,
                // Shortens the reason, because it may quote a key or a path as long as the file.
                reason: shortened(&reason, 400),
            },
            Reason::Import(error) => SceneError::Shape {
                name,
                line,
                field,
                error,
            },
        }
    }

    fn note_table(&mut self, path: &str, table: &DeTable, starts: &[usize]) {
        for (key, value) in table {
            let path = match path {
                "" => key.get_ref().to_string(),
                _ => format!("{path}.{}", key.get_ref()),
            };
            self.note(&path, key.span().start, starts);
            self.note_value(&path, value, starts);
        }
    }

    fn note_value(&mut self, path: &str, value: &Spanned<DeValue>, starts: &[usize]) {
        match value.get_ref() {
            DeValue::Table(table) => self.note_table(path, table, starts),
            DeValue::Array(entries) => {
                for (index, entry) in entries.iter().enumerate() {
                    let path = format!("{path}.{}", index + 1);
                    self.note(&path, entry.span().start, starts);
                    self.note_value(&path, entry, starts);
                }
            }
            _ => {}
        }
    }

    fn note(&mut self, path: &str, place: usize, starts: &[usize]) {
        self.lines.insert(path.into(), line_of(starts, place));
    }
}

/// Turns the path `body.2.n` into "body 2, n".
fn in_words(path: &str) -> String {
    let mut words = String::new();
    for word in path.split('.') {
        if !words.is_empty() {
            let is_number = word.bytes().all(|byte| byte.is_ascii_digit());
            words += if is_number { " " } else { ", " };
        }
        words += word;
    }
    words
}

//! What can be wrong with a scene, and where in its file that stands.

use crate::import::ImportError;
use std::collections::BTreeMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Why a scene could not be read or built.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// There is no such scene or file.
    #[error("there is no scene or file {name:?}; the scenes are {known}")]
    Unknown {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// The file cannot be read.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// The text is not that of a scene.
    #[error("{name}{}: {reason}", in_line(line))]
    Text {
        /// The scene or file.
        name: String,
        /// The line, when the fault has one.
        line: Option<usize>,
        /// What stands there and what was expected.
        reason: String,
    },
    /// What it describes cannot be.
    #[error("{name}{}: {field}: {reason}", in_line(line))]
    Build {
        /// The scene or file.
        name: String,
        /// The line, when it stands in a text.
        line: Option<usize>,
        /// The field, with the numbers of entries counted from 1.
        field: String,
        /// What was expected and what was found.
        reason: String,
    },
    /// A picture or a model that a body is made from gives no shape.
    #[error("{name}{}: {field}: {error}", in_line(line))]
    Shape {
        /// The scene or file that asks for it.
        name: String,
        /// The line, when it stands in a text.
        line: Option<usize>,
        /// The field, with the numbers of entries counted from 1.
        field: String,
        /// Which file, where in it, and what was expected there.
        error: Box<ImportError>,
    },
}

impl SceneError {
    /// For a text that does not hold the fields of a scene.
    pub(super) fn of_text(name: &str, text: &str, error: &toml::de::Error) -> Self {
        let mut message = shortened(error.message(), 400);
        for (type_name, words) in IN_WORDS {
            message = message.replace(type_name, words);
        }
        // What is missing from the text as a whole is nowhere; what is missing in a line is between letters.
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

/// What a reader who does not know Rust calls its types.
const IN_WORDS: [(&str, &str); 6] = [
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

/// The first letters of a text that may be as long as a file.
pub fn shortened(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.into(),
    }
}

/// Where each line of a text begins.
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

/// A value that cannot be: where, as in `body.2.n`, and why.
#[derive(Debug)]
pub(super) struct Wrong {
    path: String,
    reason: Reason,
}

#[derive(Debug)]
enum Reason {
    Text(String),
    Import(Box<ImportError>),
}

impl Wrong {
    pub(super) fn new(field: &str, reason: impl ToString) -> Self {
        let (path, reason) = (field.into(), Reason::Text(reason.to_string()));
        Self { path, reason }
    }

    /// A file that gives no shape.
    pub(super) fn file(error: ImportError) -> Self {
        let (path, reason) = ("file".into(), Reason::Import(Box::new(error)));
        Self { path, reason }
    }

    /// The same in an entry of a list, counted from 0.
    pub(super) fn inside(self, list: &str, index: usize) -> Self {
        let path = format!("{list}.{}.{}", index + 1, self.path);
        Self { path, ..self }
    }

    /// The same in a table.
    pub(super) fn under(self, table: &str) -> Self {
        let path = format!("{table}.{}", self.path);
        Self { path, ..self }
    }
}

/// `Ok` when a value is good.
pub(super) fn require(good: bool, field: &str, reason: impl ToString) -> Result<(), Wrong> {
    good.then_some(()).ok_or_else(|| Wrong::new(field, reason))
}

/// That every number is finite and, in a world of two dimensions, the third is 0.
pub(super) fn require_vector(dim: usize, field: &str, vector: [f32; 3]) -> Result<(), Wrong> {
    let finite = vector.iter().all(|k| k.is_finite());
    let found = format!("found {vector:?}");
    require(finite, field, format!("expected finite numbers, {found}"))?;
    let flat = vector[dim..].iter().all(|&k| k == 0.0);
    let expected = "expected 0 for the third axis of a world with dim = 2";
    require(flat, field, format!("{expected}, {found}"))
}

/// Where a scene was read from. It is no part of what the scene says, so that any two are equal.
#[derive(Clone, Debug, Default)]
pub(super) struct Origin {
    pub(super) name: String,
    /// By path, as in `body.2.n`.
    lines: BTreeMap<String, usize>,
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
        let (name, lines) = (name.into(), BTreeMap::new());
        Self { name, lines }
    }

    pub(super) fn error(&self, wrong: Wrong) -> SceneError {
        // A value that is not written down: the line of the entry that it belongs to.
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
                // It may quote a key or a path that is as long as the file.
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

/// `body.2.n` as it is read aloud: body 2, n.
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

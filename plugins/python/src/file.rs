//! Files as arguments: paths, or the bytes themselves.

use crate::convert::Any;
use crate::error::file_error;
use fuwafuwa_scenes::disk::read_bytes;
use fuwafuwa_scenes::import::{Colours, ImportNote};
use pyo3::exceptions::{PyTypeError, PyUserWarning};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::ffi::CString;
use std::path::PathBuf;

/// Contents of a file with its name, for error texts.
pub struct File {
    /// Path, or a description of bytes.
    pub name: String,
    /// Contents.
    pub bytes: Vec<u8>,
}

impl File {
    /// Reads a file of at most `most` bytes from a path, or takes the bytes.
    pub fn read(source: &Any<'_>, most: u64) -> PyResult<Self> {
        if let Ok(bytes) = source.cast::<PyBytes>() {
            let (name, bytes) = ("bytes".to_owned(), bytes.as_bytes().to_vec());
            return Ok(Self { name, bytes });
        }
        let path: PathBuf = source.extract().map_err(|_: PyErr| {
            PyTypeError::new_err("a file must be a path (str or os.PathLike) or bytes")
        })?;
        let bytes = read_bytes(&path, most).map_err(|error| file_error(&path, &error))?;
        let name = path.display().to_string();
        Ok(Self { name, bytes })
    }
}

/// Returns the materials of colours from a dict: keys are tuples of red, green and blue, or indices of a palette.
pub fn colours(materials: Option<&Bound<'_, PyDict>>) -> PyResult<Colours> {
    let mut colours = Colours::default();
    for (key, number) in materials.into_iter().flat_map(|materials| materials.iter()) {
        let number: u8 = number.extract()?;
        if let Ok(index) = key.extract::<u8>() {
            colours.indices.insert(index, number);
        } else {
            let (red, green, blue) = key.extract()?;
            colours.named.insert([red, green, blue], number);
        }
    }
    Ok(colours)
}

/// Shows notes of an importer as warnings, and returns their texts.
pub fn shown(py: Python<'_>, notes: Vec<String>) -> PyResult<Vec<String>> {
    let category = py.get_type::<PyUserWarning>();
    for note in &notes {
        let text = CString::new(note.replace('\0', "\u{fffd}"))?;
        PyErr::warn(py, &category, &text, 1)?;
    }
    Ok(notes)
}

/// Returns the texts of notes.
pub fn texts(notes: &[ImportNote]) -> Vec<String> {
    notes.iter().map(ToString::to_string).collect()
}

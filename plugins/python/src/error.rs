//! The exception `fuwafuwa.Error`, with the words of the errors of the engine.

use pyo3::create_exception;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use std::cell::RefCell;
use std::fmt::Display;
use std::io;
use std::path::Path;

create_exception!(
    fuwafuwa,
    Error,
    PyValueError,
    "A value is invalid, a handle is stale, or a file or a snapshot cannot be read.\n\nThe text names the field, \
     what was expected and what was given. A failed call changes nothing."
);

/// Returns the exception for an error of the engine or of an importer.
pub fn invalid(error: impl Display) -> PyErr {
    Error::new_err(error.to_string())
}

/// Returns the exception for an invalid argument, in the words of the engine.
pub fn invalid_parameter(
    field: impl Into<String>,
    expected: impl Into<String>,
    given: impl Into<String>,
) -> PyErr {
    invalid(fuwafuwa::Error::InvalidParameter {
        field: field.into().into(),
        expected: expected.into().into(),
        given: given.into(),
    })
}

/// Returns the exception for a file that cannot be read or written: the subclass of `OSError` that belongs to the error
/// code.
pub fn file_error(path: &Path, error: &io::Error) -> PyErr {
    let path = path.display().to_string();
    match error.raw_os_error() {
        Some(code) => {
            let text = error.to_string();
            let end = text.find(" (os error").unwrap_or(text.len());
            PyOSError::new_err((code, text[..end].to_owned(), path))
        }
        None => PyOSError::new_err(format!("{path}: {error}")),
    }
}

/// First exception of a function of Python that the engine calls and that cannot stop the engine.
#[derive(Default)]
pub struct FirstException(RefCell<Option<PyErr>>);

impl FirstException {
    /// Returns the result of a call. Returns `otherwise` if the call raises an exception, or an earlier one did.
    pub fn catch<R>(&self, otherwise: R, call: impl FnOnce() -> PyResult<R>) -> R {
        if self.0.borrow().is_some() {
            return otherwise;
        }
        call().unwrap_or_else(|error| {
            self.0.replace(Some(error));
            otherwise
        })
    }

    /// Returns `result`, or the exception.
    pub fn or<R>(self, result: R) -> PyResult<R> {
        self.0.into_inner().map_or(Ok(result), Err)
    }
}

/// Results whose error becomes `fuwafuwa.Error`.
pub trait OrInvalid<T> {
    /// Converts the error to an exception.
    fn or_invalid(self) -> PyResult<T>;
}

impl<T, E: Display> OrInvalid<T> for Result<T, E> {
    fn or_invalid(self) -> PyResult<T> {
        self.map_err(invalid)
    }
}

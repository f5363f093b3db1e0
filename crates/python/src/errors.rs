//! The package's exceptions, and conversions from Rust errors.

use editor::{Source, in_words};
use engine::{Diagnostic, Severity, line_and_column};
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fmt::Display;
use std::io::IsTerminal;

create_exception!(
    infinite_arcade,
    ArcadeError,
    PyException,
    "The requested operation failed; the message gives the reason."
);
create_exception!(
    infinite_arcade,
    LogError,
    ArcadeError,
    "A log is damaged, was changed, or belongs to a different episode."
);
create_exception!(
    infinite_arcade,
    VgdlError,
    PyValueError,
    "A game or level does not compile. The exception prints like the messages of `arcade`; `diagnostics` contains the problems as dictionaries."
);

/// Converts an error to an [`ArcadeError`] with the same message.
pub(crate) fn failed(error: impl Display) -> PyErr {
    ArcadeError::new_err(error.to_string())
}

/// Converts an error to a [`LogError`] with the same message.
pub(crate) fn bad_log(error: impl Display) -> PyErr {
    LogError::new_err(error.to_string())
}

/// Creates a `ValueError` with a message.
pub(crate) fn invalid(message: impl Display) -> PyErr {
    PyValueError::new_err(message.to_string())
}

/// Creates a [`VgdlError`] with a text's problems. `name` identifies the text in messages.
pub(crate) fn malformed(py: Python<'_>, name: &str, text: &str, problems: &[Diagnostic]) -> PyErr {
    let source = Source { name, text, is_coloured: std::io::stderr().is_terminal() };
    let error = VgdlError::new_err(in_words(source, problems));
    let listed =
        problems.iter().map(|problem| described(py, name, text, problem)).collect::<PyResult<Vec<_>>>();
    let listed = listed.and_then(|listed| error.value(py).setattr("diagnostics", listed));
    listed.err().unwrap_or(error)
}

/// Converts a problem to a dictionary.
pub(crate) fn described<'py>(
    py: Python<'py>,
    name: &str,
    text: &str,
    problem: &Diagnostic,
) -> PyResult<Bound<'py, PyDict>> {
    let (line, column) = line_and_column(text, problem.span.start);
    let entry = PyDict::new(py);
    entry.set_item("file", name)?;
    entry.set_item("line", line)?;
    entry.set_item("column", column)?;
    entry.set_item("code", problem.code)?;
    entry.set_item("severity", if problem.severity == Severity::Error { "error" } else { "warning" })?;
    entry.set_item("message", &problem.message)?;
    entry.set_item("label", &problem.label)?;
    entry.set_item("help", &problem.help)?;
    entry.set_item("start", problem.span.start)?;
    entry.set_item("end", problem.span.end)?;
    Ok(entry)
}

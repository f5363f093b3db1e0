//! The crate's error type.

use base::MessagePath;
use std::fmt;
use std::path::{Path, PathBuf};

/// The reason why an evaluation cannot be created, continued or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluationError {
    /// Access to a file or folder failed.
    #[error("cannot {action} {}", path.in_message())]
    Io {
        /// The operation that failed.
        action: &'static str,
        /// The path to the file or folder.
        path: PathBuf,
        /// The operating system's error.
        source: std::io::Error,
    },
    /// The request is malformed. The message contains the cause and the next step.
    #[error("{0}")]
    Malformed(String),
}

impl EvaluationError {
    /// Returns the error for a file or folder whose content is invalid.
    pub(crate) fn malformed(path: &Path, what: impl fmt::Display) -> EvaluationError {
        EvaluationError::Malformed(format!("{}: {what}", path.in_message()))
    }

    /// Returns a closure for `map_err` that converts the I/O error of an operation on a path.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> EvaluationError {
        let path = path.to_owned();
        move |source| EvaluationError::Io { action, path, source }
    }
}

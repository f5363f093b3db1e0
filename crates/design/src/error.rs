//! The crate's error type.

use base::MessagePath;
use evaluation::EvaluationError;
use std::io;
use std::path::{Path, PathBuf};

/// The reason why drafts cannot be created, continued or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DesignError {
    /// Access to a file or folder failed.
    #[error("cannot {action} {}", path.in_message())]
    Io {
        /// The operation that failed.
        action: &'static str,
        /// The path to the file or folder.
        path: PathBuf,
        /// The operating system's error.
        source: io::Error,
    },
    /// The request or a file is malformed. The message contains the cause and the next step.
    #[error("{0}")]
    Malformed(String),
    /// A log or a mailbox cannot be used.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
}

impl DesignError {
    /// Returns the error for a file or folder whose content is invalid.
    pub(crate) fn malformed(path: &Path, what: &str) -> DesignError {
        DesignError::Malformed(format!("{}: {what}", path.in_message()))
    }

    /// Returns a closure for `map_err` that converts the I/O error of an operation on a path.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> DesignError {
        let path = path.to_owned();
        move |source| DesignError::Io { action, path, source }
    }
}

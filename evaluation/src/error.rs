//! What can be wrong with an evaluation.

use std::path::{Path, PathBuf};

/// Why an evaluation cannot be set up, continued or read.
#[derive(Debug, thiserror::Error)]
pub enum EvaluationError {
    /// A file or folder cannot be used.
    #[error("cannot {action} {}", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// On what.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The question is malformed, in these words: they name the thing and the next move.
    #[error("{0}")]
    Malformed(String),
}

impl EvaluationError {
    /// For `map_err`.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> EvaluationError {
        let path = path.to_owned();
        move |source| EvaluationError::Io { action, path, source }
    }
}

//! Report files, and report rendering errors.

use evaluation::EvaluationError;
use std::error::Error;

/// A report file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// The path relative to the report's folder, separated by `/`.
    pub name: String,
    /// The file's content.
    pub bytes: Vec<u8>,
}

impl File {
    pub(crate) fn text((name, text): (String, String)) -> File {
        File { name, bytes: text.into_bytes() }
    }
}

/// The reason why a report cannot be rendered.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// An episode's log cannot be read.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// An image or a page cannot be rendered.
    #[error("{what}")]
    Failed {
        /// The part of the report that failed.
        what: &'static str,
        /// The error that caused the failure.
        source: Box<dyn Error + Send + Sync>,
    },
}

impl PageError {
    pub(crate) fn failed<E: Error + Send + Sync + 'static>(
        what: &'static str,
    ) -> impl FnOnce(E) -> PageError {
        move |error| PageError::Failed { what, source: Box::new(error) }
    }
}

//! The errors of this crate.

use base::MessagePath;
use std::io;
use std::path::{Path, PathBuf};

/// The reasons for having no answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TrustError {
    /// The file system refuses.
    #[error("cannot {action} `{}`", path.in_message())]
    Io {
        /// The verb of the operation that failed.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
    /// A text is no key.
    #[error("{0}")]
    Key(String),
    /// A document is malformed.
    #[error("`{place}`: {fault}")]
    Document {
        /// The file.
        place: String,
        /// The fault, and the next move.
        fault: String,
    },
    /// Something cannot be done as asked.
    #[error("{0}")]
    Refused(String),
}

impl TrustError {
    /// Returns a function that makes the error of an operation.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> TrustError {
        let path = path.to_path_buf();
        move |source| TrustError::Io { action, path, source }
    }

    /// The error of a malformed document.
    pub(crate) fn document(place: impl Into<String>, fault: impl Into<String>) -> TrustError {
        TrustError::Document { place: place.into(), fault: fault.into() }
    }
}

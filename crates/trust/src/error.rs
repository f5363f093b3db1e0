//! The error type of this crate.

use base::MessagePath;
use std::io;
use std::path::{Path, PathBuf};

/// A reason why an operation fails.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TrustError {
    /// The file system refuses.
    #[error("cannot {action} `{}`", path.in_message())]
    Io {
        /// The verb of the failed operation.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
    /// A text is not a key.
    #[error("{0}")]
    Key(String),
    /// A document is malformed.
    #[error("`{place}`: {fault}")]
    Document {
        /// The file.
        place: String,
        /// The fault, and the recommended next step.
        fault: String,
    },
    /// A request cannot be fulfilled.
    #[error("{0}")]
    Refused(String),
}

impl TrustError {
    /// Returns a function that converts an I/O error of an operation.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> TrustError {
        let path = path.to_path_buf();
        move |source| TrustError::Io { action, path, source }
    }

    /// Returns the error for a malformed document.
    pub(crate) fn document(place: impl Into<String>, fault: impl Into<String>) -> TrustError {
        TrustError::Document { place: place.into(), fault: fault.into() }
    }
}

//! The crate's error type.

use base::MessagePath;
use std::io;
use std::path::{Path, PathBuf};

/// The reason for a failed operation.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TrustError {
    /// Access to a file or folder failed.
    #[error("cannot {action} `{}`", path.in_message())]
    Io {
        /// The verb for the failed operation.
        action: &'static str,
        /// The path to the file or folder.
        path: PathBuf,
        /// The file system's error.
        source: io::Error,
    },
    /// The text is not a key.
    #[error("{0}")]
    Key(String),
    /// The document is malformed.
    #[error("`{place}`: {fault}")]
    Document {
        /// The document's name.
        place: String,
        /// A sentence that describes the fault and the recommended next step.
        fault: String,
    },
    /// The request was rejected.
    #[error("{0}")]
    Refused(String),
}

impl TrustError {
    /// Returns a closure that converts an I/O error for an operation on a path.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> TrustError {
        let path = path.to_path_buf();
        move |source| TrustError::Io { action, path, source }
    }

    /// Returns the error for a malformed document.
    pub(crate) fn document(place: impl Into<String>, fault: impl Into<String>) -> TrustError {
        TrustError::Document { place: place.into(), fault: fault.into() }
    }
}

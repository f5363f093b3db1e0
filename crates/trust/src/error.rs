//! The error type of this crate.

use base::MessagePath;
use std::io;
use std::path::{Path, PathBuf};

/// The reason why an operation of this crate failed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TrustError {
    /// A file or folder cannot be accessed.
    #[error("cannot {action} `{}`", path.in_message())]
    Io {
        /// The verb for the failed operation.
        action: &'static str,
        /// The path of the file or folder.
        path: PathBuf,
        /// The error of the file system.
        source: io::Error,
    },
    /// A text is not a key.
    #[error("{0}")]
    Key(String),
    /// A document is malformed.
    #[error("`{place}`: {fault}")]
    Document {
        /// The name of the document.
        place: String,
        /// A sentence about the fault, and the recommended next step.
        fault: String,
    },
    /// A request cannot be fulfilled.
    #[error("{0}")]
    Refused(String),
}

impl TrustError {
    /// Returns a function that converts the I/O error of an operation on a path.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> TrustError {
        let path = path.to_path_buf();
        move |source| TrustError::Io { action, path, source }
    }

    /// Returns the error for a malformed document.
    pub(crate) fn document(place: impl Into<String>, fault: impl Into<String>) -> TrustError {
        TrustError::Document { place: place.into(), fault: fault.into() }
    }
}

//! Paths: their text form, and the lookup of files and folders.

use crate::failure::Failure;
use std::borrow::Cow;
use std::fs::{self, Metadata};
use std::io::ErrorKind;
use std::path::Path;

/// Returns the path for a JSON document: bytes that are not UTF-8 become U+FFFD. `json!` panics on a path that is not
/// UTF-8, so that no path goes into a document directly.
pub(crate) fn in_json(path: &Path) -> Cow<'_, str> {
    path.to_string_lossy()
}

/// Returns the metadata of the file or folder at `path`, following links; none if nothing is there. A folder that may
/// not be entered is a failure, not an absence.
pub(crate) fn metadata(path: &Path) -> Result<Option<Metadata>, Failure> {
    match fs::metadata(path) {
        Ok(found) => Ok(Some(found)),
        Err(error) => match error.kind() {
            ErrorKind::NotFound | ErrorKind::NotADirectory | ErrorKind::InvalidFilename => Ok(None),
            _ => Err(Failure::read(path, error)),
        },
    }
}

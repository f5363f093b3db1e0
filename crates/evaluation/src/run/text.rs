//! Reads files from a results folder whose source may be untrusted. Reads only regular files up to a size
//! limit.

use crate::error::EvaluationError;
use std::fs;
use std::fs::File;
use std::io::ErrorKind;
use std::path::Path;

/// The recommendation in error messages about unreadable files in a results folder.
pub(crate) const RESTORE: &str = "restore the results folder";

/// Returns `true` if a file or folder exists within a results folder. A dangling link is an error, because
/// its target has been lost.
///
/// # Errors
/// Returns an error if the path is a dangling link, or cannot be examined.
pub(crate) fn is_there(path: &Path) -> Result<bool, EvaluationError> {
    match fs::symlink_metadata(path) {
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(false),
        Err(error) => Err(EvaluationError::io("examine", path)(error)),
        Ok(found) if found.is_symlink() && fs::metadata(path).is_err() => {
            Err(EvaluationError::malformed(path, format!("a broken link; {RESTORE}")))
        }
        Ok(_) => Ok(true),
    }
}

/// Opens a regular file of at most `limit` bytes. Files of other kinds are never opened, because opening a
/// pipe, for example, can block forever. `next_step` is appended to error messages.
///
/// # Errors
/// Returns an error if the path is not a regular file, exceeds the limit, or cannot be read.
pub(crate) fn open_file(path: &Path, limit: u64, next_step: &str) -> Result<File, EvaluationError> {
    let file = match disk::open(path) {
        Err(error) if matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::IsADirectory) => {
            return Err(EvaluationError::malformed(path, format!("not a file; {next_step}")));
        }
        opened => opened.map_err(EvaluationError::io("read", path))?,
    };
    let found = file.metadata().map_err(EvaluationError::io("read", path))?;
    if found.len() > limit {
        let what = format!("larger than {limit} bytes, the limit for such a file; {next_step}");
        return Err(EvaluationError::malformed(path, what));
    }
    Ok(file)
}

/// Reads a text file of at most `limit` bytes.
///
/// # Errors
/// Returns an error in the same cases as [`open_file`], or if the file is not text.
pub(crate) fn read_text(path: &Path, limit: usize, next_step: &str) -> Result<String, EvaluationError> {
    let file = open_file(path, limit as u64, next_step)?;
    let bytes = disk::start(file, limit as u64 + 1).map_err(EvaluationError::io("read", path))?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let what = format!("not a text file (byte {at} is not UTF-8); {next_step}");
        EvaluationError::malformed(path, what)
    })
}

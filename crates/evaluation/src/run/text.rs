//! Files of a results folder from a possibly untrusted source: only regular files are read, and only up to a limit.

use crate::error::EvaluationError;
use std::fs;
use std::fs::File;
use std::io::ErrorKind;
use std::path::Path;

/// The next step for a file of a results folder that cannot be read.
pub(crate) const RESTORE: &str = "restore the results folder";

/// Tests whether a file or folder of a results folder is there. What a dangling link led to is lost, not absent.
///
/// # Errors
/// It is a link that leads nowhere, or cannot be examined.
pub(crate) fn is_there(path: &Path) -> Result<bool, EvaluationError> {
    match fs::symlink_metadata(path) {
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(false),
        Err(error) => Err(EvaluationError::io("examine", path)(error)),
        Ok(found) if found.is_symlink() && fs::metadata(path).is_err() => {
            Err(EvaluationError::malformed(path, format!("a link that leads to no file; {RESTORE}")))
        }
        Ok(_) => Ok(true),
    }
}

/// Opens a regular file of at most `limit` bytes; `next_step` ends the message about any other. Other files, such as a pipe, are not opened, because that could block
/// forever.
///
/// # Errors
/// It is not a regular file, is larger, or cannot be read.
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

/// Reads a text of at most `limit` bytes.
///
/// # Errors
/// The same as for [`open_file`], or the file is not text.
pub(crate) fn read_text(path: &Path, limit: usize, next_step: &str) -> Result<String, EvaluationError> {
    let file = open_file(path, limit as u64, next_step)?;
    let bytes = disk::start(file, limit as u64 + 1).map_err(EvaluationError::io("read", path))?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let what = format!("not a text file (byte {at} is not UTF-8); {next_step}");
        EvaluationError::malformed(path, what)
    })
}

//! Files of a results folder from a possibly untrusted source: only regular files are read, and only up to a limit.

use crate::error::EvaluationError;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Opens a regular file of at most `limit` bytes. Other files, such as a pipe, are not opened, because that could block
/// forever.
///
/// # Errors
/// It is not a regular file, is larger, or cannot be read.
pub(crate) fn open_file(path: &Path, limit: u64) -> Result<File, EvaluationError> {
    let found = path.metadata().map_err(EvaluationError::io("read", path))?;
    if !found.is_file() {
        return Err(EvaluationError::malformed(path, "not a file; restore the results folder"));
    }
    if found.len() > limit {
        let what = format!("larger than {limit} bytes, the limit for such a file");
        return Err(EvaluationError::malformed(path, what));
    }
    File::open(path).map_err(EvaluationError::io("read", path))
}

/// Reads a text of at most `limit` bytes.
///
/// # Errors
/// The same as for [`open_file`], or the file is not text.
pub(crate) fn read_text(path: &Path, limit: usize) -> Result<String, EvaluationError> {
    let mut bytes = Vec::new();
    let mut file = open_file(path, limit as u64)?.take(limit as u64 + 1);
    file.read_to_end(&mut bytes).map_err(EvaluationError::io("read", path))?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let what = format!("not a text file (byte {at} is not UTF-8); restore the results folder");
        EvaluationError::malformed(path, what)
    })
}

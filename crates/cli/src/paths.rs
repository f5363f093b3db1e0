//! Paths: their textual form, and the lookup of files and folders.

use crate::failure::Failure;
use clap::builder::{PathBufValueParser, TypedValueParser};
use snapshots::MANIFEST_FILE;
use std::borrow::Cow;
use std::fs::{self, Metadata};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Returns the path as text for a JSON document. Invalid UTF-8 is replaced with U+FFFD. Paths must not be
/// inserted into a document directly, because `json!` panics on a non-UTF-8 path.
pub(crate) fn in_json(path: &Path) -> Cow<'_, str> {
    path.to_string_lossy()
}

/// Returns the metadata of the file or folder at `path`, following links. Returns `None` if nothing exists at
/// `path`. A folder that denies access is a failure, not a missing file.
pub(crate) fn metadata(path: &Path) -> Result<Option<Metadata>, Failure> {
    match fs::metadata(path) {
        Ok(found) => Ok(Some(found)),
        Err(error) => absent_or_failed(path, error),
    }
}

/// Returns a release's folder: `place` itself, or its subfolder `public` if `place` contains the two parts (public and
/// withheld) of a sealed release.
pub(crate) fn release(place: PathBuf) -> PathBuf {
    let public = place.join("public");
    match !place.join(MANIFEST_FILE).exists() && public.join(MANIFEST_FILE).is_file() {
        true => public,
        false => place,
    }
}

/// Returns a parser for arguments that specify a release (see [`release`]).
pub(crate) fn release_parser() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().map(release)
}

fn absent_or_failed<T>(path: &Path, error: std::io::Error) -> Result<Option<T>, Failure> {
    match error.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory | ErrorKind::InvalidFilename => Ok(None),
        _ => Err(Failure::read(path, error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unreadable_folders_are_not_absent() {
        let metadata = |kind: ErrorKind| absent_or_failed::<()>(Path::new("a/b"), kind.into());
        assert!(metadata(ErrorKind::NotFound).expect("absent").is_none());
        assert!(metadata(ErrorKind::NotADirectory).expect("absent").is_none());
        let refused = metadata(ErrorKind::PermissionDenied).expect_err("refused");
        assert_eq!(refused.code(), crate::failure::ENVIRONMENT);
        assert!(refused.to_string().starts_with("cannot read `a/b`: permission denied"), "{refused}");
    }

    #[cfg(unix)]
    #[test]
    fn paths_that_are_not_utf8_have_a_text() {
        use std::os::unix::ffi::OsStrExt;
        let path = Path::new(std::ffi::OsStr::from_bytes(b"caf\xe9.gif"));
        assert_eq!(serde_json::json!({ "file": in_json(path) })["file"], "caf\u{fffd}.gif");
    }
}

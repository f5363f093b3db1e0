//! Paths as text.

use std::borrow::Cow;
use std::path::Path;

/// The path for a JSON document: bytes that are not UTF-8 become U+FFFD. `json!` panics on a path that is not UTF-8, so
/// that no path goes into a document by itself.
pub(crate) fn in_json(path: &Path) -> Cow<'_, str> {
    path.to_string_lossy()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn paths_that_are_not_utf8_have_a_text() {
        use std::os::unix::ffi::OsStrExt;
        let path = Path::new(std::ffi::OsStr::from_bytes(b"caf\xe9.gif"));
        assert_eq!(serde_json::json!({ "file": in_json(path) })["file"], "caf\u{fffd}.gif");
    }
}

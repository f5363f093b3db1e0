//! Detection of unpublished releases.

use crate::error::SnapshotError;
use std::path::Path;

/// Rejects `.partial` folders and everything inside them, because even a complete release does not count until it is
/// published.
pub(crate) fn refuse_unfinished(root: &Path) -> Result<(), SnapshotError> {
    let real = std::fs::canonicalize(root).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => SnapshotError::NotASnapshot(root.to_path_buf()),
        _ => SnapshotError::Io { action: "examine", path: root.to_path_buf(), source },
    })?;
    // For folders further up, the name alone is weak evidence, so the folder must also contain a draft.
    let is_draft = |folder: &Path| folder.join(".lock").exists() && folder.join("tree").exists();
    let unfinished = real.ancestors().enumerate().any(|(above, folder)| {
        folder.extension().is_some_and(|end| end == "partial") && (above < 2 || is_draft(folder))
    });
    if unfinished { Err(SnapshotError::Unfinished(root.to_path_buf())) } else { Ok(()) }
}

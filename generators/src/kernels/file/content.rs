//! The kernel and scene files embedded in this crate.

use include_dir::{Dir, include_dir};

/// The kernel files.
pub(crate) static KERNELS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/kernels");
/// The scene files.
pub(crate) static SCENES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/scenes");

/// Returns the name (without extension) and content of each TOML file in a folder, sorted by name.
pub(crate) fn files(folder: &'static Dir<'static>) -> impl Iterator<Item = (&'static str, &'static str)> {
    let file = |path: &'static std::path::Path| path.file_name()?.to_str()?.strip_suffix(".toml");
    let mut files: Vec<(&str, &str)> =
        folder.files().filter_map(|entry| Some((file(entry.path())?, entry.contents_utf8()?))).collect();
    files.sort_unstable();
    files.into_iter()
}

//! Waiting until names are on disk: a rename or a new folder is durable only when the folder that holds the name is
//! synced.

use std::fs::{self, File};
use std::path::Path;

use crate::error::SnapshotError;

/// Waits until the names in `folder` and all folders below are on disk, the deepest first.
pub(super) fn sync_folders(folder: &Path) -> Result<(), SnapshotError> {
    for entry in fs::read_dir(folder).map_err(SnapshotError::io("list", folder))? {
        let entry = entry.map_err(SnapshotError::io("list", folder))?;
        if entry.file_type().map_err(SnapshotError::io("examine", &entry.path()))?.is_dir() {
            sync_folders(&entry.path())?;
        }
    }
    sync_folder(folder)
}

/// Waits until the names in `folder` are on disk. Only Unix lets a folder be opened and synced; elsewhere the file
/// system's journal must suffice.
pub(crate) fn sync_folder(folder: &Path) -> Result<(), SnapshotError> {
    if cfg!(unix) {
        let sync = || File::open(folder)?.sync_all();
        sync().map_err(SnapshotError::io("write", folder))?;
    }
    #[cfg(test)]
    record::SYNCED.with_borrow_mut(|synced| synced.push(folder.to_path_buf()));
    Ok(())
}

/// Creates `folder` and its missing parents, and waits until their names are on disk.
pub(crate) fn create_folder(folder: &Path) -> Result<(), SnapshotError> {
    let is_missing = |above: &&Path| !above.as_os_str().is_empty() && !above.exists();
    let missing: Vec<&Path> = folder.ancestors().take_while(is_missing).collect();
    fs::create_dir_all(folder).map_err(SnapshotError::io("create", folder))?;
    missing.into_iter().try_for_each(|created| sync_folder(parent_of(created)))
}

/// The folder that holds `path`, never the empty path.
pub(super) fn parent_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

/// The folders that this thread has waited for.
#[cfg(test)]
pub(crate) mod record {
    use std::cell::RefCell;
    use std::path::PathBuf;

    thread_local! {
        pub(super) static SYNCED: RefCell<Vec<PathBuf>> = const { RefCell::new(Vec::new()) };
    }

    /// The folders synced since the last call.
    pub(crate) fn synced() -> Vec<PathBuf> {
        SYNCED.with_borrow_mut(std::mem::take)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Draft;
    use super::super::tests::home;
    use super::record::synced;

    /// A published release is synced, with the names of all new folders above it.
    #[test]
    fn new_names_are_synced() {
        let (home, _) = home();
        let out = home.path().join("a/b/new");
        synced();
        let draft = Draft::create(&out).expect("vacant");
        let parents = synced();
        for above in ["", "a"] {
            assert!(parents.contains(&home.path().join(above)), "{parents:?}");
        }
        draft.write("c/d", b"one").expect("written");
        draft.commit().expect("published");
        let partial = home.path().join("a/b/new.partial");
        let expect = [partial.join("tree/c"), partial.join("tree"), home.path().join("a/b")];
        assert_eq!(synced(), expect);
    }
}

//! Functions that wait until names are on disk. A rename or a new folder is durable only after the folder that
//! contains its name has been synced.

use std::fs;
use std::path::Path;

use crate::error::SnapshotError;

/// Waits until the names in `folder` and in all folders below it are on disk, deepest first.
pub(super) fn sync_folders(folder: &Path) -> Result<(), SnapshotError> {
    for entry in fs::read_dir(folder).map_err(SnapshotError::io("list", folder))? {
        let entry = entry.map_err(SnapshotError::io("list", folder))?;
        if entry.file_type().map_err(SnapshotError::io("examine", &entry.path()))?.is_dir() {
            sync_folders(&entry.path())?;
        }
    }
    sync_folder(folder)
}

/// Waits until the names in `folder` are on disk.
pub(super) fn sync_folder(folder: &Path) -> Result<(), SnapshotError> {
    disk::sync_folder(folder).map_err(SnapshotError::io("write", folder))?;
    #[cfg(test)]
    record::SYNCED.with_borrow_mut(|synced| synced.push(folder.to_path_buf()));
    Ok(())
}

/// A record of the folders that this thread has synced.
#[cfg(test)]
mod record {
    use std::cell::RefCell;
    use std::path::PathBuf;

    thread_local! {
        pub(super) static SYNCED: RefCell<Vec<PathBuf>> = const { RefCell::new(Vec::new()) };
    }

    /// Returns the folders synced since the last call.
    pub(super) fn synced() -> Vec<PathBuf> {
        SYNCED.with_borrow_mut(std::mem::take)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Draft;
    use super::super::tests::home;
    use super::record::synced;

    /// A published release is synced from the deepest folder up to the folder that contains the release's
    /// name.
    #[test]
    fn new_names_are_synced() {
        let (home, _) = home();
        let out = home.path().join("a/b/new");
        let draft = Draft::create(&out).expect("vacant");
        synced();
        draft.write("c/d", b"one").expect("written");
        draft.commit().expect("published");
        let partial = home.path().join("a/b/new.partial");
        let expect = [partial.join("tree/c"), partial.join("tree"), home.path().join("a/b")];
        assert_eq!(synced(), expect);
    }
}

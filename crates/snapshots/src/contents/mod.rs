//! Access to a release, which is either a folder or an archive.

pub mod archive;
pub(crate) mod disclose;
pub(crate) mod integrity;
pub mod proof;
pub(crate) mod replay;
pub(crate) mod unfinished;
pub(crate) mod untracked;

use std::fs;
use std::path::{Path, PathBuf};

use crate::contents::archive::Archive;
use crate::contents::integrity::{Integrity, check_integrity};
use crate::error::SnapshotError;
use crate::format::folder::{self, Limits};

/// The source of a release's files.
pub(crate) enum Contents {
    /// A release folder.
    Folder(PathBuf),
    /// A release archive, in memory.
    Archive(Box<Archive>),
}

/// Checks the integrity of the release at `place`, a folder or an archive, without keeping its files in
/// memory.
///
/// # Errors
/// See [`check_integrity`] and [`Archive::check`].
pub fn integrity_of(place: &Path) -> Result<Integrity, SnapshotError> {
    if is_file(place) { Archive::check(place) } else { check_integrity(place) }
}

/// Returns `true` if the release at `place` is a single file.
pub(crate) fn is_file(place: &Path) -> bool {
    fs::metadata(place).is_ok_and(|found| found.is_file())
}

impl Contents {
    /// Checks the integrity of the release at `place`, a folder or an archive, and returns access to its files.
    ///
    /// # Errors
    /// See [`check_integrity`] and [`Archive::open`].
    pub(crate) fn open(place: &Path) -> Result<(Integrity, Contents), SnapshotError> {
        if is_file(place) {
            let archive = Archive::open(place)?;
            return Ok((archive.integrity.clone(), Contents::Archive(Box::new(archive))));
        }
        Ok((check_integrity(place)?, Contents::Folder(place.to_path_buf())))
    }

    /// Returns the content of a file; `None` if there is no such file.
    ///
    /// # Errors
    /// See [`folder::read`].
    pub(crate) fn find(&self, path: &str) -> Result<Option<Vec<u8>>, SnapshotError> {
        match self {
            Contents::Folder(root) => folder::find(root, path, Limits::SNAPSHOT.file_bytes),
            Contents::Archive(archive) => Ok(archive.file(path).map(<[u8]>::to_vec)),
        }
    }

    /// Returns the content of a file listed in the manifest.
    ///
    /// # Errors
    /// See [`folder::read`]. For an archive, returns an error if there is no such file.
    pub(crate) fn read(&self, path: &str) -> Result<Vec<u8>, SnapshotError> {
        match self {
            Contents::Folder(root) => folder::read(root, path, Limits::SNAPSHOT.file_bytes),
            Contents::Archive(archive) => {
                archive.file(path).map(<[u8]>::to_vec).ok_or_else(|| SnapshotError::Io {
                    action: "find",
                    path: path.into(),
                    source: std::io::ErrorKind::NotFound.into(),
                })
            }
        }
    }
}

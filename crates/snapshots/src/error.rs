//! The crate's error type. Errors concern operations, never a VGDL file.

use base::MessagePath;
use std::io;
use std::path::{Path, PathBuf};

use crate::format::merkle::DuplicatePath;
use crate::format::path::PathProblem;
use base::canonical::CanonicalError;

/// A reason why a release folder cannot be written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SnapshotError {
    /// A file system operation failed.
    #[error("cannot {action} `{}`", .path.in_message())]
    Io {
        /// The failed operation as a verb, as in "cannot read".
        action: &'static str,
        /// The path on which the operation failed.
        path: PathBuf,
        /// The operating system's error.
        source: io::Error,
    },
    /// The output path is already occupied.
    #[error("`{}` already exists and is not an empty folder: choose another --out", .0.in_message())]
    Occupied(PathBuf),
    /// The output path lies below a file.
    #[error("`{}` cannot be created, because part of its path is a file; choose another --out", .0.in_message())]
    BelowFile(PathBuf),
    /// A folder whose name ends in `.partial` was not left by a killed run.
    #[error("`{}` was not made by arcade: choose another --out or move it away", .0.in_message())]
    Foreign(PathBuf),
    /// The output path contains the work of an interrupted run.
    #[error("`{}` holds the work of an interrupted run: continue with the same command and --resume, or remove the folder to start over", .0.in_message())]
    Interrupted(PathBuf),
    /// The finished jobs belong to a different mint.
    #[error(
        "`{}` holds work from a different recipe, different flags or a different arcade version: continue \
         with those, or choose another --out",
        .0.in_message()
    )]
    OtherPlan(PathBuf),
    /// The release to be packed is sealed, so part of it is withheld.
    #[error("`{}` is sealed, and only a complete release can be packed: reveal it first", .0.in_message())]
    HeldBack(PathBuf),
    /// A file in a shard (a separately minted part of a release) differs from its entry in the shard's list.
    #[error("`{}` was changed after it was made: fetch the shard again, or mint it again", .0.in_message())]
    Altered(PathBuf),
    /// A file that should contain a sealed release's secret does not contain one.
    #[error("`{}` is not the secret of a sealed release: {source}", .path.in_message())]
    NotASecret {
        /// The file without a secret.
        path: PathBuf,
        /// The error from parsing the secret.
        source: serde_json::Error,
    },
    /// The secret was not drawn by arcade.
    #[error(
        "`{}` is not a valid secret: {what}; draw one with `arcade release RECIPE --commit`", .path.in_message()
    )]
    WeakSecret {
        /// The file with the invalid secret.
        path: PathBuf,
        /// The problem with the secret.
        what: String,
    },
    /// A different process is writing to the output path.
    #[error("another arcade process is writing `{}`: wait for it to finish, or choose another --out", .0.in_message())]
    Busy(PathBuf),
    /// The output path ends in `..` or `.` or is the root of the file system.
    #[error("`{}` does not end in a folder name: specify the folder to create, as in --out releases/new", .0.in_message())]
    Nameless(PathBuf),
    /// The relative path is not allowed in a release.
    #[error("`{}` cannot be in a snapshot: {problem}; rename it", path.escape_debug())]
    Path {
        /// The path as stated.
        path: String,
        /// The rule that the path violates.
        problem: PathProblem,
    },
    /// A symbolic link. Releases contain only files and folders.
    #[error("`{}` is a symbolic link, and links are not followed: replace it with the file", .0.in_message())]
    Link(PathBuf),
    /// A folder, pipe or device where a file should be, or a file where a folder should be.
    #[error("`{}` is not a {expected}: fetch the snapshot again", .path.in_message())]
    ReleaseKind {
        /// The entry's path.
        path: PathBuf,
        /// The expected kind of entry: "file" or "folder".
        expected: &'static str,
    },
    /// A file exceeds the size limit.
    #[error("`{}` is larger than {limit} bytes, the limit for a file in a snapshot: split it", .path.in_message())]
    TooLarge {
        /// The oversized file.
        path: PathBuf,
        /// The limit, in bytes.
        limit: u64,
    },
    /// The folder has no manifest, or the file is not an archive.
    #[error("`{}` has no MANIFEST.json: pass a snapshot folder or its .tar.zst", .0.in_message())]
    NotASnapshot(PathBuf),
    /// A single file was given, but a folder is required.
    #[error("`{}` is not a folder: pass the snapshot's folder; unpack an archive first, for example with tar \
             -xf", .0.in_message())]
    NotAFolder(PathBuf),
    /// The path is inside a `.partial` folder.
    #[error(
        "`{}` is unfinished: continue minting it with `arcade release RECIPE --out {} --resume`, or mint it \
         again",
        .0.in_message(), finished(.0)
    )]
    Unfinished(PathBuf),
    /// The manifest's format is newer than every format supported by this binary.
    #[error(
        "snapshot format {found} is newer than this version of arcade supports ({known}): use a newer version"
    )]
    Format {
        /// The format stated in the manifest.
        found: u64,
        /// The newest format supported by this binary.
        known: u32,
    },
    /// The manifest is not JSON, or does not have the expected structure.
    #[error("`{}` is not a snapshot manifest: fetch the snapshot again", .path.in_message())]
    Syntax {
        /// The manifest's path.
        path: PathBuf,
        /// The position of the error, and the expected content.
        source: serde_json::Error,
    },
    /// The manifest contradicts itself or exceeds its limits.
    #[error("`{}` is not a valid manifest: {message}", .path.in_message())]
    Manifest {
        /// The manifest's path.
        path: PathBuf,
        /// The problem, including the item's name.
        message: String,
    },
    /// A folder being searched for releases contains too many entries.
    #[error("`{}` contains more than {limit} files and folders: pass the releases one by one", .path.in_message())]
    Crowded {
        /// The folder with too many entries.
        path: PathBuf,
        /// The maximum number of entries.
        limit: usize,
    },
    /// A folder being searched for releases does not contain a release.
    #[error("`{}` contains no release: pass a snapshot folder, its .tar.zst, or a folder that contains snapshots", .0.in_message())]
    NoRelease(PathBuf),
    /// An archive is damaged so close to its start that its manifest cannot be read.
    #[error("`{}` is not a valid archive: {message}", .path.in_message())]
    Archive {
        /// The path of the damaged archive.
        path: PathBuf,
        /// The problem with the archive.
        message: String,
    },
    /// A file to be written already exists.
    #[error("`{}` already exists: choose another --out", .0.in_message())]
    Taken(PathBuf),
    /// A sound release is required, but a release does not match its manifest.
    #[error("`{}` does not verify ({first}; and {more} more): run `arcade verify` on it", .path.in_message())]
    Unsound {
        /// The path of the unsound release.
        path: PathBuf,
        /// The release's first problem.
        first: String,
        /// The number of additional problems.
        more: usize,
    },
    /// A file changed between two accesses.
    #[error("`{}` changed while it was being read: stop other programs from writing there, and try again", .0.in_message())]
    Changed(PathBuf),
    /// A path is too long for a tar header.
    #[error("the path `{0}` is too long for an archive: distribute the folder instead")]
    Untarable(String),
    /// A value, most likely the recipe, cannot be written as canonical JSON.
    #[error(transparent)]
    Canonical(#[from] CanonicalError),
    /// Two items have the same path.
    #[error(transparent)]
    DuplicatePath(#[from] DuplicatePath),
}

/// Returns the final name of an unfinished folder, for messages. The path may also be inside that folder.
fn finished(unfinished: &Path) -> String {
    let draft = unfinished.ancestors().find(|folder| folder.extension().is_some_and(|end| end == "partial"));
    draft.map_or_else(|| "DIR".to_owned(), |draft| draft.with_extension("").in_message().to_string())
}

impl SnapshotError {
    /// Returns a closure for `map_err` that creates the error for a failed `action` on `path`.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> SnapshotError {
        move |source| SnapshotError::Io { action, path: path.to_path_buf(), source }
    }

    /// Returns the same error with `place` as the manifest's path. Manifests are parsed from bytes, without a path.
    pub(crate) fn in_manifest(self, place: &Path) -> SnapshotError {
        let path = place.to_path_buf();
        match self {
            SnapshotError::Syntax { source, .. } => SnapshotError::Syntax { path, source },
            SnapshotError::Manifest { message, .. } => SnapshotError::Manifest { path, message },
            other => other,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::error::Error;

    use super::*;

    #[test]
    fn messages_name_the_thing_and_the_next_move() {
        let newer = SnapshotError::Format { found: 7, known: 1 };
        assert_eq!(
            newer.to_string(),
            "snapshot format 7 is newer than this version of arcade supports (1): use a newer version"
        );
        let occupied = SnapshotError::Occupied("releases/new".into());
        assert_eq!(
            occupied.to_string(),
            "`releases/new` already exists and is not an empty folder: choose another --out"
        );
    }

    #[test]
    fn the_source_is_kept() {
        let refused = io::Error::from(io::ErrorKind::PermissionDenied);
        let error = SnapshotError::io("read", Path::new("a/b"))(refused);
        assert_eq!(error.to_string(), "cannot read `a/b`");
        assert!(error.source().is_some());
    }

    /// A path from a manifest may contain any character, so it must be escaped before it reaches a terminal.
    #[test]
    fn control_characters_are_escaped() {
        let path = "a\u{1b}[2Jb".to_string();
        let error = SnapshotError::Path { problem: PathProblem::Character('\u{1b}'), path };
        assert!(!error.to_string().contains('\u{1b}'), "{error}");
    }
}

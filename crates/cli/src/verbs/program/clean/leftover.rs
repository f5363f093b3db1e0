//! Files and folders left behind by interrupted runs. Each kind is recognised by a property that only
//! arcade's files have.

use crate::failure::Failure;
use base::MessagePath;
use itertools::Itertools;
use snapshots::Abandoned;
use snapshots::mint::Shard;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// A file or folder that an interrupted run left behind.
pub(super) struct Leftover {
    pub(super) path: PathBuf,
    pub(super) kind: LeftoverKind,
}

pub(super) enum LeftoverKind {
    /// The unfinished folder of a release, report or export. If it contains finished jobs, the interrupted
    /// run can be resumed.
    Draft(Abandoned),
    /// A shard (a part of a release minted separately) and its description.
    Shard(String),
    /// An unfinished file. While this value holds it open, other processes do not consider it abandoned.
    File(#[expect(dead_code, reason = "the open file holds the lock")] File),
    Scratch,
    /// A file that redirected a browser to the `arcade studio` page.
    Page,
}

impl Leftover {
    /// Returns the leftover at the given path, or `None` if the path is in use or is not a leftover.
    pub(super) fn at(path: &Path) -> Result<Option<Leftover>, Failure> {
        let Ok(found) = fs::symlink_metadata(path) else { return Ok(None) };
        let kind = if found.is_file() {
            disk::unfinished(path).map(LeftoverKind::File)
        } else if !found.is_dir() {
            None
        } else if let Some(draft) = Abandoned::at(path)? {
            Some(LeftoverKind::Draft(draft))
        } else {
            Shard::at(path).map(|(shard, recipe)| LeftoverKind::Shard(format!("shard {shard} of `{recipe}`")))
        };
        Ok(kind.map(|kind| Leftover { path: path.to_path_buf(), kind }))
    }

    /// Returns the kind of leftover, as a keyword and as a phrase.
    pub(super) fn described(&self) -> (&'static str, String) {
        match &self.kind {
            LeftoverKind::Draft(draft) if draft.finished_jobs == 0 => {
                ("unfinished", "unfinished work".to_owned())
            }
            LeftoverKind::Draft(draft) => {
                ("interrupted", format!("an interrupted run with {} finished jobs", draft.finished_jobs))
            }
            LeftoverKind::Shard(shard) => ("shard", shard.clone()),
            LeftoverKind::File(_) => ("file", "an unfinished file".to_owned()),
            LeftoverKind::Scratch => ("scratch", "temporary files of a player".to_owned()),
            LeftoverKind::Page => {
                ("page", "a file that redirected to the page of `arcade studio`".to_owned())
            }
        }
    }

    /// Returns the disk space occupied by the leftover's files, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        let (mut bytes, mut waiting) = (0, vec![self.path.clone()]);
        while let Some(path) = waiting.pop() {
            match fs::symlink_metadata(&path) {
                Ok(found) if found.is_dir() => {
                    let entries = fs::read_dir(&path).into_iter().flatten().flatten();
                    waiting.extend(entries.map(|entry| entry.path()));
                }
                Ok(found) => bytes += found.len(),
                Err(_) => {}
            }
        }
        bytes
    }

    pub(super) fn remove(self) -> Result<(), Failure> {
        let removed = match self.kind {
            LeftoverKind::Draft(draft) => return draft.remove().map_err(Failure::from),
            LeftoverKind::Shard(_) | LeftoverKind::Scratch => fs::remove_dir_all(&self.path),
            LeftoverKind::File(_) | LeftoverKind::Page => fs::remove_file(&self.path),
        };
        removed.map_err(|error| {
            Failure::environment(error, format_args!("cannot remove `{}`", self.path.in_message()))
        })
    }
}

/// Returns `true` if the text may be the random part of a scratch folder's name.
fn is_drawn(text: &str) -> bool {
    text.len() == 6 && text.chars().all(|character| character.is_ascii_alphanumeric())
}

/// The name prefix of players' scratch folders.
const SCRATCH: &str = "arcade-player-";
/// The minimum age at which a scratch folder cannot belong to a player that is just starting.
const SETTLED: Duration = Duration::from_secs(3600);

/// Returns the scratch folders of terminated players in the system's temporary folder. The list is empty on
/// systems that do not list processes' working folders.
pub(super) fn scratch() -> Vec<Leftover> {
    let Some(used) = working_folders() else { return Vec::new() };
    let Ok(place) = fs::canonicalize(std::env::temp_dir()) else { return Vec::new() };
    let paths =
        fs::read_dir(&place).into_iter().flatten().flatten().map(|entry| entry.path()).sorted().collect_vec();
    let of = |path: PathBuf| match path {
        path if is_page(&path) => Some(Leftover { path, kind: LeftoverKind::Page }),
        path if is_scratch(&path) && !used.iter().any(|used| used.starts_with(&path)) => {
            Some(Leftover { path, kind: LeftoverKind::Scratch })
        }
        _ => None,
    };
    paths.into_iter().filter_map(of).collect()
}

/// Returns `true` for a file that redirected a browser to a studio, belongs to the current user, and is at
/// least an hour old.
fn is_page(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    let drawn = name.and_then(|name| name.strip_prefix("arcade-studio-")?.strip_suffix(".html"));
    let Ok(found) = fs::symlink_metadata(path) else { return false };
    drawn.is_some_and(is_drawn) && found.is_file() && is_own(&found) && found.modified().is_ok_and(is_settled)
}

/// Returns `true` for a player's scratch folder that belongs to the current user and has been unchanged for
/// at least an hour.
fn is_scratch(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    let Ok(found) = fs::symlink_metadata(path) else { return false };
    name.and_then(|name| name.strip_prefix(SCRATCH)).is_some_and(is_drawn)
        && found.is_dir()
        && is_own(&found)
        && found.modified().is_ok_and(is_settled)
}

fn is_settled(touched: SystemTime) -> bool {
    #[expect(clippy::disallowed_methods, reason = "no output that is recorded depends on it")]
    let now = SystemTime::now();
    now.duration_since(touched).is_ok_and(|age| age > SETTLED)
}

/// Returns `true` if the file belongs to the current user.
#[cfg(unix)]
fn is_own(found: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    // A process's entries in /proc belong to its user.
    fs::metadata("/proc/self").is_ok_and(|own| own.uid() == found.uid())
}

#[cfg(not(unix))]
fn is_own(_found: &fs::Metadata) -> bool {
    false
}

/// Returns the working folders of running processes, or `None` if the system does not list them.
fn working_folders() -> Option<Vec<PathBuf>> {
    let processes = fs::read_dir("/proc").ok()?;
    let folders: Vec<PathBuf> =
        processes.flatten().filter_map(|process| fs::read_link(process.path().join("cwd")).ok()).collect();
    // This process itself has a working folder, so an empty list means that the system hides working folders.
    (!folders.is_empty()).then_some(folders)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_drawn_names_are_ours() {
        for (name, expect) in
            [("a1B2c3", true), ("a1B2c", false), ("a1B2c34", false), ("notes!", false), ("", false)]
        {
            assert_eq!(is_drawn(name), expect, "{name}");
        }
    }

    #[test]
    fn a_file_that_is_being_written_is_not_abandoned() {
        let home = tempfile::tempdir().expect("temporary folder");
        let path = home.path().join(".arcade-a1B2c3.partial");
        let file = File::create(&path).expect("created");
        file.lock().expect("locked");
        assert!(Leftover::at(&path).expect("examined").is_none());
        drop(file);
        assert!(matches!(
            Leftover::at(&path).expect("examined"),
            Some(Leftover { kind: LeftoverKind::File(_), .. })
        ));
    }
}

//! Ownership of a `.partial` folder. The folder belongs to the process that holds its lock.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Seek, Write};
use std::path::Path;

use crate::error::SnapshotError;
use disk::Lock;

/// The lock file, which exists as long as [`TREE`] does. Its content, [`MARK`], identifies the folder as
/// belonging to a draft.
pub(super) const LOCK: &str = ".lock";
/// The content of [`LOCK`]. A file with the same name but different content does not belong to a draft.
pub(super) const MARK: &str =
    "unfinished work of `arcade`, which replaces or removes it (infinite-arcade draft 1)\n";
/// The folder for unfinished work.
pub(super) const TREE: &str = "tree";
/// The folder whose content is kept if the work is interrupted.
pub(super) const JOBS: &str = "jobs";

/// Creates `partial` or takes it over, locks it, and marks it as belonging to a draft.
pub(super) fn acquire(partial: &Path) -> Result<Lock, SnapshotError> {
    let mut lock = take(partial)?;
    mark(lock.file()).map_err(SnapshotError::io("lock", &partial.join(LOCK)))?;
    Ok(lock)
}

/// Creates `partial` or takes it over, and locks it. An existing lock file is left unchanged.
pub(super) fn take(partial: &Path) -> Result<Lock, SnapshotError> {
    let busy = || SnapshotError::Busy(partial.to_path_buf());
    let lock_path = partial.join(LOCK);
    // If a process that is finishing removes the folder in the meantime, the attempt starts over.
    for _ in 0..16 {
        match fs::create_dir(partial) {
            Err(source) if source.kind() != ErrorKind::AlreadyExists => {
                return Err(SnapshotError::io("create", partial)(source));
            }
            _ => {}
        }
        match is_ours(partial) {
            Ok(true) => {}
            Ok(false) => return Err(SnapshotError::Foreign(partial.to_path_buf())),
            Err(source) if source.kind() == ErrorKind::NotFound => continue,
            Err(source) => return Err(SnapshotError::io("examine", partial)(source)),
        }
        match Lock::take(&lock_path) {
            Ok(Some(lock)) => return Ok(lock),
            Ok(None) => return Err(busy()),
            Err(source) if source.kind() == ErrorKind::NotFound => {}
            Err(source) => return Err(SnapshotError::io("lock", &lock_path)(source)),
        }
    }
    Err(busy())
}

/// Writes [`MARK`], and waits until the mark is on disk. The mark shows that everything written later belongs
/// to a draft.
fn mark(lock: &mut File) -> io::Result<()> {
    if disk::start(&*lock, MARK.len() as u64 + 1)? == MARK.as_bytes() {
        return Ok(());
    }
    lock.rewind()?;
    lock.set_len(0)?;
    lock.write_all(MARK.as_bytes())?;
    lock.sync_all()
}

/// Returns `true` if the folder belongs to a draft. Such a folder contains only draft files, and has a lock with
/// [`MARK`] unless there is no work to lose. For example, `--out results` must not delete a user's own
/// `results.partial`.
pub(super) fn is_ours(partial: &Path) -> io::Result<bool> {
    if !fs::symlink_metadata(partial)?.is_dir() {
        return Ok(false);
    }
    let (mut lock, mut work) = (None, false);
    for entry in fs::read_dir(partial)? {
        let entry = entry?;
        let kind = entry.file_type()?;
        if entry.file_name() == LOCK && kind.is_file() {
            lock = Some(content(&entry.path())?);
        } else if (entry.file_name() == TREE || entry.file_name() == JOBS) && kind.is_dir() {
            work = true;
        } else {
            return Ok(false);
        }
    }
    Ok(match lock {
        Some(lock) if lock == MARK.as_bytes() => true,
        // A run that was killed before writing the mark, or is about to write it, has not written anything else.
        Some(lock) => MARK.as_bytes().starts_with(&lock) && !work,
        None => !work,
    })
}

/// Reads the start of a lock file, up to one byte more than the length of [`MARK`]. On Windows, a file locked by a
/// different process cannot be read. In that case, returns [`MARK`], because the next step attempts to lock the file
/// anyway.
fn content(lock: &Path) -> io::Result<Vec<u8>> {
    match disk::read_start(lock, MARK.len() as u64 + 1) {
        Err(_) if cfg!(windows) => Ok(MARK.as_bytes().to_vec()),
        read => read,
    }
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::super::Draft;
    use super::super::tests::{home, names};
    use super::*;

    #[test]
    fn foreign_folders_are_untouched() {
        for mine in ["results.csv", "tree/a"] {
            let (home, out) = home();
            let mine = home.path().join("new.partial").join(mine);
            fs::create_dir_all(mine.parent().expect("below home")).expect("created");
            fs::write(&mine, "precious").expect("written");
            assert!(matches!(Draft::create(&out), Err(SnapshotError::Foreign(_))));
            assert_eq!(fs::read(&mine).expect("still there"), b"precious");
        }
    }

    /// A lock file identifies a draft only by its content.
    #[test]
    fn foreign_locks_are_untouched() {
        for (lock, other) in [("", "tree/a"), ("4711\n", "tree/a"), ("", "jobs/a.json"), ("precious", "")] {
            let (home, out) = home();
            let partial = home.path().join("new.partial");
            fs::create_dir(&partial).expect("created");
            fs::write(partial.join(LOCK), lock).expect("written");
            if !other.is_empty() {
                fs::create_dir_all(partial.join(other).parent().expect("below")).expect("created");
                fs::write(partial.join(other), "precious").expect("written");
            }
            for open in [Draft::create, Draft::resume] {
                assert!(matches!(open(&out), Err(SnapshotError::Foreign(_))), "{lock:?} {other}");
            }
            assert_eq!(fs::read_to_string(partial.join(LOCK)).expect("still there"), lock);
            if !other.is_empty() {
                assert_eq!(fs::read(partial.join(other)).expect("still there"), b"precious");
            }
        }
    }

    /// If a run is killed before or while writing the mark, nothing else exists yet, and the next run takes
    /// over the folder.
    #[test]
    fn unmarked_locks_are_taken_over() {
        for written in [0, 7, MARK.len()] {
            let (home, out) = home();
            let partial = home.path().join("new.partial");
            fs::create_dir(&partial).expect("created");
            fs::write(partial.join(LOCK), &MARK[..written]).expect("written");
            let draft = Draft::create(&out).expect("nothing is lost");
            assert_eq!(fs::read_to_string(partial.join(LOCK)).expect("there"), MARK);
            draft.commit().expect("published");
            assert_eq!(names(home.path()), ["new"]);
        }
    }

    #[test]
    fn two_drafts_of_one_place() {
        let (_home, out) = home();
        let first = Draft::create(&out).expect("vacant");
        first.write("a", b"one").expect("written");
        assert!(matches!(Draft::create(&out), Err(SnapshotError::Busy(_))));
        drop(first);
        let second = Draft::create(&out).expect("free again");
        second.write("b", b"two").expect("written");
        second.commit().expect("published");
        assert!(matches!(Draft::create(&out), Err(SnapshotError::Occupied(_))));
    }

    /// Many threads race for one folder. Each thread either acquires the folder exclusively or receives the reason
    /// for its failure.
    #[test]
    fn a_race_has_one_winner_at_a_time() {
        let (home, out) = home();
        thread::scope(|scope| {
            for runner in 0..8_u8 {
                let out = &out;
                scope.spawn(move || {
                    for _ in 0..100 {
                        match Draft::create(out) {
                            Ok(draft) => {
                                draft.write("a", &[runner]).expect("nobody else writes here");
                                let tree = draft.tree();
                                assert_eq!(fs::read(tree.join("a")).expect("still ours"), [runner]);
                                assert_eq!(names(&tree), ["a"]);
                            }
                            Err(SnapshotError::Busy(_)) => thread::yield_now(),
                            Err(other) => panic!("{other:?}"),
                        }
                    }
                });
            }
        });
        assert!(names(home.path()).is_empty());
    }
}

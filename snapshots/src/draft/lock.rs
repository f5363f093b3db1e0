//! Whose `.partial` folder it is: the one process that holds the lock in it.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::Path;

use crate::error::SnapshotError;
use crate::folder;

/// The file that is locked. It exists as long as [`TREE`] does, and marks the folder as one of ours.
pub(super) const LOCK: &str = ".lock";
/// The folder with the work.
pub(super) const TREE: &str = "tree";
/// The folder with what is kept when the work is interrupted.
pub(super) const LOTS: &str = "lots";

/// Creates `partial` or takes it over, and locks it.
pub(super) fn acquire(partial: &Path) -> Result<File, SnapshotError> {
    let busy = || SnapshotError::Busy { path: partial.to_path_buf() };
    let lock_path = partial.join(LOCK);
    // A holder that finishes while we look removes the folder under our feet; then we start again.
    for _ in 0..16 {
        match fs::create_dir(partial) {
            Err(source) if source.kind() != ErrorKind::AlreadyExists => {
                return Err(SnapshotError::io("create", partial)(source));
            }
            _ => {}
        }
        match is_ours(partial) {
            Ok(true) => {}
            Ok(false) => return Err(SnapshotError::Foreign { path: partial.to_path_buf() }),
            Err(source) if source.kind() == ErrorKind::NotFound => continue,
            Err(source) => return Err(SnapshotError::io("examine", partial)(source)),
        }
        let lock = match File::options().write(true).create(true).truncate(false).open(&lock_path) {
            Ok(lock) => lock,
            Err(source) if source.kind() == ErrorKind::NotFound => continue,
            Err(source) => return Err(SnapshotError::io("lock", &lock_path)(source)),
        };
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(busy()),
            Err(TryLockError::Error(source)) if source.kind() == ErrorKind::Unsupported => {}
            Err(TryLockError::Error(source)) => return Err(SnapshotError::io("lock", &lock_path)(source)),
        }
        // The lock counts only if the file is still the one at that path.
        let held = lock.metadata().map_err(SnapshotError::io("lock", &lock_path))?;
        if fs::symlink_metadata(&lock_path).is_ok_and(|found| folder::same_file(&held, &found)) {
            return Ok(lock);
        }
    }
    Err(busy())
}

/// Whether the folder holds nothing but what a draft makes. Somebody's own `results.partial` is not to be
/// deleted because `--out results` was asked for.
pub(super) fn is_ours(partial: &Path) -> io::Result<bool> {
    if !fs::symlink_metadata(partial)?.is_dir() {
        return Ok(false);
    }
    let (mut lock, mut tree) = (false, false);
    for entry in fs::read_dir(partial)? {
        let entry = entry?;
        let kind = entry.file_type()?;
        if entry.file_name() == LOCK && kind.is_file() {
            lock = true;
        } else if (entry.file_name() == TREE || entry.file_name() == LOTS) && kind.is_dir() {
            tree = true;
        } else {
            return Ok(false);
        }
    }
    Ok(lock || !tree)
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::super::Draft;
    use super::super::tests::{home, names};
    use super::*;

    #[test]
    fn a_folder_of_somebody_else_is_left_alone() {
        for mine in ["results.csv", "tree/a"] {
            let (home, out) = home();
            let mine = home.path().join("new.partial").join(mine);
            fs::create_dir_all(mine.parent().expect("below home")).expect("created");
            fs::write(&mine, "precious").expect("written");
            assert!(matches!(Draft::create(&out), Err(SnapshotError::Foreign { .. })));
            assert_eq!(fs::read(&mine).expect("still there"), b"precious");
        }
    }

    #[test]
    fn two_drafts_of_one_place() {
        let (_home, out) = home();
        let first = Draft::create(&out).expect("vacant");
        first.write("a", b"one").expect("written");
        assert!(matches!(Draft::create(&out), Err(SnapshotError::Busy { .. })));
        drop(first);
        let second = Draft::create(&out).expect("free again");
        second.write("b", b"two").expect("written");
        second.commit().expect("published");
        assert!(matches!(Draft::create(&out), Err(SnapshotError::Occupied { .. })));
    }

    /// Many threads race for one place: each either gets it alone or is told why not.
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
                            Err(SnapshotError::Busy { .. }) => thread::yield_now(),
                            Err(other) => panic!("{other:?}"),
                        }
                    }
                });
            }
        });
        assert!(names(home.path()).is_empty());
    }
}

//! Drafts (unfinished folders) left by killed runs.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use super::lock::{self, JOBS, LOCK, TREE};
use super::remove_tree;
use crate::error::SnapshotError;
use disk::Lock;

/// A draft on which no process is working. While this value exists, no process can take over the draft.
#[derive(Debug)]
pub struct Abandoned {
    partial: PathBuf,
    /// The number of finished jobs of an interrupted mint, which `--resume` can reuse.
    pub finished_jobs: usize,
    /// The lock, which is released on drop.
    _lock: Lock,
}

impl Abandoned {
    /// Returns the abandoned draft in the `.partial` folder at `partial`. Returns `None` if the folder does not
    /// belong to a draft, or if a process is working on the draft. A folder belongs to a draft only if it contains a
    /// lock and, apart from that, only draft files. Links are not followed.
    ///
    /// # Errors
    /// Returns an error if a file system operation fails.
    pub fn at(partial: &Path) -> Result<Option<Abandoned>, SnapshotError> {
        if partial.extension().is_none_or(|ending| ending != "partial") {
            return Ok(None);
        }
        match holds_work(partial) {
            Ok(true) => {}
            Ok(false) => return Ok(None),
            Err(source) if source.kind() == ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(SnapshotError::io("examine", partial)(source)),
        }
        let lock = match lock::take(partial) {
            Ok(lock) => lock,
            Err(SnapshotError::Busy(_) | SnapshotError::Foreign(_)) => return Ok(None),
            Err(error) => return Err(error),
        };
        let finished_jobs = finished(&partial.join(JOBS)).map_err(SnapshotError::io("list", partial))?;
        Ok(Some(Abandoned { partial: partial.to_path_buf(), finished_jobs, _lock: lock }))
    }

    /// Removes the draft and all its content.
    ///
    /// # Errors
    /// Returns an error if a file system operation fails. The lock then remains, so the rest can be removed later.
    pub fn remove(self) -> Result<(), SnapshotError> {
        let remove = || {
            remove_tree(&self.partial.join(TREE))?;
            remove_tree(&self.partial.join(JOBS))?;
            fs::remove_file(self.partial.join(LOCK))?;
            fs::remove_dir(&self.partial)
        };
        remove().map_err(SnapshotError::io("remove", &self.partial))
    }
}

/// Returns `true` if the folder is not a link, and contains a draft's lock and, apart from that, only draft files. A
/// run that is killed while starting or ending leaves only a lock.
fn holds_work(partial: &Path) -> io::Result<bool> {
    if !fs::symlink_metadata(partial)?.is_dir() || !fs::symlink_metadata(partial.join(LOCK))?.is_file() {
        return Ok(false);
    }
    lock::is_ours(partial)
}

/// Counts the finished jobs' files in a folder.
fn finished(jobs: &Path) -> io::Result<usize> {
    let listed = match fs::read_dir(jobs) {
        Err(source) if source.kind() == ErrorKind::NotFound => return Ok(0),
        listed => listed?,
    };
    let mut count = 0;
    for entry in listed {
        count += usize::from(entry?.path().extension().is_some_and(|ending| ending == "json"));
    }
    Ok(count)
}

#[cfg(test)]
mod tests {
    use super::super::Draft;
    use super::super::tests::{home, names};
    use super::*;

    /// Leaves a draft behind, like a run that is killed.
    fn killed(out: &Path) -> PathBuf {
        let draft = Draft::create(out).expect("vacant");
        draft.write("games/a", b"one").expect("written");
        let (partial, aside) = (draft.partial.clone(), out.with_extension("aside"));
        fs::rename(&partial, &aside).expect("moved");
        drop(draft);
        fs::rename(&aside, &partial).expect("moved back");
        partial
    }

    #[test]
    fn leftovers_of_killed_runs_are_removed() {
        let (home, out) = home();
        let partial = killed(&out);
        let abandoned = Abandoned::at(&partial).expect("examined").expect("abandoned");
        assert_eq!(abandoned.finished_jobs, 0);
        // Meanwhile, no other draft can take over the folder.
        assert!(matches!(Draft::create(&out), Err(SnapshotError::Busy(_))));
        abandoned.remove().expect("removed");
        assert!(names(home.path()).is_empty());
    }

    #[test]
    fn a_lock_alone_is_left_by_a_killed_run() {
        let (home, _) = home();
        let partial = home.path().join("new.partial");
        for lock in ["", lock::MARK] {
            fs::create_dir(&partial).expect("created");
            assert!(Abandoned::at(&partial).expect("examined").is_none(), "a folder without a lock");
            fs::write(partial.join(LOCK), lock).expect("written");
            Abandoned::at(&partial).expect("examined").expect("abandoned").remove().expect("removed");
            assert!(names(home.path()).is_empty());
        }
    }

    #[test]
    fn finished_jobs_are_counted() {
        let (_home, out) = home();
        let partial = killed(&out);
        fs::create_dir(partial.join(JOBS)).expect("created");
        for name in ["a.json", "b.json", "b.new", "plan.txt"] {
            fs::write(partial.join(JOBS).join(name), "").expect("written");
        }
        assert_eq!(Abandoned::at(&partial).expect("examined").expect("abandoned").finished_jobs, 2);
    }

    #[test]
    fn active_drafts_and_foreign_folders_are_not_abandoned() {
        let (home, out) = home();
        let draft = Draft::create(&out).expect("vacant");
        assert!(Abandoned::at(&draft.partial).expect("examined").is_none());
        for (name, mine) in
            [("a.partial", "tree/x"), ("b.partial", "x"), ("c", ".lock"), ("d.partial", ".lock")]
        {
            let folder = home.path().join(name);
            let mine = folder.join(mine);
            fs::create_dir_all(mine.parent().expect("below")).expect("created");
            fs::write(&mine, "precious").expect("written");
            assert!(Abandoned::at(&folder).expect("examined").is_none(), "{name}");
            assert!(mine.exists());
        }
        let partial = killed(&home.path().join("other"));
        fs::write(partial.join("notes.txt"), "precious").expect("written");
        assert!(Abandoned::at(&partial).expect("examined").is_none());
    }

    #[cfg(unix)]
    #[test]
    fn links_are_not_followed() {
        let (home, out) = home();
        let partial = killed(&out);
        let link = home.path().join("link.partial");
        std::os::unix::fs::symlink(&partial, &link).expect("linked");
        assert!(Abandoned::at(&link).expect("examined").is_none());
        let precious = home.path().join("precious");
        fs::write(&precious, "precious").expect("written");
        std::os::unix::fs::symlink(&precious, partial.join(TREE).join("link")).expect("linked");
        Abandoned::at(&partial).expect("examined").expect("abandoned").remove().expect("removed");
        assert_eq!(fs::read(&precious).expect("still there"), b"precious");
    }
}

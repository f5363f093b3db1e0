//! Atomic writes of release folders. A release is either complete or absent, even after a crash.
//!
//! Unfinished work is stored next to its destination, and published by a single `rename` within the file system:
//!
//! ```text
//! releases/2026-12.partial/.lock    locked from creation until after the rename; its content identifies a draft
//! releases/2026-12.partial/tree/    becomes releases/2026-12
//! releases/2026-12.partial/jobs/    finished jobs, kept after an interruption for `Draft::resume`
//! ```
//!
//! The lock is an operating system lock ([`Lock`]), which is released when its process ends. A `.partial`
//! folder with a free lock was therefore left by a killed run, and is replaced. The tree is one level below
//! the lock, because the lock must outlive the rename. Inside the tree, the lock would be published or
//! released too early.

mod abandoned;
mod lock;
mod sync;

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::error::SnapshotError;
use crate::format::folder::{self, Limits};
use crate::format::layout::HELD;
use crate::format::path::check_path;
use disk::Lock;
use lock::{JOBS, LOCK, TREE};
use sync::{sync_folder, sync_folders};

/// The file inside the tree if the draft is published as a single file.
const SINGLE: &str = "file";

pub use abandoned::Abandoned;

/// A release folder under construction. Dropping an uncommitted draft removes its files, as far as possible.
///
/// Writing takes `&self`, so many threads may write different files.
#[derive(Debug)]
pub struct Draft {
    out: PathBuf,
    partial: PathBuf,
    /// `true` if all content is readable only by its owner, even after publication.
    is_secret: bool,
    /// The lock, which is released after `drop` has removed the folder.
    _lock: Lock,
}

impl Draft {
    /// Starts a draft for the folder `out`, which must be absent or empty. Missing parents are created.
    ///
    /// A stale `<out>.partial` is replaced, never adopted. On a file system without locks, two processes must not use
    /// the same `out`.
    ///
    /// # Errors
    /// Returns an error in each of these cases:
    ///
    /// - `out` is occupied ([`Occupied`](SnapshotError::Occupied)).
    /// - A different process is writing `out` ([`Busy`](SnapshotError::Busy)).
    /// - An interrupted run has left work ([`Interrupted`](SnapshotError::Interrupted)).
    /// - `<out>.partial` does not belong to a draft ([`Foreign`](SnapshotError::Foreign)).
    /// - A file system operation fails.
    pub fn create(out: &Path) -> Result<Draft, SnapshotError> {
        let draft = Draft::resume(out)?;
        match fs::read_dir(draft.jobs()).is_ok_and(|mut jobs| jobs.next().is_some()) {
            true => Err(SnapshotError::Interrupted(draft.partial.clone())),
            false => Ok(draft),
        }
    }

    /// Starts a draft like [`create`](Draft::create), but retains an interrupted draft's finished
    /// [`jobs`](Draft::jobs).
    ///
    /// # Errors
    /// See [`create`](Draft::create), except that interrupted work is not an error.
    pub fn resume(out: &Path) -> Result<Draft, SnapshotError> {
        let partial = partial_of(out).ok_or_else(|| SnapshotError::Nameless(out.to_path_buf()))?;
        check_vacant(out)?;
        let parent = parent_of(out);
        disk::create_folder(parent).map_err(SnapshotError::io("create", parent))?;

        let lock = lock::acquire(&partial)?;
        let draft = Draft { out: out.to_path_buf(), partial, is_secret: false, _lock: lock };
        // Meanwhile, the previous holder of the lock may have published its release.
        check_vacant(out)?;
        let tree = draft.tree();
        remove_tree(&tree).map_err(SnapshotError::io("remove", &tree))?;
        fs::create_dir(&tree).map_err(SnapshotError::io("create", &tree))?;
        Ok(draft)
    }

    /// Writes the file at `relative`, creates its parents, and waits until the content is on disk.
    ///
    /// # Errors
    /// Returns an error if the path is unsafe, the file is larger than readers accept, the file was already written,
    /// or a file system operation fails. On a case-insensitive file system, a name that differs only in case counts
    /// as the same file.
    pub fn write(&self, relative: &str, bytes: &[u8]) -> Result<(), SnapshotError> {
        let limit = Limits::SNAPSHOT.file_bytes;
        if bytes.len() as u64 > limit {
            return Err(SnapshotError::TooLarge { path: folder::join(&self.tree(), relative), limit });
        }
        self.write_of_any_size(relative, bytes)
    }

    /// Writes a file of any size like [`write`](Draft::write), for folders that are not releases.
    ///
    /// # Errors
    /// See [`write`](Draft::write).
    pub fn write_of_any_size(&self, relative: &str, bytes: &[u8]) -> Result<(), SnapshotError> {
        check_path(relative).map_err(|problem| SnapshotError::Path { path: relative.into(), problem })?;
        let path = folder::join(&self.tree(), relative);
        let parent = parent_of(&path);
        let is_secret = self.is_secret || relative.starts_with(HELD);
        create_folders(parent, is_secret).map_err(SnapshotError::io("create", parent))?;
        let write = || {
            let mut options = File::options();
            options.write(true).create_new(true);
            #[cfg(unix)]
            if is_secret {
                std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
            }
            let mut file = options.open(&path)?;
            file.write_all(bytes)?;
            file.sync_all()
        };
        write().map_err(SnapshotError::io("write", &path))
    }

    /// Publishes the draft as `out` in one step, and waits until the rename is on disk. The files were synced when
    /// written, so only the folders are synced now.
    ///
    /// # Errors
    /// Returns an error if `out` is no longer absent or empty, or if a file system operation fails. The draft
    /// is then dropped. If only the sync of the parent folder fails, `out` exists and is complete
    /// nevertheless.
    pub fn commit(self) -> Result<(), SnapshotError> {
        let tree = self.tree();
        sync_folders(&tree)?;
        let occupied = |source: io::Error| match source.kind() {
            ErrorKind::DirectoryNotEmpty | ErrorKind::NotADirectory | ErrorKind::AlreadyExists => {
                SnapshotError::Occupied(self.out.clone())
            }
            _ => SnapshotError::io("create", &self.out)(source),
        };
        if let Err(source) = fs::remove_dir(&self.out)
            && source.kind() != ErrorKind::NotFound
        {
            return Err(occupied(source));
        }
        fs::rename(&tree, &self.out).map_err(occupied)?;
        sync_folder(parent_of(&self.out))?;
        // Leftovers matter only to the next draft, which reports them.
        drop(remove_tree(&self.jobs()));
        Ok(())
    }

    /// Ends the draft without a result, and also removes its [`jobs`](Draft::jobs).
    ///
    /// # Errors
    /// Returns an error if a file system operation fails.
    pub fn discard(self) -> Result<(), SnapshotError> {
        let jobs = self.jobs();
        remove_tree(&jobs).map_err(SnapshotError::io("remove", &jobs))
    }

    /// Creates the file of a draft that is published as a single file. Returns the file, and its path for use in
    /// messages.
    ///
    /// # Errors
    /// Returns an error if the file was already created, or if a file system operation fails.
    pub(crate) fn single(&self) -> Result<(File, PathBuf), SnapshotError> {
        let path = self.tree().join(SINGLE);
        let file = File::options().read(true).write(true).create_new(true).open(&path);
        Ok((file.map_err(SnapshotError::io("create", &path))?, path))
    }

    /// Publishes the file from [`single`](Draft::single) as `out` in one step, and waits until its name is on disk.
    /// The file's content must already be synced. A file created at `out` in the meantime is not replaced.
    ///
    /// # Errors
    /// Returns an error if `out` exists ([`Taken`](SnapshotError::Taken)), or if a file system operation fails. The
    /// draft is then dropped.
    pub(crate) fn commit_single(self) -> Result<(), SnapshotError> {
        let taken = || SnapshotError::Taken(self.out.clone());
        let path = self.tree().join(SINGLE);
        match fs::hard_link(&path, &self.out) {
            Ok(()) => {}
            Err(source) if source.kind() == ErrorKind::AlreadyExists => return Err(taken()),
            // Not every file system supports links. Without links, the rename would replace a file created after this
            // check.
            Err(_) if fs::symlink_metadata(&self.out).is_ok() => return Err(taken()),
            Err(_) => fs::rename(&path, &self.out).map_err(SnapshotError::io("create", &self.out))?,
        }
        sync_folder(parent_of(&self.out))
    }

    /// Restricts the unfinished work to its owner, as sealed releases require. Withheld files stay restricted
    /// after publication.
    ///
    /// # Errors
    /// Returns an error if a file system operation fails.
    pub fn keep_private(&self) -> Result<(), SnapshotError> {
        #[cfg(unix)]
        {
            let owner = std::os::unix::fs::PermissionsExt::from_mode(0o700);
            fs::set_permissions(&self.partial, owner).map_err(SnapshotError::io("protect", &self.partial))?;
        }
        Ok(())
    }

    /// Restricts all content to its owner, before and after publication, as shards (separately minted parts) of sealed
    /// releases require. Must be called before the first file is written.
    ///
    /// # Errors
    /// Returns an error if a file system operation fails.
    pub fn keep_secret(&mut self) -> Result<(), SnapshotError> {
        self.keep_private()?;
        #[cfg(unix)]
        {
            let (tree, owner) = (self.tree(), std::os::unix::fs::PermissionsExt::from_mode(0o700));
            fs::set_permissions(&tree, owner).map_err(SnapshotError::io("protect", &tree))?;
        }
        self.is_secret = true;
        Ok(())
    }

    /// Returns the path of a draft's [`jobs`](Draft::jobs) for the folder `out`, even if there is no draft.
    pub fn jobs_of(out: &Path) -> Option<PathBuf> {
        Some(partial_of(out)?.join(JOBS))
    }

    /// Returns the path of a folder next to the draft, without creating it. The folder outlives a draft that
    /// is dropped or killed, and is removed when the draft is committed.
    pub fn jobs(&self) -> PathBuf {
        self.partial.join(JOBS)
    }

    fn tree(&self) -> PathBuf {
        self.partial.join(TREE)
    }
}

impl Drop for Draft {
    /// Removes the draft. After a commit, only the lock remains to be removed. The lock is removed last,
    /// because it marks the folder as belonging to a draft.
    fn drop(&mut self) {
        let removed = remove_tree(&self.tree());
        // An empty folder holds no work. A folder with content stays, and so does the lock that marks it as
        // belonging to a draft.
        if fs::remove_dir(self.jobs()).is_err_and(|refused| refused.kind() != ErrorKind::NotFound) {
            return;
        }
        let removed = removed
            .and_then(|()| fs::remove_file(self.partial.join(LOCK)))
            .and_then(|()| fs::remove_dir(&self.partial));
        // A failure cannot be handled here, and the next draft replaces any leftovers.
        drop(removed);
    }
}

/// Returns the folder for unfinished work on `out`; `None` if `out` has no file name.
fn partial_of(out: &Path) -> Option<PathBuf> {
    let mut name = OsString::from(out.file_name()?);
    name.push(".partial");
    Some(out.with_file_name(name))
}

/// Returns the parent folder of `path`, which is never the empty path.
fn parent_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

/// Creates a folder and its missing parents. If `is_secret` is set, the created folders are accessible only to their
/// owner.
fn create_folders(folder: &Path, is_secret: bool) -> io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    if is_secret {
        std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    }
    builder.create(folder)
}

/// Checks, as far as possible without writing, that a release can be written to `out`.
///
/// # Errors
/// Returns an error if `out` exists and is not an empty folder, or if a file system operation fails.
pub fn check_vacant(out: &Path) -> Result<(), SnapshotError> {
    let occupied = || SnapshotError::Occupied(out.to_path_buf());
    match fs::symlink_metadata(out) {
        Err(source) if source.kind() == ErrorKind::NotFound => Ok(()),
        Err(source) if source.kind() == ErrorKind::NotADirectory => {
            Err(SnapshotError::BelowFile(out.to_path_buf()))
        }
        Err(source) => Err(SnapshotError::io("examine", out)(source)),
        Ok(found) if !found.is_dir() => Err(occupied()),
        Ok(_) => match fs::read_dir(out).map_err(SnapshotError::io("list", out))?.next() {
            Some(_) => Err(occupied()),
            None => Ok(()),
        },
    }
}

/// Removes a folder with its content, without following links. An absent folder is not an error.
fn remove_tree(tree: &Path) -> io::Result<()> {
    match fs::remove_dir_all(tree) {
        Err(source) if source.kind() == ErrorKind::NotFound => Ok(()),
        result => result,
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::process::{Command, Stdio};
    use std::thread;
    use std::time::Duration;

    use tempfile::TempDir;

    use super::*;

    pub(crate) fn home() -> (TempDir, PathBuf) {
        let home = TempDir::new().expect("temporary folder");
        let out = home.path().join("new");
        (home, out)
    }

    pub(crate) fn names(folder: &Path) -> Vec<String> {
        let listed = fs::read_dir(folder).expect("readable");
        let mut names: Vec<String> =
            listed.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn commit_publishes_exactly_what_was_written() {
        let (home, out) = home();
        let draft = Draft::create(&out).expect("vacant");
        draft.write("README.md", b"one").expect("written");
        draft.write("games/x/lvl0.txt", b"").expect("written");
        assert_eq!(names(home.path()), ["new.partial"]);
        draft.commit().expect("published");
        assert_eq!(names(home.path()), ["new"]);
        assert_eq!(names(&out), ["README.md", "games"]);
        assert_eq!(names(&out.join("games/x")), ["lvl0.txt"]);
        assert_eq!(fs::read(out.join("README.md")).expect("readable"), b"one");
    }

    #[test]
    fn empty_folders_and_missing_parents_are_accepted() {
        let (home, out) = home();
        fs::create_dir(&out).expect("created");
        Draft::create(&out).expect("vacant").commit().expect("published");
        let deep = home.path().join("a/b/c/");
        let draft = Draft::create(&deep).expect("vacant");
        assert_eq!(names(&home.path().join("a/b")), ["c.partial"]);
        draft.commit().expect("published");
        assert_eq!(names(&home.path().join("a/b")), ["c"]);
    }

    #[test]
    fn dropping_removes_everything() {
        let (home, out) = home();
        let draft = Draft::create(&out).expect("vacant");
        draft.write("a/b", b"one").expect("written");
        drop(draft);
        assert!(names(home.path()).is_empty());
    }

    #[test]
    fn occupied_outputs_are_reported_and_untouched() {
        let (home, out) = home();
        fs::create_dir(&out).expect("created");
        fs::write(out.join("mine"), "precious").expect("written");
        let error = Draft::create(&out).expect_err("taken").to_string();
        assert!(error.starts_with(&format!("`{}` already exists", out.display())), "{error}");
        let file = out.join("mine");
        assert!(matches!(Draft::create(&file), Err(SnapshotError::Occupied(path)) if path == file));
        let below = file.join("x");
        assert!(matches!(Draft::create(&below), Err(SnapshotError::BelowFile(path)) if path == below));
        assert_eq!(names(home.path()), ["new"]);
        assert_eq!(names(&out), ["mine"]);
    }

    #[test]
    fn newly_occupied_outputs_are_untouched() {
        let (home, out) = home();
        for folder in [true, false] {
            let draft = Draft::create(&out).expect("vacant");
            draft.write("a", b"one").expect("written");
            let mine = if folder { out.join("mine") } else { out.clone() };
            fs::create_dir_all(mine.parent().expect("below home")).expect("created");
            fs::write(&mine, "precious").expect("written");
            assert!(matches!(draft.commit(), Err(SnapshotError::Occupied(_))));
            assert_eq!(fs::read(&mine).expect("still there"), b"precious");
            assert_eq!(names(home.path()), ["new"]);
            remove_tree(&out).or_else(|_| fs::remove_file(&out)).expect("removed");
        }
    }

    #[test]
    fn places_without_a_name() {
        for out in ["/", "..", ".", "a/.."] {
            assert!(matches!(Draft::create(Path::new(out)), Err(SnapshotError::Nameless(_))), "{out}");
        }
    }

    #[test]
    fn stale_work_is_replaced_never_adopted() {
        let (home, out) = home();
        let partial = home.path().join("new.partial");
        fs::create_dir_all(partial.join("tree/games")).expect("created");
        fs::write(partial.join("tree/games/old"), "stale").expect("written");
        fs::write(partial.join(LOCK), lock::MARK).expect("written");
        let draft = Draft::create(&out).expect("the lock is free");
        draft.write("fresh", b"").expect("written");
        draft.commit().expect("published");
        assert_eq!(names(&out), ["fresh"]);
        assert_eq!(names(home.path()), ["new"]);
    }

    #[cfg(unix)]
    #[test]
    fn links_are_never_followed_or_adopted() {
        use std::os::unix::fs::symlink;
        let (home, out) = home();
        let elsewhere = home.path().join("elsewhere");
        fs::create_dir(&elsewhere).expect("created");
        fs::write(elsewhere.join("mine"), "precious").expect("written");
        symlink("elsewhere", &out).expect("linked");
        assert!(matches!(Draft::create(&out), Err(SnapshotError::Occupied(_))));
        let other = home.path().join("other");
        symlink("elsewhere", home.path().join("other.partial")).expect("linked");
        assert!(matches!(Draft::create(&other), Err(SnapshotError::Foreign(_))));
        assert_eq!(names(&elsewhere), ["mine"]);
    }

    #[test]
    fn writes_are_checked() {
        let (home, out) = home();
        let draft = Draft::create(&out).expect("vacant");
        for path in ["../a", "/a", "a//b", "a b", ""] {
            assert!(matches!(draft.write(path, b""), Err(SnapshotError::Path { .. })), "{path}");
        }
        draft.write("a", b"one").expect("written");
        assert!(matches!(draft.write("a", b"two"), Err(SnapshotError::Io { .. })));
        assert!(matches!(draft.write("a/b", b"two"), Err(SnapshotError::Io { .. })));
        let large = vec![0; (64 << 20) + 1];
        assert!(matches!(draft.write("large", &large), Err(SnapshotError::TooLarge { .. })));
        draft.write_of_any_size("report", &large).expect("written");
        draft.commit().expect("published");
        assert_eq!(names(&out), ["a", "report"]);
        assert_eq!(fs::read(out.join("a")).expect("readable"), b"one");
        assert_eq!(names(home.path()), ["new"]);
    }

    /// Every part of a secret draft, from the first folder to the published release, is accessible only to its owner.
    #[cfg(unix)]
    #[test]
    fn secrets_are_readable_by_their_owner_only() {
        use std::os::unix::fs::PermissionsExt;
        let (home, out) = home();
        let mut draft = Draft::create(&out).expect("vacant");
        draft.keep_secret().expect("protected");
        draft.write("jobs/a.json", b"one").expect("written");
        let mode = |path: &Path| fs::metadata(path).expect("there").permissions().mode() & 0o777;
        assert_eq!(mode(&home.path().join("new.partial")), 0o700);
        draft.commit().expect("published");
        assert_eq!(
            (mode(&out), mode(&out.join("jobs")), mode(&out.join("jobs/a.json"))),
            (0o700, 0o700, 0o600)
        );
    }

    /// The process that [`a_killed_run`] kills. When run on its own, this test finds no instructions in its
    /// folder and returns.
    #[test]
    fn victim() {
        if fs::read("orders").ok().as_deref() != Some(b"write until killed") {
            return;
        }
        // If the other test ends without killing this process, this process's input ends as well, and the process
        // must exit.
        thread::spawn(|| {
            io::copy(&mut io::stdin(), &mut io::sink()).expect("readable");
            std::process::exit(1);
        });
        let draft = Draft::create(Path::new("new")).expect("vacant");
        for n in 0..1_000_000 {
            draft.write(&format!("games/{n}"), b"one").expect("written");
        }
    }

    #[test]
    fn a_killed_run() {
        let (home, out) = home();
        fs::write(home.path().join("orders"), "write until killed").expect("written");
        let mut victim = Command::new(std::env::current_exe().expect("the test's own program"))
            .args(["--exact", "draft::tests::victim"])
            .current_dir(home.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .expect("started");
        let tree = home.path().join("new.partial/tree/games");
        while !tree.join("3").exists() {
            assert!(victim.try_wait().expect("waited for").is_none(), "ended before it was killed");
            thread::sleep(Duration::from_millis(5));
        }
        assert!(matches!(Draft::create(&out), Err(SnapshotError::Busy(_))));
        victim.kill().expect("killed");
        victim.wait().expect("gone");
        assert_eq!(names(home.path()), ["new.partial", "orders"]);
        assert!(tree.join("3").exists());
        let draft = Draft::create(&out).expect("the lock died with its holder");
        draft.write("fresh", b"").expect("written");
        draft.commit().expect("published");
        assert_eq!(names(&out), ["fresh"]);
        assert_eq!(names(home.path()), ["new", "orders"]);
    }
}

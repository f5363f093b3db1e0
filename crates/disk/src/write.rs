//! Writes files that are complete or absent. Each file is written next to its target, synced and renamed, and
//! then its folder is synced.

use std::cell::Cell;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use tempfile::{Builder, NamedTempFile, PersistError};

/// The prefix and the suffix of an unfinished file's name, with six letters or digits between them. An
/// unfinished file is stored next to its target.
const UNFINISHED: (&str, &str) = (".arcade-", ".partial");

/// Writes a whole file, replacing any previous file, like [`Disk::write`].
///
/// # Errors
/// Returns an error if the file system fails. In that case, the previous content is unchanged.
pub fn write(path: &Path, bytes: &[u8], access: Access) -> io::Result<()> {
    Disk::new().write(path, bytes, access)
}

/// Writes a whole new file. Never replaces an existing file with this name.
///
/// # Errors
/// Returns an error if the name already exists ([`ErrorKind::AlreadyExists`]) or the file system fails. In
/// that case, no unfinished file remains.
pub fn create(path: &Path, bytes: &[u8], access: Access) -> io::Result<()> {
    let taken = || io::Error::from(ErrorKind::AlreadyExists);
    if fs::symlink_metadata(path).is_ok() {
        return Err(taken());
    }
    let disk = Disk::new();
    let placed = match disk.fill(path, bytes, access)?.persist_noclobber(path) {
        // Not every file system supports renaming without replacing.
        Err(PersistError { error, file }) if error.kind() != ErrorKind::AlreadyExists => {
            match fs::symlink_metadata(path) {
                Ok(_) => return Err(taken()),
                Err(_) => file.persist(path),
            }
        }
        placed => placed,
    };
    placed.map_err(|failed| failed.error)?;
    disk.sync(parent(path))
}

/// Creates a folder and its parents, and waits until the new folders' names are on disk.
///
/// # Errors
///
/// Returns an error if the file system fails.
pub fn create_folder(folder: &Path) -> io::Result<()> {
    Disk::new().create_folder(folder)
}

/// Waits until the file names in a folder are on disk. Only Unix supports this; on other systems, the file
/// system's journal must suffice.
///
/// # Errors
/// Returns an error if the file system fails.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) {
        File::open(folder)?.sync_all()?;
    }
    Ok(())
}

/// Returns `true` if a file name has the form of an unfinished file's name.
pub fn is_unfinished(name: &OsStr) -> bool {
    let drawn = name.to_str().and_then(|name| name.strip_prefix(UNFINISHED.0)?.strip_suffix(UNFINISHED.1));
    drawn.is_some_and(|drawn| drawn.len() == 6 && drawn.chars().all(|letter| letter.is_ascii_alphanumeric()))
}

/// Opens and locks an unfinished file that no process is writing. Returns `None` for any other file. While
/// the returned file is open, this function returns `None` for it in every other process.
pub fn unfinished(path: &Path) -> Option<File> {
    if !is_unfinished(path.file_name()?) {
        return None;
    }
    let file = File::options().write(true).open(path).ok()?;
    file.try_lock().ok().map(|()| file)
}

/// Writes files so that a power loss at any moment leaves each file either unchanged or complete.
///
/// Tests can simulate a power loss: a disk created by [`Disk::losing_power_after`] stops after a given number
/// of steps, and leaves all files as they are at that point.
#[derive(Debug, Default)]
pub struct Disk {
    /// The number of remaining steps before the power loss, or `None` if the power is never lost.
    left: Option<Cell<usize>>,
}

/// The access that users other than the owner have to a new file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// The same access as to the replaced file, or the system's default for a new file.
    Shared,
    /// No access: only the owner can read the file.
    Private,
}

impl Disk {
    /// Creates a disk that never simulates a power loss.
    pub fn new() -> Disk {
        Disk::default()
    }

    /// Creates a disk that stops working after `steps` changes to the file system. A write interrupted by the
    /// power loss writes half of its bytes.
    pub fn losing_power_after(steps: usize) -> Disk {
        Disk { left: Some(Cell::new(steps)) }
    }

    /// Writes a whole file, replacing any previous file. Links and pipes are replaced without being followed
    /// or opened.
    ///
    /// # Errors
    /// Returns an error if the file system fails. In that case, the previous content is unchanged.
    pub fn write(&self, path: &Path, bytes: &[u8], access: Access) -> io::Result<()> {
        let fresh = self.fill(path, bytes, access)?;
        self.step()?;
        // If the file cannot be renamed, dropping it removes it.
        fresh.persist(path).map_err(|failed| failed.error)?;
        self.sync(parent(path))
    }

    /// Writes bytes to a new file next to `path`, and waits until the bytes are on disk.
    fn fill(&self, path: &Path, bytes: &[u8], access: Access) -> io::Result<NamedTempFile> {
        self.step()?;
        let mut builder = Builder::new();
        builder.prefix(UNFINISHED.0).suffix(UNFINISHED.1).disable_cleanup(self.left.is_some());
        #[cfg(unix)]
        {
            let mode = if access == Access::Private { 0o600 } else { 0o666 };
            builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
        }
        // The name of the unfinished file would be confusing in an error message.
        let unnamed = |error: io::Error| error.raw_os_error().map_or(error, io::Error::from_raw_os_error);
        let mut fresh = builder.tempfile_in(parent(path)).map_err(unnamed)?;
        // If the file system supports locks, the lock makes `unfinished` leave the file alone.
        let _ = fresh.as_file().try_lock();
        let (first, second) = bytes.split_at(bytes.len() / 2);
        fresh.as_file_mut().write_all(first)?;
        self.step()?;
        fresh.as_file_mut().write_all(second)?;
        match fs::symlink_metadata(path) {
            Ok(before) if before.is_file() && access == Access::Shared => {
                fresh.as_file().set_permissions(before.permissions())?;
            }
            _ => {}
        }
        self.step()?;
        fresh.as_file().sync_all()?;
        Ok(fresh)
    }

    /// Creates a folder and its parents, and waits until the new folders' names are on disk.
    ///
    /// # Errors
    ///
    /// Returns an error if the file system fails.
    pub fn create_folder(&self, folder: &Path) -> io::Result<()> {
        let missing: Vec<&Path> =
            folder.ancestors().take_while(|above| !above.as_os_str().is_empty() && !above.exists()).collect();
        for created in missing.into_iter().rev() {
            self.step()?;
            match fs::create_dir(created) {
                // Another process may create the folder at the same time.
                Err(error) if error.kind() == ErrorKind::AlreadyExists && created.is_dir() => {}
                made => made?,
            }
            self.sync(parent(created))?;
        }
        Ok(())
    }

    fn sync(&self, folder: &Path) -> io::Result<()> {
        self.step()?;
        sync_folder(folder)
    }

    /// Counts a change to the file system, and fails if the power is lost.
    fn step(&self) -> io::Result<()> {
        let Some(left) = &self.left else { return Ok(()) };
        match left.get().checked_sub(1) {
            Some(fewer) => {
                left.set(fewer);
                Ok(())
            }
            None => Err(io::Error::other("the power was lost, as the test requested")),
        }
    }
}

/// Returns a file's folder, which is never the empty path.
fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    fn names(folder: &Path) -> Vec<PathBuf> {
        let listed = fs::read_dir(folder).expect("readable");
        listed.map(|entry| PathBuf::from(entry.expect("readable").file_name())).collect()
    }

    /// Checks that a file has either its old or its new content, regardless of when the power is lost.
    #[test]
    fn a_file_is_old_or_new_after_a_loss_of_power() {
        let mut ends = Vec::new();
        for steps in 0.. {
            let home = tempfile::tempdir().expect("temporary folder");
            let path = home.path().join("file");
            write(&path, b"old", Access::Shared).expect("written");
            let written = Disk::losing_power_after(steps).write(&path, b"new!", Access::Shared);
            let found = fs::read(&path).expect("there");
            assert!(found == b"old" || found == b"new!", "{found:?} after {steps} steps");
            ends.push(found == b"new!");
            // Leftover unfinished files do not interfere, and no process holds a lock on them.
            write(&path, b"again", Access::Private).expect("written");
            let left: Vec<PathBuf> =
                names(home.path()).into_iter().filter(|name| name.as_os_str() != "file").collect();
            assert!(left.len() <= 1, "{left:?}");
            assert!(left.iter().all(|name| unfinished(&home.path().join(name)).is_some()), "{left:?}");
            if written.is_ok() {
                break;
            }
        }
        assert_eq!(ends, [false, false, false, false, true, true]);
    }

    #[test]
    fn failed_writes_leave_nothing() {
        let home = tempfile::tempdir().expect("temporary folder");
        let path = home.path().join("file");
        fs::create_dir(&path).expect("created");
        assert!(write(&path, b"x", Access::Shared).is_err(), "a folder is not replaced");
        assert_eq!(create(&path, b"x", Access::Shared).expect_err("taken").kind(), ErrorKind::AlreadyExists);
        assert_eq!(names(home.path()), [Path::new("file")]);
        fs::remove_dir(&path).expect("removed");
        create(&path, b"mine", Access::Shared).expect("written");
        assert_eq!(create(&path, b"x", Access::Shared).expect_err("taken").kind(), ErrorKind::AlreadyExists);
        assert_eq!(fs::read(&path).expect("there"), b"mine");
        assert_eq!(names(home.path()), [Path::new("file")]);
        let absent = home.path().join("absent/file");
        assert_eq!(write(&absent, b"x", Access::Shared).expect_err("absent").kind(), ErrorKind::NotFound);
        assert_eq!(create(&absent, b"x", Access::Shared).expect_err("absent").kind(), ErrorKind::NotFound);
    }

    #[test]
    fn unfinished_files_are_recognised() {
        for (name, expected) in [
            (".arcade-a1B2c3.partial", true),
            (".arcade-a1B2c.partial", false),
            (".arcade-notes!.partial", false),
            (".arcade-.partial", false),
            ("a1B2c3", false),
        ] {
            assert_eq!(is_unfinished(OsStr::new(name)), expected, "{name}");
        }
        let home = tempfile::tempdir().expect("temporary folder");
        let fresh = Disk::new().fill(&home.path().join("file"), b"x", Access::Shared).expect("written");
        assert!(unfinished(fresh.path()).is_none(), "it is being written");
    }

    #[cfg(unix)]
    #[test]
    fn access_is_kept_or_restricted_from_the_start() {
        use std::os::unix::fs::PermissionsExt;
        let home = tempfile::tempdir().expect("temporary folder");
        let folder = home.path().join("a/b");
        create_folder(&folder).expect("created");
        let mode = |path: &Path| fs::metadata(path).expect("there").permissions().mode() & 0o777;
        let path = folder.join("secret");
        write(&path, b"x", Access::Private).expect("written");
        assert_eq!(mode(&path), 0o600);
        Disk::losing_power_after(1).write(&path, b"y", Access::Private).expect_err("cut");
        let half = names(&folder).into_iter().find(|name| is_unfinished(name.as_os_str())).expect("left");
        assert_eq!(mode(&folder.join(half)), 0o600);
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).expect("set");
        write(&path, b"z", Access::Shared).expect("written");
        assert_eq!(mode(&path), 0o640);
        // A new file gets the same permissions as any other new file.
        fs::write(folder.join("plain"), "").expect("written");
        write(&folder.join("new"), b"", Access::Shared).expect("written");
        create(&folder.join("newer"), b"", Access::Shared).expect("written");
        assert_eq!(
            (mode(&folder.join("new")), mode(&folder.join("newer"))),
            (mode(&folder.join("plain")), mode(&folder.join("plain")))
        );
    }

    /// Checks that a link's target stays unchanged, and that writing does not wait for a pipe.
    #[cfg(unix)]
    #[test]
    fn links_and_pipes_are_replaced() {
        let home = tempfile::tempdir().expect("temporary folder");
        let (victim, path) = (home.path().join("victim"), home.path().join("file"));
        fs::write(&victim, "precious").expect("written");
        std::os::unix::fs::symlink(&victim, &path).expect("linked");
        write(&path, b"mine", Access::Shared).expect("written");
        assert!(fs::symlink_metadata(&path).expect("there").is_file());
        assert_eq!(fs::read(&victim).expect("there"), b"precious");
        fs::remove_file(&path).expect("removed");
        assert!(std::process::Command::new("mkfifo").arg(&path).status().expect("run").success());
        write(&path, b"mine", Access::Shared).expect("written");
        assert_eq!(fs::read(&path).expect("there"), b"mine");
        std::os::unix::fs::symlink(home.path().join("absent"), home.path().join("dangling")).expect("linked");
        let taken = create(&home.path().join("dangling"), b"x", Access::Shared);
        assert_eq!(taken.expect_err("taken").kind(), ErrorKind::AlreadyExists);
        assert!(!home.path().join("absent").exists());
    }

    /// Checks power losses during the creation of each new folder, and during the wait until its name is on
    /// disk.
    #[test]
    fn names_of_new_folders_are_waited_for() {
        let home = tempfile::tempdir().expect("temporary folder");
        let deep = home.path().join("a/b/c");
        assert!(Disk::losing_power_after(5).create_folder(&deep).is_err());
        assert!(deep.exists());
        fs::remove_dir_all(home.path().join("a")).expect("removed");
        Disk::losing_power_after(6).create_folder(&deep).expect("created");
        Disk::losing_power_after(0).create_folder(&deep).expect("there already");
    }
}

//! Files that are complete or absent: written beside their place, synced, renamed, and their folder synced.

use std::cell::Cell;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Writes files so that a loss of power at any moment leaves each of them as it was, or complete.
///
/// A test can cut the power: [`Disk::losing_power_after`] stops before a given step, leaving everything as it then is.
#[derive(Debug, Default)]
pub struct Disk {
    /// The steps that are left before the power is lost; `None` if it never is.
    left: Option<Cell<usize>>,
}

/// The access that others have to a new file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// The default of the system.
    Shared,
    /// None: only the owner can read it.
    Private,
}

impl Disk {
    /// The disk of the machine.
    pub fn new() -> Disk {
        Disk::default()
    }

    /// A disk that stops working after so many steps, each of which is one change of the file system. The step that is
    /// cut writes half of its bytes.
    pub fn losing_power_after(steps: usize) -> Disk {
        Disk { left: Some(Cell::new(steps)) }
    }

    /// Writes a whole file, replacing what was there.
    ///
    /// # Errors
    /// The file system refuses; then the previous content is untouched.
    pub fn write(&self, path: &Path, bytes: &[u8], access: Access) -> io::Result<()> {
        let folder = parent(path);
        self.create_folder(&folder)?;
        let beside = unfinished(path);
        let written = self.fill(&beside, bytes, access).and_then(|()| {
            self.step()?;
            fs::rename(&beside, path)
        });
        if written.is_err() && !self.is_off() {
            // The name may be taken by a leftover that cannot be opened; then there is nothing of ours to remove.
            let _ = fs::remove_file(&beside);
        }
        written?;
        self.sync(&folder)
    }

    fn fill(&self, beside: &Path, bytes: &[u8], access: Access) -> io::Result<()> {
        self.step()?;
        // A leftover of a killed run may have other permissions.
        match fs::remove_file(beside) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        if access == Access::Private {
            std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        }
        #[cfg(not(unix))]
        let _ = access;
        let mut file = options.open(beside)?;
        let (first, second) = bytes.split_at(bytes.len() / 2);
        file.write_all(first)?;
        self.step()?;
        file.write_all(second)?;
        self.step()?;
        file.sync_all()
    }

    /// Creates a folder with its parents, and waits until their names are on disk.
    ///
    /// # Errors
    /// The file system refuses.
    pub fn create_folder(&self, folder: &Path) -> io::Result<()> {
        let missing: Vec<PathBuf> = folder
            .ancestors()
            .take_while(|above| !above.as_os_str().is_empty() && !above.exists())
            .map(Path::to_path_buf)
            .collect();
        for created in missing.iter().rev() {
            self.step()?;
            fs::create_dir(created)?;
            self.sync(&parent(created))?;
        }
        Ok(())
    }

    /// Waits until the names in a folder are on disk. Only Unix allows that.
    fn sync(&self, folder: &Path) -> io::Result<()> {
        self.step()?;
        if cfg!(unix) {
            File::open(folder)?.sync_all()?;
        }
        Ok(())
    }

    /// Counts a change of the file system.
    fn step(&self) -> io::Result<()> {
        let Some(left) = &self.left else { return Ok(()) };
        match left.get().checked_sub(1) {
            Some(fewer) => {
                left.set(fewer);
                Ok(())
            }
            None => Err(io::Error::other("the power is lost, as the test asked")),
        }
    }

    fn is_off(&self) -> bool {
        self.left.as_ref().is_some_and(|left| left.get() == 0)
    }
}

/// The folder of a file.
fn parent(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

/// The name of a file while it is written, which `arcade clean` recognises.
fn unfinished(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".arcade-{name}.partial"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whenever the power is lost, the file is the old one or the new one.
    #[test]
    fn a_file_is_old_or_new_after_a_loss_of_power() {
        let mut ends = Vec::new();
        for steps in 0.. {
            let home = tempfile::tempdir().expect("temporary folder");
            let path = home.path().join("file");
            Disk::new().write(&path, b"old", Access::Shared).expect("written");
            let written = Disk::losing_power_after(steps).write(&path, b"new!", Access::Shared);
            let found = fs::read(&path).expect("there");
            assert!(found == b"old" || found == b"new!", "{found:?} after {steps} steps");
            ends.push(found == b"new!");
            // Leftovers are in nobody's way.
            Disk::new().write(&path, b"again", Access::Private).expect("written");
            assert_eq!(fs::read_dir(home.path()).expect("listed").count(), 1);
            if written.is_ok() {
                break;
            }
        }
        assert_eq!(ends, [false, false, false, false, true, true]);
    }

    #[cfg(unix)]
    #[test]
    fn private_files_are_private_from_the_start() {
        use std::os::unix::fs::PermissionsExt;
        let home = tempfile::tempdir().expect("temporary folder");
        let path = home.path().join("a/b/secret");
        Disk::new().write(&path, b"x", Access::Private).expect("written");
        assert_eq!(fs::metadata(&path).expect("there").permissions().mode() & 0o777, 0o600);
        Disk::losing_power_after(2).write(&path, b"y", Access::Private).expect_err("cut");
        let half = home.path().join("a/b/.arcade-secret.partial");
        assert_eq!(fs::metadata(&half).expect("there").permissions().mode() & 0o777, 0o600);
    }
}

//! Operating system file locks.

use crate::open::{is_same_file, open, open_no_follow};
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::Path;

/// A lock on a file. The lock excludes other processes until it is dropped. The operating system releases it
/// when the process ends, for whatever reason.
#[derive(Debug)]
pub struct Lock(File);

impl Lock {
    /// Locks a file, creating it if it does not exist. Returns `None` if the lock is already held. On a file
    /// system that does not support locks, locking always succeeds.
    ///
    /// # Errors
    /// Returns an error if the path is a link or not a regular file, or if the file system fails.
    pub fn take(path: &Path) -> io::Result<Option<Lock>> {
        // The current holder may finish and remove the file after it has been opened here.
        for _ in 0..16 {
            let file = open_no_follow(path)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Ok(None),
                Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {}
                Err(TryLockError::Error(error)) => return Err(error),
            }
            // The lock is valid only if the path still refers to the locked file.
            let held = file.metadata()?;
            if fs::symlink_metadata(path).is_ok_and(|found| is_same_file(&held, &found)) {
                return Ok(Some(Lock(file)));
            }
        }
        Ok(None)
    }

    /// Returns `true` if the lock on a file is held. Does not create the file, and does not follow links.
    pub fn is_held(path: &Path) -> bool {
        let file = if path.is_symlink() { Err(ErrorKind::InvalidInput.into()) } else { open(path) };
        file.is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
    }

    /// Returns the locked file, open for reading and writing.
    pub fn file(&mut self) -> &mut File {
        &mut self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read, Write};

    #[test]
    fn a_lock_has_one_holder() {
        let home = tempfile::tempdir().expect("temporary folder");
        let path = home.path().join(".lock");
        assert!(!Lock::is_held(&path) && !path.exists());
        let mut first = Lock::take(&path).expect("created").expect("free");
        assert!(Lock::is_held(&path));
        assert!(Lock::take(&path).expect("opened").is_none());
        first.file().write_all(b"mine").expect("written");
        drop(first);
        assert!(!Lock::is_held(&path));
        let mut text = String::new();
        let mut second = Lock::take(&path).expect("opened").expect("free again");
        second.file().read_to_string(&mut text).expect("readable");
        assert_eq!(text, "mine");
        // A file that replaces a locked file has its own lock.
        fs::remove_file(&path).expect("removed");
        assert!(Lock::take(&path).expect("created").is_some());
        assert_eq!(Lock::take(&home.path().join("a/b")).expect_err("no folder").kind(), ErrorKind::NotFound);
    }

    #[cfg(unix)]
    #[test]
    fn links_are_not_locked() {
        let home = tempfile::tempdir().expect("temporary folder");
        let (target, link) = (home.path().join("target"), home.path().join("link"));
        std::os::unix::fs::symlink(&target, &link).expect("linked");
        assert_eq!(Lock::take(&link).expect_err("a link").kind(), ErrorKind::InvalidInput);
        let _held = Lock::take(&target).expect("created").expect("free");
        assert!(!Lock::is_held(&link));
    }
}

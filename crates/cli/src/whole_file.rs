//! Writing of single files: each is complete, or unchanged.

use crate::failure::Failure;
use crate::protected;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// The beginning and end of the names of unfinished files. They lie beside their targets, and `arcade clean`
/// recognises them.
pub(crate) const UNFINISHED: (&str, &str) = (".arcade-", ".partial");

/// Writes a temporary file beside `path`, waits until it is on disk, and moves it to `path` in one step.
///
/// If that fails, or if the process is killed, the previous content is untouched. Links are followed. Devices and
/// pipes (`/dev/stdout`) are written in place.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    protected::check(path)?;
    replace(path, |file| file.write_all(bytes)).map_err(|error| Failure::write(path, error))
}

/// Writes a new file; if it cannot be written completely, it is removed, so that it is not in the way.
pub(crate) fn create(options: &mut OpenOptions, path: &Path, bytes: &[u8]) -> io::Result<()> {
    fill(options.write(true).create_new(true).open(path)?, path, bytes)
}

fn fill(mut file: File, path: &Path, bytes: &[u8]) -> io::Result<()> {
    file.write_all(bytes).and_then(|()| file.sync_all()).inspect_err(|_| drop(fs::remove_file(path)))
}

fn replace(path: &Path, content: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let before = match fs::metadata(path) {
        Ok(found) => Some(found),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => return Err(error),
    };
    if before.as_ref().is_some_and(|found| found.is_dir()) {
        return Err(ErrorKind::IsADirectory.into());
    }
    if before.as_ref().is_some_and(|found| !found.is_file()) {
        return content(&mut OpenOptions::new().write(true).open(path)?);
    }
    let place = destination(path)?;
    let folder = match place.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let mut fresh = beside(folder)?;
    // The lock tells `arcade clean` to leave the file alone while it is written, if the file system supports locks.
    let _ = fresh.as_file().try_lock();
    content(fresh.as_file_mut())?;
    if let Some(before) = before {
        fresh.as_file().set_permissions(before.permissions())?;
    }
    fresh.as_file().sync_all()?;
    // Dropping a file that could not be moved removes it.
    fresh.persist(&place).map_err(|failed| failed.error)?;
    sync(folder)
}

/// Returns the target of this path: links, even those to missing files, are followed.
fn destination(path: &Path) -> io::Result<PathBuf> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_symlink() => match fs::canonicalize(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                let target = fs::read_link(path)?;
                Ok(path.parent().unwrap_or(Path::new(".")).join(target))
            }
            place => place,
        },
        _ => Ok(path.to_owned()),
    }
}

/// Creates a new file in this folder, with the default permissions of new files.
fn beside(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(UNFINISHED.0).suffix(UNFINISHED.1);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    // The name of the scratch file would only confuse: keep only the cause.
    builder
        .tempfile_in(folder)
        .map_err(|error| error.raw_os_error().map_or(error, io::Error::from_raw_os_error))
}

/// Waits until the entries of a folder are on disk. Only Unix allows that.
fn sync(folder: &Path) -> io::Result<()> {
    if cfg!(unix) {
        File::open(folder)?.sync_all()?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let listed = fs::read_dir(folder).expect("readable");
        listed.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect()
    }

    /// An empty secret would have to be removed by hand, because a secret is never overwritten.
    #[test]
    fn partial_new_files_are_removed() {
        let home = tempfile::tempdir().expect("temporary folder");
        let place = home.path().join("new.secret.json");
        fs::write(&place, "").expect("written");
        let unwritable = File::open(&place).expect("there");
        assert!(fill(unwritable, &place, b"secret").is_err());
        assert!(!place.exists());
        create(&mut OpenOptions::new(), &place, b"secret").expect("written");
        assert_eq!(fs::read(&place).expect("there"), b"secret");
    }

    #[test]
    fn failed_writes_keep_the_old_file() {
        let home = tempfile::tempdir().expect("temporary folder");
        let path = home.path().join("win.json");
        write(&path, b"old").expect("written");
        // Simulates a disk that is full after some bytes.
        let cut = replace(&path, |file| {
            file.write_all(b"ne")?;
            Err(ErrorKind::StorageFull.into())
        });
        let error = Failure::write(&path, cut.expect_err("cut"));
        assert_eq!(error.code(), crate::failure::ENVIRONMENT);
        assert_eq!(fs::read(&path).expect("there"), b"old");
        assert_eq!(names(home.path()), ["win.json"]);
        let cut = replace(&home.path().join("other"), |_| Err(ErrorKind::StorageFull.into()));
        assert!(cut.is_err());
        assert_eq!(names(home.path()), ["win.json"]);
        write(&path, b"new").expect("written");
        assert_eq!(fs::read(&path).expect("there"), b"new");
    }

    #[test]
    fn impossible_paths_are_distinguished() {
        let home = tempfile::tempdir().expect("temporary folder");
        let message = |path: &Path| write(path, b"").expect_err("impossible").to_string();
        assert!(message(home.path()).contains("is a folder"));
        assert!(message(&home.path().join("a/b")).contains("folder does not exist"));
        assert!(message(&home.path().join("a".repeat(300))).contains("choose a shorter one"));
        assert!(names(home.path()).is_empty());
    }

    #[cfg(unix)]
    #[test]
    fn links_permissions_and_devices_are_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let home = tempfile::tempdir().expect("temporary folder");
        let (target, link) = (home.path().join("target"), home.path().join("link"));
        fs::write(&target, "old").expect("written");
        fs::set_permissions(&target, fs::Permissions::from_mode(0o640)).expect("set");
        symlink("target", &link).expect("linked");
        write(&link, b"new").expect("written");
        assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(fs::read(&target).expect("there"), b"new");
        assert_eq!(fs::metadata(&target).expect("there").permissions().mode() & 0o777, 0o640);
        fs::remove_file(&target).expect("removed");
        write(&link, b"again").expect("written");
        assert_eq!(fs::read(&target).expect("there"), b"again");
        // The file has the permissions of any other new file.
        fs::write(home.path().join("plain"), "").expect("written");
        let mode = |name: &str| fs::metadata(home.path().join(name)).expect("there").permissions().mode();
        assert_eq!(mode("target"), mode("plain"));
        write(Path::new("/dev/null"), b"gone").expect("written");
        assert!(!fs::metadata("/dev/null").expect("there").is_file());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_an_environment_failure() {
        let error = write(Path::new("/dev/full"), b"x").expect_err("full");
        assert_eq!(error.code(), crate::failure::ENVIRONMENT);
        assert!(error.to_string().contains("No space left"), "{error}");
    }
}

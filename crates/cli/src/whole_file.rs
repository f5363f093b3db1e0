//! Writing of single files that the user names: each is complete, or unchanged.

use crate::failure::Failure;
use crate::protected;
use disk::Access;
use std::fs::{self, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Writes a whole file, as [`disk::write`] does. Links are followed. Devices and pipes (`/dev/stdout`) are written in place.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    protected::check(path)?;
    replace(path, bytes).map_err(|error| Failure::write(path, error))
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => return Err(ErrorKind::IsADirectory.into()),
        Ok(found) if !found.is_file() => return OpenOptions::new().write(true).open(path)?.write_all(bytes),
        Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    disk::write(&destination(path)?, bytes, Access::Shared)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let listed = fs::read_dir(folder).expect("readable");
        listed.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect()
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

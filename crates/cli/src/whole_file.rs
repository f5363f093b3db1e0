//! Writes single files specified by the user. Each file is either complete or unchanged.

use crate::failure::Failure;
use crate::protected;
use base::MessagePath;
use disk::Access;
use std::fs::{self, Metadata, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Writes an entire file like [`disk::write`], but rejects the paths that [`check`] rejects. Devices and the
/// process's own streams (`/dev/stdout`) are written in place.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    protected::check(path)?;
    let written = match Place::of(path)? {
        Place::File => disk::write(path, bytes, Access::Shared),
        Place::Stream => {
            OpenOptions::new().append(true).open(path).and_then(|mut stream| stream.write_all(bytes))
        }
    };
    written.map_err(|error| Failure::write(path, error))
}

/// Rejects a path that [`write`] would reject, before the work starts. Also rejects each of the command's
/// `inputs`.
pub(crate) fn check(path: &Path, inputs: &[&Path]) -> Result<(), Failure> {
    protected::check(path)?;
    Place::of(path)?;
    if !folder_of(path).is_dir() {
        return Err(Failure::write(path, ErrorKind::NotFound.into()));
    }
    let Ok(there) = fs::canonicalize(path) else { return Ok(()) };
    match inputs.iter().any(|input| fs::canonicalize(input).is_ok_and(|input| there.starts_with(input))) {
        true => Err(malformed!(
            "cannot write `{}`: this command reads that file; choose another file",
            path.in_message()
        )),
        false => Ok(()),
    }
}

/// The kind of file that a path refers to.
enum Place {
    /// A regular file, or a path where nothing exists yet.
    File,
    /// A device, or one of the process's streams.
    Stream,
}

impl Place {
    /// Examines a path specified by the user. Other users with write access to its folder may have replaced
    /// the file with a link to a different file, or with a pipe, which would block when opened.
    fn of(path: &Path) -> Result<Place, Failure> {
        let name = path.in_message();
        if is_own_stream(path) {
            return Ok(Place::Stream);
        }
        match fs::symlink_metadata(path) {
            Ok(found) if found.is_symlink() => Err(match target(path) {
                Some(target) => malformed!(
                    "cannot write `{name}`: it is a link; use its target, `{}`, or remove the link",
                    target.in_message()
                ),
                None => malformed!("cannot write `{name}`: it is a link; remove it, or choose another file"),
            }),
            Ok(found) if found.is_file() => Ok(Place::File),
            Ok(found) if found.is_dir() => Err(Failure::write(path, ErrorKind::IsADirectory.into())),
            Ok(found) if is_character_device(&found) => Ok(Place::Stream),
            Ok(_) => Err(malformed!("cannot write `{name}`: it is not a file; choose a regular file")),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(Place::File),
            Err(error) => Err(Failure::write(path, error)),
        }
    }
}

/// Returns `true` if a path denotes one of the process's standard streams. On some systems, such paths are
/// links.
fn is_own_stream(path: &Path) -> bool {
    let is_numbered =
        ["/dev/fd", "/proc/self/fd"].iter().any(|folder| path.parent() == Some(Path::new(folder)));
    cfg!(unix)
        && (is_numbered || ["/dev/stdout", "/dev/stderr"].iter().any(|stream| path == Path::new(stream)))
}

fn is_character_device(found: &Metadata) -> bool {
    #[cfg(unix)]
    {
        std::os::unix::fs::FileTypeExt::is_char_device(&found.file_type())
    }
    #[cfg(not(unix))]
    {
        let _ = found;
        false
    }
}

/// Returns the target of a link, which need not exist. Returns `None` if the link leads back to itself.
fn target(link: &Path) -> Option<PathBuf> {
    match fs::canonicalize(link) {
        Err(error) if error.kind() == ErrorKind::NotFound => {
            Some(folder_of(link).join(fs::read_link(link).ok()?))
        }
        found => found.ok(),
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
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
    fn links_and_pipes_are_refused_with_a_step_that_works() {
        use std::os::unix::fs::symlink;
        let home = tempfile::tempdir().expect("temporary folder");
        let at = |name: &str| home.path().join(name);
        fs::write(at("target"), "old").expect("written");
        symlink("target", at("link")).expect("linked");
        symlink("absent", at("dangling")).expect("linked");
        symlink("loop", at("loop")).expect("linked");
        let made = std::process::Command::new("mkfifo").arg(at("pipe")).status().expect("started");
        assert!(made.success());
        for (name, expect) in [
            ("link", "/target`, or remove the link"),
            ("dangling", "/absent`, or remove the link"),
            ("loop", "it is a link; remove it"),
            ("pipe", "it is not a file; choose a regular file"),
        ] {
            for refused in [write(&at(name), b"new"), check(&at(name), &[])] {
                let error = refused.expect_err(name);
                assert_eq!(error.code(), crate::failure::MALFORMED);
                assert!(error.to_string().contains(expect), "{error}");
            }
        }
        assert_eq!(fs::read(at("target")).expect("there"), b"old");
        assert!(!at("absent").exists());
    }

    #[test]
    fn inputs_are_no_outputs() {
        let home = tempfile::tempdir().expect("temporary folder");
        let (log, game) = (home.path().join("log"), home.path().join("game.txt"));
        fs::create_dir(&log).expect("created");
        for file in [&game, &log.join("checkpoint")] {
            fs::write(file, "old").expect("written");
            let error = check(&home.path().join("log/..").join(file), &[&log, &game]).expect_err("an input");
            assert!(error.to_string().contains("this command reads that file; choose another"), "{error}");
        }
        check(&home.path().join("other.txt"), &[&log, &game]).expect("no input");
    }

    #[cfg(unix)]
    #[test]
    fn permissions_and_devices_are_kept() {
        use std::os::unix::fs::PermissionsExt;
        let home = tempfile::tempdir().expect("temporary folder");
        let target = home.path().join("target");
        fs::write(&target, "old").expect("written");
        fs::set_permissions(&target, fs::Permissions::from_mode(0o640)).expect("set");
        write(&target, b"new").expect("written");
        assert_eq!(fs::metadata(&target).expect("there").permissions().mode() & 0o777, 0o640);
        // The file gets the same permissions as any other new file.
        let [plain, fresh] = ["plain", "fresh"].map(|name| home.path().join(name));
        fs::write(&plain, "").expect("written");
        write(&fresh, b"new").expect("written");
        let mode = |path: &Path| fs::metadata(path).expect("there").permissions().mode();
        assert_eq!(mode(&fresh), mode(&plain));
        for device in ["/dev/null", "/dev/stdout"] {
            check(Path::new(device), &[]).expect("a stream");
        }
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

//! Opens and reads files that other users may have tampered with.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Opens a regular file for reading. Follows links, because the user chose the name.
///
/// # Errors
/// Returns an error if the path is not a regular file, or the file cannot be read.
pub fn open(path: &Path) -> io::Result<File> {
    regular(&fs::metadata(path)?)?;
    let file = File::open(path)?;
    regular(&file.metadata()?)?;
    Ok(file)
}

/// Reads a regular file of at most `limit` bytes, following links. Returns `None` if the file is larger.
///
/// # Errors
/// Returns an error if the path is not a regular file, or the file cannot be read.
pub fn read(path: &Path, limit: u64) -> io::Result<Option<Vec<u8>>> {
    bounded(open(path)?, limit)
}

/// Reads the first `limit` bytes of a regular file, following links.
///
/// # Errors
/// Returns an error if the path is not a regular file, or the file cannot be read.
pub fn read_start(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    start(open(path)?, limit)
}

/// Reads at most `limit` bytes from a reader.
///
/// # Errors
/// Returns an error if reading fails.
pub fn start(reader: impl Read, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(limit).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn bounded(file: File, limit: u64) -> io::Result<Option<Vec<u8>>> {
    let bytes = start(file, limit.saturating_add(1))?;
    Ok(Some(bytes).filter(|bytes| bytes.len() as u64 <= limit))
}

/// Reads a file of at most `limit` bytes, without following links. Returns `None` if the file is larger.
///
/// # Errors
/// Returns an error if the path is not a regular file, or the file cannot be read.
pub fn read_no_follow(path: &Path, limit: u64) -> io::Result<Option<Vec<u8>>> {
    bounded(existing(path, OpenOptions::new().read(true))?, limit)
}

/// Opens a file for reading and writing, without following a link or truncating the file. Creates the file if
/// it does not exist.
///
/// # Errors
/// Returns an error if the path is not a regular file, or the file cannot be opened.
pub fn open_no_follow(path: &Path) -> io::Result<File> {
    open_or_create(path, OpenOptions::new().read(true).write(true))
}

/// Opens a file for reading and appending, without following a link. Creates the file if it does not exist.
///
/// # Errors
/// Returns an error if the path is not a regular file, or the file cannot be opened.
pub fn append_no_follow(path: &Path) -> io::Result<File> {
    open_or_create(path, OpenOptions::new().read(true).append(true))
}

/// Creates a folder and its parents. If the path already exists, it must not be a link.
///
/// # Errors
/// Returns an error if the path is a link or a file, or if the file system fails.
pub fn create_folder_no_follow(path: &Path) -> io::Result<()> {
    match fs::symlink_metadata(path) {
        Ok(found) if !found.is_dir() => Err(invalid("is not a folder")),
        Ok(_) => Ok(()),
        Err(error) if error.kind() == ErrorKind::NotFound => fs::create_dir_all(path),
        Err(error) => Err(error),
    }
}

/// Returns `true` if users other than the owner can read a file, or `false` if the permissions are unknown.
pub fn is_readable_by_others(path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::metadata(path).is_ok_and(|found| found.permissions().mode() & 0o044 != 0)
    }
    #[cfg(not(unix))]
    {
        let _ = path;
        false
    }
}

fn open_or_create(path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    // Another process may create or remove the file between the two attempts.
    for _ in 0..16 {
        match existing(path, options) {
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            opened => return opened,
        }
        match options.clone().create_new(true).open(path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            opened => return opened,
        }
    }
    Err(io::Error::from(ErrorKind::AlreadyExists))
}

/// Opens an existing file, provided that it is a regular file and not a link.
fn existing(path: &Path, options: &OpenOptions) -> io::Result<File> {
    // Another process may replace the file between the two steps.
    for _ in 0..16 {
        let examined = fs::symlink_metadata(path)?;
        regular(&examined)?;
        let file = options.open(path)?;
        if is_same_file(&examined, &file.metadata()?) {
            return Ok(file);
        }
    }
    Err(invalid("keeps being replaced"))
}

fn regular(found: &Metadata) -> io::Result<()> {
    match () {
        () if found.is_file() => Ok(()),
        () if found.is_dir() => Err(ErrorKind::IsADirectory.into()),
        () => Err(invalid("is not a file")),
    }
}

fn invalid(what: &str) -> io::Error {
    io::Error::new(ErrorKind::InvalidInput, what)
}

/// Returns `true` if `one` and `other` describe the same file, or if this cannot be determined.
pub fn is_same_file(one: &Metadata, other: &Metadata) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        (one.dev(), one.ino()) == (other.dev(), other.ino())
    }
    #[cfg(not(unix))]
    {
        one.file_type() == other.file_type()
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::io::Write;
    use std::os::unix::fs::symlink;
    use std::process::Command;
    use std::thread;

    /// Checks that opening a file never changes the target of a link, nor creates the target of a dangling
    /// link.
    #[test]
    fn links_lead_nowhere() {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name);
        fs::write(at("victim"), "precious").unwrap();
        symlink(at("victim"), at("link")).unwrap();
        symlink(at("absent"), at("dangling")).unwrap();
        for link in ["link", "dangling"] {
            assert_eq!(open_no_follow(&at(link)).unwrap_err().kind(), ErrorKind::InvalidInput);
            assert_eq!(append_no_follow(&at(link)).unwrap_err().kind(), ErrorKind::InvalidInput);
            assert_eq!(read_no_follow(&at(link), 99).unwrap_err().kind(), ErrorKind::InvalidInput);
            assert!(create_folder_no_follow(&at(link)).is_err());
        }
        assert_eq!(fs::read(at("victim")).unwrap(), b"precious");
        assert!(!at("absent").exists());
        symlink(home.path(), at("folder")).unwrap();
        assert!(create_folder_no_follow(&at("folder")).is_err());
        create_folder_no_follow(&at("new/folder")).unwrap();
        create_folder_no_follow(&at("new/folder")).unwrap();
    }

    #[test]
    fn opening_truncates_nothing() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("file");
        open_no_follow(&path).unwrap().write_all(b"one").unwrap();
        drop(open_no_follow(&path).unwrap());
        append_no_follow(&path).unwrap().write_all(b" two").unwrap();
        assert_eq!(read_no_follow(&path, 7).unwrap().unwrap(), b"one two");
        assert_eq!(read(&path, 6).unwrap(), None);
    }

    /// Checks that a file can be opened while another thread keeps replacing it.
    #[test]
    fn replaced_files_are_opened() {
        let home = tempfile::tempdir().unwrap();
        let (path, next) = (home.path().join("file"), home.path().join("next"));
        fs::write(&path, "new").unwrap();
        thread::scope(|scope| {
            let replacing = scope.spawn(|| {
                for _ in 0..4_000 {
                    fs::write(&next, "new").unwrap();
                    fs::rename(&next, &path).unwrap();
                }
            });
            while !replacing.is_finished() {
                read_no_follow(&path, 3).expect("a file is always there");
            }
        });
    }

    /// Checks that pipes are not opened, because a pipe without a writer would block forever.
    #[test]
    fn pipes_are_not_opened() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("pipe");
        assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
        for opened in [open(&path), open_no_follow(&path), append_no_follow(&path)] {
            assert_eq!(opened.unwrap_err().to_string(), "is not a file");
        }
        assert_eq!(read(Path::new("/dev/zero"), 9).unwrap_err().to_string(), "is not a file");
        assert_eq!(read(home.path(), 9).unwrap_err().kind(), ErrorKind::IsADirectory);
    }
}

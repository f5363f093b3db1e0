//! Reads an untrusted release folder. Links are not followed, only regular files are opened, and every size is
//! bounded before any content is read.
//!
//! The folder specified by the user may itself be reached through a link, but nothing inside it may. The only
//! defence against a folder that changes *while* it is being read is that, on Unix, an opened file is
//! compared with the file that was examined.

use std::ffi::OsStr;
use std::fs::{self, File, Metadata};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::error::SnapshotError;
use crate::format::path::{PathProblem, check_path};
use crate::format::problem::{Flaw, Problem};
use base::Digest;

/// The limits on a release folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// The maximum number of files, and the maximum number of folders.
    pub files: u64,
    /// The maximum size of one file, in bytes.
    pub file_bytes: u64,
    /// The maximum total size of all files, in bytes.
    pub total_bytes: u64,
}

impl Limits {
    /// The limits of format 1: 100 000 files, up to 64 MiB each, 4 GiB in total.
    pub const SNAPSHOT: Limits = Limits { files: 100_000, file_bytes: 64 << 20, total_bytes: 4 << 30 };
}

/// A regular file in a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// The relative path, `/`-separated, valid according to [`check_path`].
    pub path: String,
    /// The size, in bytes.
    pub size: u64,
}

/// The content of a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listing {
    /// The regular files that are allowed in a release, sorted by the bytes of their paths.
    pub entries: Vec<Entry>,
    /// The problems with all other entries, sorted.
    pub problems: Vec<Problem>,
    /// The top-level names that were skipped, sorted.
    pub passed_over: Vec<String>,
    /// `true` if the whole folder was listed, or `false` after [`Flaw::TooMany`], in which case there are no
    /// entries.
    pub complete: bool,
}

/// Walks the folder `root`. The result does not depend on the system's listing order.
///
/// Links, special files, unsafe names, empty folders and exceeded limits are reported as problems, not
/// errors.
///
/// Cost: one examination per name, for at most twice `limits.files` names. Files are not opened.
///
/// # Errors
/// Returns an error if a folder cannot be read.
pub fn list(root: &Path, limits: &Limits) -> Result<Listing, SnapshotError> {
    list_but(root, limits, &[])
}

/// Lists a folder like [`list`], but skips top-level entries that have one of the given names.
pub(crate) fn list_but(root: &Path, limits: &Limits, names: &[&str]) -> Result<Listing, SnapshotError> {
    let (mut entries, mut problems, mut passed_over) = (Vec::new(), Vec::new(), Vec::new());
    let (mut files, mut folders, mut total) = (0, 0, 0_u64);
    let mut waiting = vec![String::new()];
    while let Some(folder) = waiting.pop() {
        let place = if folder.is_empty() { root.to_path_buf() } else { join(root, &folder) };
        let mut empty = true;
        for child in fs::read_dir(&place).map_err(SnapshotError::io("list", &place))? {
            let child = child.map_err(SnapshotError::io("list", &place))?;
            empty = false;
            if let Some(name) = names.iter().find(|name| folder.is_empty() && child.file_name() == **name) {
                passed_over.push((*name).to_owned());
                continue;
            }
            let found = child.metadata().map_err(SnapshotError::io("examine", &child.path()))?;
            let count = if found.is_dir() { &mut folders } else { &mut files };
            *count += 1;
            if *count > limits.files {
                let flaw = Flaw::TooMany { limit: limits.files };
                let problems = vec![Problem { path: ".".into(), flaw }];
                return Ok(Listing { entries: Vec::new(), problems, passed_over, complete: false });
            }
            if found.is_file() {
                total = total.saturating_add(found.len());
            }
            let (path, named) = relative(&folder, &child.file_name());
            match flaw_of(&found, named, limits) {
                Some(flaw) => problems.push(Problem { path, flaw }),
                None if found.is_dir() => waiting.push(path),
                None => entries.push(Entry { path, size: found.len() }),
            }
        }
        if empty && !folder.is_empty() {
            problems.push(Problem { path: folder, flaw: Flaw::EmptyFolder });
        }
    }
    if total > limits.total_bytes {
        let flaw = Flaw::TotalTooLarge { size: total, limit: limits.total_bytes };
        problems.push(Problem { path: ".".into(), flaw });
    }
    entries.sort_unstable_by(|a, b| a.path.cmp(&b.path));
    problems.sort_unstable();
    passed_over.sort_unstable();
    Ok(Listing { entries, problems, passed_over, complete: true })
}

/// Reads the file at `relative` below `root`. The file may be at most `limit` bytes long.
///
/// # Errors
/// Returns an error if the path is unsafe, a component is a link, the entry is not a file, the file is longer than
/// `limit` bytes, or the file cannot be read.
pub fn read(root: &Path, relative: &str, limit: u64) -> Result<Vec<u8>, SnapshotError> {
    let file = open(root, relative)?;
    let path = join(root, relative);
    let bytes = disk::start(file, limit.saturating_add(1)).map_err(SnapshotError::io("read", &path))?;
    if bytes.len() as u64 > limit { Err(SnapshotError::TooLarge { path, limit }) } else { Ok(bytes) }
}

/// Reads a file like [`read`], but returns `None` if there is no such file.
///
/// # Errors
/// See [`read`].
pub(crate) fn find(root: &Path, relative: &str, limit: u64) -> Result<Option<Vec<u8>>, SnapshotError> {
    match read(root, relative, limit) {
        Err(SnapshotError::Io { source, .. }) if source.kind() == io::ErrorKind::NotFound => Ok(None),
        read => read.map(Some),
    }
}

/// Returns the size and digest of the file at `relative` below `root`, read in chunks. For a file longer than
/// `limit`, only the first `limit` + 1 bytes are read and counted.
///
/// # Errors
/// See [`read`], except that a long file is not an error.
pub(crate) fn digest(root: &Path, relative: &str, limit: u64) -> Result<(u64, Digest), SnapshotError> {
    let file = open(root, relative)?;
    let mut hasher = blake3::Hasher::new();
    let hashed = hasher.update_reader(file.take(limit.saturating_add(1)));
    hashed.map_err(SnapshotError::io("read", &join(root, relative)))?;
    Ok((hasher.count(), Digest::from_bytes(*hasher.finalize().as_bytes())))
}

/// Opens the regular file at `relative` below `root` without following any link.
pub(crate) fn open(root: &Path, relative: &str) -> Result<File, SnapshotError> {
    check_path(relative).map_err(|problem| SnapshotError::Path { path: relative.into(), problem })?;
    let mut path = root.to_path_buf();
    let mut components = relative.split('/').peekable();
    let mut examined = None;
    while let Some(component) = components.next() {
        path.push(component);
        let found = fs::symlink_metadata(&path).map_err(SnapshotError::io("examine", &path))?;
        if found.is_symlink() {
            return Err(SnapshotError::Link(path));
        }
        let (fits, expected) = match components.peek() {
            None => (found.is_file(), "file"),
            Some(_) => (found.is_dir(), "folder"),
        };
        if !fits {
            return Err(SnapshotError::ReleaseKind { path, expected });
        }
        examined = Some(found);
    }
    let opened = || -> io::Result<(File, Metadata)> {
        let file = File::open(&path)?;
        let found = file.metadata()?;
        Ok((file, found))
    };
    let (file, found) = opened().map_err(SnapshotError::io("open", &path))?;
    if examined.is_some_and(|examined| disk::is_same_file(&examined, &found)) {
        Ok(file)
    } else {
        Err(SnapshotError::ReleaseKind { path, expected: "file" })
    }
}

/// Returns the path of `name` in `folder`, and the result of checking that path. A non-Unicode name is shown
/// approximately.
fn relative(folder: &str, name: &OsStr) -> (String, Result<(), PathProblem>) {
    let separator = if folder.is_empty() { "" } else { "/" };
    let path = format!("{folder}{separator}{}", name.to_string_lossy());
    let named = if name.to_str().is_some() { check_path(&path) } else { Err(PathProblem::NotUnicode) };
    (path, named)
}

fn flaw_of(found: &Metadata, named: Result<(), PathProblem>, limits: &Limits) -> Option<Flaw> {
    if let Err(problem) = named {
        return Some(Flaw::Name(problem));
    }
    if found.is_symlink() {
        return Some(Flaw::Link);
    }
    if found.is_dir() {
        return None;
    }
    if !found.is_file() {
        return Some(Flaw::Special);
    }
    let (size, limit) = (found.len(), limits.file_bytes);
    (size > limit).then_some(Flaw::TooLarge { size, limit })
}

/// Joins `relative` to `root`, with the system's separators.
pub(crate) fn join(root: &Path, relative: &str) -> PathBuf {
    let mut path = root.to_path_buf();
    path.extend(relative.split('/'));
    path
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tempfile::TempDir;

    use super::*;

    fn home(files: &[(&str, usize)]) -> TempDir {
        let home = TempDir::new().expect("temporary folder");
        for (path, size) in files {
            let path = join(home.path(), path);
            fs::create_dir_all(path.parent().expect("below home")).expect("created");
            fs::write(path, vec![b'x'; *size]).expect("written");
        }
        home
    }

    #[track_caller]
    fn check(home: &TempDir, limits: Limits, entries: &[(&str, u64)], problems: &[(&str, Flaw)]) {
        let listing = list(home.path(), &limits).expect("readable");
        let found: Vec<(&str, u64)> = listing.entries.iter().map(|e| (e.path.as_str(), e.size)).collect();
        assert_eq!(found, entries);
        let found: Vec<(&str, Flaw)> =
            listing.problems.iter().map(|p| (p.path.as_str(), p.flaw.clone())).collect();
        assert_eq!(found, problems);
    }

    #[test]
    fn files_are_listed_in_path_order() {
        let home = home(&[("b", 1), ("a/c", 2), ("a-b", 0), ("a/b/c", 3)]);
        check(&home, Limits::SNAPSHOT, &[("a-b", 0), ("a/b/c", 3), ("a/c", 2), ("b", 1)], &[]);
        check(&self::home(&[]), Limits::SNAPSHOT, &[], &[]);
        assert!(list(&home.path().join("absent"), &Limits::SNAPSHOT).is_err());
    }

    #[test]
    fn limits_are_problems() {
        let home = home(&[("a", 10), ("b/c", 20), ("d", 30)]);
        let all = [("a", 10), ("b/c", 20), ("d", 30)];
        let limits = Limits { files: 3, file_bytes: 30, total_bytes: 60 };
        check(&home, limits, &all, &[]);
        let large = Flaw::TooLarge { size: 30, limit: 29 };
        check(&home, Limits { file_bytes: 29, ..limits }, &all[..2], &[("d", large)]);
        let total = Flaw::TotalTooLarge { size: 60, limit: 59 };
        check(&home, Limits { total_bytes: 59, ..limits }, &all, &[(".", total)]);
        check(&home, Limits { files: 2, ..limits }, &[], &[(".", Flaw::TooMany { limit: 2 })]);
        let complete = |files| list(home.path(), &Limits { files, ..limits }).expect("readable").complete;
        assert!(complete(3) && !complete(2));
    }

    #[test]
    fn folders_are_limited_and_must_not_be_empty() {
        let home = home(&[("a/b/c/d", 1)]);
        fs::create_dir(home.path().join("a/e")).expect("created");
        check(&home, Limits::SNAPSHOT, &[("a/b/c/d", 1)], &[("a/e", Flaw::EmptyFolder)]);
        let limits = Limits { files: 3, ..Limits::SNAPSHOT };
        check(&home, limits, &[], &[(".", Flaw::TooMany { limit: 3 })]);
    }

    #[test]
    fn names_are_judged_and_bad_folders_not_entered() {
        let home = home(&[("a b/c", 1), ("good", 1), ("né", 1)]);
        let name = |c| Flaw::Name(PathProblem::Character(c));
        check(&home, Limits::SNAPSHOT, &[("good", 1)], &[("a b", name(' ')), ("né", name('é'))]);
    }

    #[test]
    fn reading_is_bounded() {
        let home = home(&[("a/b", 10), ("empty", 0)]);
        assert_eq!(read(home.path(), "a/b", 10).expect("small enough"), [b'x'; 10]);
        assert_eq!(read(home.path(), "a/b", u64::MAX).expect("small enough").len(), 10);
        assert!(read(home.path(), "empty", 0).expect("small enough").is_empty());
        assert!(matches!(read(home.path(), "a/b", 9), Err(SnapshotError::TooLarge { limit: 9, .. })));
        assert_eq!(digest(home.path(), "a/b", 10).expect("readable"), (10, Digest::of(&[b'x'; 10])));
        assert_eq!(digest(home.path(), "a/b", 3).expect("readable"), (4, Digest::of(b"xxxx")));
    }

    #[test]
    fn reading_stays_inside() {
        let home = home(&[("in/a", 1), ("out", 1)]);
        let root = home.path().join("in");
        for path in ["../out", "/etc/hostname", "a/../../out", "./a", ""] {
            assert!(matches!(read(&root, path, 9), Err(SnapshotError::Path { .. })), "{path}");
        }
        assert!(matches!(read(&root, "absent", 9), Err(SnapshotError::Io { .. })));
        assert!(matches!(read(&root, "a/b", 9), Err(SnapshotError::ReleaseKind { expected: "folder", .. })));
        assert!(matches!(
            read(home.path(), "in", 9),
            Err(SnapshotError::ReleaseKind { expected: "file", .. })
        ));
    }

    #[cfg(unix)]
    mod unix {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;
        use std::os::unix::fs::symlink;
        use std::os::unix::net::UnixListener;

        use super::*;

        #[test]
        fn links_are_reported_and_not_followed() {
            let home = home(&[("in/a", 1), ("out/b", 1)]);
            let root = home.path().join("in");
            symlink("../out/b", root.join("file")).expect("linked");
            symlink("../out", root.join("folder")).expect("linked");
            symlink("nowhere", root.join("dangling")).expect("linked");
            symlink(".", root.join("self")).expect("linked");
            let listing = list(&root, &Limits::SNAPSHOT).expect("readable");
            assert_eq!(listing.entries, [Entry { path: "a".into(), size: 1 }]);
            let linked: Vec<&str> = listing.problems.iter().map(|p| p.path.as_str()).collect();
            assert_eq!(linked, ["dangling", "file", "folder", "self"]);
            assert!(listing.problems.iter().all(|p| p.flaw == Flaw::Link));
            for path in ["file", "folder/b", "dangling", "self/a", "self/self/a"] {
                assert!(matches!(read(&root, path, 9), Err(SnapshotError::Link(_))), "{path}");
            }
            // The folder specified by the user may itself be a link.
            symlink("in", home.path().join("alias")).expect("linked");
            assert_eq!(read(&home.path().join("alias"), "a", 9).expect("readable"), b"x");
        }

        #[test]
        fn special_files_are_not_opened() {
            let home = home(&[("a", 1)]);
            let _socket = UnixListener::bind(home.path().join("socket")).expect("bound");
            check(&home, Limits::SNAPSHOT, &[("a", 1)], &[("socket", Flaw::Special)]);
            assert!(matches!(read(home.path(), "socket", 9), Err(SnapshotError::ReleaseKind { .. })));
        }

        #[test]
        fn names_that_are_not_unicode() {
            let home = home(&[]);
            fs::write(home.path().join(OsStr::from_bytes(b"a\xff")), "").expect("written");
            let flaw = Flaw::Name(PathProblem::NotUnicode);
            check(&home, Limits::SNAPSHOT, &[], &[("a\u{fffd}", flaw)]);
        }
    }
}

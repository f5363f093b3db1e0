//! Files in a release folder that its manifest does not list: papers (documents such as the licence), and files left by
//! other programs.

use crate::error::SnapshotError;
use crate::format::folder::{self, Entry, Limits, Listing};
use crate::format::problem::{Flaw, Problem};
use std::path::Path;

/// The folder for papers (documents such as the licence), at the top of a release.
pub const PAPERS: &str = "papers/";

/// The limits for a release's papers (documents such as the licence): 1000 files of at most 64 MiB, 256 MiB in total.
pub const PAPERS_LIMITS: Limits = Limits { files: 1000, file_bytes: 64 << 20, total_bytes: 256 << 20 };

/// The names of files and folders that version control, file managers and downloads leave at the top of a folder.
/// The content of such files is not read.
pub(crate) const IGNORED_NAMES: [&str; 12] = [
    ".DS_Store",
    ".cache",
    ".directory",
    ".git",
    ".gitattributes",
    ".github",
    ".gitignore",
    ".gitmodules",
    ".hg",
    ".svn",
    "Thumbs.db",
    "desktop.ini",
];

/// The files in a release folder that its manifest does not list.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Untracked {
    /// The papers (documents such as the licence), by path.
    pub papers: Vec<Entry>,
    /// The names of files left by other programs at the top of the release. The content of such files is not
    /// read.
    pub ignored: Vec<String>,
}

/// Lists the files in the release folder `root`: those that its manifest must list, and all others.
///
/// # Errors
/// Returns an error if a folder cannot be read.
pub(crate) fn list(root: &Path) -> Result<(Listing, Untracked), SnapshotError> {
    let mut listing = folder::list_but(root, &Limits::SNAPSHOT, &IGNORED_NAMES)?;
    let is_paper = |path: &str| path.starts_with(PAPERS);
    let entries = std::mem::take(&mut listing.entries);
    let (papers, entries): (Vec<Entry>, _) = entries.into_iter().partition(|entry| is_paper(&entry.path));
    listing.entries = entries;
    // An empty folder for papers is harmless.
    listing.problems.retain(|problem| {
        problem.flaw != Flaw::EmptyFolder
            || !(is_paper(&problem.path) || is_paper(&format!("{}/", problem.path)))
    });
    let Limits { files, total_bytes, .. } = PAPERS_LIMITS;
    let size = papers.iter().map(|entry| entry.size).sum();
    let too_many = (papers.len() as u64 > files).then_some(Flaw::TooMany { limit: files });
    let too_large = (size > total_bytes).then_some(Flaw::TotalTooLarge { size, limit: total_bytes });
    let problem = |flaw| Problem { path: PAPERS.trim_end_matches('/').to_owned(), flaw };
    listing.problems.extend(too_many.into_iter().chain(too_large).map(problem));
    listing.problems.sort_unstable();
    let ignored = std::mem::take(&mut listing.passed_over);
    Ok((listing, Untracked { papers, ignored }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[track_caller]
    fn check(files: &[(&str, usize)], expect: (&[&str], &[&str], &[&str], &[&str])) {
        let home = tempfile::tempdir().unwrap();
        for (path, size) in files {
            let path = home.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::File::create(path).unwrap().set_len(*size as u64).unwrap();
        }
        let (listing, beside) = list(home.path()).unwrap();
        let paths = |entries: &[Entry]| entries.iter().map(|entry| entry.path.clone()).collect::<Vec<_>>();
        let problems: Vec<String> = listing.problems.iter().map(ToString::to_string).collect();
        assert_eq!(paths(&listing.entries), expect.0);
        assert_eq!(paths(&beside.papers), expect.1);
        assert_eq!(beside.ignored, expect.2);
        assert_eq!(problems, expect.3);
    }

    #[test]
    fn papers_and_ignored_files_are_not_in_the_tree() {
        check(
            &[
                ("README.md", 1),
                ("papers/LICENSE", 1),
                ("papers/talk/slides.pdf", 1),
                (".git/HEAD", 1),
                (".DS_Store", 1),
            ],
            (&["README.md"], &["papers/LICENSE", "papers/talk/slides.pdf"], &[".DS_Store", ".git"], &[]),
        );
        // Below the top level, no entry is skipped, and unsafe entries in the papers folder are reported,
        // too.
        check(
            &[("games/x/.DS_Store", 1), ("games/.git/HEAD", 1), ("games/papers/x", 1), ("papers", 1)],
            (&["games/.git/HEAD", "games/papers/x", "games/x/.DS_Store", "papers"], &[], &[], &[]),
        );
        check(
            &[("papers/my notes.txt", 1)],
            (
                &[],
                &[],
                &[],
                &[
                    "papers/my notes.txt: unsafe name (the path has the character ' ': only A-Z, a-z, 0-9, `.`, `_`, `-` and `/` may be used)",
                ],
            ),
        );
    }

    #[test]
    fn papers_are_bounded() {
        let large = 64 << 20;
        check(
            &[
                ("papers/1", large),
                ("papers/2", large),
                ("papers/3", large),
                ("papers/4", large),
                ("papers/5", 1),
            ],
            (
                &[],
                &["papers/1", "papers/2", "papers/3", "papers/4", "papers/5"],
                &[],
                &["papers: too large in total (268435457 bytes; the limit is 268435456)"],
            ),
        );
        check(
            &[("papers/1", large + 1)],
            (&[], &[], &[], &["papers/1: too large (67108865 bytes; the limit is 67108864)"]),
        );
        let names: Vec<String> = (0..1001).map(|number| format!("papers/{number:04}")).collect();
        let home = tempfile::tempdir().unwrap();
        fs::create_dir(home.path().join("papers")).unwrap();
        names.iter().for_each(|name| fs::write(home.path().join(name), "").unwrap());
        let problems = list(home.path()).unwrap().0.problems;
        assert_eq!(problems, [Problem { path: "papers".into(), flaw: Flaw::TooMany { limit: 1000 } }]);
    }

    #[cfg(unix)]
    #[test]
    fn papers_hold_no_links() {
        let home = tempfile::tempdir().unwrap();
        fs::create_dir_all(home.path().join("papers/empty")).unwrap();
        std::os::unix::fs::symlink("/etc", home.path().join("papers/link")).unwrap();
        let (listing, beside) = list(home.path()).unwrap();
        assert!(beside.papers.is_empty());
        assert_eq!(listing.problems, [Problem { path: "papers/link".into(), flaw: Flaw::Link }]);
    }
}

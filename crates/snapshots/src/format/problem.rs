//! The problems found in an untrusted release folder. They are data rather than errors, so that all of them can be
//! reported together.

use crate::format::path::PathProblem;
use base::Digest;

/// A problem with a release folder. Problems are sorted by the bytes of the path, then by flaw.
///
/// `Display` writes the path and the flaw, escaped for printing:
/// `games/x/lvl0.txt: altered (digest 12ab34cd…, the manifest says 56ef7890…)`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
#[error("{}: {flaw}", path.escape_debug())]
pub struct Problem {
    /// The path, relative to the release folder and `/`-separated, or `.` for the folder itself. A
    /// non-Unicode name is shown approximately.
    pub path: String,
    /// The flaw at the path.
    pub flaw: Flaw,
}

/// A flaw at a path in a release folder.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
#[non_exhaustive]
pub enum Flaw {
    /// The manifest lists the path, but there is no such regular file.
    #[error("missing")]
    Missing,
    /// A file not listed in the manifest.
    #[error("extra (not in the manifest; accompanying files belong in papers/)")]
    Extra,
    /// An empty folder, which a manifest cannot list.
    #[error("extra (an empty folder)")]
    EmptyFolder,
    /// The size differs from the stated one, so the content was not read.
    #[error("wrong size ({found} bytes, but the manifest states {stated})")]
    Size {
        /// The size in the folder, in bytes.
        found: u64,
        /// The stated size, in bytes.
        stated: u64,
    },
    /// The content does not match the stated digest.
    #[error("altered (the digest is {}, but the manifest states {})", short(found), short(stated))]
    Altered {
        /// The digest of the file in the folder.
        found: Digest,
        /// The digest stated in the manifest.
        stated: Digest,
    },
    /// A symbolic link, which was not followed.
    #[error("a symbolic link instead of a file or folder")]
    Link,
    /// A pipe, socket or device, which was not opened.
    #[error("neither a file nor a folder")]
    Special,
    /// A name that a release must not contain. A folder with such a name was not entered.
    #[error("unsafe name ({0})")]
    Name(PathProblem),
    /// A file larger than the limit for one file.
    #[error("too large ({size} bytes; the limit is {limit})")]
    TooLarge {
        /// The size in the folder, in bytes.
        size: u64,
        /// The limit, in bytes.
        limit: u64,
    },
    /// The folder contains too many files or folders. The remaining entries were not examined, and no other
    /// problem with the folder's content is reported.
    #[error("more than {limit} files or folders")]
    TooMany {
        /// The limit on the number of files and on the number of folders.
        limit: u64,
    },
    /// The total size of the files exceeds the limit.
    #[error("too large in total ({size} bytes; the limit is {limit})")]
    TotalTooLarge {
        /// The total size of all regular files, in bytes.
        size: u64,
        /// The limit, in bytes.
        limit: u64,
    },
    /// The manifest is not in this format's canonical form (whitespace, order, line endings, a missing or
    /// duplicate field). Its meaning is intact, but its bytes differ from the minted ones.
    #[error("not in canonical form (the text differs from the minted form)")]
    NotCanonical,
    /// A file is not a list of withheld files, although its digest matches the commitment.
    #[error("not a list of withheld files ({0})")]
    NotAList(String),
    /// An archive entry, or the archive itself, does not have the form that packing gives to archives.
    #[error("different from the packed form ({0})")]
    NotAsPacked(String),
    /// The stated checksum differs from the checksum computed from the stated root, lock file and sizes.
    #[error("wrong checksum (the root, the lock file's digest or a size was changed)")]
    WrongChecksum,
    /// The stated root differs from the root computed from the manifest's header and items.
    #[error("wrong root (the items give {}, but the manifest states {})", short(found), short(stated))]
    WrongRoot {
        /// The root computed from the header and items.
        found: Digest,
        /// The root stated in the manifest.
        stated: Digest,
    },
}

/// Returns a prefix that identifies a digest. The [`Problem`] itself contains the whole digest.
fn short(digest: &Digest) -> String {
    let text = digest.to_string();
    format!("{}…", &text[..8])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(path: &str, flaw: Flaw, expect: &str) {
        assert_eq!(Problem { path: path.into(), flaw }.to_string(), expect);
    }

    #[test]
    fn display_names_the_path_and_the_flaw() {
        let (found, stated) = (Digest::of(b""), Digest::of(b"abc"));
        check(
            "games/x/lvl0.txt",
            Flaw::Altered { found, stated },
            "games/x/lvl0.txt: altered (the digest is af1349b9…, but the manifest states 6437b3ac…)",
        );
        check("a", Flaw::Size { found: 3, stated: 2 }, "a: wrong size (3 bytes, but the manifest states 2)");
        check(".", Flaw::TooMany { limit: 9 }, ".: more than 9 files or folders");
        let bell = Flaw::Name(PathProblem::Character('\u{7}'));
        let text = Problem { path: "a\u{7}b".into(), flaw: bell }.to_string();
        assert!(text.starts_with("a\\u{7}b: unsafe name (the path has the character '\\u{7}'"), "{text}");
    }

    #[test]
    fn order_is_by_path_bytes_first() {
        let problem = |path: &str, flaw| Problem { path: path.into(), flaw };
        let mut problems =
            [problem("b", Flaw::Missing), problem("a/b", Flaw::Extra), problem("a-b", Flaw::Link)];
        problems.sort();
        assert_eq!(problems.map(|p| p.path), ["a-b", "a/b", "b"]);
    }
}

//! The problems that reading an untrusted release folder can find. They are data, so that all are reported at once.

use std::fmt;

use crate::path::PathProblem;
use engine::Digest;

/// A problem of a release folder. Ordered by the bytes of the path, then by flaw.
///
/// `Display` gives the path and the flaw, escaped for printing: `games/x/lvl0.txt: altered (digest 12ab34cd…, the
/// manifest says 56ef7890…)`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Problem {
    /// The path, relative to the release folder and `/`-separated; `.` for the folder itself. A name that is not
    /// Unicode is shown approximately.
    pub path: String,
    /// The flaw.
    pub flaw: Flaw,
}

/// The flaws that a path of a release folder can have.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Flaw {
    /// The manifest lists the path, but no regular file is there.
    Missing,
    /// A file that the manifest does not list.
    Extra,
    /// An empty folder, which no manifest can list.
    EmptyFolder,
    /// The size is not the stated one, so the content was not read.
    Size {
        /// Bytes in the folder.
        found: u64,
        /// Bytes that the manifest states.
        stated: u64,
    },
    /// The content is not the stated one.
    Altered {
        /// Digest of the file in the folder.
        found: Digest,
        /// Digest that the manifest states.
        stated: Digest,
    },
    /// A symbolic link; it was not followed.
    Link,
    /// A pipe, socket or device; it was not opened.
    Special,
    /// A name that no release may contain; a folder with such a name was not entered.
    Name(PathProblem),
    /// A file larger than the limit for one file.
    TooLarge {
        /// Bytes in the folder.
        size: u64,
        /// The limit, in bytes.
        limit: u64,
    },
    /// More files, or more folders, than the limit. The rest was not examined, and nothing else about the folder's
    /// content is reported.
    TooMany {
        /// The limit for either of them.
        limit: u64,
    },
    /// The total size of the files exceeds the limit.
    TotalTooLarge {
        /// The bytes of all regular files.
        size: u64,
        /// The limit, in bytes.
        limit: u64,
    },
    /// The manifest's text differs from the text that this format writes for its content (spaces, order, line ends, a
    /// missing or duplicate field): its meaning is intact, but its bytes are not as minted.
    NotCanonical,
    /// An entry of an archive, or the archive itself, is not as packed.
    NotAsPacked(String),
    /// The stated checksum is not that of the stated root, lock file and sizes.
    WrongChecksum,
    /// The stated root is not the root over the manifest's own header and items.
    WrongRoot {
        /// The root computed from them.
        found: Digest,
        /// The root that the manifest states.
        stated: Digest,
    },
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.escape_debug(), self.flaw)
    }
}

impl fmt::Display for Flaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Flaw::Missing => write!(f, "missing"),
            Flaw::Extra => {
                write!(f, "extra (not in the manifest; accompanying files belong in papers/)")
            }
            Flaw::EmptyFolder => write!(f, "extra (an empty folder)"),
            Flaw::Size { found, stated } => {
                write!(f, "wrong size ({found} bytes, the manifest says {stated})")
            }
            Flaw::Altered { found, stated } => {
                write!(f, "altered (digest {}, the manifest says {})", short(found), short(stated))
            }
            Flaw::Link => write!(f, "a symbolic link instead of a file or folder"),
            Flaw::Special => write!(f, "neither a file nor a folder"),
            Flaw::Name(problem) => write!(f, "unsafe name ({problem})"),
            Flaw::TooLarge { size, limit } => write!(f, "too large ({size} bytes of at most {limit})"),
            Flaw::TooMany { limit } => write!(f, "more than {limit} files or folders"),
            Flaw::TotalTooLarge { size, limit } => {
                write!(f, "too large altogether ({size} bytes of at most {limit})")
            }
            Flaw::NotCanonical => write!(f, "not in canonical form (its text is not as minted)"),
            Flaw::NotAsPacked(what) => write!(f, "not as packed ({what})"),
            Flaw::WrongChecksum => {
                write!(f, "wrong checksum (the root, the lock file's digest or a size is not as minted)")
            }
            Flaw::WrongRoot { found, stated } => {
                write!(f, "wrong root (its items give {}, it says {})", short(found), short(stated))
            }
        }
    }
}

/// A prefix of a digest to recognise it by; [`Problem`] holds all of it.
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
            "games/x/lvl0.txt: altered (digest af1349b9…, the manifest says 6437b3ac…)",
        );
        check("a", Flaw::Size { found: 3, stated: 2 }, "a: wrong size (3 bytes, the manifest says 2)");
        check(".", Flaw::TooMany { limit: 9 }, ".: more than 9 files or folders");
        let bell = Flaw::Name(PathProblem::Character('\u{7}'));
        let text = Problem { path: "a\u{7}b".into(), flaw: bell }.to_string();
        assert!(text.starts_with("a\\u{7}b: unsafe name (it has the character '\\u{7}'"), "{text}");
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

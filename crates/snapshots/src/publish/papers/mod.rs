//! Papers: documents that accompany a release without being part of it: licence, citation, datasheet, errata, and
//! whatever its publisher adds.
//!
//! They lie in `papers/`, beside the hashed tree and outside the manifest, because a DOI or an erratum comes after the
//! root is fixed. So nothing in them is proved. They are bounded, and links and unsafe names are refused as everywhere
//! else. Entries that other programs leave at the top of a folder (`.git`, `.DS_Store`) are skipped and reported.

mod datasheet;

use crate::SnapshotError;
use crate::format::folder::{self, Entry, Limits, Listing};
use crate::format::manifest::{Manifest, ReleaseKind};
use crate::format::problem::{Flaw, Problem};
use crate::mint::Minted;
use crate::recipe::cited::Cited;
use crate::recipe::sealed::Reveal;
use serde::Deserialize;
use std::path::Path;

/// The folder of the papers, at the top of a release.
pub const PAPERS: &str = "papers/";

/// The limits of the papers of a release: 1 000 files of at most 64 MiB, 256 MiB together.
pub const PAPERS_LIMITS: Limits = Limits { files: 1000, file_bytes: 64 << 20, total_bytes: 256 << 20 };

/// The names that version control, file managers and downloads leave at the top of a folder. Their content is not
/// read.
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

/// The files of a release folder that its manifest does not list.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Untracked {
    /// The papers, by path.
    pub papers: Vec<Entry>,
    /// Files that other programs left at the top, by name; they are not read.
    pub ignored: Vec<String>,
}

/// The files in the release folder `root` that its manifest must list, and the files beside them.
///
/// # Errors
/// A folder cannot be read.
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

impl Minted {
    /// The initial papers of a release, by path. Their facts are those of the manifest and the cards.
    pub fn papers(&self) -> Vec<(String, String)> {
        let manifest = &self.manifest;
        let papers = [
            ("CHANGELOG.md", errata(manifest)),
            ("CITATION.cff", citation(manifest)),
            ("DATASHEET.md", datasheet::datasheet(self)),
            ("LICENSE", licence(manifest)),
        ];
        papers.into_iter().map(|(name, text)| (format!("{PAPERS}{name}"), text)).collect()
    }
}

/// The content of a sealed release's paper after the reveal.
pub(crate) fn revealed(path: &str, content: Vec<u8>, what: Reveal) -> Vec<u8> {
    match (path.strip_prefix(PAPERS), std::str::from_utf8(&content)) {
        (Some("DATASHEET.md"), Ok(text)) => datasheet::revealed(text, what).into_bytes(),
        _ => content,
    }
}

/// The licence of generated content.
fn licence(manifest: &Manifest) -> String {
    format!(
        "SPDX-License-Identifier: MIT OR Apache-2.0\n\n\
         The games, levels, cards, episodes and texts of the release `{}` were made by the programs of Infinite Arcade\n\
         from a recipe; those called after a corpus game follow a game that the authors of Infinite Arcade wrote.\n\
         As far as anybody holds rights in any of it, you may use it under either of these licences, as you choose:\n\n\
         - the Apache License, Version 2.0: https://www.apache.org/licenses/LICENSE-2.0\n\
         - the MIT licence, which follows.\n\n\
         You need not ask, and you need not name the models that you evaluate. A citation is welcome: CITATION.cff.\n\n\
         ----\n\n{}",
        manifest.name,
        include_str!("../../../LICENSE-MIT")
    )
}

/// The citation of a release: [CFF 1.2.0](https://citation-file-format.github.io). The root identifies the bytes.
fn citation(manifest: &Manifest) -> String {
    let names = Names::of(manifest);
    let cited = Cited::of(&manifest.name, &names.authors, names.publisher.as_deref());
    let authors: String =
        cited.authors().into_iter().map(|author| format!("  - name: {}\n", quoted(author))).collect();
    let description = manifest.recipe.get("description").and_then(|text| text.as_str()).unwrap_or_default();
    format!(
        "cff-version: 1.2.0\n\
         message: \"If you use this release, please cite it, and name its root.\"\n\
         type: dataset\n\
         title: {}\n\
         version: {}\n\
         abstract: {}\n\
         authors:\n{authors}\
         identifiers:\n  - type: other\n    value: \"blake3:{}\"\n    \
         description: \"Root digest: it covers every file of the release but its papers\"\n\
         license:\n  - MIT\n  - Apache-2.0\n\
         keywords:\n  - benchmark\n  - games\n  - planning\n  - VGDL\n",
        quoted(&cited.title()),
        quoted(&manifest.name),
        quoted(description.trim()),
        manifest.root,
    )
}

/// The keys of a recipe that name people.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Names {
    authors: Vec<String>,
    publisher: Option<String>,
}

impl Names {
    /// The names in the recipe of a manifest. Those that have another form are left out.
    fn of(manifest: &Manifest) -> Names {
        serde_json::from_value(manifest.recipe.clone()).unwrap_or_default()
    }
}

/// The title of a release.
pub(crate) fn title(manifest: &Manifest) -> String {
    let names = Names::of(manifest);
    Cited::of(&manifest.name, &names.authors, names.publisher.as_deref()).title()
}

/// Quotes a text for YAML, with double quotes.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => quoted.extend(['\\', character]),
            // Line breaks in YAML, or characters that it does not allow.
            '\u{2028}' | '\u{2029}' | '\u{feff}' => quoted += &format!("\\u{:04x}", character as u32),
            _ if character.is_control() => quoted += &format!("\\u{:04x}", character as u32),
            _ => quoted.push(character),
        }
    }
    quoted.push('"');
    quoted
}

/// The page for errata.
fn errata(manifest: &Manifest) -> String {
    let sealed = match manifest.kind {
        ReleaseKind::Open => "",
        ReleaseKind::Sealed => " When it is revealed, files are added and none is changed.",
    };
    format!(
        "# Errata of `{}`\n\n\
         A release never changes: its root names every byte.{sealed} What is found to be wrong with it is told here, the newest \
         first: when it was found, by whom, which games and levels it concerns, and which scores.\n\n\
         Nothing so far.\n",
        manifest.name
    )
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
        // Below the top no entry is skipped, and the papers folder does not hide unsafe entries.
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
                    "papers/my notes.txt: unsafe name (it has the character ' ': only A-Z, a-z, 0-9, `.`, `_`, `-` and `/` may be used)",
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
                &["papers: too large altogether (268435457 bytes of at most 268435456)"],
            ),
        );
        check(
            &[("papers/1", large + 1)],
            (&[], &[], &[], &["papers/1: too large (67108865 bytes of at most 67108864)"]),
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

    #[test]
    fn texts_of_a_citation_stay_in_their_quotes() {
        assert_eq!(quoted("a \"b\" \\ é\n\u{2028}\u{7f}"), "\"a \\\"b\\\" \\\\ é\\u000a\\u2028\\u007f\"");
    }

    #[test]
    fn a_citation_names_the_root() {
        let manifest = crate::format::manifest::tests::example(&[]);
        let text = citation(&manifest);
        assert!(text.starts_with("cff-version: 1.2.0\nmessage: "), "{text}");
        assert!(text.contains(&format!("value: \"blake3:{}\"", manifest.root)), "{text}");
        assert!(text.contains("version: \"2026-12\"\n"), "{text}");
        assert!(text.contains("authors:\n  - name: \"The Infinite Arcade authors\"\nidentifiers:"), "{text}");
        let mut own = manifest;
        own.recipe = serde_json::json!({ "authors": ["Ada \"A\" L", "Bo"], "publisher": "Example Lab" });
        let text = citation(&own);
        assert!(text.contains("title: \"Example Lab 2026-12\"\n"), "{text}");
        assert!(
            text.contains("authors:\n  - name: \"Ada \\\"A\\\" L\"\n  - name: \"Bo\"\nidentifiers:"),
            "{text}"
        );
    }
}

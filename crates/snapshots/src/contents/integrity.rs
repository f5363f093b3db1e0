//! The integrity check: a release folder must contain exactly the files listed in its manifest.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use crate::contents::disclose::{LIST_LIMIT, disclose};
use crate::contents::untracked::{self, Untracked};
use crate::error::SnapshotError;
use crate::format::folder::{self, Listing};
use crate::format::layout::{HELD, is_solution};
use crate::format::manifest::item::ReleaseKind;
use crate::format::manifest::withheld::HeldPart;
use crate::format::manifest::{MANIFEST_FILE, MANIFEST_LIMIT, Manifest};
use crate::format::problem::{Flaw, Problem};
use crate::sections::memory::part::has_second_wins;

/// The result of [`check_integrity`].
#[derive(Debug, Clone, PartialEq)]
pub struct Integrity {
    /// The manifest stored in the folder.
    pub manifest: Manifest,
    /// All problems, sorted; empty if the folder matches its manifest.
    pub problems: Vec<Problem>,
    /// The files outside the tree, which the root does not cover; empty for an archive.
    pub beside: Untracked,
}

impl Integrity {
    /// Returns `true` if there are no problems: the files and the header match `manifest.root`. The caller must
    /// compare that root with the published one.
    pub fn is_sound(&self) -> bool {
        self.problems.is_empty()
    }

    /// Returns an error about the release at `path` if there are problems.
    pub(crate) fn require_sound(&self, path: &Path) -> Result<(), SnapshotError> {
        let Some((first, more)) = self.problems.split_first() else { return Ok(()) };
        let (path, first) = (path.to_path_buf(), first.to_string());
        Err(SnapshotError::Unsound { path, first, more: more.len() })
    }
}

/// Compares the folder `root` with its `MANIFEST.json` and reports every difference. The folder is not
/// trusted: links are not followed, and files are not read if they exceed a snapshot's limits or differ from
/// their stated size.
///
/// Cost: one pass over the files, in chunks, and memory proportional to the manifest.
///
/// # Errors
/// Returns an error if the manifest is missing or invalid (see [`Manifest::parse`]), or if a file system operation
/// fails.
pub fn check_integrity(root: &Path) -> Result<Integrity, SnapshotError> {
    let bytes = folder::read(root, MANIFEST_FILE, MANIFEST_LIMIT).map_err(|error| absent(error, root))?;
    let mut manifest =
        Manifest::parse(&bytes).map_err(|error| error.in_manifest(&root.join(MANIFEST_FILE)))?;
    let mut problems = manifest_problems(&manifest, &bytes)?;
    let (listing, beside) = untracked::list(root)?;
    problems.extend(list_problems(root, &mut manifest, &listing)?);
    problems.extend(file_problems(root, &manifest, listing)?);
    problems.sort_unstable();
    Ok(Integrity { manifest, problems, beside })
}

/// Replaces the error for an unreadable manifest with an error about the release at `root`.
fn absent(error: SnapshotError, root: &Path) -> SnapshotError {
    let path = root.to_path_buf();
    match error {
        SnapshotError::Io { source, .. } if source.kind() == ErrorKind::NotFound => {
            SnapshotError::NotASnapshot(path)
        }
        SnapshotError::Io { source, .. } if source.kind() == ErrorKind::NotADirectory => {
            match fs::metadata(root).is_ok_and(|found| found.is_file()) {
                true => SnapshotError::NotAFolder(path),
                false => SnapshotError::NotASnapshot(path),
            }
        }
        other => other,
    }
}

/// Returns the problems with the text, the root and the checksum of a readable manifest.
pub(crate) fn manifest_problems(manifest: &Manifest, bytes: &[u8]) -> Result<Vec<Problem>, SnapshotError> {
    let problem = |flaw| Problem { path: MANIFEST_FILE.into(), flaw };
    let mut problems = Vec::new();
    if !manifest.is_text(bytes)? {
        problems.push(problem(Flaw::NotCanonical));
    }
    let (found, stated) = (manifest.computed_root()?, manifest.root);
    if found != stated {
        problems.push(problem(Flaw::WrongRoot { found, stated }));
    } else if manifest.checksum != manifest.computed_checksum() {
        problems.push(problem(Flaw::WrongChecksum));
    }
    Ok(problems)
}

/// Reads the lists of withheld files that exist, and returns the problems with them. One list contains the wins that
/// the memory tests publish early. It may exist without the list of all other files, but not vice versa.
fn list_problems(
    root: &Path,
    manifest: &mut Manifest,
    listing: &Listing,
) -> Result<Vec<Problem>, SnapshotError> {
    let mut problems = Vec::new();
    if manifest.withheld.is_none() {
        return Ok(problems);
    }
    let is_there = |part: HeldPart| listing.entries.iter().any(|entry| entry.path == part.list());
    let is_whole = is_there(HeldPart::Rest) || !has_second_wins(manifest);
    let is_begun = HeldPart::ALL.into_iter().any(is_there);
    for part in HeldPart::ALL {
        let path = part.list();
        if !is_there(part) {
            if is_begun && (is_whole || part == HeldPart::Solutions) {
                problems.push(Problem { path: path.into(), flaw: Flaw::Missing });
            }
            continue;
        }
        let flaw = match folder::read(root, path, LIST_LIMIT) {
            Ok(bytes) => disclose(manifest, part, &bytes).err(),
            Err(SnapshotError::TooLarge { limit, .. }) => {
                let size = listing.entries.iter().find(|entry| entry.path == path).map(|entry| entry.size);
                Some(Flaw::TooLarge { size: size.unwrap_or(limit), limit })
            }
            Err(error) => return Err(error),
        };
        problems.extend(flaw.map(|flaw| Problem { path: path.into(), flaw }));
    }
    Ok(problems)
}

fn file_problems(root: &Path, manifest: &Manifest, listing: Listing) -> Result<Vec<Problem>, SnapshotError> {
    let mut problems = listing.problems;
    if !listing.complete {
        return Ok(problems);
    }
    // Entries that exist but are not plain files have already been reported, so they do not count as missing.
    let named: BTreeSet<String> = problems.iter().map(|problem| problem.path.clone()).collect();
    let mut awaited: BTreeMap<&str, _> = manifest.files().map(|item| (item.path.as_str(), item)).collect();
    // The lists of withheld files have already been checked.
    let is_judged = |path: &str| {
        path == MANIFEST_FILE || manifest.withheld.is_some() && HeldPart::of_list(path).is_some()
    };
    awaited.retain(|path, _| !is_judged(path));
    for entry in listing.entries.iter().filter(|entry| !is_judged(&entry.path)) {
        let flaw = match awaited.remove(entry.path.as_str()) {
            None => Some(Flaw::Extra),
            Some(item) if item.size != entry.size => {
                Some(Flaw::Size { found: entry.size, stated: item.size })
            }
            Some(item) => match folder::digest(root, &item.path, item.size)? {
                (size, _) if size != item.size => Some(Flaw::Size { found: size, stated: item.size }),
                (_, found) if found != item.digest => Some(Flaw::Altered { found, stated: item.digest }),
                _ => None,
            },
        };
        problems.extend(flaw.map(|flaw| Problem { path: entry.path.clone(), flaw }));
    }
    // Before the reveal, a sealed release withholds either all of its witnesses or none. The wins that the memory tests
    // publish early may already be present. Hidden files are not expected.
    let is_listed = manifest.kind == ReleaseKind::Sealed && manifest.withheld.is_none();
    let is_held = |path: &str| is_listed && path.starts_with(HELD);
    let stays = |path: &str| is_held(path) && !is_solution(path);
    let lacks_all = |of: &dyn Fn(&str) -> bool| {
        manifest
            .items
            .iter()
            .filter(|item| of(&item.path))
            .all(|item| awaited.contains_key(item.path.as_str()))
    };
    let withheld: &dyn Fn(&str) -> bool = match () {
        () if lacks_all(&is_held) => &is_held,
        () if is_listed && has_second_wins(manifest) && lacks_all(&stays) => &stays,
        () => &|_| false,
    };
    let is_missing = |path: &&str| !(named.contains(*path) || withheld(path));
    let missing: Vec<&str> = awaited.keys().copied().filter(is_missing).collect();
    problems.extend(missing.into_iter().map(|path| Problem { path: path.into(), flaw: Flaw::Missing }));
    Ok(problems)
}

#[cfg(test)]
mod tests {
    use tempfile::TempDir;

    use super::*;
    use crate::draft::Draft;
    use crate::format::manifest::tests::example;
    use crate::format::path::PathProblem;
    use base::Digest;

    const FILES: [(&str, &[u8]); 4] = [
        ("README.md", b"about this release"),
        ("games/x/game.vgdl", b"BasicGame\n    SpriteSet\n"),
        ("games/x/lvl0.txt", b"www\nwAw\nwww\n"),
        ("games/y/lvl0.txt", b""),
    ];

    struct Release {
        _home: TempDir,
        root: std::path::PathBuf,
    }

    fn release() -> Release {
        let home = TempDir::new().expect("temporary folder");
        let root = home.path().join("release");
        let draft = Draft::create(&root).expect("vacant");
        for (path, content) in FILES {
            draft.write(path, content).expect("written");
        }
        draft.write(MANIFEST_FILE, &example(&FILES).to_bytes().expect("sound")).expect("written");
        draft.commit().expect("published");
        Release { _home: home, root }
    }

    #[track_caller]
    fn check(change: impl FnOnce(&Path), expect: &[(&str, Flaw)]) {
        let release = release();
        assert!(check_integrity(&release.root).expect("readable").is_sound());
        change(&release.root);
        let integrity = check_integrity(&release.root).expect("readable");
        let expect: Vec<Problem> = expect
            .iter()
            .map(|(path, flaw)| Problem { path: path.to_string(), flaw: flaw.clone() })
            .collect();
        assert_eq!(integrity.problems, expect);
        assert_eq!(integrity.is_sound(), expect.is_empty());
    }

    fn write(path: &str, content: &[u8]) -> impl FnOnce(&Path) {
        move |root| fs::write(root.join(path), content).expect("written")
    }

    #[test]
    fn untouched() {
        check(|_| (), &[]);
        check(|root| fs::write(root.join("games/y/lvl0.txt"), "").expect("rewritten"), &[]);
    }

    #[test]
    fn every_byte_counts() {
        let release = release();
        for (path, content) in FILES {
            for position in 0..content.len() {
                for bit in [0, 5, 7] {
                    let mut altered = content.to_vec();
                    altered[position] ^= 1 << bit;
                    fs::write(release.root.join(path), &altered).expect("written");
                    let flaw = Flaw::Altered { found: Digest::of(&altered), stated: Digest::of(content) };
                    let problems = check_integrity(&release.root).expect("readable").problems;
                    assert_eq!(problems, [Problem { path: path.into(), flaw }]);
                }
            }
            fs::write(release.root.join(path), content).expect("restored");
        }
        assert!(check_integrity(&release.root).expect("readable").is_sound());
    }

    /// A flipped bit anywhere in the manifest is reported as damage, never as a sound release, a different
    /// format, or a fault in a single file.
    #[test]
    fn every_byte_of_the_manifest_counts() {
        let release = release();
        let path = release.root.join(MANIFEST_FILE);
        let bytes = fs::read(&path).expect("readable");
        // One bit of every byte is flipped. In a sweep (`cargo xtask sweep`), all bits are flipped.
        let sweeping = std::env::var_os("ARCADE_SWEEP").is_some();
        for position in 0..bytes.len() {
            for bit in (0..8).filter(|bit| sweeping || position % 8 == *bit) {
                let mut altered = bytes.clone();
                altered[position] ^= 1 << bit;
                fs::write(&path, &altered).expect("written");
                let damaged = match check_integrity(&release.root) {
                    Ok(integrity) => integrity.problems.iter().any(|problem| problem.path == MANIFEST_FILE),
                    Err(error) => {
                        matches!(error, SnapshotError::Syntax { .. } | SnapshotError::Manifest { .. })
                    }
                };
                assert!(damaged, "bit {bit} of byte {position}");
            }
        }
        for length in (0..bytes.len()).step_by(if sweeping { 1 } else { 7 }) {
            fs::write(&path, &bytes[..length]).expect("written");
            let sound = check_integrity(&release.root).is_ok_and(|integrity| integrity.is_sound());
            assert!(!sound, "cut to {length} bytes");
        }
    }

    #[test]
    fn sizes() {
        check(write("README.md", b"about"), &[("README.md", Flaw::Size { found: 5, stated: 18 })]);
        check(write("games/y/lvl0.txt", b"\0"), &[("games/y/lvl0.txt", Flaw::Size { found: 1, stated: 0 })]);
    }

    #[test]
    fn missing_extra_and_renamed() {
        let remove = |root: &Path| fs::remove_file(root.join("README.md")).expect("removed");
        check(remove, &[("README.md", Flaw::Missing)]);
        check(write("games/x/lvl1.txt", b"new"), &[("games/x/lvl1.txt", Flaw::Extra)]);
        check(write("games/x/.DS_Store", b""), &[("games/x/.DS_Store", Flaw::Extra)]);
        check(write("MANIFEST", b""), &[("MANIFEST", Flaw::Extra)]);
        check(write("games/MANIFEST.json", b""), &[("games/MANIFEST.json", Flaw::Extra)]);
        let rename = |root: &Path| {
            fs::rename(root.join("games/x/lvl0.txt"), root.join("games/x/lvl1.txt")).expect("renamed");
        };
        check(rename, &[("games/x/lvl0.txt", Flaw::Missing), ("games/x/lvl1.txt", Flaw::Extra)]);
        let swap = |root: &Path| fs::rename(root.join("games/x"), root.join("games/z")).expect("renamed");
        check(
            swap,
            &[
                ("games/x/game.vgdl", Flaw::Missing),
                ("games/x/lvl0.txt", Flaw::Missing),
                ("games/z/game.vgdl", Flaw::Extra),
                ("games/z/lvl0.txt", Flaw::Extra),
            ],
        );
        let folder = |root: &Path| fs::create_dir_all(root.join("games/z/empty")).expect("created");
        check(folder, &[("games/z/empty", Flaw::EmptyFolder)]);
        let spaced = Flaw::Name(PathProblem::Character(' '));
        check(write("games/x/a b", b""), &[("games/x/a b", spaced)]);
    }

    /// Papers (documents such as the licence), and files that other programs leave outside the tree, are listed and do
    /// not count as tampering.
    #[test]
    fn files_outside_the_tree() {
        let release = release();
        let root = &release.root;
        for (path, content) in [("papers/LICENSE", "MIT"), (".git/objects/a b", ""), (".DS_Store", "")] {
            fs::create_dir_all(root.join(path).parent().expect("below")).expect("created");
            fs::write(root.join(path), content).expect("written");
        }
        let Integrity { problems, beside, .. } = check_integrity(root).expect("readable");
        assert_eq!(problems, []);
        assert_eq!(
            beside.papers.iter().map(|entry| entry.path.as_str()).collect::<Vec<_>>(),
            ["papers/LICENSE"]
        );
        assert_eq!(beside.ignored, [".DS_Store", ".git"]);
        // The root does not protect papers (documents such as the licence), even if the manifest lists them.
        let mut files = FILES.to_vec();
        files.push(("papers/LICENSE", b"MIT"));
        let text = example(&files).to_bytes().expect("sound");
        fs::write(root.join(MANIFEST_FILE), text).expect("written");
        let problems = check_integrity(root).expect("readable").problems;
        assert_eq!(problems, [Problem { path: "papers/LICENSE".into(), flaw: Flaw::Missing }]);
    }

    #[test]
    fn a_folder_in_the_place_of_a_file() {
        let replace = |root: &Path| {
            fs::remove_file(root.join("README.md")).expect("removed");
            fs::create_dir(root.join("README.md")).expect("created");
            fs::write(root.join("README.md/inside"), "").expect("written");
        };
        check(replace, &[("README.md", Flaw::Missing), ("README.md/inside", Flaw::Extra)]);
    }

    #[cfg(unix)]
    #[test]
    fn links_are_found_even_to_the_same_content() {
        use std::os::unix::fs::symlink;
        check(
            |root| {
                fs::rename(root.join("README.md"), root.join("../elsewhere")).expect("moved");
                symlink("../elsewhere", root.join("README.md")).expect("linked");
            },
            &[("README.md", Flaw::Link)],
        );
        check(
            |root| {
                fs::rename(root.join("games/y"), root.join("../y")).expect("moved");
                symlink("../../y", root.join("games/y")).expect("linked");
            },
            &[("games/y", Flaw::Link), ("games/y/lvl0.txt", Flaw::Missing)],
        );
        let loops = |root: &Path| symlink(".", root.join("games/loop")).expect("linked");
        check(loops, &[("games/loop", Flaw::Link)]);
        let release = release();
        fs::rename(release.root.join(MANIFEST_FILE), release.root.join("../m")).expect("moved");
        symlink("../m", release.root.join(MANIFEST_FILE)).expect("linked");
        assert!(matches!(check_integrity(&release.root), Err(SnapshotError::Link(_))));
    }

    /// A manifest adjusted to an altered file needs a new root. If it keeps the old root, the root is
    /// reported as wrong.
    #[test]
    fn a_forged_manifest_has_another_root() {
        let release = release();
        let mut files = FILES;
        files[2].1 = b"www\nw.w\nwww\n";
        fs::write(release.root.join(files[2].0), files[2].1).expect("written");
        let forged = example(&files);
        assert_ne!(forged.root, example(&FILES).root);
        let disguised = Manifest { root: example(&FILES).root, ..forged.clone() };
        let text = disguised.text().expect("plain recipe");
        fs::write(release.root.join(MANIFEST_FILE), text).expect("written");
        let flaw = Flaw::WrongRoot { found: forged.root, stated: disguised.root };
        let problems = check_integrity(&release.root).expect("readable").problems;
        assert_eq!(problems, [Problem { path: MANIFEST_FILE.into(), flaw }]);
    }

    #[test]
    fn another_text_of_the_same_manifest() {
        let reformat = |root: &Path| {
            let path = root.join(MANIFEST_FILE);
            let text = fs::read_to_string(&path).expect("readable");
            fs::write(&path, text.replace('\n', "\r\n")).expect("written");
        };
        check(reformat, &[(MANIFEST_FILE, Flaw::NotCanonical)]);
        let repeat = |root: &Path| {
            let path = root.join(MANIFEST_FILE);
            let text = fs::read_to_string(&path).expect("readable");
            fs::write(&path, text.replace("\"sizes\":", "\"sizes\": [1], \"sizes\":")).expect("written");
        };
        check(repeat, &[(MANIFEST_FILE, Flaw::NotCanonical)]);
    }

    #[test]
    fn no_manifest_or_a_broken_one_is_an_error() {
        let release = release();
        let path = release.root.join(MANIFEST_FILE);
        fs::write(&path, "{ \"format\": 1 ").expect("written");
        let error = check_integrity(&release.root).expect_err("cut off");
        assert!(error.to_string().contains(&path.display().to_string()), "{error}");
        fs::remove_file(&path).expect("removed");
        let file = release.root.join("README.md");
        for root in [release.root.clone(), release.root.join("absent"), file.join("x")] {
            assert!(matches!(check_integrity(&root), Err(SnapshotError::NotASnapshot(path)) if path == root));
        }
        assert!(matches!(check_integrity(&file), Err(SnapshotError::NotAFolder(path)) if path == file));
    }

    /// Problems do not mask each other.
    #[test]
    fn all_problems_at_once_in_order() {
        check(
            |root| {
                write("README.md", b"another release!!!")(root);
                write("zzz", b"")(root);
                fs::remove_file(root.join("games/x/lvl0.txt")).expect("removed");
            },
            &[
                (
                    "README.md",
                    Flaw::Altered {
                        found: Digest::of(b"another release!!!"),
                        stated: Digest::of(FILES[0].1),
                    },
                ),
                ("games/x/lvl0.txt", Flaw::Missing),
                ("zzz", Flaw::Extra),
            ],
        );
    }
}

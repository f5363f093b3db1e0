//! Protection of releases against misplaced output. A file added to a release breaks its verification, or would be
//! published with the release.

use crate::failure::Failure;
use crate::shell;
use base::MessagePath;
use snapshots::{Draft, MANIFEST_FILE};
use std::ffi::OsStr;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Rejects an output path that lies in a release or in a release's withheld part, except in the release's
/// `papers/` folder. Also rejects `-`, which stands for standard output in subcommands that can write there.
pub(crate) fn check(place: &Path) -> Result<(), Failure> {
    if place == Path::new("-") {
        bail!(
            "this command cannot write to standard output: pass a folder or file instead of `-` (use ./- for \
             a file named `-`)"
        );
    }
    let there = resolved(place);
    for folder in there.ancestors().skip(1) {
        let below = there.strip_prefix(folder).unwrap_or(&there);
        let is_paper = below.components().next() == Some(Component::Normal(OsStr::new("papers")));
        let is_held = folder.ends_with("held") && is_release(&folder.with_file_name("public"));
        if is_held || (!is_paper && is_release(folder)) {
            bail!(
                "`{}` is in the release itself, {}, which would no longer verify: choose a folder outside it",
                place.in_message(),
                shell::quoted(folder)
            );
        }
    }
    Ok(())
}

/// The first bytes of a manifest in canonical JSON. The file name alone proves nothing, because other
/// programs may use it.
const MANIFEST_START: &[u8] = b"{\n  \"canary\": ";

/// Returns `true` if the folder contains a release's manifest.
fn is_release(folder: &Path) -> bool {
    let start = disk::read_start(&folder.join(MANIFEST_FILE), MANIFEST_START.len() as u64);
    start.is_ok_and(|start| start == MANIFEST_START)
}

/// Starts a draft of a folder or file that lies outside any release.
pub(crate) fn draft(out: &Path) -> Result<Draft, Failure> {
    check(out)?;
    Draft::create(out).map_err(Failure::from)
}

/// Writes a report's files into a draft, publishes the draft, and returns the file names.
pub(crate) fn publish(draft: Draft, files: Vec<pages::File>) -> Result<Vec<String>, Failure> {
    for file in &files {
        draft.write_of_any_size(&file.name, &file.bytes)?;
    }
    draft.commit()?;
    Ok(files.into_iter().map(|file| file.name).collect())
}

/// Starts a draft like [`draft`], but keeps the finished jobs from an interrupted draft.
pub(crate) fn resumed(out: &Path) -> Result<Draft, Failure> {
    check(out)?;
    Draft::resume(out).map_err(Failure::from)
}

/// Returns the absolute path, resolving links in the part of the path that exists.
fn resolved(place: &Path) -> PathBuf {
    for above in place.ancestors() {
        let known = if above.as_os_str().is_empty() { Path::new(".") } else { above };
        if let Ok(folder) = fs::canonicalize(known) {
            // Joining an empty path would add a slash.
            return match place.strip_prefix(above) {
                Ok(rest) if rest.as_os_str().is_empty() => folder,
                Ok(rest) => folder.join(rest),
                Err(_) => folder,
            };
        }
    }
    place.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_written_into_a_release_but_papers() {
        let home = tempfile::tempdir().expect("temporary folder");
        let at = |path: &str| home.path().join(path);
        for folder in ["new/games", "new/papers", "sealed/public", "sealed/held"] {
            fs::create_dir_all(at(folder)).expect("created");
        }
        for folder in ["new", "sealed/public"] {
            fs::write(at(folder).join(MANIFEST_FILE), MANIFEST_START).expect("written");
        }
        fs::create_dir(at("other")).expect("created");
        fs::write(at("other").join(MANIFEST_FILE), "{ \"name\": \"of another program\" }").expect("written");
        for inside in [
            "new/p.json",
            "new/games/a/b",
            "new/x/papers",
            "new/MANIFEST.json",
            "sealed/public/x/y",
            "sealed/held/z",
        ] {
            let error = check(&at(inside)).expect_err(inside);
            assert_eq!(error.code(), crate::failure::MALFORMED);
            assert!(error.to_string().contains("is in the release itself"), "{error}");
        }
        for outside in [
            "new",
            "p.json",
            "a/b/c",
            "new/papers/talk.pdf",
            "new/papers/a/b",
            "sealed/x",
            "newer/x",
            "other/x",
        ] {
            check(&at(outside)).expect(outside);
        }
        check(Path::new("relative.json")).expect("elsewhere");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_into_a_release_is_followed() {
        let home = tempfile::tempdir().expect("temporary folder");
        let release = home.path().join("new");
        fs::create_dir_all(release.join("games")).expect("created");
        fs::write(release.join(MANIFEST_FILE), MANIFEST_START).expect("written");
        std::os::unix::fs::symlink(release.join("games"), home.path().join("link")).expect("linked");
        check(&home.path().join("link/x")).expect_err("inside");
    }
}

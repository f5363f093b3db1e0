//! The chain of releases. Each release states its predecessor's root, so history cannot be changed without
//! changing every later release.

use base::MessagePath;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::Serialize;

use crate::contents::archive::{is_called_archive, is_foreign};
use crate::contents::integrity::Integrity;
use crate::contents::{Contents, integrity_of, is_file};
use crate::error::SnapshotError;
use crate::format::manifest::{MANIFEST_FILE, Manifest};
use crate::format::plausible::CARD_AND_CANARY_SINCE;
use crate::lineage::ancestry::{AncestryError, Holdings};
use crate::recipe::known::Known;
use base::Digest;
use engine::SEMANTICS;
use generators::GENERATION;

/// The maximum number of releases, and the maximum number of other entries, in a folder that is searched for
/// releases.
pub const MAX_RELEASES: usize = 10_000;

/// The facts about a release that matter for the chain.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Link {
    /// The release's name.
    pub name: String,
    /// The release's root.
    pub root: Digest,
    /// The predecessor's root, as stated in the release.
    pub parent: Option<Digest>,
    /// The folder or archive that contains the release. Serialisation replaces invalid Unicode in this path.
    #[serde(serialize_with = "shown")]
    pub place: PathBuf,
}

fn shown<S: serde::Serializer>(place: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&place.to_string_lossy())
}

impl Link {
    /// Returns the release of a manifest found at `place`, as a link of a chain.
    pub fn of(manifest: &Manifest, place: &Path) -> Link {
        let Manifest { name, root, parent, .. } = manifest;
        Link { name: name.clone(), root: *root, parent: *parent, place: place.to_path_buf() }
    }
}

/// A release with its predecessors, and the problems found in the chain.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Chain {
    /// The releases, from the given release back to the oldest release found.
    pub releases: Vec<Link>,
    /// `true` if the last release does not state a predecessor.
    pub complete: bool,
    /// The number of given releases that are not part of the chain.
    pub others: usize,
    /// The problems; empty if the chain is complete and has no competing history.
    pub problems: Vec<String>,
}

/// Follows the roots from `start` back through the releases in `folders`. Each folder is a release (folder or
/// archive) or contains releases. The integrity of all these releases is checked, except that of `start`, which must
/// have been checked already.
///
/// A chain is sound if
/// - every stated root is found, up to a release that does not state one;
/// - no two releases follow the same release in the chain, because the chain would then have two histories;
/// - no release follows a missing release, because the missing release could belong to a second history;
/// - each release in the chain lists the content of its predecessors, and repeats no part of that content.
///
/// Cost: one pass over the files of all releases and a second pass over the files of the chain, plus a few
/// milliseconds per game in the chain. Folders are read on all threads of the current rayon pool, archives one at a
/// time. Memory use covers the manifests, one archived file at a time, and one archive in the chain.
///
/// # Errors
/// Returns an error if a folder does not contain any release, or if a file system operation fails.
pub fn follow(start: Link, folders: &[PathBuf]) -> Result<Chain, SnapshotError> {
    let mut places = BTreeSet::new();
    for folder in folders {
        places.extend(releases_in(folder)?);
    }
    let (archives, folders): (Vec<PathBuf>, Vec<PathBuf>) =
        places.into_iter().partition(|place| is_file(place));
    let judge = |place: PathBuf| check(&place).map(|checked| (place, checked));
    let mut checked: Vec<_> = folders.into_par_iter().map(judge).collect::<Result<_, _>>()?;
    for place in archives {
        checked.push(judge(place)?);
    }
    checked.sort_by(|(one, _), (two, _)| one.cmp(two));
    let (mut links, mut problems) = (Vec::new(), Vec::new());
    for (_, link) in checked {
        match link {
            Ok(link) => links.push(link),
            Err(problem) => problems.push(problem),
        }
    }
    let mut chain = join(start, links, problems);
    chain.problems.extend(history_problems(&chain.releases)?);
    Ok(chain)
}

/// Checks the release at `place`, and returns a message if the release is unsound.
fn check(place: &Path) -> Result<Result<Link, String>, SnapshotError> {
    let wrong = |what: &dyn std::fmt::Display| Ok(Err(format!("{}: {what}", place.in_message())));
    match integrity_of(place) {
        Ok(integrity) => match integrity.problems.as_slice() {
            [] => Ok(Ok(Link::of(&integrity.manifest, place))),
            [only] => wrong(only),
            [first, rest @ ..] => wrong(&format_args!("{first}; and {} more", rest.len())),
        },
        Err(error @ SnapshotError::Io { .. }) => Err(error),
        Err(error) => match std::error::Error::source(&error) {
            Some(source) => wrong(&format_args!("{error}: {source}")),
            None => wrong(&error),
        },
    }
}

/// Checks that each release in a chain lists the content of its predecessors, and does not repeat any of it. The
/// releases are passed newest first.
///
/// `known` is compared as a whole if the release has the current generation and semantics. For other releases, only
/// the names of their predecessors are compared.
pub(crate) fn history_problems(releases: &[Link]) -> Result<Vec<String>, SnapshotError> {
    let mut problems = Vec::new();
    let (mut forms, mut items) = (BTreeMap::new(), BTreeMap::new());
    let mut before: Option<(Manifest, Holdings)> = None;
    for link in releases.iter().rev() {
        let name = &link.name;
        let (Integrity { manifest, .. }, contents) = Contents::open(&link.place)?;
        let is_ours = (manifest.generation, manifest.semantics) == (GENERATION, SEMANTICS);
        let holdings = match Holdings::read(&contents, &manifest) {
            Ok(holdings) => holdings,
            Err(AncestryError::Snapshot(error)) => return Err(error),
            // Cards of other generations may have a different layout, which cannot be checked.
            Err(_) if !is_ours => {
                before = None;
                continue;
            }
            Err(error) => {
                problems.push(format!("`{name}` in {}: {error}", link.place.in_message()));
                before = None;
                continue;
            }
        };
        if manifest.generation >= CARD_AND_CANARY_SINCE {
            let stated = manifest.recipe.get("known").cloned().unwrap_or_else(|| serde_json::json!({}));
            let stated: Option<Known> = serde_json::from_value(stated).ok();
            let due = before.as_ref().and_then(|(parent, holds)| holds.known_after(parent).ok());
            if let (Some(due), Some(parent)) = (due, link.parent) {
                let fits = match &stated {
                    Some(stated) if is_ours => *stated == due,
                    Some(stated) => stated.releases == due.releases,
                    None => !is_ours,
                };
                if !fits {
                    problems.push(format!(
                        "`{name}` in {} has a wrong list of earlier content: its recipe's `known` does not \
                         follow from the release with root {parent}",
                        link.place.in_message()
                    ));
                }
            }
            let again = |mine: &BTreeMap<Digest, String>, theirs: &BTreeMap<Digest, String>| {
                mine.iter()
                    .find_map(|(what, here)| Some(format!("{here} is the same as {}", theirs.get(what)?)))
            };
            let found = [again(&holdings.forms, &forms), again(&holdings.items, &items)];
            problems.extend(found.into_iter().flatten().map(|found| {
                format!("`{name}` in {} repeats earlier content: {found}", link.place.in_message())
            }));
        }
        let of = |what: &String| format!("{what} of `{name}`");
        forms.extend(holdings.forms.iter().map(|(form, id)| (*form, of(id))));
        items.extend(holdings.items.iter().map(|(item, path)| (*item, of(path))));
        before = Some((manifest, holdings));
    }
    Ok(problems)
}

/// Returns the releases at `folder` or directly below it, sorted by name. Other content is ignored, and links
/// are not followed.
pub(crate) fn releases_in(folder: &Path) -> Result<Vec<PathBuf>, SnapshotError> {
    let is_release = |place: &Path| fs::symlink_metadata(place.join(MANIFEST_FILE)).is_ok();
    let found = fs::metadata(folder).map_err(|source| match source.kind() {
        ErrorKind::NotFound => SnapshotError::NotASnapshot(folder.to_path_buf()),
        _ => SnapshotError::io("examine", folder)(source),
    })?;
    if found.is_file() || is_release(folder) {
        return Ok(vec![folder.to_path_buf()]);
    }
    let mut places = Vec::new();
    for (number, entry) in fs::read_dir(folder).map_err(SnapshotError::io("list", folder))?.enumerate() {
        if number == MAX_RELEASES {
            return Err(SnapshotError::Crowded { path: folder.to_path_buf(), limit: MAX_RELEASES });
        }
        let entry = entry.map_err(SnapshotError::io("list", folder))?;
        let place = entry.path();
        let kind = entry.file_type().map_err(SnapshotError::io("examine", &place))?;
        let archive = kind.is_file() && is_called_archive(&place) && !is_foreign(&place)?;
        // A sealed release is minted into `public/` and `held/`.
        let public = place.join("public");
        if archive || (kind.is_dir() && is_release(&place)) {
            places.push(place);
        } else if kind.is_dir() && public.is_dir() && !public.is_symlink() && is_release(&public) {
            places.push(public);
        }
    }
    if places.is_empty() {
        return Err(SnapshotError::NoRelease(folder.to_path_buf()));
    }
    places.sort();
    Ok(places)
}

/// Builds the chain from `start` back through its predecessors among `links`, which are sound releases.
fn join(start: Link, links: Vec<Link>, mut problems: Vec<String>) -> Chain {
    // The root identifies a release, so two copies of a release count as one.
    let mut by_root: BTreeMap<Digest, Link> = BTreeMap::new();
    by_root.insert(start.root, start.clone());
    for link in links {
        by_root.entry(link.root).or_insert(link);
    }
    let mut releases = vec![start.clone()];
    let mut passed = BTreeSet::from([start.root]);
    let mut next = start.parent;
    let mut complete = true;
    while let Some(root) = next {
        let newer = &releases[releases.len() - 1].name;
        let Some(link) = by_root.get(&root) else {
            problems.push(format!(
                "`{newer}` follows the release with root {root}, which is not among those given: add its folder to \
                 --chain"
            ));
            complete = false;
            break;
        };
        if !passed.insert(root) {
            problems
                .push(format!("`{newer}` follows `{}`, which follows it: the chain is circular", link.name));
            complete = false;
            break;
        }
        next = link.parent;
        releases.push(link.clone());
    }
    let mut names: BTreeMap<&str, &Link> = BTreeMap::new();
    let followers: BTreeMap<Digest, &Link> =
        releases.iter().filter_map(|link| Some((link.parent?, link))).collect();
    // The chain's own releases come first, because all others are compared with them.
    let others: Vec<&Link> = by_root.values().filter(|link| !passed.contains(&link.root)).collect();
    for link in releases.iter().chain(others.iter().copied()) {
        if let Some(other) = names.insert(&link.name, link) {
            problems.push(format!(
                "two releases are called `{}`: root {} in {} and root {} in {}",
                link.name,
                other.root,
                other.place.in_message(),
                link.root,
                link.place.in_message()
            ));
        }
    }
    for link in &others {
        let Some(parent) = link.parent else { continue };
        if !by_root.contains_key(&parent) {
            problems.push(format!(
                "`{}` in {} follows the release with root {parent}, which is not among those given, so it \
                 may belong to a different history: add that release to --chain, or leave `{}` out",
                link.name,
                link.place.in_message(),
                link.name
            ));
        }
        let Some(follower) = followers.get(&parent) else { continue };
        problems.push(format!(
            "`{}` in {} and `{}` in {} follow the same release (root {parent}), so they belong to different \
             histories: pass only one of them",
            follower.name,
            follower.place.in_message(),
            link.name,
            link.place.in_message()
        ));
    }
    let others = others.len();
    Chain { releases, complete, others, problems }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn link(name: &str, root: &str, parent: Option<&str>) -> Link {
        let digest = |text: &str| Digest::of(text.as_bytes());
        Link { name: name.into(), root: digest(root), parent: parent.map(digest), place: name.into() }
    }

    #[track_caller]
    fn check(start: Link, links: Vec<Link>, chain: &[&str], complete: bool, problems: &[&str]) {
        let found = join(start, links, Vec::new());
        let names: Vec<&str> = found.releases.iter().map(|link| link.name.as_str()).collect();
        assert_eq!(names, chain);
        assert_eq!(found.complete, complete);
        assert_eq!(found.problems.len(), problems.len(), "{:?}", found.problems);
        for (problem, words) in found.problems.iter().zip(problems) {
            assert!(problem.contains(words), "{problem}");
        }
    }

    #[test]
    fn chains() {
        let (one, two, three) = (link("1", "a", None), link("2", "b", Some("a")), link("3", "c", Some("b")));
        check(one.clone(), vec![], &["1"], true, &[]);
        check(three.clone(), vec![one.clone(), two.clone()], &["3", "2", "1"], true, &[]);
        // The start is among the given releases, one release is given twice, and one is unrelated.
        let given = vec![two.clone(), one.clone(), two.clone(), three.clone(), link("tiny", "t", None)];
        check(three.clone(), given.clone(), &["3", "2", "1"], true, &[]);
        assert_eq!(join(three.clone(), given, Vec::new()).others, 1);
        let missing = format!("`2` follows the release with root {}", one.root);
        check(three.clone(), vec![two.clone()], &["3", "2"], false, &[&missing]);
    }

    /// A release is reported if it follows a missing rival of release `2`.
    #[test]
    fn missing_predecessors_are_reported() {
        let (one, two) = (link("1", "a", None), link("2", "b", Some("a")));
        let rival = link("3x", "d", Some("the rival of 2"));
        check(two, vec![one, rival], &["2", "1"], true, &["`3x` in 3x follows the release with root"]);
    }

    #[test]
    fn later_releases_are_ignored() {
        let (one, two, other) = (link("1", "a", None), link("2", "b", Some("a")), link("2b", "c", Some("a")));
        check(one, vec![two, other], &["1"], true, &[]);
    }

    #[test]
    fn other_histories() {
        let (one, two, three) = (link("1", "a", None), link("2", "b", Some("a")), link("3", "c", Some("b")));
        let fork = link("2x", "d", Some("a"));
        check(
            three.clone(),
            vec![one.clone(), two.clone(), fork],
            &["3", "2", "1"],
            true,
            &["`2` in 2 and `2x` in 2x follow the same release"],
        );
        let double = link("2", "e", None);
        check(
            three.clone(),
            vec![one.clone(), two.clone(), double],
            &["3", "2", "1"],
            true,
            &["two releases are called `2`"],
        );
        let homonym = link("3", "a", None);
        check(three, vec![homonym, two], &["3", "2", "3"], true, &["two releases are called `3`"]);
    }

    /// Sound releases cannot form a cycle, because a root covers the parent's root, but the walk must
    /// terminate in any case.
    #[test]
    fn rings_end() {
        let (one, two) = (link("1", "a", Some("b")), link("2", "b", Some("a")));
        check(two, vec![one], &["2", "1"], false, &["the chain is circular"]);
        check(link("1", "a", Some("a")), vec![], &["1"], false, &["the chain is circular"]);
    }
}

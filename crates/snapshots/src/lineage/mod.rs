//! The available ancestors of a release, and the claims that can be checked even if other ancestors are unavailable.
//!
//! [`chain::follow`](crate::lineage::chain::follow) requires every release in a chain and judges every given
//! release. In contrast, this module ends the chain at the first unavailable release and ignores releases
//! outside the chain.

pub(crate) mod ancestry;
pub mod chain;

use crate::contents::integrity::Integrity;
use crate::contents::{integrity_of, is_file};
use crate::error::SnapshotError;
use crate::format::folder;
use crate::format::manifest::{MANIFEST_FILE, MANIFEST_LIMIT, Manifest};
use crate::lineage::chain::{Link, history_problems, releases_in};
use base::Digest;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A release that a later release states as its parent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ancestor {
    /// The root stated in the later release.
    pub root: Digest,
    /// The release; `None` if it was not found.
    pub link: Option<Link>,
    /// The reasons why the release that was found does not have the stated root. Empty if the root matches, or if no
    /// release was found.
    pub problems: Vec<String>,
}

/// The ancestors of a release.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lineage {
    /// The ancestors, from the parent back. Only the last ancestor can be absent or damaged.
    pub ancestors: Vec<Ancestor>,
    /// `true` if the ancestors reach back to a release without a parent.
    pub complete: bool,
    /// The folders and archives that could not be read, with the reasons.
    pub unread: Vec<String>,
    /// The problems with the history as a whole: duplicate names, inconsistent lists of earlier content, and
    /// repeated content.
    pub problems: Vec<String>,
}

/// Follows the roots from `start` back among the releases in `folders`. Each folder is a release (folder or
/// archive) or contains releases. Only the ancestors' integrity is checked. `heard` is called with each
/// ancestor after it has been checked, and can end the search by returning `false`. `start` must have been
/// verified already.
///
/// Cost: reading the manifests in the folders, two passes over the files of each ancestor, and one pass over each
/// archive if a root is not found in any folder.
///
/// # Errors
/// Returns an error if a release in the chain has become unreadable.
pub fn trace(
    start: &Link,
    folders: &[PathBuf],
    heard: &mut dyn FnMut(&Ancestor) -> bool,
) -> Result<Lineage, SnapshotError> {
    let mut candidates = Candidates::of(folders);
    let mut chain = vec![start.clone()];
    let (mut ancestors, mut complete) = (Vec::new(), true);
    let mut next = start.parent;
    while let Some(root) = next {
        let ancestor = match chain.iter().any(|link| link.root == root) {
            true => {
                let problems = vec!["the release follows itself: the chain is circular".to_owned()];
                Ancestor { root, link: None, problems }
            }
            false => candidates.find(root),
        };
        let goes_on = heard(&ancestor);
        let link = ancestor.link.clone().filter(|_| ancestor.problems.is_empty());
        ancestors.push(ancestor);
        let Some(link) = link.filter(|_| goes_on) else {
            complete = false;
            break;
        };
        next = link.parent;
        chain.push(link);
    }
    let mut names = BTreeSet::new();
    let again = chain.iter().filter(|link| !names.insert(&link.name));
    let mut problems: Vec<String> =
        again.map(|link| format!("two releases of the chain are called `{}`", link.name)).collect();
    problems.extend(history_problems(&chain)?);
    Ok(Lineage { ancestors, complete, unread: candidates.unread, problems })
}

/// The releases that are searched for ancestors.
struct Candidates {
    /// The release folders, with their stated roots.
    folders: Vec<(Digest, PathBuf)>,
    archives: Vec<PathBuf>,
    /// The archives already read.
    opened: Vec<(PathBuf, Integrity)>,
    unread: Vec<String>,
}

impl Candidates {
    fn of(folders: &[PathBuf]) -> Candidates {
        let mut candidates =
            Candidates { folders: Vec::new(), archives: Vec::new(), opened: Vec::new(), unread: Vec::new() };
        let mut places = BTreeSet::new();
        for folder in folders {
            match releases_in(folder) {
                Ok(found) => places.extend(found),
                // The folder contains no release.
                Err(SnapshotError::NoRelease(_)) => {}
                Err(error) => candidates.put_aside(&error),
            }
        }
        for place in places {
            if is_file(&place) {
                candidates.archives.push(place);
                continue;
            }
            let named = |error: SnapshotError| error.in_manifest(&place.join(MANIFEST_FILE));
            let bytes = folder::read(&place, MANIFEST_FILE, MANIFEST_LIMIT);
            match bytes.and_then(|bytes| Manifest::parse(&bytes).map_err(named)) {
                Ok(manifest) => candidates.folders.push((manifest.root, place)),
                Err(error) => candidates.put_aside(&error),
            }
        }
        candidates
    }

    fn put_aside(&mut self, error: &SnapshotError) {
        let reason = std::error::Error::source(error).map_or(String::new(), |source| format!(": {source}"));
        self.unread.push(format!("{error}{reason}"));
    }

    /// Returns the release with the given root, preferably a sound one. If none is sound, returns the first release
    /// that states this root, with the problems found in it.
    fn find(&mut self, root: Digest) -> Ancestor {
        let mut damaged = None;
        let places: Vec<PathBuf> = self
            .folders
            .iter()
            .filter(|(stated, _)| *stated == root)
            .map(|(_, place)| place.clone())
            .collect();
        for place in places {
            match integrity_of(&place) {
                Ok(integrity) => {
                    let ancestor = judged(root, &integrity, &place);
                    if ancestor.problems.is_empty() {
                        return ancestor;
                    }
                    damaged.get_or_insert(ancestor);
                }
                Err(error) => self.put_aside(&error),
            }
        }
        for place in std::mem::take(&mut self.archives) {
            match integrity_of(&place) {
                Ok(integrity) => self.opened.push((place, integrity)),
                Err(error) => self.put_aside(&error),
            }
        }
        for (place, integrity) in self.opened.iter().filter(|(_, found)| found.manifest.root == root) {
            let ancestor = judged(root, integrity, place);
            if ancestor.problems.is_empty() {
                return ancestor;
            }
            damaged.get_or_insert(ancestor);
        }
        damaged.unwrap_or(Ancestor { root, link: None, problems: Vec::new() })
    }
}

fn judged(root: Digest, integrity: &Integrity, place: &Path) -> Ancestor {
    let problems = integrity.problems.iter().map(ToString::to_string).collect();
    Ancestor { root, link: Some(Link::of(&integrity.manifest, place)), problems }
}

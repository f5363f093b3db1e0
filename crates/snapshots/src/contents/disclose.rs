//! The lists of the files that a sealed release withholds, and the commitments to those lists.
//!
//! A sealed release publishes neither the paths, nor the sizes, nor the plain digests of its withheld files, because
//! anyone could check a guessed text against its digest. Instead, its manifest contains the digests of two lists, which
//! are also withheld. A list begins with a salt derived from the secret, so nobody can guess it. It contains the path,
//! size and digest of every file in its part, so its digest commits to all of these files. The lists' digests are
//! leaves of the tree.

use crate::error::SnapshotError;
use crate::format::layout::HELD;
use crate::format::manifest::item::Item;
use crate::format::manifest::withheld::{HeldPart, Withheld};
use crate::format::manifest::{MANIFEST_LIMIT, Manifest};
use crate::format::problem::Flaw;
use crate::recipe::secret::Secret;
use base::Digest;
use base::canonical::{is_canonical_json, to_canonical_json};
use serde::{Deserialize, Serialize};

/// The maximum size of a list, in bytes.
pub(crate) const LIST_LIMIT: u64 = MANIFEST_LIMIT;

/// The list of the files in one withheld part.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct HeldList {
    /// A value derived from the secret.
    salt: Digest,
    /// The files, sorted by the bytes of their paths.
    items: Vec<Item>,
}

/// Moves the items below [`HELD`] from a manifest into two lists, commits to the lists, and returns their
/// paths and contents. The caller must recompute the manifest's root.
///
/// # Errors
/// Returns an error if a list exceeds the size limit for manifests.
pub fn withhold(manifest: &mut Manifest, secret: &Secret) -> Result<Vec<(String, Vec<u8>)>, SnapshotError> {
    let items = std::mem::take(&mut manifest.items);
    let (mut held, public): (Vec<Item>, Vec<Item>) =
        items.into_iter().partition(|item| item.path.starts_with(HELD));
    held.retain(|item| HeldPart::of_list(&item.path).is_none());
    held.sort_by(|a, b| a.path.cmp(&b.path));
    manifest.items = public;
    let mut lists = Vec::new();
    for part in HeldPart::ALL {
        let items = held.iter().filter(|item| part.has(&item.path)).cloned().collect();
        let bytes = to_canonical_json(&HeldList { salt: secret.salt(part), items })?.into_bytes();
        if bytes.len() as u64 > LIST_LIMIT {
            return Err(SnapshotError::TooLarge { path: part.list().into(), limit: LIST_LIMIT });
        }
        lists.push((part.list().to_owned(), bytes));
    }
    let [rest, solutions] = [0, 1].map(|at: usize| Digest::of(&lists[at].1));
    held.extend(lists.iter().map(|(path, bytes)| Item::of(path.clone(), bytes)));
    held.sort_by(|a, b| a.path.cmp(&b.path));
    manifest.withheld = Some(Withheld { solutions, rest, disclosed: held });
    manifest.format = crate::format::manifest::SEALED_FORMAT;
    Ok(lists)
}

/// Adds the files in a part's list to the manifest's known withheld files.
///
/// # Errors
/// Returns an error if the list differs from the committed one, or contains a file that is not allowed in it.
pub(crate) fn disclose(manifest: &mut Manifest, part: HeldPart, bytes: &[u8]) -> Result<(), Flaw> {
    let withheld = manifest
        .withheld
        .as_mut()
        .expect("only sealed releases, whose manifests have `withheld`, are passed");
    let (found, stated) = (Digest::of(bytes), withheld.digest(part));
    if found != stated {
        return Err(Flaw::Altered { found, stated });
    }
    let list: HeldList = serde_json::from_slice(bytes).map_err(|error| Flaw::NotAList(error.to_string()))?;
    if !is_canonical_json(&list, bytes).unwrap_or(false) {
        return Err(Flaw::NotCanonical);
    }
    if let Some(item) = list.items.iter().find(|item| !part.has(&item.path)) {
        return Err(Flaw::NotAList(format!("`{}` does not belong in this list", item.path.escape_debug())));
    }
    if let Some(pair) = list.items.windows(2).find(|pair| pair[0].path >= pair[1].path) {
        let path = pair[1].path.escape_debug();
        return Err(Flaw::NotAList(format!("`{path}` is listed twice or out of order")));
    }
    let before = withheld.disclosed.clone();
    withheld.disclosed.push(Item::of(part.list(), bytes));
    withheld.disclosed.extend(list.items);
    withheld.disclosed.sort_by(|a, b| a.path.cmp(&b.path));
    // The new files are checked together with all others, because their paths might conflict.
    if let Err(error) = manifest.check_files() {
        manifest.withheld.as_mut().expect("the manifest withholds files").disclosed = before;
        return Err(Flaw::NotAList(error.to_string()));
    }
    Ok(())
}

/// Returns a sentence about the salt in a part's list if the salt is not derived from the secret; `None` if the salt
/// is correct.
pub(crate) fn salt_flaw(part: HeldPart, bytes: &[u8], secret: &Secret) -> Option<String> {
    let list = serde_json::from_slice::<HeldList>(bytes).ok()?;
    (list.salt != secret.salt(part))
        .then(|| format!("{}: the salt is not derived from the release's secret", part.list()))
}

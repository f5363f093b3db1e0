//! Inclusion proofs. A proof shows that a file or game belongs to the release with a given root. The rest of the
//! release is not needed.
//!
//! A proof is a small file in canonical JSON. It contains no secrets and need not be trusted: the verifier
//! trusts only a root from a different source.

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

use crate::error::SnapshotError;
use crate::format::folder::Limits;
use crate::format::manifest::withheld::HeldPart;
use crate::format::manifest::{HEADER_LEAF, MANIFEST_FILE, Manifest};
use crate::format::merkle::{self, Leaf, Proof};
use crate::format::path::check_path;
use base::Digest;
use base::canonical::to_canonical_json;

/// The maximum size of a proof, in bytes: 4 MiB, enough for a game with about three thousand files.
pub const MAX_PROOF: u64 = 4 << 20;
/// The version of the proof format.
const PROOF_FORMAT: u32 = 1;
/// The maximum height of a tree with at most 2⁶⁴ leaves.
const MAX_HEIGHT: usize = 64;

/// A reason why a proof cannot be created or read. It is about the request, not about the item.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProofError {
    /// The release does not contain the requested item.
    #[error("`{}` is neither a file nor a game of `{release}`{}", id.escape_debug(), near.as_ref().map_or_else(String::new, |near| format!(": did you mean `{near}`?")))]
    NoSuchItem {
        /// The requested item's ID.
        id: String,
        /// The release's name.
        release: String,
        /// The nearest existing ID.
        near: Option<String>,
    },
    /// The root covers the item only indirectly, through a list of withheld files.
    #[error("`{}` is covered by the root only through the list of withheld files, so it has no proof of its \
             own: prove `{list}`, which contains its digest", id.escape_debug())]
    Listed {
        /// The requested item's ID.
        id: String,
        /// The path of the list of withheld files.
        list: &'static str,
    },
    /// The proof exceeds the maximum size.
    #[error("the proof is larger than {MAX_PROOF} bytes: fetch it again")]
    TooLarge,
    /// The proof is not JSON with the expected structure.
    #[error("this is not an inclusion proof ({0}): fetch it again")]
    Syntax(serde_json::Error),
    /// The proof is well-formed, but its values cannot occur in a valid proof.
    #[error("the inclusion proof is not valid ({0}): fetch it again")]
    Unsound(String),
    /// The manifest's tree cannot be computed.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

/// A proof that an item is in a release. An item is one file, or all files of a game.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ItemProof {
    /// The version of this layout: 1.
    pub format: u32,
    /// The release's name. It is a label that proves nothing.
    pub release: String,
    /// The proof's root. Compare it with a root from a different source.
    pub root: Digest,
    /// The item: a path in the release such as `games/x/lvl0.txt`, or the name of a folder in `games/`.
    pub item: String,
    /// The files, sorted by the bytes of their paths: a single file for a path, or all of the game's listed
    /// files for a game.
    pub files: Vec<FileProof>,
}

/// A proof that a file is in a release.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileProof {
    /// The path in the release.
    pub path: String,
    /// The digest of the content.
    pub digest: Digest,
    /// The path from the file's leaf to the root.
    pub proof: Proof,
}

impl ItemProof {
    /// Creates the proof for `id`, which is either a path in the manifest or the ID of a game. An ID selects all of
    /// the game's files.
    ///
    /// Cost: O(n log n) for each file of the item, where n is the number of files in the release.
    ///
    /// # Errors
    /// Returns an error if the item does not exist.
    pub fn of(manifest: &Manifest, id: &str) -> Result<ItemProof, ProofError> {
        let wanted = |path: &str| path == id || game_of(path) == Some(id);
        let leaves = manifest.leaves()?;
        let items = manifest.files().filter(|item| wanted(&item.path));
        let files: Vec<FileProof> = items
            .filter_map(|item| {
                let proof = merkle::prove(&leaves, &item.path)?;
                Some(FileProof { path: item.path.clone(), digest: item.digest, proof })
            })
            .collect();
        if files.is_empty() {
            let part = HeldPart::ALL.into_iter().find(|part| part.has(id));
            if let Some(part) = part.filter(|_| manifest.item(id).is_some()) {
                return Err(ProofError::Listed { id: id.into(), list: part.list() });
            }
            let games = manifest.items.iter().filter_map(|item| game_of(&item.path));
            let known: BTreeSet<&str> =
                manifest.files().map(|item| item.path.as_str()).chain(games).collect();
            let near = engine::nearest(id, known).map(str::to_owned);
            return Err(ProofError::NoSuchItem { id: id.into(), release: manifest.name.clone(), near });
        }
        let (release, root) = (manifest.name.clone(), manifest.computed_root()?);
        Ok(ItemProof { format: PROOF_FORMAT, release, root, item: id.into(), files })
    }

    /// Serialises the proof as canonical JSON that [`ItemProof::parse`] can read.
    ///
    /// # Errors
    /// Returns an error if the proof is larger than [`MAX_PROOF`].
    pub fn to_bytes(&self) -> Result<Vec<u8>, ProofError> {
        let bytes = to_canonical_json(self).map_err(SnapshotError::from)?.into_bytes();
        if bytes.len() as u64 > MAX_PROOF { Err(ProofError::TooLarge) } else { Ok(bytes) }
    }

    /// Reads an untrusted proof, and checks everything that can be checked without the root and the files.
    ///
    /// # Errors
    /// Returns an error in each of these cases:
    ///
    /// - The proof is too large, is not canonical JSON with the expected structure, has a different format version,
    ///   or is empty.
    /// - The label is not a release name.
    /// - The files are unsorted, have unsafe or reserved paths, or do not belong to the item.
    /// - A file's position, or its path to the root, is impossible in the tree.
    pub fn parse(bytes: &[u8]) -> Result<ItemProof, ProofError> {
        if bytes.len() as u64 > MAX_PROOF {
            return Err(ProofError::TooLarge);
        }
        let proof: ItemProof = serde_json::from_slice(bytes).map_err(ProofError::Syntax)?;
        let unsound = |what: String| Err(ProofError::Unsound(what));
        if proof.format != PROOF_FORMAT {
            return unsound(format!(
                "the proof has format {}, but this version of arcade reads format {PROOF_FORMAT}",
                proof.format
            ));
        }
        if proof.files.is_empty() {
            return unsound("the proof lists no files".into());
        }
        for file in &proof.files {
            let path = file.path.escape_debug();
            if let Err(problem) = check_path(&file.path) {
                return unsound(format!("`{path}` cannot be in a snapshot: {problem}"));
            }
            if [HEADER_LEAF, MANIFEST_FILE].iter().any(|reserved| file.path.eq_ignore_ascii_case(reserved)) {
                return unsound(format!(
                    "`{path}` is the reserved name of the manifest, not part of a release"
                ));
            }
            // The manifest's header is also a leaf, so there are at most as many leaves as a release can have
            // files, including the manifest.
            let (index, size) = (file.proof.index, file.proof.size);
            if index >= size || size > Limits::SNAPSHOT.files {
                return unsound(format!(
                    "`{path}` is leaf {index} of {size}, a position that no release has"
                ));
            }
            let of_the_game = game_of(&file.path) == Some(proof.item.as_str());
            if file.path != proof.item && !of_the_game {
                return unsound(format!("`{path}` isn't part of `{}`", proof.item.escape_debug()));
            }
            if file.proof.siblings.len() > MAX_HEIGHT {
                return unsound(format!(
                    "`{path}` has {} steps to the root, more than any release has",
                    file.proof.siblings.len()
                ));
            }
        }
        if let Some(pair) = proof.files.windows(2).find(|pair| pair[0].path >= pair[1].path) {
            return unsound(format!("`{}` is listed twice or out of order", pair[1].path));
        }
        let apart = |pair: &[FileProof]| {
            pair[0].proof.size != pair[1].proof.size || pair[0].proof.index >= pair[1].proof.index
        };
        if let Some(pair) = proof.files.windows(2).find(|pair| apart(pair)) {
            return unsound(format!(
                "`{}` and `{}` cannot be in the same release",
                pair[0].path, pair[1].path
            ));
        }
        if check_path(&proof.release).is_err() || proof.release.contains('/') {
            return unsound(format!("`{}` is not a valid release name", proof.release.escape_debug()));
        }
        if to_canonical_json(&proof).map_err(SnapshotError::from)?.as_bytes() != bytes {
            return unsound("its text is not in canonical form".into());
        }
        Ok(proof)
    }

    /// Returns every reason why the item `id` is not covered by `root`, given the item's files; empty if `root`
    /// covers it. Each reason names a file and its digests. `content` returns the digest of the file at a path, or
    /// `None` if there is no such file.
    ///
    /// # Errors
    /// Returns the errors of `content`.
    pub fn check<E>(
        &self,
        id: &str,
        root: &Digest,
        mut content: impl FnMut(&str) -> Result<Option<Digest>, E>,
    ) -> Result<Vec<String>, E> {
        let mut problems = Vec::new();
        if self.item != id {
            problems.push(format!(
                "the proof is for `{}`, not for `{}`",
                self.item.escape_debug(),
                id.escape_debug()
            ));
        }
        if self.root != *root {
            problems.push(format!("the proof leads to the root {}, not to {root}", self.root));
        }
        // The remaining checks would only repeat the problem for every file.
        if !problems.is_empty() {
            return Ok(problems);
        }
        for file in &self.files {
            let path = file.path.as_str();
            match content(path)? {
                None => problems.push(format!("{path}: missing")),
                Some(found) if found != file.digest => {
                    problems.push(format!(
                        "{path}: altered (the digest is {found}, but the proof states {})",
                        file.digest
                    ));
                }
                Some(_) => {}
            }
            let leaf = Leaf { path: file.path.clone(), digest: file.digest };
            if !file.proof.verify(&leaf, root) {
                problems.push(format!(
                    "{path}: the proof does not lead from digest {} to the root {root}",
                    file.digest
                ));
            }
        }
        Ok(problems)
    }
}

/// Returns the game to which a path in a release belongs; `None` if the path is not in a game's folder.
fn game_of(path: &str) -> Option<&str> {
    let (game, file) = path.strip_prefix("games/")?.split_once('/')?;
    (!game.is_empty() && !file.is_empty()).then_some(game)
}

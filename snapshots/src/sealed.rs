//! Sealed releases: the seed is committed to before, and revealed later.

use crate::folder::{self, Limits};
use crate::integrity::check_integrity;
use crate::manifest::{MANIFEST_FILE, Manifest};
use crate::{Draft, SnapshotError};
use crate::papers::{PAPERS_LIMITS, PASSED_OVER};
use engine::Digest;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::Path;

/// The file of a sealed release that holds its secret, among those held back.
pub const SECRET_FILE: &str = "held/secret.json";
/// Where the files of a sealed release lie that are held back until it is revealed.
pub const HELD: &str = "held/";

/// Where a sealed release has the witness of a level, by the game's folder below `games`.
pub(crate) fn held_witness(game: &str, level: usize) -> String {
    format!("{HELD}{game}/lvl{level}.json")
}

/// What a sealed release is minted from, and what its recipe commits to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Secret {
    /// Name of the release that it is meant for.
    pub name: String,
    /// The text that the seed comes from.
    pub seed: String,
    /// What keeps the seed from being guessed: 64 hexadecimal digits.
    pub nonce: Digest,
}

impl Secret {
    /// A secret from 64 bytes of chance: half of them for the seed, half for the nonce.
    pub fn draw(name: &str, chance: [u8; 64]) -> Secret {
        let (seed, nonce) = chance.split_at(32);
        // Hashed, so that even chance of little worth has the full length.
        let seed = Digest::of(seed).to_string();
        Secret { name: name.to_owned(), seed, nonce: Digest::of(nonce) }
    }

    /// BLAKE3(seed ‖ nonce): the bytes of the seed's text, then the 32 bytes of the nonce.
    pub fn commitment(&self) -> Digest {
        Digest::of(&[self.seed.as_bytes(), self.nonce.as_bytes()].concat())
    }
}

/// The largest file of a secret, in bytes.
const SECRET_LIMIT: u64 = 4096;

/// Reads a secret from a file below a folder.
///
/// # Errors
/// It cannot be read, or is no secret.
pub fn read_secret(folder: &Path, file: &str) -> Result<Secret, SnapshotError> {
    let bytes = folder::read(folder, file, SECRET_LIMIT)?;
    serde_json::from_slice(&bytes)
        .map_err(|source| SnapshotError::NotASecret { path: folder.join(file), source })
}

/// Why a release is not revealed.
#[derive(Debug, thiserror::Error)]
pub enum RevealError {
    /// It is open, or has no commitment.
    #[error("`{0}` is not sealed: there is nothing to reveal")]
    Open(String),
    /// The two parts are not those that the manifest commits to.
    #[error("the two parts are not what the manifest commits to: {}", .0.join("; "))]
    Problems(Vec<String>),
    /// A part cannot be read, or the whole cannot be written.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

/// Joins the two parts of a sealed release, `public` and `held`, in a draft: the files of both, if they are exactly those under
/// the root of the public manifest, and the secret is the one committed to; and the papers.
/// Returns that manifest.
///
/// Cost: one pass over the files, in pieces; memory in proportion to the manifest.
///
/// # Errors
/// A file is missing, changed or none of the manifest's, the seed or the nonce is not the one committed to, or the file system
/// refuses.
pub fn reveal(public: &Path, held: &Path, draft: &Draft) -> Result<Manifest, RevealError> {
    let integrity = check_integrity(public)?;
    let manifest = integrity.manifest;
    let Some(commitment) = manifest.commitment else { return Err(RevealError::Open(manifest.name)) };
    let mut problems: Vec<String> = integrity.problems.iter().map(ToString::to_string).collect();
    let listing = folder::list_but(held, &Limits::SNAPSHOT, &PASSED_OVER)?;
    problems.extend(listing.problems.iter().map(|problem| format!("{HELD}{problem}")));
    let there: BTreeSet<String> =
        listing.entries.iter().map(|entry| format!("{HELD}{}", entry.path)).collect();
    let awaited: BTreeSet<&str> =
        manifest.items.iter().map(|item| item.path.as_str()).filter(|path| path.starts_with(HELD)).collect();
    problems.extend(
        there
            .iter()
            .filter(|path| !awaited.contains(path.as_str()))
            .map(|path| format!("{path}: not of this release")),
    );
    problems
        .extend(awaited.iter().filter(|path| !there.contains(**path)).map(|path| format!("{path}: missing")));
    if !problems.is_empty() {
        return Err(RevealError::Problems(problems));
    }
    for item in &manifest.items {
        let (part, path) = match item.path.strip_prefix(HELD) {
            Some(path) => (held, path),
            None => (public, item.path.as_str()),
        };
        let bytes = folder::read(part, path, Limits::SNAPSHOT.file_bytes)?;
        if Digest::of(&bytes) != item.digest || bytes.len() as u64 != item.size {
            problems.push(format!("{}: not the file that was committed to", item.path));
        } else {
            draft.write(&item.path, &bytes)?;
        }
    }
    if problems.is_empty() {
        let file = SECRET_FILE.strip_prefix(HELD).expect("it is held");
        if read_secret(held, file)?.commitment() != commitment {
            problems.push(format!("{SECRET_FILE}: its seed and nonce are not those of the commitment"));
        }
    }
    if !problems.is_empty() {
        return Err(RevealError::Problems(problems));
    }
    draft.write(MANIFEST_FILE, &manifest.to_bytes()?)?;
    Ok(manifest)
}
    for paper in &integrity.beside.papers {
        draft.write(&paper.path, &folder::read(public, &paper.path, PAPERS_LIMITS.file_bytes)?)?;
    }

//! Minting a release again from the recipe in its manifest, and comparing byte by byte.

use crate::corpus::Corpus;
use crate::folder::{self, Limits};
use crate::manifest::{Kind, MANIFEST_FILE, MANIFEST_LIMIT, Manifest};
use crate::mint::{MintError, Minted, Progress, mint};
use crate::recipe::{Recipe, RecipeError};
use crate::{Digest, SnapshotError};
use std::collections::BTreeSet;
use std::path::Path;

/// Why a release cannot be minted again here.
#[derive(Debug, thiserror::Error)]
pub enum RegenerateError {
    /// Other generators made it.
    #[error(
        "this release was minted under generation {generation} and semantics {semantics}; this arcade has \
         {} and {}: use an arcade that has the same",
        generators::GENERATION,
        engine::SEMANTICS
    )]
    OtherVersion {
        /// In the manifest.
        generation: u32,
        /// In the manifest.
        semantics: u32,
    },
    /// Its seed is not public.
    #[error(
        "this release is sealed: its seed is not in the folder, so it cannot be minted again before it is revealed"
    )]
    Sealed,
    /// The recipe in the manifest is not one.
    #[error("the manifest's recipe is not a recipe: {0}")]
    NotARecipe(serde_json::Error),
    /// The recipe in the manifest has a value out of range.
    #[error("the manifest's recipe: {0}")]
    Recipe(#[from] RecipeError),
    /// It cannot be minted.
    #[error(transparent)]
    Mint(#[from] MintError),
    /// The folder cannot be read.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

/// The release minted again, and where it differs.
#[derive(Clone, Debug)]
pub struct Regenerated {
    /// The new one.
    pub minted: Minted,
    /// What differs, each naming the file; empty if every byte is the same.
    pub differences: Vec<String>,
    /// Whether another set of dependencies (Cargo.lock) minted it; not a difference by itself.
    pub other_lockfile: bool,
}

/// Mints the release in `root` again and compares every file. The digest of Cargo.lock in the manifest is provenance
/// and may differ.
///
/// # Errors
/// The folder is no release, or one that this binary cannot mint.
pub fn regenerate(
    root: &Path,
    corpus: &Corpus,
    lockfile: Digest,
    progress: &dyn Progress,
) -> Result<Regenerated, RegenerateError> {
    let bytes = folder::read(root, MANIFEST_FILE, MANIFEST_LIMIT).map_err(|error| match error {
        SnapshotError::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
            SnapshotError::NotASnapshot { path: root.to_path_buf() }
        }
        other => other,
    })?;
    let manifest = Manifest::parse(&bytes).map_err(|error| error.in_manifest(&root.join(MANIFEST_FILE)))?;
    let Manifest { generation, semantics, .. } = manifest;
    if generation != generators::GENERATION || semantics != engine::SEMANTICS {
        return Err(RegenerateError::OtherVersion { generation, semantics });
    }
    if manifest.kind == Kind::Sealed {
        return Err(RegenerateError::Sealed);
    }
    let recipe: Recipe =
        serde_json::from_value(manifest.recipe.clone()).map_err(RegenerateError::NotARecipe)?;
    recipe.check()?;
    let minted = mint(&recipe, corpus, lockfile, progress)?;
    let differences = differences(root, &manifest, &bytes, &minted)?;
    Ok(Regenerated { other_lockfile: manifest.lockfile != lockfile, minted, differences })
}

fn differences(
    root: &Path,
    manifest: &Manifest,
    bytes: &[u8],
    minted: &Minted,
) -> Result<Vec<String>, SnapshotError> {
    let listing = folder::list(root, &Limits::SNAPSHOT)?;
    let mut differences: Vec<String> = listing.problems.iter().map(ToString::to_string).collect();
    let named: BTreeSet<&str> = listing.problems.iter().map(|problem| problem.path.as_str()).collect();
    let there: BTreeSet<&str> = listing.entries.iter().map(|entry| entry.path.as_str()).collect();
    for (path, content) in &minted.files {
        if !there.contains(path.as_str()) {
            if !named.contains(path.as_str()) {
                differences.push(format!("{path}: missing"));
            }
        } else if folder::read(root, path, Limits::SNAPSHOT.file_bytes)? != *content {
            differences.push(format!("{path}: differs"));
        }
    }
    let made: BTreeSet<&str> = minted.files.iter().map(|(path, _)| path.as_str()).collect();
    let extra = there.iter().filter(|path| **path != MANIFEST_FILE && !made.contains(*path));
    differences.extend(extra.map(|path| format!("{path}: not part of the release")));
    let mut expected = Manifest { lockfile: manifest.lockfile, ..minted.manifest.clone() };
    expected.seal_root()?;
    if expected.to_bytes()? != bytes {
        differences.push(format!("{MANIFEST_FILE}: differs"));
    }
    differences.sort();
    Ok(differences)
}

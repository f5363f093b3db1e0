//! The reveal of a sealed release, which merges its two parts.

use crate::contents::disclose::{LIST_LIMIT, disclose, salt_flaw};
use crate::contents::integrity::check_integrity;
use crate::contents::untracked::{IGNORED_NAMES, PAPERS_LIMITS};
use crate::draft::Draft;
use crate::error::SnapshotError;
use crate::format::folder::{self, Limits};
use crate::format::layout::{HELD, SECRET_FILE, SIBLINGS, is_solution};
use crate::format::manifest::withheld::{HeldPart, Reveal};
use crate::format::manifest::{MANIFEST_FILE, Manifest};
use crate::format::witness::Witness;
use crate::publish::papers;
use crate::recipe::secret::{Secret, UNRELATED_WITNESS, read_revealed};
use crate::sections::memory::part::has_second_wins;
use crate::sections::summary_paths;
use base::Digest;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

/// A reason why a release cannot be revealed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RevealError {
    /// The release is open, or has no commitment.
    #[error("`{0}` is not sealed: there is nothing to reveal")]
    Open(String),
    /// The release does not contain two wins per level, so there are no wins for early publication.
    #[error(
        "`{0}` has no second wins, because its recipe has no `[memory]` with `witnesses`: its witnesses are \
         revealed with everything else, so omit --solutions"
    )]
    NoSecondWins(String),
    /// The two parts differ from the content to which the manifest commits.
    #[error("the two parts do not match the commitments of the manifest: {}", .0.join("; "))]
    Problems(Vec<String>),
    /// A part cannot be read, or the result cannot be written.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

/// Merges the two parts of a sealed release (`public` and `held`) and the papers (documents such as the licence) into a
/// draft, and returns the manifest of the public part. The files must be exactly the files that this manifest's root
/// covers. The secret must match the commitment, and the witnesses must have been played under that secret.
///
/// Cost: one pass over the files, in chunks, and memory proportional to the manifest.
///
/// # Errors
/// Returns an error if a file is missing, changed or unlisted, if the seed or the nonce does not match the commitment,
/// or if a file system operation fails.
pub fn reveal(public: &Path, held: &Path, what: Reveal, draft: &Draft) -> Result<Manifest, RevealError> {
    let integrity = check_integrity(public)?;
    let mut manifest = integrity.manifest;
    if manifest.commitment.is_none() {
        return Err(RevealError::Open(manifest.name));
    }
    if what == Reveal::Solutions && !has_second_wins(&manifest) {
        return Err(RevealError::NoSecondWins(manifest.name));
    }
    let mut problems: Vec<String> = integrity.problems.iter().map(ToString::to_string).collect();
    let mut salts = Vec::new();
    let has_lists = manifest.withheld.is_some();
    for part in HeldPart::ALL.into_iter().filter(|_| has_lists) {
        let file = part.list().strip_prefix(HELD).expect("the list is in the held part");
        let Some(bytes) = folder::find(held, file, LIST_LIMIT)? else { continue };
        if manifest.hides(part) {
            let flaw = disclose(&mut manifest, part, &bytes).err();
            problems.extend(flaw.map(|flaw| format!("{}: {flaw}", part.list())));
        }
        salts.push((part, bytes));
    }
    let listing = folder::list_but(held, &Limits::SNAPSHOT, &IGNORED_NAMES)?;
    problems.extend(listing.problems.iter().map(|problem| format!("{HELD}{problem}")));
    let there: Vec<String> = listing.entries.iter().map(|entry| format!("{HELD}{}", entry.path)).collect();
    let there: BTreeSet<&str> = there.iter().map(String::as_str).collect();
    let held_files = manifest.held();
    let mut awaited = held_files.clone();
    if manifest.withheld.is_some() {
        awaited.extend(HeldPart::ALL.map(HeldPart::list));
    }
    problems.extend(there.difference(&awaited).map(|path| format!("{path}: not part of this release")));
    problems.extend(awaited.difference(&there).map(|path| format!("{path}: missing")));
    if !problems.is_empty() {
        return Err(RevealError::Problems(problems));
    }
    for item in manifest.files() {
        let (part, path) = match item.path.strip_prefix(HELD) {
            Some(path) => (held, path),
            None => (public, item.path.as_str()),
        };
        let bytes = folder::read(part, path, Limits::SNAPSHOT.file_bytes)?;
        if Digest::of(&bytes) != item.digest || bytes.len() as u64 != item.size {
            problems.push(format!("{}: the file does not match its commitment", item.path));
        } else if what == Reveal::All || !item.path.starts_with(HELD) || is_early(&item.path) {
            draft.write(&item.path, &bytes)?;
        }
    }
    if problems.is_empty() {
        let file = SECRET_FILE.strip_prefix(HELD).expect("the secret is in the held part");
        let secret = read_revealed(held, file)?;
        problems.extend(secret.flaw(&manifest)?.map(|flaw| format!("{SECRET_FILE}: {flaw}")));
        problems.extend(salts.iter().filter_map(|(part, bytes)| salt_flaw(*part, bytes, &secret)));
        problems.extend(unrelated_witnesses(
            &secret,
            &manifest.recipe,
            held,
            &held_files,
            &summary_paths(&manifest),
        )?);
    }
    if !problems.is_empty() {
        return Err(RevealError::Problems(problems));
    }
    for paper in &integrity.beside.papers {
        let content = folder::read(public, &paper.path, PAPERS_LIMITS.file_bytes)?;
        draft.write(&paper.path, &papers::revealed(&paper.path, content, what))?;
    }
    draft.write(MANIFEST_FILE, &manifest.to_bytes()?)?;
    Ok(manifest)
}

/// Returns `true` if a withheld file can be revealed early: the wins selected at random for early publication, and the
/// list of these wins.
fn is_early(path: &str) -> bool {
    is_solution(path) || path == HeldPart::Solutions.list()
}

/// Returns the withheld witnesses whose seeds are not derived from the secret.
fn unrelated_witnesses(
    secret: &Secret,
    recipe: &Value,
    held: &Path,
    files: &BTreeSet<&str>,
    summaries: &[String],
) -> Result<Vec<String>, SnapshotError> {
    let mut problems = Vec::new();
    let is_witness = |path: &&&str| {
        !(**path == SECRET_FILE
            || path.starts_with(SIBLINGS)
            || summaries.iter().any(|summary| summary == **path))
    };
    for path in files.iter().filter(is_witness) {
        let file = path.strip_prefix(HELD).expect("the witness is in the held part");
        let bytes = folder::read(held, file, Limits::SNAPSHOT.file_bytes)?;
        match serde_json::from_slice::<Witness>(&bytes) {
            Ok(witness) if secret.leads_to(&witness, recipe) => {}
            Ok(_) => problems.push(format!("{path}: {UNRELATED_WITNESS}")),
            Err(error) => problems.push(format!("{path}: not a valid witness: {error}")),
        }
    }
    Ok(problems)
}

//! Mints a release again from the recipe in its manifest, and compares the results byte by byte.

use crate::Digest;
use crate::contents::integrity::check_integrity;
use crate::contents::unfinished::refuse_unfinished;
use crate::contents::untracked;
use crate::error::SnapshotError;
use crate::format::folder::{self, Limits};
use crate::format::layout::SECRET_FILE;
use crate::format::manifest::item::ReleaseKind;
use crate::format::manifest::{MANIFEST_FILE, MANIFEST_LIMIT, Manifest};
use crate::format::plausible::impossible;
use crate::format::version::{CURRENT, MintedBy};
use crate::mint::error::MintError;
use crate::mint::plan::corpus::Corpus;
use crate::mint::{JobStore, Minted, Plan, Sink, lay_out};
use crate::recipe::Recipe;
use crate::recipe::error::RecipeError;
use crate::recipe::secret::{Secret, read_revealed};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use validators::{Criteria, Criterion};

/// A reason why a release cannot be minted again on this machine.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RegenerateError {
    /// The release was minted by a different version of the generators.
    #[error("this release was minted by {}; this is arcade {CURRENT}: {}", .0, next_move(.0))]
    OtherVersion(MintedBy),
    /// No version of the program could have written this manifest.
    #[error(
        "{MANIFEST_FILE} is damaged or was changed: {0}; fetch the release again, and run `arcade verify` on it"
    )]
    Damaged(String),
    /// The seed of the release is not public.
    #[error(
        "this release is sealed: its seed is not in the folder, so it cannot be minted again until it is \
         revealed"
    )]
    Sealed,
    /// The release is a single file, such as an archive.
    #[error("this is a file: pass a release folder; unpack an archive first (`tar --zstd -xf FILE`)")]
    NotAFolder,
    /// The recipe in the manifest is malformed.
    #[error("the manifest's recipe is not valid: {0}")]
    NotARecipe(serde_json::Error),
    /// The recipe in the manifest contains an out-of-range value.
    #[error("the manifest's recipe: {0}")]
    Recipe(#[from] RecipeError),
    /// The folder cannot be read.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

/// Returns the command that installs the version that regeneration requires.
fn next_move(minted_by: &MintedBy) -> String {
    match minted_by.install_command() {
        Some(command) => {
            format!("install that version in a clone of the repository (`{command}`) and regenerate with it")
        }
        None => "neither the manifest nor this version of arcade names a version that can mint it".to_owned(),
    }
}

/// A release that was minted again, and its differences from the original.
#[derive(Clone, Debug)]
pub struct Regenerated {
    /// The release that was minted again.
    pub minted: Minted,
    /// The result of the comparison.
    pub compared: Compared,
}

/// A comparison of a release with a new release minted from the same recipe.
#[derive(Clone, Debug)]
pub struct Compared {
    /// The differences, each with the file name; empty if all bytes are equal.
    pub differences: Vec<String>,
    /// `false` if the folder contains only a manifest, so that nothing else could be compared.
    pub has_files: bool,
    /// `true` if the release was minted with different dependencies (`Cargo.lock`). This alone does not count
    /// as a difference.
    pub other_lockfile: bool,
}

/// A release that is to be minted again. Its jobs run like those of a new release
/// ([`make_jobs`](crate::mint::make_jobs)).
#[derive(Debug)]
pub struct Regeneration {
    root: PathBuf,
    manifest: Manifest,
    bytes: Vec<u8>,
    recipe: Recipe,
    secret: Option<Secret>,
}

impl Regeneration {
    /// Reads the recipe of the release in the folder `root`, and the secret if the release was revealed. Also opens
    /// every file to be compared, so that an unreadable file is reported before the jobs run.
    ///
    /// # Errors
    /// Returns an error if the folder is not a release, the release is damaged, or this binary cannot mint it.
    pub fn of(root: &Path) -> Result<Regeneration, RegenerateError> {
        if root.is_file() {
            return Err(match root.file_name().is_some_and(|name| name == MANIFEST_FILE) {
                true => SnapshotError::NotASnapshot(root.to_path_buf()).into(),
                false => RegenerateError::NotAFolder,
            });
        }
        refuse_unfinished(root)?;
        let bytes = folder::find(root, MANIFEST_FILE, MANIFEST_LIMIT)?;
        let bytes = bytes.ok_or_else(|| SnapshotError::NotASnapshot(root.to_path_buf()))?;
        let manifest =
            Manifest::parse(&bytes).map_err(|error| error.in_manifest(&root.join(MANIFEST_FILE)))?;
        let minted_by = manifest.minted_by();
        let computed = manifest.computed_root()?;
        let damage = impossible(&minted_by).or_else(|| {
            (computed != manifest.root).then(|| "the root does not match the content".to_owned())
        });
        if let Some(what) = damage {
            return Err(RegenerateError::Damaged(what));
        }
        if (minted_by.generation, minted_by.semantics) != (CURRENT.generation, CURRENT.semantics) {
            return Err(RegenerateError::OtherVersion(minted_by));
        }
        let secret = match manifest.kind {
            ReleaseKind::Open => None,
            ReleaseKind::Sealed if root.join(SECRET_FILE).exists() => Some(read_revealed(root, SECRET_FILE)?),
            ReleaseKind::Sealed => return Err(RegenerateError::Sealed),
        };
        let recipe: Recipe =
            serde_json::from_value(manifest.recipe.clone()).map_err(RegenerateError::NotARecipe)?;
        recipe.check()?;
        // If the folder or one of its files cannot be read, this fails early, before minting takes minutes.
        Comparison::of(root)?.open_all()?;
        Ok(Regeneration { root: root.to_path_buf(), manifest, bytes, recipe, secret })
    }

    /// Returns the maximum number of forward-model calls per level that the recipe allows, in win searches and in
    /// players' episodes.
    pub fn calls_per_level(&self) -> u64 {
        let of = |criteria: &Criteria| {
            let play = |decision: u64| decision.saturating_mul(criteria.most_ticks as u64);
            // Every reference player may play one round of episodes of the maximum length before all budgets are spent.
            let names = criteria.ladder.iter().chain(&criteria.held_out);
            let names = names.filter(|_| criteria.includes(Criterion::Skill));
            let budgets = names.filter_map(|name| name.rsplit(':').next()?.parse::<u64>().ok());
            let round = budgets.map(|budget| play(budget).saturating_mul(criteria.patience as u64));
            let searched = play(criteria.decision).saturating_mul(criteria.mcts_plays.into());
            [criteria.budget, criteria.ladder_calls, criteria.early_calls, criteria.ablation_calls, searched]
                .into_iter()
                .chain(round)
                .fold(0, u64::saturating_add)
        };
        self.recipe.corpus.criteria.as_ref().map_or(0, of).max(of(&self.recipe.criteria))
    }

    /// Creates the plan for the release's recipe.
    ///
    /// # Errors
    /// Returns an error if the recipe cannot be minted with the given corpus.
    pub fn plan<'a>(&'a self, corpus: &'a Corpus) -> Result<Plan<'a>, MintError> {
        Plan::new(&self.recipe, self.secret.as_ref(), corpus)
    }

    /// Lays out the release from a job store that contains all results, and compares every file. The digest of
    /// `Cargo.lock` in the manifest is provenance and may differ. Every file except the manifest is also passed to
    /// `also`.
    ///
    /// # Errors
    /// Returns an error if a job's result is missing or unsound, or if a file system operation fails.
    pub fn compare(
        &self,
        plan: &Plan<'_>,
        store: &dyn JobStore,
        lockfile: Digest,
        also: &mut Sink<'_>,
    ) -> Result<Regenerated, MintError> {
        let mut comparison = Comparison::of(&self.root)?;
        let minted = lay_out(plan, self.secret.as_ref(), store, lockfile, &mut |path, content| {
            comparison.file(path, content)?;
            also(path, content)
        })?;
        let compared = comparison.finish(&self.manifest, &self.bytes, &minted.manifest)?;
        Ok(Regenerated { minted, compared })
    }

    /// Compares the release with the release in the folder `out`, if the one in `out` is complete and was minted by
    /// this version from the same recipe. Returns the manifest in `out` and the comparison. Does not mint anything.
    ///
    /// # Errors
    /// Returns an error if `out` contains an unreadable manifest, or if a file system operation fails.
    pub fn compare_complete(&self, out: &Path) -> Result<Option<(Manifest, Compared)>, SnapshotError> {
        let found = match check_integrity(out) {
            Ok(found) => found,
            Err(SnapshotError::NotASnapshot(_) | SnapshotError::NotAFolder(_)) => return Ok(None),
            Err(error) => return Err(error),
        };
        let manifest = found.manifest;
        let version = |manifest: &Manifest| (manifest.generation, manifest.semantics);
        if !found.problems.is_empty()
            || manifest.recipe != self.manifest.recipe
            || version(&manifest) != version(&self.manifest)
        {
            return Ok(None);
        }
        let mut comparison = Comparison::of(&self.root)?;
        for item in manifest.files() {
            comparison.file(&item.path, &folder::read(out, &item.path, item.size)?)?;
        }
        let compared = comparison.finish(&self.manifest, &self.bytes, &manifest)?;
        Ok(Some((manifest, compared)))
    }
}

/// A comparison of a folder's files with the minted files.
struct Comparison<'a> {
    root: &'a Path,
    /// The files that have not yet been compared with a minted file.
    there: BTreeSet<String>,
    /// The paths with a problem that was reported individually.
    named: BTreeSet<String>,
    differences: Vec<String>,
    /// `false` if the folder contains only a manifest.
    has_files: bool,
}

impl Comparison<'_> {
    fn of(root: &Path) -> Result<Comparison<'_>, SnapshotError> {
        let (listing, _) = untracked::list(root)?;
        let mut there: BTreeSet<String> = listing.entries.into_iter().map(|entry| entry.path).collect();
        there.remove(MANIFEST_FILE);
        Ok(Comparison {
            root,
            has_files: !(there.is_empty() && listing.problems.is_empty()),
            there,
            differences: listing.problems.iter().map(ToString::to_string).collect(),
            named: listing.problems.into_iter().map(|problem| problem.path).collect(),
        })
    }

    /// Opens every file in order to detect unreadable files.
    fn open_all(&self) -> Result<(), SnapshotError> {
        self.there.iter().try_for_each(|path| folder::open(self.root, path).map(drop))
    }

    fn file(&mut self, path: &str, content: &[u8]) -> Result<(), SnapshotError> {
        if !self.has_files {
            return Ok(());
        }
        if !self.there.remove(path) {
            if !self.named.contains(path) {
                self.differences.push(format!("{path}: missing"));
            }
        } else if folder::read(self.root, path, Limits::SNAPSHOT.file_bytes)? != content {
            self.differences.push(format!("{path}: differs"));
        }
        Ok(())
    }

    fn finish(
        mut self,
        manifest: &Manifest,
        bytes: &[u8],
        minted: &Manifest,
    ) -> Result<Compared, SnapshotError> {
        self.differences.extend(self.there.iter().map(|path| format!("{path}: not part of the release")));
        let mut expected = Manifest { lockfile: manifest.lockfile, ..minted.clone() };
        expected.seal_root()?;
        if expected.to_bytes()? != bytes {
            self.differences.push(format!("{MANIFEST_FILE}: differs"));
        }
        self.differences.sort();
        Ok(Compared {
            differences: self.differences,
            has_files: self.has_files,
            other_lockfile: manifest.lockfile != minted.lockfile,
        })
    }
}

//! Minting into a folder: plans the mint, runs its jobs, resumes it after an interruption, and publishes the
//! result in one step.

use crate::contents::integrity::check_integrity;
use crate::draft::Draft;
use crate::error::SnapshotError;
use crate::format::layout::HELD;
use crate::format::manifest::MANIFEST_FILE;
use crate::format::version::CURRENT;
use crate::mint::error::MintError;
use crate::mint::plan::corpus::Corpus;
use crate::mint::plan::{Job, Plan};
use crate::mint::{
    JobFolder, JobStore, MergeError, Minted, Progress, Remark, Shard, Shards, jobs_left, lay_out, make_jobs,
};
use crate::recipe::Recipe;
use crate::recipe::secret::Secret;
use crate::sections::marks::MarkPlayers;
use base::Digest;
use std::path::{Path, PathBuf};

/// The resources that a program provides for minting.
#[derive(Clone, Copy, Debug)]
pub struct Tools<'a> {
    /// The hand-written corpus games.
    pub corpus: &'a Corpus,
    /// The digest of the `Cargo.lock` used to build the program.
    pub lockfile: Digest,
    /// The reference players that recipes can request.
    pub players: &'a dyn MarkPlayers,
}

/// A release or shard to be minted into a folder.
#[derive(Clone, Debug)]
pub struct Order {
    /// The recipe, which includes the parent and the beacon's value, if any.
    pub recipe: Recipe,
    /// A sealed release's secret.
    pub secret: Option<Secret>,
    /// The output folder, which must be absent or empty. A sealed release consists of two folders, `public` and
    /// `held`, inside it.
    pub out: PathBuf,
    /// The shard; `None` for the whole release.
    pub shard: Option<Shard>,
    /// `true` to reuse the finished jobs of an interrupted mint, and to accept a complete result that already exists.
    pub resume: bool,
}

/// An order whose recipe can be minted.
#[derive(Debug)]
pub struct Prepared<'a> {
    /// The whole release's plan.
    pub plan: Plan<'a>,
    /// The jobs that the order requires.
    pub jobs: Vec<Job>,
    /// `true` if the folder already contains the requested result. Only an order with `resume` accepts this.
    pub is_complete: bool,
    order: &'a Order,
    tools: Tools<'a>,
}

/// The result of a mint.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// The folder already contained the complete result.
    Complete,
    /// A shard with the given number of jobs was written.
    Shard(usize),
    /// A release was written.
    Release(Box<Minted>),
}

impl Order {
    /// Plans the mint, without writing anything.
    ///
    /// # Errors
    /// Returns an error if the recipe cannot be minted with the given secret and tools, or if a file system
    /// operation fails.
    pub fn prepare<'a>(
        &'a self,
        tools: Tools<'a>,
        progress: &dyn Progress,
    ) -> Result<Prepared<'a>, MintError> {
        let plan = plan(&self.recipe, self.secret.as_ref(), tools, progress)?;
        let jobs = self.shard.map_or_else(|| plan.jobs().to_vec(), |shard| shard.jobs(&plan));
        let is_complete = self.resume && self.is_complete(&plan)?;
        if jobs.is_empty() && !is_complete {
            progress.remark(&Remark::EmptyShard);
        }
        Ok(Prepared { plan, jobs, is_complete, order: self, tools })
    }

    /// Prepares and mints the order, by calling [`Order::prepare`] and [`Prepared::mint`].
    ///
    /// # Errors
    /// See [`Order::prepare`] and [`Prepared::mint`].
    pub fn mint(&self, tools: Tools<'_>, progress: &dyn Progress) -> Result<Outcome, MintError> {
        self.prepare(tools, progress)?.mint(progress)
    }

    /// Returns `true` if the folder contains this plan's release or, if the order requests a shard, that shard.
    fn is_complete(&self, plan: &Plan<'_>) -> Result<bool, SnapshotError> {
        if let Some(shard) = self.shard {
            return shard.is_whole(plan, &self.out);
        }
        let root = if plan.is_sealed() { self.out.join("public") } else { self.out.clone() };
        let found = match check_integrity(&root) {
            Ok(found) => found,
            Err(SnapshotError::NotASnapshot(_) | SnapshotError::NotAFolder(_)) => return Ok(false),
            Err(error) => return Err(error),
        };
        let minted_from: Option<Recipe> = serde_json::from_value(found.manifest.recipe.clone()).ok();
        let minted_by = found.manifest.minted_by();
        Ok(found.problems.is_empty()
            && minted_from.as_ref() == Some(&self.recipe)
            && (minted_by.generation, minted_by.semantics) == (CURRENT.generation, CURRENT.semantics))
    }
}

impl Prepared<'_> {
    /// Runs the remaining jobs, and publishes the release or the shard. The folder is either complete or absent.
    /// Until the folder is complete, the finished jobs are stored next to it ([`Draft`]).
    ///
    /// Cost: minutes for tens of games, on all threads of the current rayon pool.
    ///
    /// # Errors
    /// Returns an error if the folder is occupied, the candidates do not meet the recipe's requirements, or a file
    /// system operation fails.
    pub fn mint(&self, progress: &dyn Progress) -> Result<Outcome, MintError> {
        let Prepared { plan, jobs, order, tools, .. } = self;
        if self.is_complete {
            return Ok(Outcome::Complete);
        }
        // The draft is created before minutes of minting, so that an occupied folder is reported immediately.
        let mut draft = if order.resume { Draft::resume(&order.out) } else { Draft::create(&order.out) }?;
        match (plan.is_sealed(), order.shard) {
            (true, Some(_)) => draft.keep_secret()?,
            (true, None) => draft.keep_private()?,
            (false, _) => {}
        }
        let mut store = JobFolder::open(&draft.jobs(), plan.digest()?)?;
        if plan.is_sealed() {
            store.keep_secret()?;
        }
        progress.start(plan, &jobs_left(plan, jobs, &store)?);
        make_jobs(plan, jobs, &store, progress)?;
        progress.finish();
        let Some(shard) = order.shard else {
            let minted = publish(plan, order.secret.as_ref(), &store, tools.lockfile, draft)?;
            return Ok(Outcome::Release(Box::new(minted)));
        };
        shard.write(plan, &store, &draft)?;
        draft.commit()?;
        Ok(Outcome::Shard(jobs.len()))
    }
}

impl Shards {
    /// Merges the shards (separately minted parts). The result is bit-identical to a release minted in one piece.
    /// `secret` is the secret of a sealed release.
    ///
    /// Cost: one [`Shards::check`], on all threads of the current rayon pool.
    ///
    /// # Errors
    /// Returns an error if a shard differs from its minted form, the folder `out` is occupied, or a file system
    /// operation fails.
    pub fn merge(&self, secret: Option<&Secret>, out: &Path, tools: Tools<'_>) -> Result<Minted, MergeError> {
        let plan = Plan::new(self.recipe(), secret, tools.corpus)?;
        if !self.are_of(&plan)? {
            return Err(MergeError::OtherRecipe);
        }
        self.check(&plan)?;
        let draft = Draft::create(out)?;
        if plan.is_sealed() {
            draft.keep_private()?;
        }
        Ok(publish(&plan, secret, self, tools.lockfile, draft)?)
    }
}

/// Draws the secret for a recipe's commitment ([`Recipe::to_commit`]). The recipe is planned first, because the
/// commitment fixes the whole recipe.
///
/// # Errors
/// Returns an error if the recipe cannot be minted with the given tools.
pub fn commit(
    recipe: &Recipe,
    random: [u8; 64],
    tools: Tools<'_>,
    progress: &dyn Progress,
) -> Result<Secret, MintError> {
    let secret = Secret::draw(&recipe.name, recipe.committed(), random);
    secret.check().map_err(MintError::Unlucky)?;
    // The beacon has no value yet, but the value hardly affects the number of games that can be made.
    let minted = match &recipe.beacon {
        Some(_) => Recipe { seed: Some(secret.seed.clone()), beacon: None, ..recipe.clone() },
        None => Recipe { commitment: Some(secret.commitment()), ..recipe.clone() },
    };
    let of_minted = minted.commitment.map(|_| &secret);
    plan(&minted, of_minted, tools, progress)?;
    Ok(secret)
}

/// Creates a recipe's plan, and checks that there are enough rules and players for it.
fn plan<'a>(
    recipe: &'a Recipe,
    secret: Option<&Secret>,
    tools: Tools<'a>,
    progress: &dyn Progress,
) -> Result<Plan<'a>, MintError> {
    let plan = Plan::new(recipe, secret, tools.corpus)?.with_players(tools.players)?;
    if let Some(most) = plan.supply()? {
        progress.remark(&Remark::FewRules(most));
    }
    Ok(plan)
}

/// Lays out a release from finished jobs, and publishes it. A sealed release becomes two folders.
fn publish(
    plan: &Plan<'_>,
    secret: Option<&Secret>,
    store: &dyn JobStore,
    lockfile: Digest,
    draft: Draft,
) -> Result<Minted, MintError> {
    let is_sealed = plan.is_sealed();
    let place = |path: &str| match is_sealed && !path.starts_with(HELD) {
        true => format!("public/{path}"),
        false => path.to_owned(),
    };
    let minted =
        lay_out(plan, secret, store, lockfile, &mut |path, content| draft.write(&place(path), content))?;
    minted.publish(draft, place)?;
    Ok(minted)
}

impl Minted {
    /// Completes a draft that contains the release files by adding the manifest and the papers (documents such as the
    /// licence). `place` maps the paths of the added files.
    ///
    /// # Errors
    /// Returns an error if a file system operation fails.
    pub fn publish(&self, draft: Draft, place: impl Fn(&str) -> String) -> Result<(), SnapshotError> {
        draft.write(&place(MANIFEST_FILE), &self.manifest.to_bytes()?)?;
        for (path, text) in self.papers() {
            draft.write(&place(&path), text.as_bytes())?;
        }
        draft.commit()
    }
}

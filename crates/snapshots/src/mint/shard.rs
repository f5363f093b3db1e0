//! Shards: slices of a release's jobs that can run on different machines or at different times, and are
//! merged afterwards.
//!
//! A shard is a folder that is either complete or absent, like a release:
//!
//! ```text
//! SHARD.json          the shard's number, its recipe, and the files of its jobs with their digests
//! jobs/<name>.json    one file per job
//! ```

use super::job_store::{JobFolder, JobStore};
use super::plan::{Job, Plan};
use crate::Digest;
use crate::check::number_problems;
use crate::contents::replay::problem as replay_problem;
use crate::draft::Draft;
use crate::error::SnapshotError;
use crate::format::folder::{self, Limits};
use crate::format::manifest::MANIFEST_LIMIT;
use crate::format::manifest::item::Item;
use crate::format::version::{CURRENT, MintedBy};
use crate::mint::error::MintError;
use crate::recipe::Recipe;
use crate::sections::SECTIONS;
use crate::sections::frozen::{FrozenGame, JobResult};
use base::MessagePath;
use base::canonical::to_canonical_json;
use base::{Seed, SeedPath, SeedStep};
use engine::{Episode, Game};
use forge::card::LevelCard;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The file that describes a shard, at the shard's top level.
pub const SHARD_FILE: &str = "SHARD.json";
/// The version of the shard format.
const SHARD_FORMAT: u32 = 1;

/// A slice of the jobs: `2/4` is the second of four slices. Jobs are dealt to the slices in turn, so that all slices
/// take about the same time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shard {
    /// The shard's number, counted from 1.
    number: u32,
    of: u32,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let numbers =
            text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((number, of)) if 1 <= number && number <= of && of <= 10_000 => Ok(Shard { number, of }),
            _ => {
                Err("expected K/N for the K-th of N shards, with K from 1 to N and N up to 10000".to_owned())
            }
        }
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

/// The content of `SHARD.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ShardFile {
    format: u32,
    semantics: u32,
    generation: u32,
    shard: Shard,
    plan: Digest,
    recipe: Recipe,
    jobs: Vec<Item>,
}

/// The fields common to all versions of `SHARD.json`.
#[derive(Deserialize)]
struct Version {
    format: u32,
}

impl Shard {
    /// Returns the jobs of a plan that belong to this shard.
    pub fn jobs(&self, plan: &Plan<'_>) -> Vec<Job> {
        plan.jobs().iter().copied().skip(self.number as usize - 1).step_by(self.of as usize).collect()
    }

    /// Returns the shard in a folder, whatever its generation, and the name of its recipe. Returns `None` unless the
    /// folder contains exactly the files listed in its `SHARD.json`. The content of these files is not read.
    pub fn at(folder: &Path) -> Option<(Shard, String)> {
        let bytes = folder::read(folder, SHARD_FILE, MANIFEST_LIMIT).ok()?;
        // Any generation is accepted: shards of an earlier generation can no longer be merged here, but they
        // are still shards.
        let file: ShardFile = serde_json::from_slice(&bytes).ok()?;
        let listing = folder::list(folder, &Limits::SNAPSHOT).ok()?;
        let mut listed: Vec<&str> = file.jobs.iter().map(|item| item.path.as_str()).collect();
        listed.push(SHARD_FILE);
        listed.sort_unstable();
        let is_whole = listing.problems.is_empty()
            && listing.entries.iter().map(|entry| entry.path.as_str()).eq(listed.iter().copied());
        is_whole.then_some((file.shard, file.recipe.name))
    }

    /// Returns `true` if a folder contains this shard of the given plan, with all its files. The content of these
    /// files is not read.
    ///
    /// # Errors
    /// Returns an error if the plan has no digest.
    pub fn is_whole(&self, plan: &Plan<'_>, folder: &Path) -> Result<bool, SnapshotError> {
        let digest = plan.digest()?;
        let file = folder::read(folder, SHARD_FILE, MANIFEST_LIMIT).ok();
        let file: Option<ShardFile> = file.and_then(|bytes| serde_json::from_slice(&bytes).ok());
        let is_mine = file.is_some_and(|file| {
            file.shard == *self
                && file.plan == digest
                && file.recipe == *plan.recipe
                && (file.generation, file.semantics) == (generators::GENERATION, engine::SEMANTICS)
        });
        Ok(is_mine && Shard::at(folder).is_some())
    }

    /// Writes the shard's folder from a job store that contains all its results.
    ///
    /// # Errors
    /// Returns an error if a job's result is missing, or if a file system operation fails.
    pub fn write(&self, plan: &Plan<'_>, store: &dyn JobStore, draft: &Draft) -> Result<(), MintError> {
        let digest = plan.digest()?;
        let mut jobs = Vec::new();
        for job in self.jobs(plan) {
            let name = plan.name(job);
            let Some(result) = store.get(&name)? else { return Err(MintError::Missing(name)) };
            let text = JobFolder::text(digest, &result)?;
            let path = path(&name);
            draft.write(&path, text.as_bytes())?;
            jobs.push(Item::of(path, text.as_bytes()));
        }
        let file = ShardFile {
            format: SHARD_FORMAT,
            semantics: engine::SEMANTICS,
            generation: generators::GENERATION,
            shard: *self,
            plan: digest,
            recipe: plan.recipe.clone(),
            jobs,
        };
        draft.write(SHARD_FILE, to_canonical_json(&file).map_err(SnapshotError::from)?.as_bytes())?;
        Ok(())
    }
}

/// Returns the path of a job's file in a shard.
fn path(name: &str) -> String {
    format!("jobs/{name}.json")
}

/// A reason why shards cannot be merged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MergeError {
    /// The folder has no `SHARD.json`.
    #[error("{}: not a shard, because it has no {SHARD_FILE}; continue an unfinished shard with `arcade release … \
             --shard K/N --resume`", .0.in_message())]
    NotAShard(PathBuf),
    /// `SHARD.json` is invalid.
    #[error("{}: {what}", .path.in_message())]
    Unsound {
        /// The shard's folder.
        path: PathBuf,
        /// The problem with `SHARD.json`.
        what: String,
    },
    /// Two shards do not belong together.
    #[error("{} and {} cannot be merged: {what}", .one.in_message(), .two.in_message())]
    Apart {
        /// The first shard's folder.
        one: PathBuf,
        /// The second shard's folder.
        two: PathBuf,
        /// The property in which the two shards differ.
        what: &'static str,
    },
    /// Some of the release's shards are missing.
    #[error("shards are missing: {0}")]
    Missing(String),
    /// The jobs were not run from the recipe that the shards state.
    #[error("the shards were not made from the recipe that they state: mint the shards again")]
    OtherRecipe,
    /// The release cannot be minted from the jobs.
    #[error(transparent)]
    Mint(MintError),
    /// A file system operation failed.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

impl From<MintError> for MergeError {
    fn from(error: MintError) -> MergeError {
        match error {
            MintError::Snapshot(error) => MergeError::Snapshot(error),
            other => MergeError::Mint(other),
        }
    }
}

/// All shards of a release.
#[derive(Debug)]
pub struct Shards {
    recipe: Recipe,
    plan: Digest,
    /// Each shard, with its folder and the paths of its job files.
    shards: Vec<(PathBuf, Shard, BTreeSet<String>)>,
    /// The folder and the expected content of each job file, by path.
    jobs: BTreeMap<String, (PathBuf, Item)>,
}

impl Shards {
    /// Opens the shards in the given folders, in any order. The shards' content is not trusted.
    ///
    /// # Errors
    /// Returns an error if a folder is not a shard, its version or recipe differs from the first shard's, or a shard
    /// is missing or duplicate.
    pub fn open(folders: &[PathBuf]) -> Result<Shards, MergeError> {
        let mut read = Vec::new();
        for folder in folders {
            read.push((folder, shard_file(folder)?));
        }
        let Some((first, head)) = read.first() else {
            return Err(MergeError::Missing("no shard was given".to_owned()));
        };
        let mut numbers: BTreeMap<u32, &PathBuf> = BTreeMap::new();
        let mut jobs = BTreeMap::new();
        for (folder, file) in &read {
            let apart = |two: &Path, what| MergeError::Apart {
                one: two.to_path_buf(),
                two: folder.to_path_buf(),
                what,
            };
            if file.recipe != head.recipe || file.plan != head.plan {
                return Err(apart(first, "the shards belong to different recipes"));
            }
            if file.shard.of != head.shard.of {
                return Err(apart(first, "the shards belong to mints with different numbers of shards"));
            }
            if let Some(other) = numbers.insert(file.shard.number, folder) {
                return Err(apart(other, "both folders hold the same shard"));
            }
            for item in &file.jobs {
                jobs.insert(item.path.clone(), (folder.to_path_buf(), item.clone()));
            }
        }
        let missing: Vec<String> = (1..=head.shard.of)
            .filter(|number| !numbers.contains_key(number))
            .map(|number| format!("{number}/{}", head.shard.of))
            .collect();
        if !missing.is_empty() {
            return Err(MergeError::Missing(missing.join(", ")));
        }
        head.recipe.check().map_err(|error| unsound(first, format!("the shard's recipe: {error}")))?;
        let paths = |file: &ShardFile| file.jobs.iter().map(|item| item.path.clone()).collect();
        let shards = read.iter().map(|(folder, file)| ((*folder).clone(), file.shard, paths(file))).collect();
        Ok(Shards { recipe: head.recipe.clone(), plan: head.plan, shards, jobs })
    }

    /// Makes all checks that are cheap compared with minting. Each shard must contain exactly the jobs that the plan
    /// deals to it. Every game in the jobs must match its card, and the game's witnesses must replay to wins on its
    /// own levels.
    ///
    /// Only minting again can show that the seed produces these games, and that the judges measured these figures.
    /// Cost: a replay of every witness, on all threads of the current rayon pool.
    ///
    /// # Errors
    /// Returns an error if a shard or a job's result differs from its minted form, or if a file system operation
    /// fails.
    pub fn check(&self, plan: &Plan<'_>) -> Result<(), MergeError> {
        for (folder, shard, listed) in &self.shards {
            let dealt: BTreeSet<String> =
                shard.jobs(plan).into_iter().map(|job| path(&plan.name(job))).collect();
            if let Some(other) = listed.symmetric_difference(&dealt).next() {
                let what = if dealt.contains(other) { "lacks" } else { "lists" };
                let why = format!("{what} `{}`, unlike shard {shard} of this plan", other.escape_debug());
                return Err(unsound(folder, why));
            }
        }
        let names: Vec<String> = plan.jobs().iter().map(|job| plan.name(*job)).collect();
        names.par_iter().try_for_each(|name| {
            let place = |what: String| {
                let place = self.jobs.get(&path(name)).map(|(folder, item)| folder.join(&item.path));
                MergeError::Unsound { path: place.unwrap_or_default(), what }
            };
            let job =
                self.get(name)?.ok_or_else(|| place("not a job of this plan: mint the job again".into()))?;
            let wrong = job.games.iter().find_map(|game| problem(game, plan.seed, plan.recipe));
            wrong.map_or(Ok(()), |what| {
                Err(place(format!("{what}; no mint produces such a result, so mint the job again")))
            })
        })
    }

    /// Returns the recipe common to all shards.
    pub fn recipe(&self) -> &Recipe {
        &self.recipe
    }

    /// Returns `true` if the shards contain the jobs of this plan.
    pub fn are_of(&self, plan: &Plan<'_>) -> Result<bool, SnapshotError> {
        Ok(plan.digest()? == self.plan)
    }
}

/// Returns the first problem with a game in a job's result; `None` if there is no problem. `root` is the plan's root
/// seed.
fn problem(frozen: &FrozenGame, root: Seed, recipe: &Recipe) -> Option<String> {
    let FrozenGame { text, card, difficulties, levels, witnesses, paths, .. } = frozen;
    let id = card.id.escape_debug();
    let Ok(game) = Game::from_source(text) else { return Some(format!("`{id}` isn't a valid game")) };
    if card.digest != game.digest() || !card.id.ends_with(&game.digest().short()) {
        return Some(format!("`{id}` does not match its card"));
    }
    if levels.is_empty() || levels.len() != witnesses.len() || levels.len() != card.levels.len() {
        return Some(format!("`{id}` has no level, or not exactly one witness and one card entry per level"));
    }
    if difficulties.len() != card.levels.iter().filter(|level| level.ladder.is_some()).count() {
        return Some(format!("`{id}` does not have one difficulty per ladder"));
    }
    let is_foreign = |(path, episode): (&Vec<SeedStep>, &Episode)| {
        !path.is_empty() && SeedPath::new(root, path.clone()).seed() != episode.seed
    };
    if paths.len() != witnesses.len() || paths.iter().zip(witnesses).any(is_foreign) {
        return Some(format!("`{id}` has a witness whose randomness does not come from the plan's seed"));
    }
    let of_level = |((number, text), (episode, told)): ((usize, &String), (&Episode, &LevelCard))| {
        let Ok(level) = game.level(text) else { return Some("not a level of the game".to_owned()) };
        if told.file != format!("lvl{number}.txt") || told.digest != level.digest() {
            return Some("the level does not match its card".to_owned());
        }
        if (episode.actions.len(), episode.score) != (told.witness_ticks, told.witness_score) {
            return Some("the ticks and score of the witness differ from those in the card".to_owned());
        }
        number_problems(told, &level).into_iter().next().or_else(|| replay_problem(episode, &game, &level))
    };
    let each = levels.iter().enumerate().zip(witnesses.iter().zip(&card.levels));
    let wrong = each.enumerate();
    let wrong = wrong.map(|(number, level)| Some(format!("`{id}`, level {number}: {}", of_level(level)?)));
    let added = || SECTIONS.iter().find_map(|section| section.job_problem(recipe, frozen, &game, root));
    wrong.flatten().next().or_else(|| Some(format!("`{id}`: {}", added()?)))
}

fn unsound(folder: &Path, what: String) -> MergeError {
    MergeError::Unsound { path: folder.join(SHARD_FILE), what }
}

fn shard_file(folder: &Path) -> Result<ShardFile, MergeError> {
    let bytes = folder::find(folder, SHARD_FILE, MANIFEST_LIMIT)?;
    let bytes = bytes.ok_or_else(|| MergeError::NotAShard(folder.to_path_buf()))?;
    let syntax = |error: serde_json::Error| unsound(folder, error.to_string());
    let Version { format } = serde_json::from_slice(&bytes).map_err(syntax)?;
    if format != SHARD_FORMAT {
        return Err(unsound(
            folder,
            format!(
                "shard format {format} is not {SHARD_FORMAT}: use the version of arcade that made the shard"
            ),
        ));
    }
    let file: ShardFile = serde_json::from_slice(&bytes).map_err(syntax)?;
    if (file.generation, file.semantics) != (generators::GENERATION, engine::SEMANTICS) {
        let made_by = MintedBy { version: None, generation: file.generation, semantics: file.semantics };
        let what = format!(
            "made by {made_by}, but this is arcade {CURRENT}; merge with the version that made the shard"
        );
        return Err(unsound(folder, what));
    }
    let Shard { number, of } = file.shard;
    if number == 0 || number > of {
        return Err(unsound(folder, format!("there is no shard {number}/{of}")));
    }
    for item in &file.jobs {
        if let Err(problem) = crate::check_path(&item.path) {
            return Err(unsound(folder, format!("`{}` isn't a valid path for a job: {problem}", item.path)));
        }
    }
    Ok(file)
}

impl JobStore for Shards {
    fn get(&self, name: &str) -> Result<Option<JobResult>, SnapshotError> {
        let Some((folder, item)) = self.jobs.get(&path(name)) else { return Ok(None) };
        let bytes = folder::read(folder, &item.path, Limits::SNAPSHOT.file_bytes)?;
        if Digest::of(&bytes) != item.digest {
            return Err(SnapshotError::Altered(folder.join(&item.path)));
        }
        JobFolder::parse(self.plan, &bytes)
    }

    fn put(&self, _: &str, _: &JobResult) -> Result<(), SnapshotError> {
        unreachable!("shards are read only")
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Memory, make_jobs, tests};
    use super::*;
    use crate::recipe::secret::Secret;
    use crate::sections::memory;
    use std::fs;

    #[test]
    fn shards_are_numbered_from_one() {
        for good in ["1/1", "2/4", "4/4"] {
            assert_eq!(good.parse::<Shard>().unwrap().to_string(), good);
        }
        for bad in ["", "1", "0/4", "5/4", "1/0", "a/b", "1/20000", "-1/3"] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
    }

    /// Checks a one-job shard after a forger has changed it and updated the digests of the changed files.
    #[track_caller]
    fn check(alter: impl Fn(&mut FrozenGame), list: impl Fn(&mut ShardFile), expect: Option<&str>) {
        check_of(&tests::recipe("a"), None, alter, list, expect);
    }

    #[track_caller]
    fn check_of(
        recipe: &Recipe,
        secret: Option<&Secret>,
        alter: impl Fn(&mut FrozenGame),
        list: impl Fn(&mut ShardFile),
        expect: Option<&str>,
    ) {
        let corpus = tests::corpus(&[("fetch", tests::FETCH)]);
        let plan = Plan::new(recipe, secret, &corpus).unwrap();
        let store = Memory::default();
        make_jobs(&plan, plan.jobs(), &store, &()).unwrap();
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("shard");
        let draft = Draft::create(&folder).unwrap();
        "1/1".parse::<Shard>().unwrap().write(&plan, &store, &draft).unwrap();
        draft.commit().unwrap();

        let mut file = shard_file(&folder).unwrap();
        let place = folder.join(&file.jobs[0].path);
        let digest = plan.digest().unwrap();
        let bytes = fs::read(&place).unwrap();
        let mut job: JobResult = JobFolder::parse(digest, &bytes).unwrap().unwrap();
        alter(&mut job.games[0]);
        let text = JobFolder::text(digest, &job).unwrap();
        fs::write(&place, &text).unwrap();
        file.jobs[0] = Item::of(file.jobs[0].path.clone(), text.as_bytes());
        list(&mut file);
        fs::write(folder.join(SHARD_FILE), to_canonical_json(&file).unwrap()).unwrap();

        let shards = Shards::open(&[folder]).unwrap();
        assert!(shards.are_of(&plan).unwrap());
        match (shards.check(&plan), expect) {
            (Ok(()), None) => {}
            (Err(error), Some(words)) => assert!(error.to_string().contains(words), "{error}"),
            (found, expect) => panic!("{found:?}, not {expect:?}"),
        }
    }

    /// Withheld renamed copies (siblings) and withheld witnesses are also checked.
    #[test]
    fn forged_pairs_are_not_merged() {
        let open = tests::recipe("a");
        let memory = Some(memory::part::MemoryPart::default());
        let mut recipe = Recipe { seed: None, memory, ..open };
        let secret = Secret::draw("one", recipe.committed(), [7; 64]);
        recipe.commitment = Some(secret.commitment());
        let check = |alter: &dyn Fn(&mut FrozenGame), expect: Option<&str>| {
            check_of(&recipe, Some(&secret), alter, |_| (), expect);
        };
        check(&|game| assert!(game.sibling.is_some() && game.seconds[0].is_some()), None);
        check(
            &|game| game.seconds.push(None),
            Some("the number of second wins differs from the number of levels"),
        );
        let second = |game: &mut FrozenGame| game.seconds[0].clone().unwrap();
        let with = |game: &mut FrozenGame, second| game.seconds[0] = Some(second);
        let foreign = |game: &mut FrozenGame| {
            let known = second(game);
            with(game, memory::SecondWin { path: Vec::new(), ..known });
        };
        check(&foreign, Some("invalid second win: the randomness does not come"));
        let same = |game: &mut FrozenGame| {
            let (episode, path) = (game.witnesses[0].clone(), game.paths[0].clone());
            with(game, memory::SecondWin { episode, path });
        };
        check(&same, Some("the second win begins like the published win"));
        let changed = |game: &mut FrozenGame| {
            let sibling = game.sibling.as_mut().unwrap();
            sibling.text = sibling.text.replace("limit=50", "limit=51");
        };
        check(&changed, Some("invalid sibling: the rules are not those"));
    }

    #[test]
    fn forged_jobs_are_not_merged() {
        let same = |_: &mut ShardFile| ();
        check(|_| (), same, None);
        check(|game| game.text = "BasicGame".into(), same, Some("isn't a valid game"));
        check(|game| game.text = tests::FETCH.into(), same, Some("does not match its card"));
        check(|game| game.levels[0] = "x".into(), same, Some("level 0: not a level of the game"));
        check(|game| drop(game.witnesses.pop()), same, Some("one witness and one card entry per level"));
        check(
            |game| game.difficulties.push(validators::Difficulty::Easy),
            same,
            Some("does not have one difficulty per ladder"),
        );
        check(|game| game.marks.push(Vec::new()), same, Some("marks that the recipe does not request"));
        let ceilings = |game: &mut FrozenGame| {
            game.ceilings.push(serde_json::from_str("{\"exact\": true, \"ceilings\": []}").unwrap());
        };
        check(ceilings, same, Some("ceilings that the recipe does not request"));
        check(|game| game.card.levels[0].difficulty = 1e300, same, Some("level 0: the difficulty 1"));
        check(|game| game.card.levels[0].random.wins = 99, same, Some("`random` has 99 wins"));
        check(
            |game| game.card.levels[0].witness_ticks += 1,
            same,
            Some("the ticks and score of the witness differ"),
        );
        check(
            |game| game.witnesses[0].seed = Seed::from_text("x"),
            same,
            Some("whose randomness does not come from the plan's seed"),
        );
        let action = |game: &mut FrozenGame| game.witnesses[0].hashes.swap(0, 1);
        check(action, same, Some("level 0: the state after tick 0"));
        check(|_| (), |file| drop(file.jobs.pop()), Some("lacks `jobs/corpus-fetch.json`"));
        let other = |file: &mut ShardFile| file.jobs.push(Item::of("jobs/constructive-7.json", b""));
        check(|_| (), other, Some("lists `jobs/constructive-7.json`"));
    }
}

//! Minting: generating, judging and selecting candidates.
//!
//! A recipe is turned into a [`Plan`]: a list of independent jobs, each with its own seed. [`Plan::make`]
//! runs a job, and the result is saved in a [`JobStore`]. After all jobs have finished, games are selected
//! from the results according to the recipe's quotas and difficulty histogram, and written as files. Both
//! steps depend only on the recipe, not on threads, order, machines, time or interruptions.

mod card;
pub(crate) mod error;
mod folder;
mod freeze;
mod job_store;
pub(crate) mod plan;
mod select;
mod shard;

use crate::Digest;
use crate::card::ReleaseCard;
use crate::error::SnapshotError;
use crate::format::manifest::Manifest;
use crate::recipe::secret::Secret;
use crate::sections::frozen::{FrozenGame, JobResult};
pub use error::MintError;
pub use folder::Sink;
use forge::Tally;
use forge::card::Card;
pub use job_store::{JobFolder, JobStore, Memory};
pub use plan::forecast::Forecast;
pub use plan::{Job, Plan};
use rayon::prelude::*;
use select::{Contender, Part, select};
pub use shard::{MergeError, SHARD_FILE, Shard, Shards};
use std::fmt;

/// A release with all files written to the sink.
#[derive(Clone, Debug)]
pub struct Minted {
    /// The manifest, including the root.
    pub manifest: Manifest,
    /// The cards of the games, corpus games first.
    pub cards: Vec<Card>,
    /// The release's summary.
    pub card: ReleaseCard,
}

/// A warning about a request that can be minted nevertheless.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Remark {
    /// There are rule sets for at most the given number of new games, which is hardly more than the recipe requests.
    FewRules(usize),
    /// The shard (a separately minted part of a release) has no jobs.
    EmptyShard,
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Remark::FewRules(most) => write!(
                f,
                "there are rules for at most {most} new games, and some candidates fail: fewer games may \
                 pass than the recipe requests"
            ),
            Remark::EmptyShard => f.write_str("there are more shards than jobs: this shard is empty"),
        }
    }
}

/// An observer of a mint, called from several threads. `()` ignores all events.
pub trait Progress: Sync {
    /// Receives each warning before anything is written.
    fn remark(&self, _remark: &Remark) {}
    /// Receives the remaining jobs before they run. From this point on, the mint can be resumed.
    fn start(&self, _plan: &Plan<'_>, _left: &[Job]) {}
    /// Receives the total number of jobs, and the number of jobs already done.
    fn begin(&self, _jobs: usize, _made: usize) {}
    /// Receives the name and the games of a job that has finished.
    fn made(&self, _name: &str, _games: &[FrozenGame]) {}
    /// Marks the end of all jobs. The release or the shard (a part of it) is written afterwards.
    fn finish(&self) {}
}

impl Progress for () {}

/// Returns the jobs whose results are not in the store yet.
///
/// # Errors
/// Returns an error if a result cannot be read.
pub fn jobs_left(plan: &Plan<'_>, jobs: &[Job], store: &dyn JobStore) -> Result<Vec<Job>, SnapshotError> {
    let mut left = Vec::new();
    for &job in jobs {
        if store.get(&plan.name(job))?.is_none() {
            left.push(job);
        }
    }
    Ok(left)
}

/// Runs the jobs whose results are not in the store yet.
///
/// Cost: minutes for tens of games, on all threads of the current rayon pool.
///
/// # Errors
/// Returns an error if the criteria are invalid, or if a result cannot be stored.
pub fn make_jobs(
    plan: &Plan<'_>,
    jobs: &[Job],
    store: &dyn JobStore,
    progress: &dyn Progress,
) -> Result<(), MintError> {
    let open = jobs_left(plan, jobs, store)?;
    progress.begin(jobs.len(), jobs.len() - open.len());
    let make = |&job: &Job| {
        let result = plan.make(job)?;
        let name = plan.name(job);
        store.put(&name, &result)?;
        progress.made(&name, &result.games);
        Ok(())
    };
    // Long jobs come first. Each free thread takes the next job.
    open.par_iter().with_max_len(1).try_for_each(make)
}

/// Selects a release's games from the results of all jobs, and passes its files to the sink. Only the games'
/// metadata is kept in memory.
///
/// # Errors
/// Returns an error if a job's result is missing or unsound, the candidates do not meet the recipe's requirements, or
/// the sink fails.
pub fn lay_out(
    plan: &Plan<'_>,
    secret: Option<&Secret>,
    store: &dyn JobStore,
    lockfile: Digest,
    sink: &mut Sink<'_>,
) -> Result<Minted, MintError> {
    let job = |at: usize| {
        let name = plan.name(plan.jobs()[at]);
        store.get(&name)?.ok_or(MintError::Missing(name))
    };
    let mut contenders = Vec::new();
    let (mut tally, mut of_corpus) = (Tally::default(), Tally::default());
    for at in plan.in_order() {
        let JobResult { games, tally: spent } = job(at)?;
        for (number, game) in games.iter().enumerate() {
            let unsound = || MintError::Unsound(plan.name(plan.jobs()[at]));
            let part = Part::of(plan.jobs()[at]);
            contenders.push(Contender::of(part, (at, number), game).ok_or_else(unsound)?);
        }
        match plan.jobs()[at] {
            Job::Corpus(_) => of_corpus.add(&spent),
            _ => tally.add(&spent),
        }
    }
    let taken = select(plan, &contenders, [&of_corpus, &tally])?;
    tally.add(&of_corpus);
    let mut folder = folder::Folder::new(plan, sink);
    for &taken in &taken {
        let Contender { job: of, at, .. } = contenders[taken];
        // A witness can be checked after the reveal only if the steps from the secret to the witness's seed are
        // known.
        let is_traced = |game: &FrozenGame| !plan.is_sealed() || game.is_traced();
        let game = job(of)?.games.into_iter().nth(at).filter(is_traced);
        folder.game(game.ok_or_else(|| MintError::Unsound(plan.name(plan.jobs()[of])))?)?;
    }
    let cards = folder.cards();
    let card = ReleaseCard::of(plan, &contenders, &taken, &cards, tally);
    let manifest = folder.finish(secret, lockfile, &cards, &card)?;
    Ok(Minted { manifest, cards, card })
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::mint::plan::corpus::{Corpus, CorpusCard, CorpusGame};
    use crate::recipe::Recipe;
    use base::{Seed, SeedPath, SeedStep};
    use forge::card::Origin;

    /// A game about collecting the gem and leaving before time is up.
    pub(super) const FETCH: &str = "BasicGame
    SpriteSet
        floor > Immovable
        wall > Immovable
        gem > Immovable color=YELLOW
        exit > Door color=GREEN
        avatar > MovingAvatar
    LevelMapping
        . > floor
        w > floor wall
        g > floor gem
        e > floor exit
        A > floor avatar
    InteractionSet
        avatar wall > stepBack
        gem avatar > killSprite scoreChange=1
        exit avatar > killSprite
    TerminationSet
        MultiSpriteCounter stype1=gem stype2=exit limit=0 win=True
        Timeout limit=50 win=False
";

    pub(super) fn corpus(sources: &[(&str, &str)]) -> Corpus {
        let game = |&(name, source): &(&str, &str)| {
            let words = || name.to_owned();
            let card = CorpusCard {
                title: words(),
                description: words(),
                goal: words(),
                kind: words(),
                real_time: false,
                skill: words(),
                levels: Vec::new(),
            };
            CorpusGame { name: words(), source: source.to_owned(), levels: Vec::new(), card }
        };
        Corpus { games: sources.iter().map(game).collect(), designs: None }
    }

    /// Returns a recipe for one corpus game with one level.
    pub(crate) fn recipe(seed: &str) -> Recipe {
        let text = format!(
            "name = 'one'\ndescription = 'one'\nseed = '{seed}'\n[corpus]\ngames = 1\nlevels = 1\n\
             [criteria]\nask = ['not-idle', 'not-random', 'winnable']\nbudget = 20000\n"
        );
        Recipe::from_toml(&text).unwrap()
    }

    fn minted(recipe: &Recipe, corpus: &Corpus) -> Result<Minted, MintError> {
        let plan = Plan::new(recipe, None, corpus)?;
        let store = Memory::default();
        make_jobs(&plan, plan.jobs(), &store, &())?;
        lay_out(&plan, None, &store, Digest::of(b""), &mut |_, _| Ok(()))
    }

    /// More candidates of one kind shift the scenes of the kinds after it, so their finished jobs cannot be used again.
    #[test]
    fn finished_puzzles_are_kept_only_with_their_scenes() {
        let digest = |puzzles: &str, strays: &str| {
            let text = format!(
                "name = 'one'\ndescription = 'one'\nseed = 'scenes'\n[puzzles]\ngames = 2\ncandidates = {puzzles}\n\
                 [strays]\ngames = 2\ncandidates = {strays}\n[tiers]\n2 = 1.0\n"
            );
            let recipe = Recipe::from_toml(&text).unwrap();
            Plan::new(&recipe, None, &corpus(&[])).unwrap().digest().unwrap()
        };
        assert_eq!(digest("1.0", "1.0"), digest("1.0", "2.0"));
        assert_ne!(digest("1.0", "1.0"), digest("2.0", "1.0"));
    }

    /// Puzzles have the requested tiers, their cards state the tiers, and their witnesses' seeds can be
    /// traced.
    #[test]
    fn puzzles_are_minted_to_tiers() {
        let text = "name = 'one'\ndescription = 'one'\nseed = 'tiers'\n[puzzles]\ngames = 1\nlevels = 2\n\
                    level_tries = 12\ncandidates = 1.0\ncolumns = [8, 9]\nrows = [8, 8]\n[locks]\ngames = 1\nlevels = 1\n\
                    level_tries = 12\ncandidates = 1.0\ncolumns = [9, 9]\nrows = [8, 9]\n[yards]\ngames = 1\nlevels = 1\n\
                    level_tries = 12\ncandidates = 1.0\ncolumns = [9, 9]\nrows = [9, 9]\n[strays]\ngames = 1\nlevels = 1\n\
                    level_tries = 12\ncandidates = 1.0\ncolumns = [9, 9]\nrows = [9, 9]\n[tiers]\n2 = 1.0\n[criteria]\n\
                    ask = ['not-idle', 'not-random', 'winnable']\nbudget = 1000000\nshortest = 1.0\nmcts_plays = 1\n";
        let recipe = Recipe::from_toml(text).unwrap();
        let corpus = corpus(&[]);
        let plan = Plan::new(&recipe, None, &corpus).unwrap();
        let store = Memory::default();
        make_jobs(&plan, plan.jobs(), &store, &()).unwrap();
        for &job in plan.jobs() {
            let game = &store.get(&plan.name(job)).unwrap().unwrap().games[0];
            assert!(game.paths.iter().all(|path| !path.is_empty()), "{job:?}");
        }
        let Minted { cards, card, .. } = minted(&recipe, &corpus).unwrap();
        assert_eq!((cards.len(), card.tiers.get("2")), (4, Some(&5)));
        assert!(cards[0].origin.mechanics().iter().all(|name| name.starts_with("puzzle/")));
        for (card, level) in cards.iter().flat_map(|card| card.levels.iter().map(move |level| (card, level)))
        {
            let demand = level.demand.as_ref().unwrap();
            assert_eq!((level.tier, demand.ticks), (Some(demand.tier()), level.witness_ticks));
            assert!((20..50).contains(&demand.decisions), "{demand:?}");
            assert_eq!(demand.shortest, card.deterministic, "{demand:?}");
        }
    }

    #[test]
    fn a_corpus_game_without_new_levels_makes_room_for_the_next_of_the_draw() {
        let hopeless = FETCH
            .replace("gem avatar > killSprite scoreChange=1", "avatar gem > stepBack")
            .replace("exit avatar > killSprite", "avatar exit > stepBack");
        let corpus = corpus(&[("fetch", FETCH), ("hopeless", &hopeless)]);
        // Each of the two games must be drawn first for some seed.
        let mut first = Vec::new();
        for seed in ["a", "b", "c", "d", "e", "f"] {
            let recipe = recipe(seed);
            first.push(Plan::new(&recipe, None, &corpus).unwrap().jobs()[0]);
            let minted = minted(&recipe, &corpus).unwrap();
            let origins: Vec<&Origin> = minted.cards.iter().map(|card| &card.origin).collect();
            assert_eq!(origins, [&Origin::Corpus { name: "fetch".to_owned() }]);
        }
        assert!(first.contains(&Job::Corpus(0)) && first.contains(&Job::Corpus(1)), "{first:?}");
    }

    /// Without the seed paths, a sealed release could not show that its witnesses were played under its
    /// secret.
    #[test]
    fn games_leave_a_way_from_the_seed_to_the_witness() {
        let check = |root: Seed, game: &FrozenGame| {
            assert_eq!(game.paths.len(), game.witnesses.len());
            for (path, witness) in game.paths.iter().zip(&game.witnesses) {
                assert_eq!(SeedPath::new(root, path.clone()).seed(), witness.seed, "{path:?}");
            }
        };
        let text = "name = 'one'\ndescription = 'one'\nseed = 'x'\n[generated]\ngames = 1\nlevels = 1\nkinds = ['key-and-door']\nleast_interactions = 3\n\
            least_mechanics = 1\ncandidates = 1.0\n[corpus]\ngames = 1\nlevels = 2\n[criteria]\n\
            ask = ['not-idle', 'not-random', 'winnable']\nbudget = 100000\ndecision = 50\nmcts_plays = 1\n";
        let recipe = Recipe::from_toml(text).unwrap();
        let corpus = corpus(&[("fetch", FETCH)]);
        let plan = Plan::new(&recipe, None, &corpus).unwrap();
        for &job in plan.jobs() {
            let games = plan.make(job).unwrap().games;
            assert_eq!(games.len(), 1, "{job:?}");
            check(plan.seed, &games[0]);
        }
        // If tiers (difficulty classes) are measured, shorter wins replace the witnesses of stochastic levels.
        let moths = FETCH
            .replace("avatar > MovingAvatar", "moth > RandomNPC color=GRAY\n        avatar > MovingAvatar")
            .replace("A > floor avatar", "m > floor moth\n        A > floor avatar")
            .replace(
                "avatar wall > stepBack",
                "avatar wall > stepBack\n        moth wall > stepBack\n        avatar moth > killSprite",
            )
            .replace("Timeout", "SpriteCounter stype=avatar win=False\n        Timeout")
            .replace("limit=50", "limit=200");
        let text = "name = 'one'\ndescription = 'one'\nseed = 'm'\n[corpus]\ngames = 1\nlevels = 4\n[tiers]\n1 = 1.0\n[criteria]\n\
            ask = ['not-idle', 'not-random', 'winnable']\nbudget = 20000\ndecision = 20\nmcts_plays = 1\n";
        let tiers = Recipe::from_toml(text).unwrap();
        let corpus = self::corpus(&[("moths", &moths)]);
        let plan = Plan::new(&tiers, None, &corpus).unwrap();
        let games = plan.make(plan.jobs()[0]).unwrap().games;
        check(plan.seed, &games[0]);
        let is_shorter = |path: &Vec<SeedStep>| path.iter().any(|(purpose, _)| purpose == "shorter win");
        assert!(games[0].paths.iter().any(is_shorter), "{:?}", games[0].card.levels);
    }

    /// The estimate of a dry run differs by at most a quarter from the cost stated in `docs/how-to/mint.md`.
    #[test]
    fn estimates_are_near_to_what_was_measured() {
        let page = include_str!("../../../../docs/how-to/mint.md");
        let (_, rows) = page.split_once("| recipe | measured, in seconds of one core |").unwrap();
        let measured = |name: &str| -> f64 {
            let row = rows.lines().find_map(|row| row.strip_prefix(&format!("| `{name}` | "))).unwrap();
            row.split(' ').next().unwrap().parse().unwrap()
        };
        let names: Vec<String> = (0..28).map(|number| format!("game-{number}")).collect();
        let games: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), FETCH)).collect();
        let corpus = corpus(&games);
        for (name, text) in [
            ("tiny", include_str!("../../../../seeds/tiny.toml")),
            ("starter", include_str!("../../../../seeds/starter.toml")),
        ] {
            let recipe = Recipe::from_toml(text).unwrap();
            let plan = Plan::new(&recipe, None, &corpus).unwrap();
            let Forecast { median, tail } = plan.forecast(plan.jobs());
            let ratio = median / measured(name);
            // The cost of a few inventions depends strongly on the seed, so only the forecast's own range
            // applies.
            let range = match recipe.invented {
                None => 0.75..=1.25,
                Some(_) => median / tail..=tail / median,
            };
            assert!(range.contains(&ratio), "{name}: {ratio} of what was measured");
            assert!(tail > measured(name), "{name}: {tail}");
        }
    }

    /// Five mints from a recipe without `[criteria]` took 19 to 99 core seconds. The forecast's median lies
    /// within this range, and its tail above it.
    #[test]
    fn a_forecast_covers_what_other_seeds_cost() {
        let text = "name = 'one'\ndescription = 'one'\nseed = 'x'\n[generated]\ngames = 6\n";
        let recipe = Recipe::from_toml(text).unwrap();
        let corpus = corpus(&[]);
        let plan = Plan::new(&recipe, None, &corpus).unwrap();
        let Forecast { median, tail } = plan.forecast(plan.jobs());
        assert!((26.0..=52.0).contains(&median) && (80.0..=200.0).contains(&tail), "{median} {tail}");
        // The remaining jobs are only part of a mint, and a smaller sum has a greater relative uncertainty.
        let left = plan.forecast(&plan.jobs()[..2]);
        assert!(left.median < median / 3.0 && left.tail / left.median > tail / median, "{left:?}");
        assert_eq!(plan.forecast(&[]), Forecast { median: 0.0, tail: 0.0 });
    }

    /// A recipe can no longer be changed after the commitment, so an unfillable recipe is rejected
    /// beforehand.
    #[test]
    fn recipes_that_cannot_be_filled_are_refused() {
        let check = |generated: &str, expect: Option<&str>| {
            let text = format!("name = 'one'\ndescription = 'one'\nseed = 'x'\n[generated]\n{generated}\n");
            let recipe = Recipe::from_toml(&text).unwrap();
            let corpus = corpus(&[]);
            let supply = Plan::new(&recipe, None, &corpus).unwrap().supply();
            match expect {
                None => assert!(supply.is_ok(), "{generated}: {supply:?}"),
                Some(words) => {
                    let error = supply.unwrap_err().to_string();
                    assert!(error.contains(words), "{error}");
                }
            }
        };
        check("games = 6", None);
        check("games = 3\nkinds = ['rescue']", None);
        check(
            "games = 40\nkinds = ['rescue']",
            Some("sets of rules of the kinds rescue; lower `generated.games`"),
        );
        check("games = 600", Some("`generated.games` is 600, but the limit is "));
        // The limit depends on the recipe, not on its seed.
        let limit = |seed: &str| {
            let text =
                format!("name = 'one'\ndescription = 'one'\nseed = '{seed}'\n[generated]\ngames = 600\n");
            let (recipe, corpus) = (Recipe::from_toml(&text).unwrap(), corpus(&[]));
            Plan::new(&recipe, None, &corpus).unwrap().supply().unwrap_err().to_string()
        };
        assert_eq!(limit("x"), limit("supply"));
    }

    #[test]
    fn a_broken_game_of_the_corpus_is_told() {
        let corpus = corpus(&[("fetch", FETCH), ("torn", "BasicGame\n    SpriteSet\n")]);
        let error = minted(&recipe("a"), &corpus).unwrap_err();
        assert!(matches!(&error, MintError::BrokenCorpus { name, .. } if name == "torn"), "{error}");
    }

    #[test]
    fn too_few_candidates_are_told_with_what_stood_in_their_way() {
        let hopeless = FETCH.replace("gem avatar > killSprite scoreChange=1", "avatar gem > stepBack");
        let error = minted(&recipe("a"), &corpus(&[("hopeless", &hopeless)])).unwrap_err().to_string();
        assert!(
            error.contains(
                "`corpus.games` is 1, but only 0 candidates can be selected (96 failed `winnable`, 8 \
                 without level 0)"
            ),
            "{error}"
        );
    }

    /// A commitment covers the recipe, so the recipe's numbers cannot be raised afterwards.
    #[test]
    fn a_sealed_recipe_that_falls_short_is_committed_to_again() {
        let hopeless = FETCH.replace("gem avatar > killSprite scoreChange=1", "avatar gem > stepBack");
        let mut recipe = Recipe { seed: None, ..recipe("a") };
        let secret = Secret::draw(&recipe.name, recipe.committed(), [7; 64]);
        recipe.commitment = Some(secret.commitment());
        let corpus = corpus(&[("hopeless", &hopeless)]);
        let plan = Plan::new(&recipe, Some(&secret), &corpus).unwrap();
        let store = Memory::default();
        make_jobs(&plan, plan.jobs(), &store, &()).unwrap();
        let laid = lay_out(&plan, Some(&secret), &store, Digest::of(b""), &mut |_, _| Ok(()));
        let error = laid.unwrap_err().to_string();
        assert!(error.contains("--commit") && !error.contains("--resume"), "{error}");
    }

    /// If no rules are left, additional jobs would not help, so the advice is different.
    #[test]
    fn no_rules_left_is_told_with_another_advice_than_more_candidates() {
        let text = "name = 'one'\ndescription = 'one'\nseed = 'x'\n[generated]\ngames = 1\nlevels = 1\n";
        let recipe = Recipe::from_toml(text).unwrap();
        let corpus = corpus(&[]);
        let plan = Plan::new(&recipe, None, &corpus).unwrap();
        let store = Memory::default();
        let mut tally = Tally::default();
        tally.rejections.insert(forge::games::NO_RULES.to_owned(), 1);
        for &job in plan.jobs() {
            let result = JobResult { games: Vec::new(), tally: tally.clone() };
            store.put(&plan.name(job), &result).unwrap();
        }
        let error =
            lay_out(&plan, None, &store, Digest::of(b""), &mut |_, _| Ok(())).unwrap_err().to_string();
        assert!(error.contains("lower `generated.games`") && !error.contains("raise"), "{error}");
    }

    /// Stored results are not recomputed, and the output is byte-identical to that of an undisturbed mint.
    #[test]
    fn a_mint_goes_on_from_what_is_on_the_shelf() {
        struct Count(std::sync::Mutex<Vec<String>>);
        impl Progress for Count {
            fn made(&self, name: &str, _: &[FrozenGame]) {
                self.0.lock().unwrap().push(name.to_owned());
            }
        }
        let corpus = corpus(&[("fetch", FETCH), ("gather", &FETCH.replace("limit=50", "limit=60"))]);
        let recipe = recipe("a");
        let plan = Plan::new(&recipe, None, &corpus).unwrap();
        let store = Memory::default();
        make_jobs(&plan, &plan.jobs()[..1], &store, &()).unwrap();
        let count = Count(std::sync::Mutex::default());
        make_jobs(&plan, plan.jobs(), &store, &count).unwrap();
        assert_eq!(count.0.into_inner().unwrap(), [plan.name(plan.jobs()[1])]);
        let resumed = lay_out(&plan, None, &store, Digest::of(b""), &mut |_, _| Ok(())).unwrap();
        assert_eq!(resumed.manifest.root, minted(&recipe, &corpus).unwrap().manifest.root);
    }
}

//! A recipe's plan: a list of independent jobs, each with its own seed.

pub(crate) mod corpus;
pub(crate) mod forecast;
mod supply;

use crate::Digest;
use crate::error::SnapshotError;
use crate::format::canary::canary;
use crate::mint::error::MintError;
use crate::mint::plan::corpus::Corpus;
use crate::recipe::Recipe;
use crate::recipe::apportion::apportion;
use crate::recipe::error::RecipeError;
use crate::recipe::secret::Secret;
use crate::sections::SECTIONS;
use crate::sections::designs;
use crate::sections::frozen::{FrozenGame, JobResult};
use crate::sections::marks::MarkPlayers;
use crate::sections::puzzles::{self, PuzzleKind};
use crate::sections::section::Making;
use base::canonical::canonical_digest;
use base::{Sampler, Seed, SeedPath};
use engine::{Game, Level, syntax};
use forge::Tally;
use forge::card::Origin;
use forge::games::{Candidate, GameEffort, GameOrder, Levels, MadeGame, RuleSets, invent_one, make_one};
use forge::levels::Method;
use generators::games::Rethemed;
use generators::levels::{Examples, LevelConfig};
use std::sync::{Arc, OnceLock};
use validators::novelty::GameForm;
use validators::{CheckedCriteria, Criteria, Criterion, Effort, Panel};

/// A recipe with all the data that is required to mint it.
#[derive(Debug)]
pub struct Plan<'a> {
    /// The recipe to mint.
    pub recipe: &'a Recipe,
    pub(super) seed: Seed,
    corpus: &'a Corpus,
    /// The compiled games, by index in the corpus.
    games: Vec<Game>,
    pub(super) forms: Vec<GameForm>,
    /// The new games of previous releases.
    pub(super) before: Vec<GameForm>,
    jobs: Vec<Job>,
    /// The recipe's criteria.
    pub(super) criteria: CheckedCriteria,
    /// The criteria for corpus game levels.
    corpus_criteria: CheckedCriteria,
    /// The rule sets of new games, divided among the jobs. They are drawn when a job first needs them.
    sets: OnceLock<RuleSets>,
    /// The reference players; `None` if none have been set.
    players: Option<&'a dyn MarkPlayers>,
}

/// A unit of work that is independent of all other jobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Job {
    /// A new game from a kernel (hand-written design), by its number.
    Constructive(u32),
    /// An invented game, by its method and its number within the method.
    Invented(Method, u32),
    /// New levels for a corpus game, by its index in the corpus.
    Corpus(usize),
    /// A new puzzle, by its kind and its number within the kind.
    Puzzle(PuzzleKind, u32),
    /// A design, by its index in the pool.
    Design(usize),
}

/// The number of additional judges per game ([`GameEffort::judges`]). It is lower than in `arcade generate games`,
/// because a monthly release has hardly more candidates than games.
const JUDGES: u64 = 3;

impl<'a> Plan<'a> {
    /// Creates a recipe's plan. `secret` is a sealed release's secret.
    ///
    /// Cost: tens of milliseconds, for compiling the corpus.
    ///
    /// # Errors
    /// Returns an error if the criteria are out of range, the secret of a sealed release does not match its recipe,
    /// the recipe requests more games than the corpus contains, or the corpus is broken.
    pub fn new(
        recipe: &'a Recipe,
        secret: Option<&Secret>,
        corpus: &'a Corpus,
    ) -> Result<Plan<'a>, MintError> {
        let criteria = recipe.criteria.check()?;
        let of_corpus = recipe.corpus.criteria.as_ref().map(Criteria::check).transpose()?;
        let corpus_criteria = of_corpus.unwrap_or_else(|| criteria.clone());
        let seed = recipe.root_seed(secret)?;
        designs::check_pool(recipe, corpus.designs.as_ref())?;
        let compile = |game: &crate::CorpusGame| {
            Game::from_source(&game.source)
                .map_err(|problems| MintError::BrokenCorpus { name: game.name.clone(), problems })
        };
        let games: Vec<Game> = corpus.games.iter().map(compile).collect::<Result<_, _>>()?;
        let forms = games.iter().map(GameForm::of).collect();
        let before = recipe.known.forms()?;
        let (jobs, sets) = (Vec::new(), OnceLock::new());
        let mut plan = Plan {
            recipe,
            seed,
            corpus,
            games,
            forms,
            before,
            jobs,
            criteria,
            corpus_criteria,
            sets,
            players: None,
        };
        let new = plan.puzzles().chain(plan.invented()).chain(plan.designs()).chain(plan.generated());
        plan.jobs = new.chain(plan.of_corpus()?).collect();
        Ok(plan)
    }

    /// Sets the reference players requested in the recipe. Without them, the jobs of a recipe that requests
    /// players fail.
    ///
    /// # Errors
    /// Returns an error if the recipe requests a player that is not available.
    pub fn with_players(mut self, players: &'a dyn MarkPlayers) -> Result<Plan<'a>, MintError> {
        for player in self.recipe.marks.iter().flat_map(|asked| &asked.players) {
            let wrong = |message| RecipeError::Value { key: "marks.players", message };
            players.check(player).map_err(wrong)?;
        }
        self.players = Some(players);
        Ok(self)
    }

    /// Returns `true` if the release is sealed, which means that its seed and witnesses are withheld.
    pub fn is_sealed(&self) -> bool {
        self.recipe.commitment.is_some()
    }

    /// Returns the jobs, longest first.
    pub fn jobs(&self) -> &[Job] {
        &self.jobs
    }

    /// Returns the indices of the jobs in the order in which the release lists their games, corpus games first.
    pub(super) fn in_order(&self) -> Vec<usize> {
        let is_new = |at: &usize| !matches!(self.jobs[*at], Job::Corpus(_));
        let (new, old): (Vec<usize>, Vec<usize>) = (0..self.jobs.len()).partition(is_new);
        old.into_iter().chain(new).collect()
    }

    /// Returns a job's name, which can serve as a file name.
    pub fn name(&self, job: Job) -> String {
        match job {
            Job::Constructive(number) => format!("constructive-{number}"),
            Job::Invented(method, number) => format!("invented-{}-{number}", method.name()),
            Job::Corpus(at) => format!("corpus-{}", self.corpus.games[at].name),
            Job::Puzzle(kind, number) => format!("{}-{number}", kind.name()),
            Job::Design(at) => format!("design-{}", self.corpus.design(at).map_or("", |design| &design.name)),
        }
    }

    /// Returns the canary that every file contains, which identifies the release in text corpora.
    pub fn canary(&self) -> String {
        match self.recipe.commitment {
            // The canary is derived from the recipe's digest, so that distinct recipes have distinct
            // canaries.
            None => {
                canary(&canonical_digest(self.recipe).expect("a checked recipe contains only finite numbers"))
            }
            Some(commitment) => canary(&commitment),
        }
    }

    /// Returns the digest of everything that determines the jobs' results. Plans with the same digest share
    /// their results, even if their recipes differ in other respects.
    ///
    /// # Errors
    /// Returns no error for a checked recipe.
    pub fn digest(&self) -> Result<Digest, SnapshotError> {
        let Recipe { seed, commitment, corpus, generated, board, criteria, .. } = self.recipe;
        let mut decisive = serde_json::json!({
            "generation": generators::GENERATION,
            "semantics": engine::SEMANTICS,
            "seed": seed,
            "commitment": commitment,
            "corpus": [corpus.levels, corpus.game_tries, corpus.level_tries],
            "corpus_criteria": corpus.criteria,
            "generated": [generated.levels, generated.game_tries, generated.level_tries],
            "kinds": generated.kinds,
            "least": [generated.least_interactions, generated.least_mechanics],
            "board": board,
            "criteria": criteria,
        });
        if let Some(part) = &self.recipe.invented {
            decisive["invented"] = serde_json::json!([part.levels, part.game_tries, part.level_tries]);
        }
        if self.recipe.generated.games + self.invented_games() > 0 && !self.before.is_empty() {
            decisive["known"] = serde_json::json!(self.recipe.known);
        }
        // The scene of a puzzle depends on its position among the puzzles of all kinds.
        let first = |kind: PuzzleKind| {
            self.puzzles().position(|job| matches!(job, Job::Puzzle(other, _) if other == kind))
        };
        let firsts: Vec<usize> = PuzzleKind::ALL.into_iter().filter_map(first).collect();
        if firsts.len() > 1 {
            decisive["first_puzzles"] = serde_json::json!(firsts);
        }
        let keys = decisive.as_object_mut().expect("the value was made as an object");
        SECTIONS.iter().for_each(|section| section.decide(self.recipe, keys));
        Ok(canonical_digest(&decisive)?)
    }

    /// Returns the jobs that generate candidates for new games from kernels (hand-written designs).
    fn generated(&self) -> impl Iterator<Item = Job> + use<> {
        let part = &self.recipe.generated;
        (0..candidates(part.games, part.candidates)).map(Job::Constructive)
    }

    /// Returns the number of invented games requested in the recipe.
    fn invented_games(&self) -> u32 {
        self.recipe.invented.as_ref().map_or(0, |part| part.games)
    }

    /// Returns the jobs that generate candidates for invented games, distributed according to the weights of the
    /// recipe's mix.
    fn invented(&self) -> impl Iterator<Item = Job> + use<> {
        let methods = [Method::Evolutionary, Method::Search, Method::Constructive];
        let counts = self.recipe.invented.as_ref().map_or_else(Vec::new, |part| {
            let weights = [part.mix.evolutionary, part.mix.search, part.mix.constructive];
            apportion(candidates(part.games, part.candidates), &weights)
        });
        let all = methods.into_iter().zip(counts);
        all.flat_map(|(method, count)| (0..count).map(move |number| Job::Invented(method, number)))
    }

    /// Returns the jobs that judge designs: one for each design in the pool that has the requested number of levels.
    fn designs(&self) -> impl Iterator<Item = Job> + use<> {
        let part = self.recipe.designs.as_ref().filter(|part| part.games > 0);
        let pool = part.zip(self.corpus.designs.as_ref());
        let fitting = pool.map_or_else(Vec::new, |(part, pool)| pool.fitting(part));
        fitting.into_iter().map(Job::Design)
    }

    /// Returns the jobs that generate candidates for puzzles.
    pub(super) fn puzzles(&self) -> impl Iterator<Item = Job> + use<> {
        let all = |kind: PuzzleKind| {
            let asked =
                self.recipe.puzzles_of(kind).map_or(0, |part| candidates(part.games, part.candidates));
            (0..asked.min(kind.rules() as u32)).map(move |number| Job::Puzzle(kind, number))
        };
        PuzzleKind::ALL.map(all).into_iter().flatten()
    }

    /// Draws the corpus games to use, and returns their jobs.
    fn of_corpus(&self) -> Result<Vec<Job>, MintError> {
        let (asked, known) = (self.recipe.corpus.games, self.corpus.games.len());
        if asked as usize > known {
            return Err(MintError::SmallCorpus { asked, known });
        }
        let mut order: Vec<usize> = (0..known).collect();
        let mut sampler: Sampler = self.seed.child("corpus order", 0).sampler();
        sampler.shuffle(&mut order);
        order.truncate(candidates(asked, self.recipe.corpus.candidates) as usize);
        Ok(order.into_iter().map(Job::Corpus).collect())
    }

    /// Runs a job. Cost: one second to several minutes of core time. Uses all threads of the current rayon pool.
    ///
    /// # Errors
    /// Returns an error if the recipe requests reference results and their players are missing or fail.
    pub fn make(&self, job: Job) -> Result<JobResult, MintError> {
        let seed = self.seed_of(job);
        let (games, tally) = match job {
            Job::Corpus(at) => self.new_levels(at, &seed),
            Job::Puzzle(kind, number) => {
                let place = self.puzzles().position(|other| other == job).expect("the job is one of them");
                puzzles::make(
                    self.recipe,
                    &self.criteria,
                    &puzzles::Request { kind, number, place },
                    self.seed,
                    &seed,
                )
            }
            Job::Design(at) => {
                designs::make(self.corpus.design(at), &self.criteria, &[&self.forms, &self.before], &seed)
            }
            Job::Constructive(number) => self.draw(number, seed),
            Job::Invented(method, number) => self.invent(method, number, seed),
        };
        let criteria = self.criteria_of(job);
        let measured = SECTIONS.iter().any(|section| section.needs_tiers(self.recipe));
        let games = games.into_iter().map(|made| FrozenGame::of(made, criteria, measured));
        let mut games: Vec<FrozenGame> = games.collect();
        let making = Making { recipe: self.recipe, root: self.seed, criteria, players: self.players };
        for section in SECTIONS {
            for game in &mut games {
                let wrong = |message| MintError::Section { section: section.name(), message };
                section.complete(&making, game).map_err(wrong)?;
            }
        }
        Ok(JobResult { games, tally })
    }

    /// Returns the seed of a job, or the seed of its kind if jobs of that kind derive their own seeds.
    fn seed_of(&self, job: Job) -> SeedPath {
        let root = SeedPath::from(self.seed);
        match job {
            Job::Corpus(at) => root.child("corpus", 0).child(&self.corpus.games[at].name, 0),
            Job::Constructive(_) => root.child("constructive", 0),
            Job::Invented(method, _) => root.child("invented", 0).child(method.name(), 0),
            Job::Puzzle(kind, number) => root.child(kind.name(), number.into()),
            Job::Design(at) => {
                root.child("design", 0).child(self.corpus.design(at).map_or("", |design| &design.name), 0)
            }
        }
    }

    /// Returns the criteria for a job's games.
    pub(super) fn criteria_of(&self, job: Job) -> &CheckedCriteria {
        match job {
            Job::Corpus(_) => &self.corpus_criteria,
            _ => &self.criteria,
        }
    }

    /// Builds a game from a kernel (hand-written design).
    fn draw(&self, number: u32, seed: SeedPath) -> (Vec<MadeGame>, Tally) {
        let order = self.order(self.recipe.generated.game_tries);
        let (made, tally) = make_one(&order, self.rule_sets(), &self.forms, seed, number);
        (made.into_iter().collect(), tally)
    }

    /// Generates an invented game.
    fn invent(&self, method: Method, number: u32, seed: SeedPath) -> (Vec<MadeGame>, Tally) {
        let Some(part) = &self.recipe.invented else { return (Vec::new(), Tally::default()) };
        // A single attempt by search, or a single round of an archive, examines many rule sets.
        let tries = match method {
            Method::Constructive => part.game_tries,
            Method::Search | Method::Evolutionary => part.game_tries / 4,
        };
        let (levels, level_tries) = (part.levels, part.level_tries);
        let order = GameOrder { method, levels, level_tries, ..self.order(tries) };
        let known: Vec<GameForm> = self.forms.iter().chain(&self.before).cloned().collect();
        let (made, tally) = invent_one(&order, &self.recipe.known.census(), &known, seed, number);
        (made.into_iter().collect(), tally)
    }

    /// Returns the rule sets of new games. They are assigned before the jobs run, because independent jobs could not
    /// ensure that the rule sets are diverse.
    pub(super) fn rule_sets(&self) -> &RuleSets {
        self.sets.get_or_init(|| {
            let known: Vec<GameForm> = self.forms.iter().chain(&self.before).cloned().collect();
            RuleSets::draw(&self.order(1).kinds, &known, self.seed.child("rules", 0))
        })
    }

    pub(super) fn order(&self, attempts: u32) -> GameOrder {
        let part = &self.recipe.generated;
        let order = GameOrder::new(1);
        let kinds = if part.kinds.is_empty() { order.kinds } else { part.kinds.clone() };
        GameOrder {
            levels: part.levels,
            level_tries: part.level_tries,
            kinds,
            least_interactions: part.least_interactions,
            least_mechanics: part.least_mechanics,
            criteria: self.criteria.clone(),
            effort: GameEffort { attempts: attempts.max(1), judges: JUDGES, ..order.effort },
            ..order
        }
    }

    /// Creates a corpus game in a new theme, with new levels that resemble its own.
    fn new_levels(&self, at: usize, seed: &SeedPath) -> (Vec<MadeGame>, Tally) {
        let (recipe, known) = (self.recipe, &self.corpus.games[at]);
        let mut tally = Tally::default();
        let Ok(retold) = Rethemed::of(&self.games[at], seed.seed().child("fiction", 0)) else {
            tally.game_rejected("no fiction fits");
            return (Vec::new(), tally);
        };
        // The game is compiled from the printed text, so that the judged game is the frozen one.
        let Ok(game) = Game::from_source(&syntax::print(&retold.description)) else {
            tally.game_rejected("the rules do not compile");
            return (Vec::new(), tally);
        };
        let own = known.levels.iter().filter_map(|text| game.level(&retold.level(text)).ok());
        let like = Examples::of(&game, &own.collect::<Vec<Level>>()).map(Arc::new);
        let candidate = Candidate {
            title: retold.title,
            description: retold.summary,
            goal: retold.goal,
            kind: known.card.kind.clone(),
            real_time: known.card.real_time,
            origin: Origin::Corpus { name: known.name.clone() },
            game,
        };
        let config = like.map_or_else(|| recipe.board.levels(), LevelConfig::like);
        let criteria = &self.corpus_criteria;
        let panel = Panel::new(criteria.clone(), Effort::Sequential);
        let made = (0..recipe.corpus.game_tries).find_map(|number| {
            let levels = Levels {
                count: recipe.corpus.levels,
                tries: recipe.corpus.level_tries,
                source: &config,
                criteria,
                panel: &panel,
                seed: &seed.child("levels", u64::from(number)),
            };
            let is_hopeless =
                tally.rejections.get(Criterion::RuleUse.name()).is_some_and(|&times| times >= UNUSED);
            if is_hopeless { None } else { levels.make(candidate.clone(), &mut tally) }
        });
        (made.into_iter().collect(), tally)
    }
}

/// The number of times that a corpus game's levels may leave a rule unused before the attempts to create the game
/// stop. After that, further levels are unlikely to use the rule.
const UNUSED: u64 = 3;

/// Returns the number of candidates for a given number of games.
fn candidates(games: u32, each: f64) -> u32 {
    // The product is at most 20 times 10,000, so there is no rounding error.
    (f64::from(games) * each).ceil() as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mint::select::{Contender, Part};
    use crate::mint::tests::{FETCH, corpus, recipe};
    use validators::{CriterionSet, Difficulty};

    /// Published episodes differ from the episodes that led to a level's acceptance or selection, because those
    /// episodes are biased by luck.
    #[test]
    fn the_ladder_plays_again_for_the_card() {
        let corpus = corpus(&[("fetch", FETCH)]);
        let mut recipe = recipe("ladder");
        recipe.criteria.ask = recipe.criteria.ask.with(CriterionSet::of(&[Criterion::Skill]));
        recipe.criteria.ladder = vec!["random".to_owned(), "mcts:400".to_owned()];
        recipe.criteria.held_out = vec!["olets:100".to_owned()];
        let plan = Plan::new(&recipe, None, &corpus).unwrap();
        let [job] = plan.jobs()[..] else { panic!("one job") };
        let (made, _) = plan.new_levels(0, &plan.seed_of(job));
        let [made] = &made[..] else { panic!("one game") };
        let judged = made.card.levels[0].ladder.as_ref().unwrap();
        let mut frozen = FrozenGame::of(made.clone(), &plan.criteria, false);
        let published = frozen.card.levels[0].ladder.clone().unwrap();
        assert_eq!(frozen.difficulties, [judged.difficulty]);
        assert!(
            judged.rungs[1].rate.plays < published.rungs[1].rate.plays,
            "the judges stop when they are sure"
        );
        assert_eq!(published.rungs[1].rate.plays, recipe.criteria.ladder_plays);
        assert_ne!(&published, judged);
        // The selection counts the difficulties that the judges measured.
        frozen.difficulties = vec![Difficulty::VeryHard];
        let contender = Contender::of(Part::Corpus, (0, 0), &frozen).unwrap();
        assert_eq!(contender.difficulties, [Difficulty::VeryHard]);
    }
}

//! The making of games by each method.

use super::candidate::{MadeGame, Step};
use super::gate::{GameGate, NEAR_KNOWN};
use super::look::{Looker, axes};
use super::order::{GameOrder, RuleSource};
use crate::levels::Method;
use crate::search_loop::{Finalists, run_search, spread};
use crate::tally::Tally;
use engine::{Analysis, Game, Seed};
use generators::games::{GameConfig, GameGenome, GameVariation, Kind};
use generators::kernels::KernelGenome;
use generators::{Annealing, AnnealingConfig, MapElites, MapElitesConfig, Variation};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use validators::CriteriaError;
use validators::game_measures::{AvatarKind, GameKind, GoalKind};
use validators::novelty::GameForm;

/// The games of an order.
#[derive(Clone, Debug)]
pub struct GameSet {
    /// The games that could be made, in the order of their numbers.
    pub games: Vec<MadeGame>,
    /// The candidates that were tried, and why the others failed.
    pub tally: Tally,
    /// Games that a search looked at.
    pub looks: u64,
}

/// The reasons why no game was made.
#[derive(Debug, thiserror::Error)]
pub enum GamesError {
    /// The criteria are not sensible.
    #[error("the criteria: {0}")]
    Criteria(#[from] CriteriaError),
    /// No candidate passed.
    #[error(
        "no game was accepted of {looks} that were looked at and {} that were judged: {}", .tally.games_tried, .tally.reasons()
    )]
    NoneAccepted {
        /// Candidates that a search looked at.
        looks: u64,
        /// Candidates before the last judges, and their obstacles.
        tally: Box<Tally>,
    },
}

/// Told how the making goes; from several threads.
pub trait Progress: Sync {
    /// A game was looked at, or judged.
    fn looked(&self) {}
    /// A game is accepted.
    fn made(&self, _title: &str) {}
}

impl Progress for () {}

/// Makes the games of an order; no two of them, and none of them and a `known` game, are nearer than
/// [`NEAR`](validators::novelty::NEAR), and at most one of five (or two) is of one kind of avatar and goal. `canary` marks their files. Cost: some ten seconds of one core a game, on all threads
/// of the current rayon pool. The same order, known games and seed give the same games on any number of threads.
///
/// Games that could not be made are missing in the set.
///
/// # Errors
/// The criteria are not sensible, or not one game was accepted.
pub fn make_games(
    order: &GameOrder,
    known: &[GameForm],
    canary: &str,
    seed: Seed,
    progress: &dyn Progress,
) -> Result<GameSet, GamesError> {
    order.check()?;
    let gate = GameGate::new(order, known, canary);
    let maker = Maker { order, gate, seed, progress };
    let set = match order.method {
        Method::Constructive | Method::Search => maker.one_by_one(),
        Method::Evolutionary => maker.evolved(),
    };
    if set.games.is_empty() && order.count > 0 {
        return Err(GamesError::NoneAccepted { looks: set.looks, tally: Box::new(set.tally) });
    }
    Ok(set)
}

/// The game of this number of an order that is made one by one, if it can be made, whatever the others are like: known games
/// only are kept apart from. Cost, and what decides it: as of [`make_games`].
pub fn make_one(
    order: &GameOrder,
    known: &[GameForm],
    canary: &str,
    seed: Seed,
    number: u32,
) -> (Option<MadeGame>, Tally) {
    let maker = Maker { order, gate: GameGate::new(order, known, canary), seed, progress: &() };
    let Attempted { made, tally, .. } = maker.attempt(number, 0);
    (made.map(|(game, _)| game), tally)
}

struct Maker<'a> {
    order: &'a GameOrder,
    gate: GameGate<'a>,
    seed: Seed,
    progress: &'a dyn Progress,
}

/// The result of the attempts for one game.
struct Attempted {
    /// The game, and the attempt after the one that it comes from.
    made: Option<(MadeGame, u32)>,
    tally: Tally,
    looks: u64,
}

impl Maker<'_> {
    /// Each game by itself; one that is near to earlier ones, or of a crowded kind, makes way for the next of its place.
    fn one_by_one(&self) -> GameSet {
        let numbers = (0..self.order.count).into_par_iter();
        let mut attempted: Vec<Attempted> = numbers.map(|number| self.attempt(number, 0)).collect();
        let mut company = Company::of(self.order);
        let mut set = GameSet { games: Vec::new(), tally: Tally::default(), looks: 0 };
        for (number, attempted) in (0..).zip(&mut attempted) {
            while let Some((game, next)) = attempted.made.take() {
                match company.welcome(&game.game) {
                    Ok(()) => {
                        set.games.push(game);
                        break;
                    }
                    Err(why) => attempted.tally.taken_back(why),
                }
                let again = self.attempt(number, next);
                attempted.made = again.made;
                attempted.tally.add(&again.tally);
                attempted.looks += again.looks;
            }
            set.tally.add(&attempted.tally);
            set.looks += attempted.looks;
        }
        set
    }

    /// Attempts from one on, until a game is accepted.
    fn attempt(&self, number: u32, from: u32) -> Attempted {
        let mut attempted = Attempted { made: None, tally: Tally::default(), looks: 0 };
        let seed = self.seed.child("game", u64::from(number));
        for attempt in from..self.order.effort.attempts {
            let seed = seed.child("attempt", u64::from(attempt));
            if self.order.rules == RuleSource::Kernels {
                let genome = KernelGenome::draw(&[self.kind(number, attempt)], seed.child("rules", 0));
                let Ok(genome) = genome else { continue };
                let judges = seed.child("judges", 0);
                let made = self.gate.judge_course(&genome, attempt, judges, &mut attempted.tally);
                self.progress.looked();
                if let Some(mut made) = made {
                    self.progress.made(&made.card.title);
                    made.path = path([("game", number.into()), ("attempt", attempt.into()), ("judges", 0)]);
                    attempted.made = Some((made, attempt + 1));
                    return attempted;
                }
                continue;
            }
            let variation = GameVariation::new(GameConfig { kinds: vec![self.kind(number, attempt)] });
            let proposed: Vec<GameGenome> = match self.order.method {
                Method::Constructive => self.drawn(&variation, seed, &mut attempted).into_iter().collect(),
                _ => self.searched(&variation, seed.child("search", 0), &mut attempted),
            };
            if proposed.is_empty() {
                attempted.tally.game_rejected("look");
            }
            for (at, genome) in (0..).zip(&proposed) {
                let made = self.gate.judge(genome, attempt, seed.child("judges", at), &mut attempted.tally);
                self.progress.looked();
                if let Some(mut made) = made {
                    self.progress.made(&made.card.title);
                    made.path = path([("game", number.into()), ("attempt", attempt.into()), ("judges", at)]);
                    attempted.made = Some((made, attempt + 1));
                    return attempted;
                }
            }
        }
        attempted
    }

    /// Kinds take turns, in an order that is drawn. Some seldom come to anything: after as many attempts as are given to one
    /// kind, its place goes to another one, in an order of its own.
    fn kind(&self, number: u32, attempt: u32) -> Kind {
        let shuffled = |mut kinds: Vec<Kind>, seed: Seed| {
            seed.sampler().shuffle(&mut kinds);
            kinds
        };
        let turns = shuffled(self.order.kinds.clone(), self.seed.child("kinds", 0));
        let first = turns[number as usize % turns.len()];
        let others = turns.into_iter().filter(|&kind| kind != first).collect();
        let others = shuffled(others, self.seed.child("other kinds", u64::from(number)));
        let passed = attempt / self.order.effort.patience.max(1);
        let kinds: Vec<Kind> = [first].into_iter().chain(others).collect();
        kinds[passed as usize % kinds.len()]
    }

    /// A game as it is drawn, if a look promises something.
    fn drawn(&self, variation: &GameVariation, seed: Seed, attempted: &mut Attempted) -> Option<GameGenome> {
        let genome = variation.create(seed.child("rules", 0))?;
        let look = Looker::new(self.order, seed.child("look", 0)).look(&genome);
        attempted.note(&look);
        look.is_promising.then_some(genome)
    }

    /// The best games of a search that starts from constructive ones.
    fn searched(&self, variation: &GameVariation, seed: Seed, attempted: &mut Attempted) -> Vec<GameGenome> {
        let looks = self.order.effort.looks as usize;
        let looker = Looker::new(self.order, seed.child("look", 0));
        let config = AnnealingConfig { starts: looks / 3, ..AnnealingConfig::of(looks) };
        let mut search = Annealing::new(variation, config, seed.child("annealing", 0));
        let mut best = Finalists::new();
        let look = |genome: &GameGenome| {
            self.progress.looked();
            looker.look(genome)
        };
        run_search(&mut search, (looks, self.order.effort.batch), look, |genome, look| {
            attempted.note(&look);
            best.note(genome, genome.key(), &look.evaluation);
            look.evaluation
        });
        best.into_candidates().collect()
    }

    /// Fills an archive of games that differ, and picks games that lie far apart in it until enough are accepted.
    fn evolved(&self) -> GameSet {
        let looker = Looker::new(self.order, self.seed.child("look", 0));
        let variation = GameVariation::new(GameConfig { kinds: self.order.kinds.clone() });
        let wanted = self.order.count as usize;
        let looks = self.order.effort.looks as usize * wanted;
        let config = MapElitesConfig { initial: (looks / 3).max(1), ..MapElitesConfig::default() };
        let mut search =
            MapElites::new(&variation, GameGenome::key, axes(), config, self.seed.child("archive", 0));
        let mut company = Company::of(self.order);
        let mut set = GameSet { games: Vec::new(), tally: Tally::default(), looks: 0 };
        let mut shown = BTreeSet::new();
        for round in 0..self.order.effort.attempts {
            // The first round fills the archive, the others mend it where the judges said no.
            let looks = if round == 0 { looks } else { looks / 4 };
            let look = |genome: &GameGenome| {
                self.progress.looked();
                looker.look(genome)
            };
            run_search(&mut search, (looks, self.order.effort.batch), look, |_, look| {
                set.looks += 1;
                set.tally.calls(look.calls);
                look.evaluation
            });
            let missing = wanted - set.games.len();
            let picked = spread(search.archive(), missing, &[], |_, _| false, &mut shown, GameGenome::key);
            let judge = |(cell, genome): &(usize, GameGenome)| {
                let mut tally = Tally::default();
                let key = genome.key().to_string();
                let seed = self.seed.child("judges", 0).child(&key, 0);
                let mut made = self.gate.judge(genome, round, seed, &mut tally);
                self.progress.looked();
                if let Some(made) = &mut made {
                    made.path = path([("judges", 0), (&key, 0)]);
                }
                (*cell, made, tally)
            };
            let judged: Vec<_> = picked.par_iter().map(judge).collect();
            for (cell, made, mut tally) in judged {
                match made.map(|made| company.welcome(&made.game).map(|()| made)) {
                    Some(Ok(made)) => {
                        self.progress.made(&made.card.title);
                        set.games.push(made);
                    }
                    Some(Err(why)) => tally.taken_back(why),
                    None => search.demote(cell, REFUSED),
                }
                set.tally.add(&tally);
            }
            if set.games.len() == wanted {
                break;
            }
        }
        set
    }
}

/// Steps from seed to seed, with words of their own.
fn path<const N: usize>(steps: [(&str, u64); N]) -> Vec<Step> {
    steps.into_iter().map(|(purpose, index)| (purpose.to_owned(), index)).collect()
}

/// The games of a set so far: no two are near, and none of the kinds is crowded.
struct Company {
    forms: Vec<GameForm>,
    /// The number of games with each kind of avatar and goal, and the most that there may be.
    kinds: BTreeMap<(AvatarKind, GoalKind), usize>,
    room: usize,
}

impl Company {
    /// One of five games may be of a kind, or two of a few; as many as there are, where only some kinds are asked for.
    fn of(order: &GameOrder) -> Company {
        let room = match order.kinds.len() < Kind::ALL.len() {
            true => usize::MAX,
            false => (order.count as usize / 5).max(2),
        };
        Company { forms: Vec::new(), kinds: BTreeMap::new(), room }
    }

    /// Takes a game in, or says why not.
    fn welcome(&mut self, game: &Game) -> Result<(), &'static str> {
        let form = GameForm::of(game);
        if self.forms.iter().any(|other| form.is_near(other)) {
            return Err(NEAR_KNOWN);
        }
        let kind = GameKind::of(&Analysis::of(game));
        let there = self.kinds.entry((kind.avatar, kind.goal)).or_default();
        if *there == self.room {
            return Err("enough of its kind");
        }
        *there += 1;
        self.forms.push(form);
        Ok(())
    }
}

/// The feasibility of a game that a look took for feasible and the last judges did not.
const REFUSED: f64 = 0.95;

impl Attempted {
    fn note(&mut self, look: &super::look::Look) {
        self.looks += 1;
        self.tally.calls(look.calls);
    }
}

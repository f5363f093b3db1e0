//! Generates levels by each method.

use super::order::{LevelOrder, MadeLevel, Method};
use crate::pipeline::{DIFFICULTY, LevelGate};
use crate::progress::Progress;
use crate::tally::Tally;
use base::{Digest, Seed};
use engine::{Analysis, Game, Level};
use generators::levels::{ConstructiveLevels, LevelConfig, LevelSearch, LevelSimilarity};
use generators::{GenerateError, Generator};
use rayon::prelude::*;
use std::collections::BTreeSet;
use validators::{CheckedCriteria, CriteriaError, Criterion, Difficulty};

/// The levels generated for an order.
#[derive(Clone, Debug)]
pub struct LevelSet {
    /// The successfully generated levels, ordered by number.
    pub levels: Vec<MadeLevel>,
    /// The cost of generating the levels.
    pub tally: Tally,
}

/// The errors of level generation.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LevelsError {
    /// The generator does not support the game.
    #[error(transparent)]
    Generate(#[from] GenerateError),
    /// The criteria are invalid.
    #[error("the criteria are invalid: {0}")]
    Criteria(#[from] CriteriaError),
    /// No candidate passed all judges.
    #[error("no level was accepted ({looks} inspected, {judged} judged): {why}{}", .hint.as_ref().map_or(String::new(), |hint| format!("; {hint}")))]
    NoneAccepted {
        /// The number of candidates that a search evaluated.
        looks: u64,
        /// The number of candidates that reached the panel.
        judged: u64,
        /// The reasons why the candidates failed.
        why: String,
        /// Advice derived from the most frequent obstacle, if there is any.
        hint: Option<String>,
    },
    /// Not a single board could be filled.
    #[error("no board has room for the requested sprites: {0}")]
    NoBoard(String),
}

/// Returns advice derived from the most frequent rejection, if there is any.
fn hint(tally: &Tally) -> Option<String> {
    if tally.unbeaten > 0 && Some(&tally.unbeaten) >= tally.rejections.get(DIFFICULTY) {
        let unbeaten = tally.unbeaten;
        return Some(format!(
            "no planner on the ladder wins any of the {unbeaten} levels that met all other criteria, but \
             difficulty is measured with these planners: do not request a difficulty, or make the game easier \
             for them"
        ));
    }
    let (most, _) = tally.rejections.iter().max_by_key(|(_, count)| **count)?;
    let hint = match most.parse() {
        Ok(Criterion::Winnable) => {
            "no win was found on most levels: `arcade validate` shows whether the game can be won, and if \
             not, why"
        }
        Ok(Criterion::NotRandom) => "random keys win most levels: the rules demand too little of the player",
        Ok(Criterion::NotIdle) => "doing nothing wins most levels: the rules demand nothing of the player",
        Ok(Criterion::EarlyDeath) => "the player cannot survive the first ticks of most levels",
        _ if most == DIFFICULTY => {
            "for the planners, most levels are easier or harder than requested: request a different difficulty"
        }
        _ => return None,
    };
    Some(hint.to_owned())
}

/// Generates an order's levels for one game. The same game, order and seed give the same levels on any number of
/// threads. Cost: [`LevelOrder::effort`], on all threads of the current rayon pool.
///
/// Levels that could not be generated are missing from the set.
///
/// # Errors
/// Returns an error if the generator does not support the game, if the criteria are invalid, or if no level was
/// accepted.
pub fn make_levels(
    game: &Game,
    order: &LevelOrder,
    seed: Seed,
    progress: &dyn Progress,
) -> Result<LevelSet, LevelsError> {
    let criteria = order.checked_criteria()?;
    let generator = ConstructiveLevels::new(game, order.config())?;
    let analysis = Analysis::of(game);
    let likeness = LevelSimilarity::of(&analysis);
    let maker = Maker { analysis: &analysis, order, criteria, generator, likeness, seed, progress };
    let set = match order.method {
        Method::Constructive if !order.has_to_be_measured() => maker.draw_unjudged(),
        Method::Constructive => maker.make_by_number(|number, refused| maker.draw_and_judge(number, refused)),
        Method::Search => {
            let variation = LevelSearch::new(game, order.config(), order.puzzle(&analysis))?;
            maker.make_by_number(|number, refused| maker.search_level(&variation, number, refused))
        }
        Method::Evolutionary => {
            maker.evolve_levels(&LevelSearch::new(game, order.config(), order.puzzle(&analysis))?)
        }
    };
    if set.levels.is_empty() && order.count > 0 {
        let is_hopeless = set.tally.looks() + set.tally.levels_tried == 0;
        if is_hopeless
            && let Err(GenerateError::Unlucky(fault)) = maker.generator.generate(maker.level_seed(0))
        {
            return Err(LevelsError::NoBoard(fault));
        }
        return Err(LevelsError::NoneAccepted {
            looks: set.tally.looks(),
            judged: set.tally.levels_tried,
            why: set.tally.reasons(),
            hint: hint(&set.tally),
        });
    }
    Ok(set)
}

/// A level, if one was generated, and the cost.
pub(super) type Attempt = (Option<MadeLevel>, Tally);

pub(super) struct Maker<'a> {
    pub(super) analysis: &'a Analysis,
    pub(super) order: &'a LevelOrder,
    /// The order's criteria, after checking.
    pub(super) criteria: CheckedCriteria,
    generator: ConstructiveLevels<'a>,
    pub(super) likeness: LevelSimilarity,
    pub(super) seed: Seed,
    pub(super) progress: &'a dyn Progress,
}

impl Maker<'_> {
    /// Draws levels without judging them.
    fn draw_unjudged(&self) -> LevelSet {
        self.make_by_number(|number, refused| {
            let mut tally = Tally::default();
            for candidate in 0..DRAWS {
                match self.generator.generate(self.level_seed(number).child("candidate", candidate)) {
                    Ok(level) if refused.contains(&self.likeness.digest(&level)) => tally.reject(TWICE),
                    Ok(level) => {
                        return (Some(MadeLevel { number, level, report: None, ladder: None }), tally);
                    }
                    Err(_) => tally.reject(NO_BOARD),
                }
            }
            (None, tally)
        })
    }

    /// Draws levels until one is accepted.
    fn draw_and_judge(&self, number: u32, refused: &BTreeSet<Digest>) -> Attempt {
        let mut tally = Tally::default();
        let seed = self.level_seed(number);
        let gate = LevelGate::new(self.analysis, self.order, &self.criteria, seed.child("gate", 0));
        for candidate in 0..u64::from(self.order.effort.looks * self.order.effort.rounds) {
            match self.generator.generate(seed.child("candidate", candidate)) {
                Ok(level) if refused.contains(&self.likeness.digest(&level)) => tally.reject(TWICE),
                Ok(level) => {
                    let (made, spent) = gate.judge(number, &level);
                    self.progress.looked();
                    tally.add(&spent);
                    if made.is_some() {
                        return (made, tally);
                    }
                    if self.is_hopeless(&tally) {
                        break;
                    }
                }
                Err(_) => tally.reject(NO_BOARD),
            }
        }
        (None, tally)
    }

    /// Generates all levels in parallel, independently of each other. Then regenerates each level that is too similar
    /// to an earlier one.
    fn make_by_number(&self, make: impl Fn(u32, &BTreeSet<Digest>) -> Attempt + Sync) -> LevelSet {
        let attempts: Vec<Attempt> = (0..self.order.count)
            .into_par_iter()
            .map(|number| {
                self.progress.start();
                let attempt = make(number, &BTreeSet::new());
                if attempt.0.is_some() {
                    self.progress.made(&format!("level {number}"));
                }
                attempt
            })
            .collect();
        let mut set = LevelSet { levels: Vec::new(), tally: Tally::default() };
        let mut taken = BTreeSet::new();
        for (made, tally) in attempts {
            set.tally.add(&tally);
            let Some(mut level) = made else { continue };
            if taken.contains(&self.likeness.digest(&level.level)) {
                set.tally.reject(TWICE);
                let (again, tally) = make(level.number, &taken);
                set.tally.add(&tally);
                let Some(again) = again else { continue };
                level = again;
            }
            taken.insert(self.likeness.digest(&level.level));
            set.levels.push(level);
        }
        set
    }

    /// Returns `true` if no player on the ladder of reference players has won any of the judged levels, although the
    /// requested difficulty requires frequent wins. Further levels are then unlikely to be easier.
    pub(super) fn is_hopeless(&self, tally: &Tally) -> bool {
        let by_difficulty = tally.rejections.get(DIFFICULTY).copied().unwrap_or_default();
        let often =
            !matches!(self.order.difficulty, None | Some(Difficulty::VeryHard | Difficulty::Unbeaten));
        often && tally.unbeaten >= HOPELESS && tally.unbeaten == by_difficulty
    }

    pub(super) fn level_seed(&self, number: u32) -> Seed {
        self.seed.child("level", u64::from(number))
    }
}

/// The number of judged levels without a win by any reference player on the ladder after which no win is expected.
const HOPELESS: u64 = 6;

/// The number of boards to draw for an unjudged level.
const DRAWS: u64 = 20;
/// The reason for rejecting a candidate that repeats an earlier level of the set.
pub(super) const TWICE: &str = "the same level twice";
pub(super) const NO_BOARD: &str = "no board has room";

/// Generates levels without a requested difficulty, spread evenly from the easiest to the hardest target of the
/// constructive generator. The levels form the pool from which a level would come if no difficulty were requested.
/// Levels that cannot be generated are omitted. Cost: about a millisecond per level.
///
/// # Errors
/// Returns an error if the generator does not support the game.
pub fn unconstrained_pool(
    game: &Game,
    config: &LevelConfig,
    count: u32,
    seed: Seed,
) -> Result<Vec<Level>, GenerateError> {
    let draw = |number: u32| {
        let difficulty = f64::from(number) / f64::from(count.max(2) - 1);
        let generator = ConstructiveLevels::new(game, LevelConfig { difficulty, ..config.clone() })?;
        Ok(generator.generate(seed.child("pool", u64::from(number))).ok())
    };
    let drawn: Result<Vec<Option<Level>>, GenerateError> = (0..count).into_par_iter().map(draw).collect();
    Ok(drawn?.into_iter().flatten().collect())
}

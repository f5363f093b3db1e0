//! The search for a level for one place of a game: candidates of the generator, until one passes and fits beside the others.

use super::level::LevelTrial;
use super::{Refusal, walk};
use crate::games::puzzles::PuzzleGenerator;
use crate::games::{Drawn, FoundLevel, LevelSource, Levels};
use crate::tally::Tally;
use base::Seed;
use engine::{Action, Game, Level};
use generators::kernels::{Course, CourseLevel, Slot};
use generators::levels::{ConstructiveLevels, LevelConfig};
use generators::{GenerateError, Generator};
use validators::Criterion;

/// Further candidates that a level costs whose win was searched for in vain.
const VAIN_SEARCH: u32 = 1;
/// The same while the game has fewer than [`STAKE`] levels, so that little is lost with it: where two searches are in vain, the
/// next succeeds in one of four cases.
const EARLY_VAIN_SEARCH: u32 = 5;
const STAKE: usize = 2;

/// The place of a level in a game, beside the levels that other places have.
pub(super) struct Place<'a> {
    pub(super) levels: &'a Levels<'a>,
    pub(super) game: &'a Game,
    pub(super) number: u32,
    /// The levels of other places, each with its number.
    pub(super) others: &'a [(u32, FoundLevel)],
}

/// A generator of candidates for one place.
enum PlaceGenerator<'a> {
    Rules(Box<ConstructiveLevels<'a>>),
    Course(&'a Course, Slot),
    Puzzles(PuzzleGenerator<'a>),
}

/// A level, its question to the player if it is one of a course, and actions that win it if they are known.
type Generated = (Level, Option<String>, Option<Vec<Action>>);

impl PlaceGenerator<'_> {
    /// Generates the candidate of a seed.
    fn generate(&self, game: &Game, candidate: Seed) -> Result<Generated, GenerateError> {
        let seed = candidate.child("layout", 0);
        match self {
            PlaceGenerator::Rules(levels) => Ok((levels.generate(seed)?, None, None)),
            PlaceGenerator::Puzzles(puzzles) => {
                let far = || GenerateError::Unlucky("no puzzle is far enough from its solution".to_owned());
                let (level, known) =
                    puzzles.create_solved(game, seed, Place::seed_of_win(candidate)).ok_or_else(far)?;
                Ok((level, None, Some(known)))
            }
            PlaceGenerator::Course(course, slot) => {
                let CourseLevel { text, asks, .. } = course.level(*slot, seed)?;
                let level =
                    game.level(&text).map_err(|problems| GenerateError::Unlucky(problems.to_string()))?;
                Ok((level, Some(asks), None))
            }
        }
    }
}

impl<'a> Place<'a> {
    /// Returns the seed of the win of a candidate's puzzle.
    pub(super) fn seed_of_win(candidate: Seed) -> Seed {
        candidate.child("judges", 0).child(Criterion::Winnable.name(), 0).child("systematic", 0)
    }

    /// Returns the refusal of the game for which no level is found here.
    pub(super) fn refusal(&self) -> Refusal {
        Refusal::Because(format!("no level {}", self.number).into())
    }

    /// Returns the first candidate from number `from` on that passes.
    pub(super) fn find(&self, from: u32, tally: &mut Tally) -> Option<FoundLevel> {
        let generator = match self.generator() {
            Ok(generator) => generator,
            Err(error) => {
                tally.game_rejected(&error.to_string());
                return None;
            }
        };
        let Levels { tries, criteria, .. } = self.levels;
        let mut left = tries.saturating_sub(from);
        for candidate in from..*tries {
            if left == 0 {
                break;
            }
            left -= 1;
            let calls = tally.calls;
            let found =
                tally.spend(Tally::of_refused, |tally| self.judge_candidate(&generator, candidate, tally));
            if found.is_some() {
                return found;
            }
            // A search in vain for a win is expensive: it counts as several candidates.
            if tally.calls - calls > criteria.budget / 2 {
                left = left.saturating_sub(if self.others.len() < STAKE {
                    EARLY_VAIN_SEARCH
                } else {
                    VAIN_SEARCH
                });
            }
        }
        None
    }

    /// The difficulty that its level should have, from 0 to 1.
    fn difficulty(&self) -> f64 {
        f64::from(self.number) / f64::from((self.levels.count - 1).max(1))
    }

    fn generator(&self) -> Result<PlaceGenerator<'a>, GenerateError> {
        let difficulty = self.difficulty();
        match self.levels.source {
            LevelSource::Rules(config) => {
                let config = LevelConfig { difficulty, ..config.clone() };
                let levels = ConstructiveLevels::new(self.game, config)?;
                Ok(PlaceGenerator::Rules(Box::new(levels)))
            }
            LevelSource::Course(course) => {
                let last = Slot::ALL.len() - 1;
                let slot = Slot::ALL[(difficulty * last as f64).round() as usize];
                Ok(PlaceGenerator::Course(course, slot))
            }
            LevelSource::Puzzles(puzzles) => {
                puzzles.generator(self.game, self.number).map(PlaceGenerator::Puzzles)
            }
        }
    }

    /// Takes the candidate of a number through the stages of a level: `None`, with the reason in the tally, if it does not pass.
    fn judge_candidate(
        &self,
        generator: &PlaceGenerator<'_>,
        candidate: u32,
        tally: &mut Tally,
    ) -> Option<FoundLevel> {
        let places = self.levels.seed.child("level", u64::from(self.number));
        let seed = places.child("candidate", u64::from(candidate));
        let Ok((level, asks, known)) = generator.generate(self.game, seed) else {
            tally.no_level("level generator");
            return None;
        };
        let drawn = Drawn { level, difficulty: self.difficulty(), candidate, seed, win: None };
        let mut trial = LevelTrial::new(self, drawn, known);
        match walk(&LevelTrial::STAGES, &mut trial, tally) {
            Ok(()) => trial.found.map(|found| FoundLevel { asks, ..found }),
            Err(Refusal::Because(why)) => {
                if trial.found.is_some() {
                    tally.level_taken_back(&why);
                } else {
                    tally.no_level(&why);
                }
                None
            }
            Err(Refusal::Counted) => None,
        }
    }
}

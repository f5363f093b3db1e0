//! The search for a level for one position of a game. Tries candidates until one passes and fits the other levels.

use super::level::{LevelTrial, Place};
use super::sources::{Board, Boards, PlaceBrief};
use super::stage::{Refusal, walk};
use crate::games::{Drawn, FoundLevel, Levels};
use crate::tally::Tally;

/// The number of extra candidates to count for a failed board search while the game has fewer than [`STAKE`] levels. If
/// three searches fail, further ones rarely succeed.
const EARLY_VAIN_BOARD: u32 = 1;
/// The number of extra candidates to count for a failed win search.
const VAIN_SEARCH: u32 = 1;
/// The number of extra candidates to count for a failed search while the game has fewer than [`STAKE`] levels, so that
/// a game is given up before much effort is lost. After two failed searches, only one in four further searches
/// succeeds.
const EARLY_VAIN_SEARCH: u32 = 5;
const STAKE: usize = 2;

impl Place<'_> {
    /// Returns the reason for rejecting a game for which no level was found at this position.
    pub(super) fn refusal(&self) -> Refusal {
        Refusal::Because(format!("no level {}", self.number).into())
    }

    /// Returns the first passing candidate, starting with candidate number `from`; `None` if no candidate passes.
    pub(super) fn find(&self, from: u32, tally: &mut Tally) -> Option<FoundLevel> {
        let brief = PlaceBrief {
            number: self.number,
            difficulty: self.difficulty(),
            others: self.others,
            criteria: self.levels.criteria,
        };
        let boards = match self.levels.source.boards(self.game, &brief) {
            Ok(boards) => boards,
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
                tally.spend(Tally::of_refused, |tally| self.judge_candidate(&*boards, candidate, tally));
            if found.is_some() {
                return found;
            }
            let is_vain = !self.levels.source.mechanics().is_empty() && tally.calls == calls;
            if is_vain && self.others.len() < STAKE {
                left = left.saturating_sub(EARLY_VAIN_BOARD);
            }
            // A failed search for a win is expensive, so it counts as several candidates.
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

    /// Returns the target difficulty of the level, from 0 to 1.
    fn difficulty(&self) -> f64 {
        f64::from(self.number) / f64::from((self.levels.count - 1).max(1))
    }

    /// Takes candidate number `candidate` through a level's stages. If the candidate does not pass, counts the reason
    /// in `tally` and returns `None`.
    fn judge_candidate(&self, boards: &dyn Boards, candidate: u32, tally: &mut Tally) -> Option<FoundLevel> {
        let places = self.levels.seed.child("level", u64::from(self.number));
        let seed = places.child("candidate", u64::from(candidate));
        let Ok(Board { level, asks, known }) = boards.generate(&seed) else {
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

//! The traits of judges.

use crate::case::Case;
use crate::criterion::{About, Criterion, Stage};
use crate::gates::CarelessPlays;
use crate::measures::ladder::Ladder;
use crate::recording::{Recorded, Usage};
use crate::verdict::Finding;
use agents::Stopped;
use base::Seed;
use engine::{Analysis, Game};

/// The judge for a level criterion.
pub trait Validator: Sync {
    /// Judges the case. The same case gives the same result on any number of threads.
    fn validate(&self, case: Case<'_>) -> Finding;

    /// Judges the case like [`Validator::validate`], but can be cancelled. The call returns soon after
    /// `stopped` returns `true`, and its finding is then meaningless.
    fn validate_until(&self, case: Case<'_>, stopped: Stopped<'_>) -> Finding {
        let _ = stopped;
        self.validate(case)
    }
}

/// A game with its levels and their recorded episodes.
#[derive(Clone, Copy)]
pub(crate) struct GameCase<'a> {
    /// The game to judge.
    pub(crate) game: &'a Game,
    /// The analysis of the game's rules.
    pub(crate) analysis: &'a Analysis,
    /// The game's levels, with the episodes played by their validators.
    pub(crate) recording: &'a [Recorded<'a>],
    /// The results of the ladder (reference players of increasing strength) on each level, or `None` for a level on
    /// which no ladder was played.
    pub(crate) ladders: &'a [Option<&'a Ladder>],
    /// The rules and types that occur in the recorded episodes.
    pub(crate) usage: &'a Usage,
    /// The episodes of careless players, which press a random key in some ticks. The gates share these episodes.
    pub(crate) careless: &'a CarelessPlays<'a>,
    /// The source of the validator's own randomness.
    pub(crate) seed: Seed,
}

/// The judge for a game criterion.
pub(crate) trait GameValidator: Sync {
    /// Returns `true` if the judge needs to know which rules the recording executes. If no judge needs this, the
    /// recording is not replayed, and no random walks search for executions of the remaining rules.
    fn asks_for_usage(&self) -> bool {
        false
    }

    /// Judges the case. The same case gives the same result on any number of threads.
    fn validate(&self, case: GameCase<'_>) -> Finding;

    /// Judges the case like [`GameValidator::validate`], but can be cancelled. The call returns soon after
    /// `stopped` returns `true`, and its finding is then meaningless.
    fn validate_until(&self, case: GameCase<'_>, stopped: Stopped<'_>) -> Finding {
        let _ = stopped;
        self.validate(case)
    }
}

/// A level criterion with its judge.
pub(crate) struct LevelJudge {
    pub(crate) criterion: Criterion,
    pub(crate) stage: Stage,
    pub(crate) validator: Box<dyn Validator + Send>,
}

/// A game criterion with its judge.
pub(crate) struct GameJudge {
    pub(crate) criterion: Criterion,
    pub(crate) about: About,
    pub(crate) validator: Box<dyn GameValidator + Send>,
}

//! Judgements on a game over all its levels.

use crate::gates::CarelessPlays;
use crate::ladder::Ladder;
use crate::level_report::{Judgement, Report};
use crate::recording::{Recorded, Usage};
use crate::verdict::Finding;
use agents::Stopped;
use base::Seed;
use engine::{Analysis, Game};
use serde::Serialize;

/// A game with its levels and their recorded episodes.
#[derive(Clone, Copy)]
pub struct GameCase<'a> {
    /// The game.
    pub game: &'a Game,
    /// The analysis of its rules.
    pub analysis: &'a Analysis,
    /// Its levels with the episodes that their validators played.
    pub recording: &'a [Recorded<'a>],
    /// The ladder results of each level, if its ladder was played.
    pub ladders: &'a [Option<&'a Ladder>],
    /// The rules and types that those episodes show.
    pub(crate) usage: &'a Usage,
    /// The plays of careless players that gates share.
    pub(crate) careless: &'a CarelessPlays,
    /// The source of the validator's own randomness.
    pub seed: Seed,
}

/// A criterion of a game over all its levels.
pub trait GameValidator: Sync {
    /// Its name, kebab-case, as in recipes and cards.
    fn name(&self) -> &'static str;

    /// Tests whether it asks which rules the recording executes. Where nobody does, the recording is not replayed, and no random walks
    /// look for executions of the others.
    fn asks_for_usage(&self) -> bool {
        false
    }

    /// Judges the case. The same case gives the same answer, on any number of threads.
    fn validate(&self, case: GameCase<'_>) -> Finding;

    /// [`GameValidator::validate`], for someone who may leave: once `stopped` returns `true`, some finding comes soon, and means
    /// nothing.
    fn validate_until(&self, case: GameCase<'_>, stopped: Stopped<'_>) -> Finding {
        let _ = stopped;
        self.validate(case)
    }
}

/// The findings of all validators on a game: on each level, and on all of them together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GameReport {
    /// In the order of the levels.
    pub levels: Vec<Report>,
    /// In the order of checking.
    pub judgements: Vec<Judgement>,
}

impl GameReport {
    /// Returns `true` if every level and the game meet every criterion.
    pub fn passes(&self) -> bool {
        self.levels.iter().all(Report::passes) && self.game_passes()
    }

    /// Returns `true` if the game meets the criteria on all levels together.
    pub fn game_passes(&self) -> bool {
        self.judgements.iter().all(|judgement| judgement.finding.verdict.is_pass())
    }
}

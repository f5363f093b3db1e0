//! Judgements on a game over all its levels.

use crate::ladder::Ladder;
use crate::panel::{Judgement, Report};
use crate::recording::{Recorded, Usage};
use crate::verdict::Finding;
use engine::{Analysis, Game, Seed};
use serde::Serialize;

/// A game with its levels, and what was played on them.
#[derive(Clone, Copy)]
pub struct GameCase<'a> {
    /// The game.
    pub game: &'a Game,
    /// What its rules mean.
    pub analysis: &'a Analysis,
    /// Its levels with the episodes of their judges.
    pub recording: &'a [Recorded<'a>],
    /// How the players of a ladder fared on each, where one played.
    pub ladders: &'a [Option<&'a Ladder>],
    /// What those episodes show.
    pub(crate) usage: &'a Usage,
    /// Where the validator's own chance comes from.
    pub seed: Seed,
}

/// A criterion of a game over all its levels.
pub trait GameValidator: Sync {
    /// Its name, kebab-case, as in recipes and cards.
    fn name(&self) -> &'static str;

    /// Judges the case. The same case gives the same answer, on any number of threads.
    fn validate(&self, case: GameCase<'_>) -> Finding;
}

/// What all validators found of a game: of each level, and of all of them together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GameReport {
    /// In the order of the levels.
    pub levels: Vec<Report>,
    /// In the order of asking.
    pub judgements: Vec<Judgement>,
}

impl GameReport {
    /// Whether every level and the game meet every criterion.
    pub fn passes(&self) -> bool {
        self.levels.iter().all(Report::passes) && self.game_passes()
    }

    /// Whether the game meets the criteria on all levels together.
    pub fn game_passes(&self) -> bool {
        self.judgements.iter().all(|judgement| judgement.finding.verdict.is_pass())
    }
}

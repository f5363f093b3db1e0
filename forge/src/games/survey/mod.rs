//! Games from anywhere (written by people, or made), each judged by the same verdicts under the same budget, so that groups of
//! them can be compared. What each figure means is in `docs/side-by-side.md`.

mod compare;
mod edge;
mod row;

pub use compare::{Comparison, Group, LINES, Line, Unit};
pub use edge::{Edge, SEARCH, ladder_order};
pub use row::{GameRow, NO_LEVEL, NO_WIN};

use engine::{Digest, Game, Level, Seed};
use rayon::prelude::*;
use report::canonical::to_canonical_json;
use validators::{Criteria, CriteriaError, Panel, Report};

/// A game to be judged.
#[derive(Clone, Debug)]
pub struct SurveyedGame {
    /// What it is called, among those that it is judged with.
    pub name: String,
    /// The game.
    pub game: Game,
    /// Those of its levels that are to be judged, in their order.
    pub levels: Vec<Level>,
}

/// Judges games one after the other, all alike.
pub struct GameSurvey {
    criteria: Criteria,
    panel: Panel,
    seed: Seed,
}

/// The criteria that a survey asks: what the others ask is told by these, or is no matter of the comparison.
const ASKED: [&str; 2] = ["winnable", "skill"];

impl GameSurvey {
    /// A survey by these criteria, of which it takes the players of the ladder, budgets and thresholds; what they ask, and whom they
    /// hold out, is left aside.
    ///
    /// # Errors
    /// The criteria are not sensible.
    pub fn new(criteria: &Criteria, seed: Seed) -> Result<GameSurvey, CriteriaError> {
        let ask = ASKED.map(str::to_owned).to_vec();
        let criteria = Criteria { ask, held_out: Vec::new(), ..criteria.clone() };
        criteria.check()?;
        Ok(GameSurvey { panel: Panel::new(&criteria), criteria, seed })
    }

    /// Criteria whose budgets let a hundred games with three levels each be judged in half an hour on two cores.
    pub fn criteria() -> Criteria {
        let ladder = ["do-nothing", "random", "one-step", "mcts:30", "mcts:100", "olets:200"];
        Criteria {
            ladder: ladder.map(str::to_owned).to_vec(),
            held_out: Vec::new(),
            budget: 1_500_000,
            ladder_plays: 10,
            ladder_calls: 2_000_000,
            ..Criteria::full()
        }
    }

    /// What decides the row of a game: its rules and levels, the criteria, the seed and the rules of the engine. Rows with the
    /// same digest are the same.
    pub fn digest(&self, game: &SurveyedGame) -> Digest {
        let levels: Vec<Digest> = game.levels.iter().map(Level::digest).collect();
        let seed = *self.seed.as_bytes();
        let of = (row::FORM, engine::SEMANTICS, game.game.digest(), levels, &self.criteria, seed);
        Digest::of(to_canonical_json(&of).expect("the criteria were checked").as_bytes())
    }

    /// The row of a game. It gets the same one alone and among others, on any number of threads. Cost: for each level the
    /// budgets of the criteria for a witness and for a ladder; all levels at once.
    pub fn row(&self, surveyed: &SurveyedGame) -> GameRow {
        let SurveyedGame { game, levels, .. } = surveyed;
        let digest = self.digest(surveyed);
        let seed = self.seed.child(&game.digest().to_string(), 0);
        let judge = |level: &Level| self.panel.judge(game, level, seed.child(&level.digest().to_string(), 0));
        let reports: Vec<Report> = levels.par_iter().map(judge).collect();
        GameRow::of(surveyed, &reports, &self.criteria, digest, seed)
    }

    /// The rows of games, in their order.
    pub fn rows(&self, games: &[SurveyedGame]) -> Vec<GameRow> {
        games.iter().map(|game| self.row(game)).collect()
    }
}

#[cfg(test)]
mod tests;

//! Games judged for a comparison.

use super::row::{self, GameRow};
use super::surveyed::SurveyedGame;
use base::canonical::to_canonical_json;
use base::{Digest, Seed};
use engine::{Game, Level};
use validators::{CheckedCriteria, Criteria, CriteriaError, Criterion, CriterionSet, Effort, Judging, Panel};

/// A survey that judges games one at a time, all by the same criteria.
pub struct GameSurvey {
    criteria: CheckedCriteria,
    panel: Panel,
    seed: Seed,
}

/// The criteria that a survey checks. The other criteria are irrelevant to a comparison, or follow from the checked
/// ones.
const ASKED: CriterionSet = CriterionSet::of(&[Criterion::Winnable, Criterion::Skill]);

impl GameSurvey {
    /// Creates a survey. The ladder's reference players, the budgets and the thresholds come from `criteria`. The
    /// criteria's fields `ask` and `held_out` are ignored.
    ///
    /// # Errors
    /// Returns an error if the criteria are invalid.
    pub fn new(criteria: &Criteria, seed: Seed) -> Result<GameSurvey, CriteriaError> {
        let criteria = Criteria { ask: ASKED, held_out: Vec::new(), ..criteria.clone() }.check()?;
        Ok(GameSurvey { panel: Panel::new(criteria.clone(), Effort::Full), criteria, seed })
    }

    /// Returns criteria with budgets small enough to judge a hundred games with three levels each in half an hour on
    /// two cores.
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

    /// Returns the digest of everything that determines a game's row: the rules and levels, the criteria, the seed and
    /// the engine's rules. Rows with the same digest are identical.
    pub fn digest(&self, game: &Game, levels: &[Level]) -> Digest {
        let levels: Vec<Digest> = levels.iter().map(Level::digest).collect();
        let seed = *self.seed.as_bytes();
        let of = (row::FORM, engine::SEMANTICS, game.digest(), levels, &*self.criteria, seed);
        Digest::of(to_canonical_json(&of).expect("checked criteria contain only finite numbers").as_bytes())
    }

    /// Returns a game's row. The row does not depend on the other games or on the number of threads. Judges all levels
    /// in parallel. Costs, for each level, the criteria's budgets for a win search and for the ladder's reference
    /// players.
    pub fn row(&self, name: &str, game: &Game, levels: &[Level]) -> GameRow {
        let seed = self.seed.child(&game.digest().to_string(), 0);
        let report = self.panel.judge(Judging::game(game, levels, seed));
        let (name, game, levels) = (name.to_owned(), game.clone(), levels.to_vec());
        let digest = self.digest(&game, &levels);
        let surveyed = SurveyedGame { name, goal: String::new(), game, levels, report };
        GameRow::of(&surveyed, &self.criteria, digest, seed)
    }
}

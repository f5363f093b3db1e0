//! Games judged for a comparison.

use super::row::{self, GameRow};
use super::surveyed::SurveyedGame;
use base::canonical::to_canonical_json;
use base::{Digest, Seed};
use engine::{Game, Level};
use validators::{CheckedCriteria, Criteria, CriteriaError, Criterion, CriterionSet, Effort, Judging, Panel};

/// Judges games one after the other, all alike.
pub struct GameSurvey {
    criteria: CheckedCriteria,
    panel: Panel,
    seed: Seed,
}

/// The criteria that a survey asks: the others are no matter of the comparison, or these tell what they ask.
const ASKED: CriterionSet = CriterionSet::of(&[Criterion::Winnable, Criterion::Skill]);

impl GameSurvey {
    /// A survey by these criteria, of which it takes the players of the ladder, budgets and thresholds, and neither what they ask
    /// nor the players that they hold out.
    ///
    /// # Errors
    /// The criteria are not sensible.
    pub fn new(criteria: &Criteria, seed: Seed) -> Result<GameSurvey, CriteriaError> {
        let criteria = Criteria { ask: ASKED, held_out: Vec::new(), ..criteria.clone() }.check()?;
        Ok(GameSurvey { panel: Panel::new(criteria.clone(), Effort::Full), criteria, seed })
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

    /// The digest of all that decides the row of a game: its rules and levels, the criteria, the seed and the rules of the engine.
    /// Rows with the same digest are the same.
    pub fn digest(&self, game: &Game, levels: &[Level]) -> Digest {
        let levels: Vec<Digest> = levels.iter().map(Level::digest).collect();
        let seed = *self.seed.as_bytes();
        let of = (row::FORM, engine::SEMANTICS, game.digest(), levels, &*self.criteria, seed);
        Digest::of(
            to_canonical_json(&of).expect("checked criteria have no numbers that JSON lacks").as_bytes(),
        )
    }

    /// The row of a game. It gets the same one alone and among others, on any number of threads. Cost: for each level the
    /// budgets of the criteria for a witness and for a ladder; all levels at once.
    pub fn row(&self, name: &str, game: &Game, levels: &[Level]) -> GameRow {
        let seed = self.seed.child(&game.digest().to_string(), 0);
        let report = self.panel.judge(Judging::game(game, levels, seed));
        let (name, game, levels) = (name.to_owned(), game.clone(), levels.to_vec());
        let digest = self.digest(&game, &levels);
        let surveyed = SurveyedGame { name, goal: String::new(), game, levels, report };
        GameRow::of(&surveyed, &self.criteria, digest, seed)
    }
}

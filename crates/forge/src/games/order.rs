//! Orders of games.

use crate::levels::Method;
use generators::games::Kind;
use generators::levels::LevelConfig;
use serde::{Deserialize, Serialize};
use validators::{CheckedCriteria, Criteria, Criterion, CriterionSet};

/// An order of games.
#[derive(Clone, Debug, PartialEq)]
pub struct GameOrder {
    /// The method of inventing them. Games of kernels are drawn, whatever it is.
    pub method: Method,
    /// The number of games.
    pub count: u32,
    /// The kinds, which take turns.
    pub kinds: Vec<Kind>,
    /// Levels of each, from the easiest to the hardest.
    pub levels: u32,
    /// Levels that are tried for one place, at most.
    pub level_tries: u32,
    /// Interactions that a game has at least, guards included.
    pub least_interactions: usize,
    /// Different interactions, guards apart, that the wins of its levels execute together, at least.
    pub least_mechanics: usize,
    /// The criteria that each game has to meet. See [`GameOrder::criteria_by_default`].
    pub criteria: CheckedCriteria,
    /// The effort.
    pub effort: GameEffort,
}

base::with_defaults! {
    /// The sizes that boards are drawn from, in cells, both ends included.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct Board {
        /// Columns.
        pub columns: (usize, usize) = (10, 16),
        /// Rows.
        pub rows: (usize, usize) = (8, 11),
    }
}

impl Board {
    /// Levels of these sizes.
    pub fn levels(&self) -> LevelConfig {
        LevelConfig { columns: self.columns, rows: self.rows, ..LevelConfig::default() }
    }
}

/// The effort for one game.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GameEffort {
    /// Attempts: constructive games, searches, or rounds of archives.
    pub attempts: u32,
    /// Attempts at a game of a kernel that is made independently, in each turn of a set of rules.
    pub patience: u32,
    /// Inventions that a search looks at in one attempt.
    pub looks: u32,
    /// Candidates that are looked at together, on all threads. Part of what decides the bytes.
    pub batch: usize,
    /// Further judges, each with dice of its own, who put a game through the gates before it is accepted.
    pub judges: u64,
}

impl GameOrder {
    /// `count` games of kernels of all kinds, five levels each.
    pub fn new(count: u32) -> GameOrder {
        GameOrder {
            method: Method::Constructive,
            count,
            kinds: Kind::ALL.to_vec(),
            levels: 5,
            level_tries: 16,
            least_interactions: 7,
            least_mechanics: 3,
            criteria: GameOrder::criteria_by_default().check().expect("the defaults are in range"),
            effort: GameEffort { attempts: 160, patience: 4, looks: 12, batch: 4, judges: 10 },
        }
    }

    /// `count` invented games by a method, five levels each. Most rule sets have no boards that are worth playing, so many are tried.
    pub fn of_inventions(method: Method, count: u32) -> GameOrder {
        let order = GameOrder::new(count);
        let attempts = match method {
            Method::Constructive => 96,
            Method::Search | Method::Evolutionary => 24,
        };
        GameOrder {
            method,
            level_tries: 6,
            least_interactions: 5,
            effort: GameEffort { attempts, judges: 2, ..order.effort },
            ..order
        }
    }

    /// The order with another number of levels; fewer than three show no progression, so that is not asked then.
    #[must_use]
    pub fn with_levels(mut self, levels: u32) -> GameOrder {
        if levels < 3 {
            self.criteria = self.criteria.without(CriterionSet::of(&[Criterion::Progression]));
        }
        GameOrder { levels, ..self }
    }

    /// The criteria of games that are to be played: those of levels, and all [gates](CriterionSet::GATES). Stricter than those of
    /// a release where chance has a say, so that judges with other seeds find the same: random keys win 5 of 40 episodes at
    /// most instead of 8. The ladder of players is left to releases, which label levels by it.
    pub fn criteria_by_default() -> Criteria {
        Criteria {
            ask: Criteria::default().ask.with(CriterionSet::GATES),
            budget: 1_000_000,
            foresight: 0.4,
            least_ticks: 16,
            most_ticks: 160,
            idle_plays: 36,
            random_wins: 0.125,
            ..Criteria::of_generated_games()
        }
    }
}

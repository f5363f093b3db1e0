//! Orders of games, which state what to make.

use crate::levels::Method;
use generators::games::Kind;
use generators::levels::LevelConfig;
use serde::{Deserialize, Serialize};
use validators::{CheckedCriteria, Criteria, Criterion, CriterionSet};

/// An order of games.
#[derive(Clone, Debug, PartialEq)]
pub struct GameOrder {
    /// The method of inventing games. Games of kernels are drawn, regardless of the method.
    pub method: Method,
    /// The number of games.
    pub count: u32,
    /// The kinds of games, which take turns.
    pub kinds: Vec<Kind>,
    /// The number of levels per game, from easiest to hardest.
    pub levels: u32,
    /// The maximum number of levels that are tried for one position.
    pub level_tries: u32,
    /// The minimum number of interactions in a game, including guards.
    pub least_interactions: usize,
    /// The minimum number of different interactions, not counting guards, that the wins of all levels execute together.
    pub least_mechanics: usize,
    /// The criteria that each game must meet; see [`GameOrder::criteria_by_default`].
    pub criteria: CheckedCriteria,
    /// The effort for one game.
    pub effort: GameEffort,
}

base::with_defaults! {
    /// The range of board sizes in cells, both ends included.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct Board {
        /// The minimum and maximum number of columns.
        pub columns: (usize, usize) = (10, 16),
        /// The minimum and maximum number of rows.
        pub rows: (usize, usize) = (8, 11),
    }
}

impl Board {
    /// Returns a configuration for levels of these sizes.
    pub fn levels(&self) -> LevelConfig {
        LevelConfig { columns: self.columns, rows: self.rows, ..LevelConfig::default() }
    }
}

/// The effort for one game.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GameEffort {
    /// The number of attempts: constructive games, searches, or rounds of archives.
    pub attempts: u32,
    /// The number of attempts at a game of a kernel with one set of rules, for games that are made independently.
    pub patience: u32,
    /// The number of inventions that a search looks at in one attempt.
    pub looks: u32,
    /// The number of candidates that are looked at together, on all threads. The resulting bytes depend on this number.
    pub batch: usize,
    /// The number of further judges, each with its own seed. Each judge puts a game through the gates before the game
    /// is accepted.
    pub judges: u64,
}

impl GameOrder {
    /// Creates an order of `count` games of kernels of all kinds, with five levels each.
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

    /// Creates an order of `count` invented games by a method, with five levels each. Many rule sets are tried, because
    /// most of them have no boards that are worth playing.
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

    /// Returns the order with a different number of levels. Fewer than three levels cannot show a progression, so they
    /// drop that criterion.
    #[must_use]
    pub fn with_levels(mut self, levels: u32) -> GameOrder {
        if levels < 3 {
            self.criteria = self.criteria.without(CriterionSet::of(&[Criterion::Progression]));
        }
        GameOrder { levels, ..self }
    }

    /// Returns the criteria for games that are meant to be played: the criteria for levels, and all
    /// [gates](CriterionSet::GATES). For stochastic games, the criteria are stricter than for a release, so that judges
    /// with other seeds reach the same verdict. For example, random keys win at most 5 of 40 episodes instead of 8. The
    /// ladder of players is left to releases, which use it to label levels.
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

//! Orders of games.

use crate::levels::Method;
use generators::games::Kind;
use generators::levels::LevelConfig;
use serde::{Deserialize, Serialize};
use validators::{Criteria, CriteriaError};

/// The source of the rules of games.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RuleSource {
    /// Patterns of mechanics, combined.
    #[default]
    Patterns,
    /// Kernels in scenes, with courses of levels.
    Kernels,
}

/// An order of games.
#[derive(Clone, Debug, PartialEq)]
pub struct GameOrder {
    /// The method of making them.
    pub method: Method,
    /// The source of their rules; kernels are drawn by the constructive method only.
    pub rules: RuleSource,
    /// The number of games.
    pub count: u32,
    /// The kinds, which take turns.
    pub kinds: Vec<Kind>,
    /// Levels of each, from the easiest to the hardest.
    pub levels: u32,
    /// Levels that are tried for one place, at most.
    pub level_tries: u32,
    /// The sizes of levels.
    pub board: Board,
    /// Interactions that a game has at least, after shrinking, guards included.
    pub least_interactions: usize,
    /// Different interactions, guards apart, that the wins of its levels execute together, at least.
    pub least_mechanics: usize,
    /// The criteria that each game has to meet. See [`GameOrder::criteria_by_default`].
    pub criteria: Criteria,
    /// The effort.
    pub effort: GameEffort,
}

engine::with_defaults! {
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
    /// Attempts: constructive games, searches, or, of an archive, rounds.
    pub attempts: u32,
    /// Attempts for a place after which it goes to another kind. An archive has all kinds anyway.
    pub patience: u32,
    /// Candidates that a search looks at in one attempt.
    pub looks: u32,
    /// Candidates that are looked at together, on all threads. Part of what decides the bytes.
    pub batch: usize,
}

impl GameOrder {
    /// `count` games of all kinds by a method, five levels each.
    pub fn new(method: Method, count: u32) -> GameOrder {
        let (attempts, patience) = match method {
            Method::Constructive => (96, 8),
            Method::Search | Method::Evolutionary => (12, 2),
        };
        GameOrder {
            method,
            rules: RuleSource::Patterns,
            count,
            kinds: Kind::ALL.to_vec(),
            levels: 5,
            level_tries: 8,
            board: Board::default(),
            least_interactions: 7,
            least_mechanics: 3,
            criteria: GameOrder::criteria_by_default(),
            effort: GameEffort { attempts, patience, looks: 24, batch: 4 },
        }
    }

    /// `count` games of kernels, five levels each.
    pub fn of_kernels(count: u32) -> GameOrder {
        let ask = ["well-formed", "readable", "not-idle", "not-random", "early-death", "winnable", "length"];
        let criteria = Criteria {
            ask: ask.map(str::to_owned).to_vec(),
            budget: 1_000_000,
            foresight: 0.4,
            least_ticks: 16,
            most_ticks: 160,
            ..GameOrder::criteria_by_default()
        };
        let order = GameOrder::new(Method::Constructive, count);
        GameOrder { rules: RuleSource::Kernels, level_tries: 16, criteria, ..order }
    }

    /// All criteria of a release, but somewhat stricter where chance has a say, so that judges with other dice find the same:
    /// random keys win 5 of 40 episodes at most instead of 8, and skill pays by 30 points instead of 25. What is hard to win
    /// for a search, or hard to show, is given up early: there are others.
    pub fn criteria_by_default() -> Criteria {
        Criteria {
            budget: 400_000,
            idle_plays: 36,
            ablation_calls: 50_000,
            random_wins: 0.125,
            skill_wins: 0.4,
            skill_overall: 0.3,
            ..Criteria::of_generated_games()
        }
    }

    /// Checks the values.
    ///
    /// # Errors
    /// The first of the criteria that is out of its range.
    pub fn check(&self) -> Result<(), CriteriaError> {
        self.criteria.check()
    }
}

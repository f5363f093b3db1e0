//! Orders of levels, and the levels that are made for them.

use engine::{Analysis, Level, SpriteType};
use generators::levels::{LevelConfig, PuzzleConfig};
use std::fmt;
use std::str::FromStr;
use validators::{
    CheckedCriteria, Criteria, CriteriaError, Criterion, CriterionSet, Difficulty, Ladder, Report, RuleRef,
};

base::named_enum! {
    /// The method of making levels or games.
    pub enum Method {
        /// Walls, then furniture by role: instant, and judged only where something is asked that has to be measured.
        Constructive = "constructive",
        /// Levels are altered step by step while judges look on: each by itself.
        Search = "search",
        /// An archive of levels that differ evolves under the eyes of judges; the levels are picked from it.
        Evolutionary = "evolutionary",
    }
}

/// Floor plans for each level of a search that makes them better itself.
const PLANS_OF_ARCHIVE: usize = 40;
/// Shares of the longest way to a solution, where it is measured what a level is like.
const ANY_WAY: (f64, f64) = (0.05, 1.0);

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(name: &str) -> Result<Method, String> {
        let found = Method::ALL.into_iter().find(|method| method.name() == name);
        found.ok_or_else(|| {
            format!("there is no method `{name}`; there are constructive, search, evolutionary")
        })
    }
}

/// An order of levels.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelOrder {
    /// The method of making them.
    pub method: Method,
    /// The number of levels.
    pub count: u32,
    /// Size, and what else the constructive generator is told. Its difficulty is replaced where [`LevelOrder::difficulty`] is
    /// given.
    pub config: LevelConfig,
    /// The difficulty of each, measured with the ladder of the criteria.
    pub difficulty: Option<Difficulty>,
    /// Ticks that the shortest win found takes at least.
    pub min_solution: Option<usize>,
    /// Rules that the win has to use, every one.
    pub uses: Vec<RuleRef>,
    /// The criteria that each level has to meet. See [`LevelOrder::criteria_by_default`].
    pub criteria: Criteria,
    /// The effort of a search.
    pub effort: Effort,
}

base::with_defaults! {
    /// The effort of a search for one level, or for one level of an archive.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Effort {
        /// Candidates that are looked at between two attempts to have the best of them accepted.
        pub looks: u32 = 32,
        /// Candidates that are looked at together, on all threads. Part of what decides the bytes.
        pub batch: usize = 8,
        /// Attempts; more of them for a single level where most looks are cheap.
        pub rounds: u32 = 6,
        /// Forward-model calls of a look for a win: so many, or up to four times as many where plays are long.
        pub calls: u64 = 100_000,
    }
}

/// A level that was made.
#[derive(Clone, Debug)]
pub struct MadeLevel {
    /// Its number among those that were asked for.
    pub number: u32,
    /// The level.
    pub level: Level,
    /// The findings of its judges; `None` for a level that nobody has judged.
    pub report: Option<Report>,
    /// The ladder that tells how hard it is, if that was asked.
    pub ladder: Option<Ladder>,
}

impl LevelOrder {
    /// `count` levels of a method, with nothing special asked.
    pub fn new(method: Method, count: u32, config: LevelConfig) -> LevelOrder {
        LevelOrder {
            method,
            count,
            config,
            difficulty: None,
            min_solution: None,
            uses: Vec::new(),
            criteria: LevelOrder::criteria_by_default(),
            effort: Effort::default(),
        }
    }

    /// The criteria of a release for levels, but stricter with random play: 1 of 40 episodes won at most, so that a second
    /// look with other dice finds 10 % or less.
    ///
    /// `readable` is left out: it is a property of the rules.
    pub fn criteria_by_default() -> Criteria {
        let default = Criteria::default();
        let ask = default.ask.without(CriterionSet::of(&[Criterion::Readable]));
        Criteria { ask, random_wins: 0.025, ..default }
    }

    /// Checks the criteria with the requested shortest win.
    pub(super) fn checked_criteria(&self) -> Result<CheckedCriteria, CriteriaError> {
        let least_ticks = self.criteria.least_ticks.max(self.min_solution.unwrap_or(0));
        Criteria { least_ticks, ..self.criteria.clone() }.check()
    }

    /// The configuration of the constructive generator, with the requested difficulty translated to its own scale.
    pub fn config(&self) -> LevelConfig {
        let labels = Difficulty::LABELS.iter().map(|(label, _)| label);
        let place = self.difficulty.and_then(|asked| labels.clone().position(|label| *label == asked));
        let difficulty = place.map_or(self.config.difficulty, |place| place as f64 / 4.0);
        LevelConfig { difficulty, ..self.config.clone() }
    }

    /// The configuration of puzzles: as many things to push as the configuration counts. An archive sees to it itself
    /// that its levels get better, one by one. Where a difficulty is asked, the farthest position is seldom the one:
    /// few of the players that measure it win puzzles that long.
    pub(super) fn puzzle(&self, analysis: &Analysis) -> PuzzleConfig {
        let pushed =
            |stype: &SpriteType| analysis.pushables().iter().any(|pushable| pushable.stype == *stype);
        let counts = self.config.counts.iter().filter(|(stype, _)| pushed(stype));
        let things = counts.map(|(_, count)| *count).reduce(|one, two| one + two);
        let is_annealed = self.method != Method::Evolutionary && self.difficulty.is_none();
        PuzzleConfig {
            things,
            floor_plans: if is_annealed { PuzzleConfig::default().floor_plans } else { PLANS_OF_ARCHIVE },
            way: self.difficulty.map(|_| ANY_WAY),
            target: None,
        }
    }

    /// Returns `true` if something is asked that only playing can tell.
    pub fn has_to_be_measured(&self) -> bool {
        self.difficulty.is_some() || self.min_solution.is_some() || !self.uses.is_empty()
    }
}

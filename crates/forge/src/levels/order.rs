//! Level orders, and the levels generated for them.

use engine::{Analysis, Level, SpriteType};
use generators::levels::{LevelConfig, PuzzleConfig};
use std::fmt;
use std::str::FromStr;
use validators::{
    CheckedCriteria, Criteria, CriteriaError, Criterion, CriterionSet, Difficulty, Ladder, Report, RuleRef,
};

base::named_enum! {
    /// The method of generating levels or games.
    pub enum Method {
        /// Draws walls, and then places sprites by role. This method takes almost no time, and levels are judged only
        /// if the request requires measurements.
        Constructive = "constructive",
        /// Changes each level step by step, independently of other levels and guided by judges.
        Search = "search",
        /// Evolves a diverse archive of levels, guided by judges, and picks the final levels from it.
        Evolutionary = "evolutionary",
    }
}

/// The number of floor plans to examine per puzzle in a search that improves the levels itself.
const PLANS_OF_ARCHIVE: usize = 40;
/// The range of a puzzle's distance from its solution, as fractions of the longest distance, for levels whose
/// difficulty will be measured.
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
            format!("there is no method `{name}`; choose constructive, search or evolutionary")
        })
    }
}

/// A request for generated levels.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelOrder {
    /// The method of generating the levels.
    pub method: Method,
    /// The number of levels to generate.
    pub count: u32,
    /// The level size and the other settings of the constructive generator. If [`LevelOrder::difficulty`] is set, it
    /// overrides the configuration's difficulty.
    pub config: LevelConfig,
    /// The difficulty of each level, measured by the ladder in the criteria, which is a list of reference players of
    /// increasing strength; `None` if no difficulty is requested.
    pub difficulty: Option<Difficulty>,
    /// The minimum number of ticks in the shortest win found; `None` for no minimum.
    pub min_solution: Option<usize>,
    /// The rules that the win must use. All of them are required.
    pub uses: Vec<RuleRef>,
    /// The criteria that each level must meet; see [`LevelOrder::criteria_by_default`].
    pub criteria: Criteria,
    /// The numbers of rounds and looks (quick evaluations) allowed for a search.
    pub effort: Effort,
}

base::with_defaults! {
    /// The effort of a search for a single level, or for one level in an archive.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Effort {
        /// The number of candidates to evaluate before each attempt to get the best candidate accepted.
        pub looks: u32 = 32,
        /// The number of candidates evaluated together, on all threads. Changing this number changes the generated
        /// bytes.
        pub batch: usize = 8,
        /// The number of attempts. A single level gets more attempts if most evaluations are cheap.
        pub rounds: u32 = 6,
        /// The maximum number of forward-model calls per win search. The limit is up to four times as high if episodes
        /// are long.
        pub calls: u64 = 100_000,
    }
}

/// A generated level.
#[derive(Clone, Debug)]
pub struct MadeLevel {
    /// The level's number in the order.
    pub number: u32,
    /// The level.
    pub level: Level,
    /// The findings of the level's judges; `None` if the level was not judged.
    pub report: Option<Report>,
    /// The results of the ladder's reference players that measured the level's difficulty; `None` if no difficulty was
    /// requested.
    pub ladder: Option<Ladder>,
}

impl LevelOrder {
    /// Creates an order of `count` levels by a method, without special requests.
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

    /// Returns a release's level criteria, with a stricter limit for random play. Random play may win at most 1 of 40
    /// episodes, so that a second measurement with different seeds is likely to find a win rate of 10% or less.
    ///
    /// `readable` is omitted because it depends only on the rules.
    pub fn criteria_by_default() -> Criteria {
        let default = Criteria::default();
        let ask = default.ask.without(CriterionSet::of(&[Criterion::Readable]));
        Criteria { ask, random_wins: 0.025, ..default }
    }

    /// Checks the criteria, together with the requested minimum length of the shortest win.
    pub(super) fn checked_criteria(&self) -> Result<CheckedCriteria, CriteriaError> {
        let least_ticks = self.criteria.least_ticks.max(self.min_solution.unwrap_or(0));
        Criteria { least_ticks, ..self.criteria.clone() }.check()
    }

    /// Returns the constructive generator's configuration, with the requested difficulty converted to the generator's
    /// scale.
    pub fn config(&self) -> LevelConfig {
        let labels = Difficulty::LABELS.iter().map(|(label, _)| label);
        let place = self.difficulty.and_then(|asked| labels.clone().position(|label| *label == asked));
        let difficulty = place.map_or(self.config.difficulty, |place| place as f64 / 4.0);
        LevelConfig { difficulty, ..self.config.clone() }
    }

    /// Returns the configuration of puzzles, with the number of pushable objects from the order's configuration. An
    /// archive improves each level afterwards, so it needs few floor plans. If a difficulty is requested, the position
    /// farthest from a solution is seldom suitable, because few of the ladder's reference players win such long
    /// puzzles.
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

    /// Returns `true` if the order contains a requirement that can be measured only by playing.
    pub fn has_to_be_measured(&self) -> bool {
        self.difficulty.is_some() || self.min_solution.is_some() || !self.uses.is_empty()
    }
}

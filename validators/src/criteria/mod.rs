//! The criteria: a table that names each of them, and the traits of their judges.
//!
//! The module of a criterion has its judge, the constant `QUESTION`, and a function `judge` that makes the judge for a
//! [`Setting`].

mod ablation;
mod early_death;
mod length;
mod not_idle;
mod not_random;
mod readable;
mod rule_use;
mod skill;
mod skill_overall;
mod well_formed;
mod winnable;

pub(crate) use ablation::is_guard;
pub use early_death::NoEarlyDeath;
pub(crate) use length::without_proof;
pub use not_idle::NotIdle;
pub use not_random::NotRandom;
pub use rule_use::RulesShown;
pub(crate) use rule_use::with_count;
pub use skill_overall::SkillOverall;
pub use well_formed::WellFormed;
pub(crate) use well_formed::is_over_at_once;

use crate::allowance::Setting;
use crate::criterion_set::CriterionSet;
use crate::gates::{
    CarelessPlays, actors_matter, drama, necessity, no_dead_time, not_instant, open_ground, progression,
    tight,
};
use crate::measures::Ladder;
use crate::recording::{Recorded, Usage};
use crate::verdict::Finding;
use agents::Stopped;
use base::Seed;
use engine::{Analysis, Episode, Game, Level};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// A level to judge, with the seed to use.
#[derive(Clone, Copy)]
pub struct Case<'a> {
    /// The game.
    pub game: &'a Game,
    /// The level.
    pub level: &'a Level,
    /// The source of the validator's own randomness.
    pub seed: Seed,
    /// The analysis of the rules of the game.
    pub analysis: &'a Analysis,
    /// An episode that wins, if an earlier validator found one.
    pub witness: Option<&'a Episode>,
}

/// The judge of a criterion of levels.
pub trait Validator: Sync {
    /// Judges the case. The same case gives the same answer, on any number of threads.
    fn validate(&self, case: Case<'_>) -> Finding;

    /// Like [`Validator::validate`], but can be cancelled: once `stopped` returns `true`, it returns soon, and its finding is
    /// meaningless.
    fn validate_until(&self, case: Case<'_>, stopped: Stopped<'_>) -> Finding {
        let _ = stopped;
        self.validate(case)
    }
}

/// A game with its levels and their recorded episodes.
#[derive(Clone, Copy)]
pub(crate) struct GameCase<'a> {
    /// The game.
    pub(crate) game: &'a Game,
    /// The analysis of its rules.
    pub(crate) analysis: &'a Analysis,
    /// Its levels with the episodes that their validators played.
    pub(crate) recording: &'a [Recorded<'a>],
    /// The ladder results of each level, if its ladder was played.
    pub(crate) ladders: &'a [Option<&'a Ladder>],
    /// The rules and types that those episodes show.
    pub(crate) usage: &'a Usage,
    /// The plays of careless players that gates share.
    pub(crate) careless: &'a CarelessPlays,
    /// The source of the validator's own randomness.
    pub(crate) seed: Seed,
}

/// The judge of a criterion of a game over all its levels.
pub(crate) trait GameValidator: Sync {
    /// Whether the judge needs to know which rules the recording executes. If no judge does, the recording is not replayed, and no
    /// random walks look for executions of the other rules.
    fn asks_for_usage(&self) -> bool {
        false
    }

    /// Judges the case. The same case gives the same answer, on any number of threads.
    fn validate(&self, case: GameCase<'_>) -> Finding;

    /// Like [`GameValidator::validate`], but can be cancelled: once `stopped` returns `true`, it returns soon, and its finding is
    /// meaningless.
    fn validate_until(&self, case: GameCase<'_>, stopped: Stopped<'_>) -> Finding {
        let _ = stopped;
        self.validate(case)
    }
}

/// What a criterion of levels takes for granted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// It asks nothing of play, or its answer is the reason why the others are not asked.
    Start,
    /// It asks about plays that get beyond the first tick.
    Play,
    /// It searches for a win.
    Search,
    /// It asks about the win.
    Win,
    /// It lets a ladder of players play, which may win what no search did; skipped on a level that nobody can win.
    Ladder,
}

/// What a criterion of games is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum About {
    /// The players.
    Players,
    /// Winning play: levels without a known win are left out.
    Play,
    /// The rules: doubts about them may follow from a level that nobody can win.
    Rules,
}

/// A criterion of levels with its judge.
pub(crate) struct LevelJudge {
    pub(crate) criterion: Criterion,
    pub(crate) stage: Stage,
    pub(crate) validator: Box<dyn Validator + Send>,
}

/// A criterion of games with its judge.
pub(crate) struct GameJudge {
    pub(crate) criterion: Criterion,
    pub(crate) about: About,
    pub(crate) validator: Box<dyn GameValidator + Send>,
}

/// What an answer takes, from the cheapest to the dearest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cost {
    /// A look at the rules, the level or a known win.
    Reading,
    /// Plays of players that do not look ahead.
    Plays,
    /// Searches through the states of the game.
    Search,
    /// Plays of a ladder of players.
    Ladder,
}

/// Defines [`Criterion`] from a table with a line for each criterion.
macro_rules! criteria {
    (
        levels { $($level:ident = $level_name:literal, $stage:ident, $level_cost:ident, $level_module:ident;)* }
        games { $($game:ident = $game_name:literal, $about:ident, $game_cost:ident, $game_module:ident;)* }
        gates { $($gate:ident = $gate_name:literal, $gate_cost:ident, $gate_module:ident;)* }
    ) => {
        /// A criterion of a level, or of a game over all its levels. The order is that of checking.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Criterion {
            $(#[doc = concat!("`", $level_name, "`, of a level.")] $level,)*
            $(#[doc = concat!("`", $game_name, "`, of a game.")] $game,)*
            $(#[doc = concat!("`", $gate_name, "`, a gate.")] $gate,)*
        }

        impl CriterionSet {
            /// The criteria of a level.
            pub const LEVEL: CriterionSet = CriterionSet::of(&[$(Criterion::$level),*]);
            /// The criteria of a game over all its levels, except gates.
            pub const GAME: CriterionSet = CriterionSet::of(&[$(Criterion::$game),*]);
            /// The gates: criteria of a game that measure what people see in play.
            pub const GATES: CriterionSet = CriterionSet::of(&[$(Criterion::$gate),*]);
        }

        impl Criterion {
            /// All criteria, in the order of checking.
            pub const ALL: &[Criterion] =
                &[$(Criterion::$level,)* $(Criterion::$game,)* $(Criterion::$gate,)*];

            /// Returns the name in recipes, reports and cards.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Criterion::$level => $level_name,)*
                    $(Criterion::$game => $game_name,)*
                    $(Criterion::$gate => $gate_name,)*
                }
            }

            /// Returns the question that the criterion asks, in one sentence.
            pub fn question(self) -> &'static str {
                match self {
                    $(Criterion::$level => $level_module::QUESTION,)*
                    $(Criterion::$game => $game_module::QUESTION,)*
                    $(Criterion::$gate => $gate_module::QUESTION,)*
                }
            }

            /// Returns what an answer takes.
            pub fn cost(self) -> Cost {
                match self {
                    $(Criterion::$level => Cost::$level_cost,)*
                    $(Criterion::$game => Cost::$game_cost,)*
                    $(Criterion::$gate => Cost::$gate_cost,)*
                }
            }

            /// Returns the judge of a criterion of levels.
            pub(crate) fn level_judge(self, setting: &Setting<'_>) -> Option<LevelJudge> {
                let judge = |stage, validator| LevelJudge { criterion: self, stage, validator };
                match self {
                    $(Criterion::$level => Some(judge(Stage::$stage, Box::new($level_module::judge(setting)))),)*
                    _ => None,
                }
            }

            /// Returns the judge of a criterion of games.
            pub(crate) fn game_judge(self, setting: &Setting<'_>) -> Option<GameJudge> {
                let judge = |about, validator| GameJudge { criterion: self, about, validator };
                match self {
                    $(Criterion::$game => Some(judge(About::$about, Box::new($game_module::judge(setting)))),)*
                    $(Criterion::$gate => Some(judge(About::Play, Box::new($gate_module::judge(setting)))),)*
                    _ => None,
                }
            }
        }
    };
}

criteria! {
    levels {
        WellFormed = "well-formed", Start, Reading, well_formed;
        Readable = "readable", Start, Reading, readable;
        NotIdle = "not-idle", Play, Plays, not_idle;
        NotRandom = "not-random", Play, Plays, not_random;
        EarlyDeath = "early-death", Play, Search, early_death;
        Winnable = "winnable", Search, Search, winnable;
        Length = "length", Win, Reading, length;
        Skill = "skill", Ladder, Ladder, skill;
    }
    games {
        SkillOverall = "skill-overall", Players, Ladder, skill_overall;
        RuleUse = "rule-use", Rules, Plays, rule_use;
        Ablation = "ablation", Rules, Search, ablation;
    }
    gates {
        OpenGround = "open-ground", Reading, open_ground;
        Progression = "progression", Plays, progression;
        Drama = "drama", Plays, drama;
        NoDeadTime = "no-dead-time", Reading, no_dead_time;
        NotInstant = "not-instant", Plays, not_instant;
        ActorsMatter = "actors-matter", Plays, actors_matter;
        Tight = "tight", Plays, tight;
        Necessity = "necessity", Search, necessity;
    }
}

impl Criterion {
    /// Returns `true` for a criterion of a level.
    pub fn of_level(self) -> bool {
        CriterionSet::LEVEL.contains(self)
    }

    /// Returns `true` for a criterion of a game over all its levels, gates included.
    pub fn of_game(self) -> bool {
        !self.of_level()
    }

    /// Returns `true` for a gate: a criterion of a game that measures what people see in play.
    pub fn is_gate(self) -> bool {
        CriterionSet::GATES.contains(self)
    }
}

impl fmt::Display for Criterion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The error for a name that no criterion has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no criterion `{name}`{}; the criteria are {}", self.help(), names(Criterion::ALL))]
pub struct UnknownCriterion {
    name: String,
}

impl UnknownCriterion {
    fn help(&self) -> String {
        let near = engine::nearest(&self.name, Criterion::ALL.iter().map(|criterion| criterion.name()));
        near.map_or(String::new(), |near| format!("; did you mean `{near}`?"))
    }
}

fn names(criteria: &[Criterion]) -> String {
    criteria.iter().map(|criterion| criterion.name()).collect::<Vec<_>>().join(", ")
}

impl FromStr for Criterion {
    type Err = UnknownCriterion;

    fn from_str(name: &str) -> Result<Criterion, UnknownCriterion> {
        let found = Criterion::ALL.iter().copied().find(|criterion| criterion.name() == name);
        found.ok_or_else(|| UnknownCriterion { name: name.to_owned() })
    }
}

impl Serialize for Criterion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Criterion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Criterion, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_read_back() {
        for &criterion in Criterion::ALL {
            assert_eq!(criterion.name().parse(), Ok(criterion));
            assert_eq!(serde_json::to_value(criterion).unwrap(), criterion.name());
            assert!(criterion.question().ends_with('?'), "{criterion}");
        }
        let error = "winable".parse::<Criterion>().unwrap_err().to_string();
        assert!(error.contains("`winable`; did you mean `winnable`?"), "{error}");
        assert!(error.ends_with("tight, necessity"), "{error}");
    }

    #[test]
    fn every_criterion_is_of_levels_or_of_games() {
        let count =
            |is: fn(Criterion) -> bool| Criterion::ALL.iter().filter(|&&criterion| is(criterion)).count();
        assert_eq!(count(Criterion::of_level) + count(Criterion::of_game), Criterion::ALL.len());
        assert_eq!(CriterionSet::GATES.iter().count(), count(Criterion::is_gate));
        assert!(CriterionSet::GATES.iter().all(Criterion::of_game));
    }
}

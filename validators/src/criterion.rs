//! The names of criteria, and criterion sets.

use base::SeedPath;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// Calls the macro `$with` with the table of all criteria, in checking order. A row lists the variant of [`Criterion`],
/// its name, its [`Stage`] or its subject ([`About`]), its [`Cost`], and the module of its judge.
macro_rules! every_criterion {
    ($with:ident) => {
        $with! {
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
    };
}
pub(crate) use every_criterion;

/// The assumptions that a level criterion makes about the level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// The criterion does not depend on play, or its failure makes the panel skip other criteria.
    Start,
    /// The criterion examines episodes that get beyond the first tick.
    Play,
    /// The criterion searches for a win.
    Search,
    /// The criterion examines the win found.
    Win,
    /// The criterion uses a ladder of reference players, which may win even if no search did. Skipped on unwinnable
    /// levels.
    Ladder,
}

/// The subject of a game criterion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum About {
    /// The players' results.
    Players,
    /// Winning play. Skips levels without a known win.
    Play,
    /// The rules. Doubts about the rules may be due only to an unwinnable level.
    Rules,
}

/// The cost of reaching a verdict, from lowest to highest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cost {
    /// An inspection of the rules, the level or a known win.
    Reading,
    /// Episodes by players that do not look ahead.
    Plays,
    /// Searches through the game's states.
    Search,
    /// Episodes by a ladder of reference players of increasing strength.
    Ladder,
}

/// Defines [`Criterion`] from the table of criteria.
macro_rules! define {
    (
        levels { $($level:ident = $level_name:literal, $stage:ident, $level_cost:ident, $level_module:ident;)* }
        games { $($game:ident = $game_name:literal, $about:ident, $game_cost:ident, $game_module:ident;)* }
        gates { $($gate:ident = $gate_name:literal, $gate_cost:ident, $gate_module:ident;)* }
    ) => {
        /// A criterion for a level, or for a game as a whole. The variants are in checking order.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Criterion {
            $(#[doc = concat!("`", $level_name, "`, of a level.")] $level,)*
            $(#[doc = concat!("`", $game_name, "`, of a game.")] $game,)*
            $(#[doc = concat!("`", $gate_name, "`, a gate.")] $gate,)*
        }

        impl CriterionSet {
            /// The level criteria.
            pub const LEVEL: CriterionSet = CriterionSet::of(&[$(Criterion::$level),*]);
            /// The game criteria, except gates.
            pub const GAME: CriterionSet = CriterionSet::of(&[$(Criterion::$game),*]);
            /// The gates: criteria for whole games that measure what people notice in play.
            pub const GATES: CriterionSet = CriterionSet::of(&[$(Criterion::$gate),*]);
        }

        impl Criterion {
            /// All criteria, in checking order.
            pub const ALL: &[Criterion] =
                &[$(Criterion::$level,)* $(Criterion::$game,)* $(Criterion::$gate,)*];

            /// Returns the name used in recipes, reports and cards.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Criterion::$level => $level_name,)*
                    $(Criterion::$game => $game_name,)*
                    $(Criterion::$gate => $gate_name,)*
                }
            }

            /// Returns the cost of reaching a verdict.
            pub fn cost(self) -> Cost {
                match self {
                    $(Criterion::$level => Cost::$level_cost,)*
                    $(Criterion::$game => Cost::$game_cost,)*
                    $(Criterion::$gate => Cost::$gate_cost,)*
                }
            }
        }
    };
}

every_criterion!(define);

impl Criterion {
    /// Returns the seed for this level criterion's judge, given the panel's seed.
    pub fn seed(self, panel: &SeedPath) -> SeedPath {
        panel.child(self.name(), 0)
    }

    /// Returns `true` for a level criterion.
    pub fn of_level(self) -> bool {
        CriterionSet::LEVEL.contains(self)
    }

    /// Returns `true` for a game criterion, including gates.
    pub fn of_game(self) -> bool {
        !self.of_level()
    }
}

impl fmt::Display for Criterion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The error for an unknown criterion name.
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

/// A set of criteria, in checking order.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct CriterionSet(u32);

impl CriterionSet {
    /// Returns the set with the given criteria.
    pub const fn of(criteria: &[Criterion]) -> CriterionSet {
        let (mut bits, mut at) = (0, 0);
        while at < criteria.len() {
            bits |= 1 << criteria[at] as u32;
            at += 1;
        }
        CriterionSet(bits)
    }

    /// Returns the criteria with a given cost.
    pub fn costing(cost: Cost) -> CriterionSet {
        Criterion::ALL.iter().copied().filter(|criterion| criterion.cost() == cost).collect()
    }

    /// Returns `true` if the criterion is in the set.
    pub const fn contains(self, criterion: Criterion) -> bool {
        self.0 & 1 << criterion as u32 != 0
    }

    /// Returns `true` for the empty set.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns the set with all criteria in `others` added.
    #[must_use]
    pub const fn with(self, others: CriterionSet) -> CriterionSet {
        CriterionSet(self.0 | others.0)
    }

    /// Returns the criteria that are in both sets.
    #[must_use]
    pub const fn only(self, others: CriterionSet) -> CriterionSet {
        CriterionSet(self.0 & others.0)
    }

    /// Returns the set without the criteria in `others`.
    #[must_use]
    pub const fn without(self, others: CriterionSet) -> CriterionSet {
        CriterionSet(self.0 & !others.0)
    }

    /// Returns the criteria, in checking order.
    pub fn iter(self) -> impl Iterator<Item = Criterion> {
        Criterion::ALL.iter().copied().filter(move |&criterion| self.contains(criterion))
    }
}

impl FromIterator<Criterion> for CriterionSet {
    fn from_iter<I: IntoIterator<Item = Criterion>>(criteria: I) -> CriterionSet {
        criteria
            .into_iter()
            .fold(CriterionSet::default(), |set, criterion| set.with(CriterionSet::of(&[criterion])))
    }
}

impl fmt::Debug for CriterionSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.iter()).finish()
    }
}

impl Serialize for CriterionSet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

impl<'de> Deserialize<'de> for CriterionSet {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<CriterionSet, D::Error> {
        Ok(Vec::<Criterion>::deserialize(deserializer)?.into_iter().collect())
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
        assert!(CriterionSet::GATES.iter().all(Criterion::of_game));
    }

    #[test]
    fn a_set_keeps_the_order_of_checking() {
        let set: CriterionSet = serde_json::from_str(r#"["drama", "winnable", "drama"]"#).unwrap();
        assert_eq!(serde_json::to_string(&set).unwrap(), r#"["winnable","drama"]"#);
        assert_eq!(set.only(CriterionSet::GATES), CriterionSet::of(&[Criterion::Drama]));
        assert_eq!(set.without(CriterionSet::GATES), CriterionSet::of(&[Criterion::Winnable]));
        assert!(set.without(set).is_empty() && set.with(CriterionSet::LEVEL).contains(Criterion::Skill));
    }

    #[test]
    fn the_dearest_criteria_are_those_of_the_ladder() {
        let of_ladder = CriterionSet::of(&[Criterion::Skill, Criterion::SkillOverall]);
        assert_eq!(CriterionSet::costing(Cost::Ladder), of_ladder);
    }
}

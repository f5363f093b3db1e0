//! The thresholds of all criteria, in one place.

use crate::criterion::{Criterion, CriterionSet};
use crate::gates::Gates;
use crate::measures::ladder::LadderConfig;
use agents::PortfolioConfig;
use agents::ReferencePlanner;
use serde::{Deserialize, Serialize};
use std::ops::Deref;

base::with_defaults! {
    /// The thresholds of all criteria, which are the `[criteria]` table of a recipe. The page
    /// `docs/reference/validate.md` explains each threshold. The defaults are for minting, and are cheap enough for
    /// many candidates.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct Criteria {
        /// The criteria to check, in a fixed order from cheapest to most expensive.
        pub ask: CriterionSet = CriterionSet::LEVEL.without(CriterionSet::of(&[Criterion::Skill])),
        /// The number of forward-model calls per decision of the searching player. Players on the ladder whose names do
        /// not specify a number have the same budget.
        pub decision: u64 = 500,
        /// The total number of forward-model calls to find a win.
        pub budget: u64 = 3_000_000,
        /// The fraction of the budget that may be used to prove the length of the shortest win in a deterministic game.
        pub shortest: f64 = 0.1,
        /// The fraction of the budget that is reserved, in a stochastic game, for a search that foresees all randomness
        /// of an episode.
        #[serde(skip_serializing_if = "is_zero")]
        pub foresight: f64 = 0.0,
        /// The look-ahead, in ticks, of each bold tree search among the players that look for a win. Each entry adds
        /// one such player.
        pub depths: Vec<u32> = vec![20],
        /// The number of plain tree search episodes reported on a level's card.
        pub mcts_plays: u32 = 4,
        /// The number of episodes in which the player does nothing.
        pub idle_plays: u32 = 8,
        /// The number of episodes of random play.
        pub random_plays: u32 = 40,
        /// The maximum fraction of random episodes that may be won.
        pub random_wins: f64 = 0.2,
        /// The minimum number of ticks in the shortest win found.
        pub least_ticks: usize = 8,
        /// The maximum number of ticks in the shortest win found.
        pub most_ticks: usize = 1000,
        /// The number of initial ticks in which death must be avoidable.
        pub early_ticks: usize = 12,
        /// The number of forward-model calls per random seed in a search for a way to survive the first ticks.
        pub early_calls: u64 = 20_000,
        /// The number of random seeds with which to search for a way to survive the first ticks.
        #[serde(rename = "early_chances")]
        pub early_seeds: u32 = 20,
        /// The maximum fraction of random seeds with which early death may be unavoidable.
        pub early_deaths: f64 = 0.05,
        /// The players (for example `mcts:500`) with which difficulty and skill are measured, from weakest to
        /// strongest.
        pub ladder: Vec<String> = names(&["do-nothing", "random", "one-step", "mcts:30", "mcts:100", "olets:50"]),
        /// The players that must show skill in addition to those in `ladder`. They never guide a search.
        pub held_out: Vec<String> = names(&["mcts:300", "olets:200"]),
        /// The maximum number of episodes per player.
        pub ladder_plays: u64 = 12,
        /// The total number of forward-model calls by all players after which no further round of episodes begins.
        pub ladder_calls: u64 = 5_000_000,
        /// The limit on the length of an episode by a player on the ladder, as a multiple of the witness's ticks (plus
        /// 50).
        pub patience: usize = 3,
        /// The minimum difference between the win rates of stronger and weaker players.
        pub skill_wins: f64 = 0.25,
        /// The minimum difference between the mean scores of stronger and weaker players, as a fraction of the range of
        /// all scores. Reaching this difference is sufficient even if `skill_wins` is not reached.
        pub skill_scores: f64 = 0.1,
        /// `skill-overall`: the minimum lower end of the 95% interval for a difference between two players' win rates
        /// over all levels. One of the players looks ahead, and the other is the best player that does not.
        pub skill_overall: f64 = 0.25,
        /// The number of forward-model calls per rule to show that the rule matters.
        pub ablation_calls: u64 = 200_000,
        /// The thresholds of the gates.
        #[serde(skip_serializing_if = "Gates::are_default")]
        pub gates: Gates = Gates::default(),
    }
}

/// Returns `true` if a fraction is 0, and can therefore be omitted from files.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(share: &f64) -> bool {
    *share == 0.0
}

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

/// A problem with the values in a set of criteria.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{key}` {message}")]
pub struct CriteriaError {
    /// The value's key.
    pub key: &'static str,
    /// The unmet requirement.
    pub message: String,
}

/// Returns the error for a value that is out of range.
fn wrong<T>(key: &'static str, message: impl Into<String>) -> Result<T, CriteriaError> {
    Err(CriteriaError { key, message: message.into() })
}

impl Criteria {
    /// Returns the criteria for a single game, including criteria not used by minting. `skill-overall` is not included,
    /// because it may fail a good game merely for being too hard.
    pub fn full() -> Criteria {
        let all = Criteria::of_generated_games();
        Criteria { ask: all.ask.without(CriterionSet::of(&[Criterion::SkillOverall])), ..all }
    }

    /// Returns the configuration of the win search.
    pub fn search(&self) -> PortfolioConfig {
        PortfolioConfig {
            budget: self.budget,
            shortest: self.shortest,
            foresight: self.foresight,
            decision: self.decision,
            depths: self.depths.clone(),
            ..PortfolioConfig::default()
        }
    }

    /// Returns all criteria for generated levels and games, of which there are many candidates.
    pub fn of_generated_games() -> Criteria {
        Criteria { ask: CriterionSet::LEVEL.with(CriterionSet::GAME), ..Criteria::default() }
    }

    /// Returns `true` if a criterion is checked.
    pub fn includes(&self, criterion: Criterion) -> bool {
        self.ask.contains(criterion)
    }

    /// Checks the values. Judges accept only criteria that were checked.
    ///
    /// # Errors
    /// Returns an error for the first value that is out of range.
    pub fn check(&self) -> Result<CheckedCriteria, CriteriaError> {
        if self.includes(Criterion::SkillOverall) && !self.includes(Criterion::Skill) {
            return wrong("ask", "lists `skill-overall`, which needs the episodes of `skill`: list both");
        }
        let depths = &self.depths;
        if depths.is_empty() || depths.len() > 20 || depths.iter().any(|depth| !(1..=1000).contains(depth)) {
            return wrong("depths", "takes 1 to 20 numbers of ticks, each from 1 to 1000");
        }
        for (key, share) in [
            ("shortest", self.shortest),
            ("random_wins", self.random_wins),
            ("early_deaths", self.early_deaths),
            ("skill_wins", self.skill_wins),
            ("skill_scores", self.skill_scores),
            ("skill_overall", self.skill_overall),
        ] {
            if !(0.0..=1.0).contains(&share) {
                return wrong(key, format!("is {share}; the value must be a fraction from 0 to 1"));
            }
        }
        if self.decision == 0 || self.decision > 1_000_000 {
            return wrong(
                "decision",
                format!("is {}; the value must be from 1 to 1000000 calls", self.decision),
            );
        }
        for (key, count, most) in [
            ("early_ticks", self.early_ticks as u64, 100),
            ("early_chances", u64::from(self.early_seeds), 1000),
            ("early_calls", self.early_calls, 1_000_000_000),
            ("budget", self.budget, 1_000_000_000_000),
            ("mcts_plays", u64::from(self.mcts_plays), 1000),
            ("idle_plays", u64::from(self.idle_plays), 10_000),
            ("random_plays", u64::from(self.random_plays), 10_000),
            ("ladder_plays", self.ladder_plays, 1000),
            ("patience", self.patience as u64, 1000),
        ] {
            if count == 0 || count > most {
                return wrong(key, format!("is {count}; the value must be from 1 to {most}"));
            }
        }
        if let Some((key, message)) = self.gates.problem() {
            return wrong(key, message);
        }
        if self.includes(Criterion::Skill) && self.ladder.len() < 2 {
            let message =
                "takes at least two players: skill is the advantage of a stronger player over a weaker one";
            return wrong("ladder", message);
        }
        if self.least_ticks > self.most_ticks {
            let message =
                format!("is {}, which exceeds `most_ticks` ({})", self.least_ticks, self.most_ticks);
            return wrong("least_ticks", message);
        }
        let rungs = self.rungs("ladder", &self.ladder)?;
        let held_out = self.rungs("held_out", &self.held_out)?;
        Ok(CheckedCriteria { criteria: self.clone(), rungs, held_out })
    }

    fn rungs(&self, key: &'static str, names: &[String]) -> Result<Vec<ReferencePlanner>, CriteriaError> {
        let rungs =
            names.iter().map(|name| ReferencePlanner::new(name, self.decision)).collect::<Result<_, _>>();
        rungs
            .map_err(|unknown| CriteriaError { key, message: format!("is not a list of players: {unknown}") })
    }
}

/// Criteria whose thresholds are in range, as judges require. A subset of them needs no further check.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedCriteria {
    criteria: Criteria,
    rungs: Vec<ReferencePlanner>,
    held_out: Vec<ReferencePlanner>,
}

impl Deref for CheckedCriteria {
    type Target = Criteria;

    fn deref(&self) -> &Criteria {
        &self.criteria
    }
}

impl CheckedCriteria {
    /// Returns the criteria in the set.
    #[must_use]
    pub fn only(&self, set: CriterionSet) -> CheckedCriteria {
        self.asking(self.ask.only(set))
    }

    /// Returns the criteria not in the set.
    #[must_use]
    pub fn without(&self, set: CriterionSet) -> CheckedCriteria {
        self.asking(self.ask.without(set))
    }

    fn asking(&self, ask: CriterionSet) -> CheckedCriteria {
        CheckedCriteria { criteria: Criteria { ask, ..self.criteria.clone() }, ..self.clone() }
    }

    /// Returns the criteria with the stricter gates of [`Gates::with_margin`].
    #[must_use]
    pub fn with_margin(&self) -> CheckedCriteria {
        self.with_gates(self.gates.with_margin())
    }

    /// Returns the criteria with the laxer gates of [`Gates::for_some_levels`].
    #[must_use]
    pub fn for_some_levels(&self) -> CheckedCriteria {
        self.with_gates(self.gates.for_some_levels())
    }

    fn with_gates(&self, gates: Gates) -> CheckedCriteria {
        CheckedCriteria { criteria: Criteria { gates, ..self.criteria.clone() }, ..self.clone() }
    }

    /// Returns the players of the ladder, which are reference players of increasing strength.
    pub fn players(&self) -> LadderConfig {
        LadderConfig {
            rungs: self.rungs.clone(),
            held_out: self.held_out.clone(),
            plays: self.ladder_plays,
            calls: self.ladder_calls,
            ticks: self.most_ticks,
            patience: self.patience,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(alter: impl Fn(&mut Criteria), expect: &str) {
        let mut criteria = Criteria::full();
        alter(&mut criteria);
        let error = criteria.check().unwrap_err().to_string();
        assert!(error.contains(expect), "{error}");
    }

    #[test]
    fn out_of_range_values_are_reported_with_their_key() {
        for criteria in [Criteria::default(), Criteria::full(), Criteria::of_generated_games()] {
            assert_eq!(*criteria.check().unwrap(), criteria);
        }
        check(|criteria| criteria.ladder.push("mtcs:9".to_owned()), "`ladder` is not a list of players");
        check(|criteria| criteria.held_out.push("mcts:x".to_owned()), "`held_out` is not a list of players");
        check(|criteria| criteria.depths.clear(), "`depths`");
        check(|criteria| criteria.skill_wins = 1.5, "`skill_wins` is 1.5");
        check(|criteria| criteria.least_ticks = 5000, "`least_ticks`");
        check(
            |criteria| criteria.ask = CriterionSet::of(&[Criterion::SkillOverall]),
            "needs the episodes of `skill`",
        );
        check(|criteria| criteria.random_plays = 0, "`random_plays` is 0");
        check(|criteria| criteria.ladder.clear(), "`ladder` takes at least two players");
        check(|criteria| criteria.patience = 0, "`patience` is 0");
        check(|criteria| criteria.gates.drama = 2.0, "`gates.drama` is 2");
        check(
            |criteria| criteria.gates.spare = (0.5, 0.2),
            "`gates.spare` has the minimum 0.5 above the maximum 0.2",
        );
    }

    #[test]
    fn narrowed_criteria_are_in_range() {
        let gated = Criteria { ask: CriterionSet::GATES.with(Criteria::full().ask), ..Criteria::full() };
        let checked = gated.check().unwrap();
        assert_eq!(checked.only(CriterionSet::GATES).ask, CriterionSet::GATES);
        assert_eq!(checked.without(CriterionSet::GATES), Criteria::full().check().unwrap());
        for narrowed in [checked.with_margin(), checked.for_some_levels()] {
            assert_eq!(narrowed.check().as_ref(), Ok(&narrowed));
            assert_ne!(narrowed, checked);
        }
    }
}

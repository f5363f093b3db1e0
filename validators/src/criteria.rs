//! The thresholds of all criteria, in one place.

use crate::gates::{GATES, Gates};
use crate::ladder::{LadderConfig, Rung};
use agents::PortfolioConfig;
use serde::{Deserialize, Serialize};

base::with_defaults! {
    /// The thresholds of all criteria: the `[criteria]` table of a recipe. The page `docs/validate.md` explains each.
    /// The defaults are for minting: criteria that are cheap enough for many candidates.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct Criteria {
        /// The criteria to check, by name. They are checked in a fixed order, the cheapest first.
        pub ask: Vec<String> = names(&LEVEL_CRITERIA[..7]),
        /// Forward-model calls of one decision of the searching player, and of players of the ladder without a number.
        pub decision: u64 = 500,
        /// Forward-model calls to find a win, all plays together.
        pub budget: u64 = 3_000_000,
        /// The share of them that may go into proving how many ticks the shortest win takes, in a deterministic game.
        pub shortest: f64 = 0.1,
        /// The share of them that is kept for a search that foresees all chance of an episode, in a stochastic game.
        #[serde(skip_serializing_if = "is_zero")]
        pub foresight: f64 = 0.0,
        /// Look-ahead in ticks of the bold tree searches among the players that look for a win.
        pub depths: Vec<u32> = vec![20],
        /// Episodes of plain tree search that the card of a level reports.
        pub mcts_plays: u32 = 4,
        /// Episodes of doing nothing.
        pub idle_plays: u32 = 8,
        /// Episodes of random play.
        pub random_plays: u32 = 40,
        /// The greatest share of them that may be won.
        pub random_wins: f64 = 0.2,
        /// Ticks that the shortest win found takes at least.
        pub least_ticks: usize = 8,
        /// The most ticks that it may take.
        pub most_ticks: usize = 1000,
        /// Ticks at the start in which death must be avoidable.
        pub early_ticks: usize = 12,
        /// Forward-model calls to look for a way to survive them, for each random seed.
        pub early_calls: u64 = 20_000,
        /// Random seeds to try that with.
        #[serde(rename = "early_chances")]
        pub early_seeds: u32 = 20,
        /// The greatest share of them in which death may be unavoidable.
        pub early_deaths: f64 = 0.05,
        /// The players that difficulty and skill are measured with, the weakest first: `mcts:500`.
        pub ladder: Vec<String> = names(&["do-nothing", "random", "one-step", "mcts:30", "mcts:100", "olets:50"]),
        /// Players that must show skill too, and that never guide a search.
        pub held_out: Vec<String> = names(&["mcts:300", "olets:200"]),
        /// The greatest number of plays of each.
        pub ladder_plays: u64 = 12,
        /// Forward-model calls of all of them, after which no further round of plays begins.
        pub ladder_calls: u64 = 5_000_000,
        /// A play of the ladder is broken off after this multiple of the ticks of the witness (and 50 more).
        pub patience: usize = 3,
        /// The difference by which the win rates of stronger and weaker players must differ …
        pub skill_wins: f64 = 0.25,
        /// … or else their mean scores, as a share of the range of all scores.
        pub skill_scores: f64 = 0.1,
        /// The difference of win rates over all levels together, at the lower end of the 95 % interval.
        pub skill_overall: f64 = 0.25,
        /// Forward-model calls to show that a rule matters, for each rule.
        pub ablation_calls: u64 = 200_000,
        /// The thresholds of the gates.
        #[serde(skip_serializing_if = "Gates::are_default")]
        pub gates: Gates = Gates::default(),
    }
}

/// The criteria of a level, in the order of checking.
pub const LEVEL_CRITERIA: &[&str] =
    &["well-formed", "readable", "not-idle", "not-random", "early-death", "winnable", "length", "skill"];

/// The criteria of a game over all its levels, in the order of checking.
pub const GAME_CRITERIA: &[&str] = &["skill-overall", "rule-use", "ablation"];

/// Tests whether a share is 0, which files need not say.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(share: &f64) -> bool {
    *share == 0.0
}

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

/// A problem with a set of criteria.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{key}` {message}")]
pub struct CriteriaError {
    /// The key.
    pub key: &'static str,
    /// The requirement that its value misses.
    pub message: String,
}

/// The error of a value that is out of its range.
fn wrong(key: &'static str, message: impl Into<String>) -> Result<(), CriteriaError> {
    Err(CriteriaError { key, message: message.into() })
}

impl Criteria {
    /// Returns the criteria for a single game, with those that minting leaves out; without `skill-overall`, which may
    /// fail a good game only because it is too hard.
    pub fn full() -> Criteria {
        let mut criteria = Criteria::of_generated_games();
        criteria.ask.retain(|name| name != "skill-overall");
        criteria
    }

    /// Returns the search for a win.
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

    /// Returns all criteria: for generated games, of which there are many candidates.
    pub fn of_generated_games() -> Criteria {
        Criteria { ask: names(&[LEVEL_CRITERIA, GAME_CRITERIA].concat()), ..Criteria::default() }
    }

    /// Returns `true` if a criterion is checked.
    pub fn includes(&self, name: &str) -> bool {
        self.ask.iter().any(|asked| asked == name)
    }

    /// Validates the values.
    ///
    /// # Errors
    /// The first value that is out of range.
    pub fn check(&self) -> Result<(), CriteriaError> {
        let known = || LEVEL_CRITERIA.iter().chain(GAME_CRITERIA).chain(GATES).copied();
        if let Some(unknown) = self.ask.iter().find(|name| !known().any(|known| known == *name)) {
            let near = engine::nearest(unknown, known());
            let help = near.map_or(".".to_owned(), |near| format!("; did you mean `{near}`?"));
            let all: Vec<&str> = known().collect();
            return wrong(
                "ask",
                format!("names no criterion `{unknown}`{help} There are {}", all.join(", ")),
            );
        }
        if self.includes("skill-overall") && !self.includes("skill") {
            return wrong("ask", "names `skill-overall`, which needs the plays of `skill`: name both");
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
                return wrong(key, format!("is {share}; it takes a share from 0 to 1"));
            }
        }
        if self.decision == 0 || self.decision > 1_000_000 {
            return wrong("decision", format!("is {}; it takes 1 to 1000000 calls", self.decision));
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
                return wrong(key, format!("is {count}; it takes 1 to {most}"));
            }
        }
        if let Some((key, message)) = self.gates.problem() {
            return wrong(key, message);
        }
        if self.includes("skill") && self.ladder.len() < 2 {
            let message =
                "takes at least two players: skill is the advantage of a stronger player over a weaker one";
            return wrong("ladder", message);
        }
        if self.least_ticks > self.most_ticks {
            let message = format!("is {}, above `most_ticks`, {}", self.least_ticks, self.most_ticks);
            return wrong("least_ticks", message);
        }
        for (key, names) in [("ladder", &self.ladder), ("held_out", &self.held_out)] {
            if let Err(unknown) = self.rungs(names) {
                return wrong(key, format!("is not a list of players: {unknown}"));
            }
        }
        Ok(())
    }

    /// Returns the players of the ladder.
    ///
    /// # Errors
    /// A name that is no planner's.
    pub fn ladder_config(&self) -> Result<LadderConfig, agents::UnknownPlanner> {
        Ok(LadderConfig {
            rungs: self.rungs(&self.ladder)?,
            held_out: self.rungs(&self.held_out)?,
            plays: self.ladder_plays,
            calls: self.ladder_calls,
            ticks: self.most_ticks,
            patience: self.patience,
        })
    }

    fn rungs(&self, names: &[String]) -> Result<Vec<Rung>, agents::UnknownPlanner> {
        names.iter().map(|name| Rung::new(name, self.decision)).collect()
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
        assert_eq!(Criteria::default().check(), Ok(()));
        assert_eq!(Criteria::full().check(), Ok(()));
        assert_eq!(Criteria::of_generated_games().check(), Ok(()));
        check(|criteria| criteria.ask.push("winable".to_owned()), "did you mean `winnable`?");
        check(|criteria| criteria.ladder.push("mtcs:9".to_owned()), "`ladder` is not a list of players");
        check(|criteria| criteria.held_out.push("mcts:x".to_owned()), "`held_out` is not a list of players");
        check(|criteria| criteria.depths.clear(), "`depths`");
        check(|criteria| criteria.skill_wins = 1.5, "`skill_wins` is 1.5");
        check(|criteria| criteria.least_ticks = 5000, "`least_ticks`");
        check(|criteria| criteria.ask = vec!["skill-overall".to_owned()], "needs the plays of `skill`");
        check(|criteria| criteria.random_plays = 0, "`random_plays` is 0");
        check(|criteria| criteria.ladder.clear(), "`ladder` takes at least two players");
        check(|criteria| criteria.patience = 0, "`patience` is 0");
        check(|criteria| criteria.gates.drama = 2.0, "`gates.drama` is 2");
        check(|criteria| criteria.gates.spare = (0.5, 0.2), "`gates.spare` has 0.5 above 0.2");
    }
}

//! Can it be won?

use crate::verdict::{Case, Finding, Rate, Validator, Verdict};
use agents::{Budget, Limits, Mcts, MctsConfig, Play, play};
use engine::Outcome;
use rayon::prelude::*;

/// Monte-Carlo tree search wins at least one of several plays; the shortest win is the witness.
///
/// No win is `Unknown`, never `Fail`: a search that samples proves nothing by failing.
#[derive(Clone, Debug)]
pub struct Winnable {
    /// Forward-model calls of a decision.
    pub decision: u64,
    /// Forward-model calls of all plays together, shared out evenly; a play stops at the first decision beyond its share.
    pub budget: u64,
    /// Look-ahead of each play in ticks; as many plays as entries. Short ones react, long ones plan.
    pub depths: Vec<u32>,
}

impl Validator for Winnable {
    fn name(&self) -> &'static str {
        "winnable"
    }

    fn validate(&self, case: Case<'_>) -> Finding {
        let share = self.budget / self.depths.len().max(1) as u64;
        let limits = Limits { calls: share, ..Limits::default() };
        let played: Vec<Play> = self
            .depths
            .par_iter()
            .enumerate()
            .map(|(run, &depth)| {
                let seed = case.seed.child("winnable", run as u64);
                let config = MctsConfig { depth, ..MctsConfig::default() };
                let mut planner = Mcts::new(config, seed.child("planner", 0));
                play(case.game, case.level, &mut planner, Budget(self.decision), seed.child("chance", 0), limits)
            })
            .collect();
        let measured = Rate::of(&played);
        let won = played.into_iter().filter(|play| play.episode.outcome == Outcome::Won);
        let verdict = match won.min_by_key(|play| play.episode.actions.len()) {
            Some(play) => Verdict::Pass { witness: Some(play.episode) },
            None => Verdict::Unknown { spent: measured.calls },
        };
        Finding { verdict, measured: Some(measured) }
    }
}

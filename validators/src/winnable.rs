//! Can it be won?

use crate::verdict::{Case, Finding, Rate, Validator, Verdict};
use agents::{Budget, Limits, Mcts, MctsConfig, Play, play};
use engine::Outcome;
use rayon::prelude::*;

/// Monte-Carlo tree search ([`MctsConfig::bold`]) wins at least one play; the shortest win is the witness.
///
/// Plays come in rounds, one of each depth; rounds go on until one has a win or the budget is spent. No win is `Unknown`,
/// never `Fail`: a search that samples proves nothing by failing.
#[derive(Clone, Debug)]
pub struct Winnable {
    /// Forward-model calls of a decision.
    pub decision: u64,
    /// Forward-model calls of all plays together. What is left is shared out evenly among the plays of a round; a play
    /// stops at the first decision beyond its share.
    pub budget: u64,
    /// Look-ahead in ticks of each play of a round. Short ones react, long ones plan.
    pub depths: Vec<u32>,
}

/// Rounds at most: plays of games that end at once cost next to nothing.
const MAX_ROUNDS: u64 = 20;

impl Winnable {
    fn round(&self, case: Case<'_>, round: u64, budget: u64) -> Vec<Play> {
        let share = budget / self.depths.len().max(1) as u64;
        let limits = Limits { calls: share, ..Limits::default() };
        let seed = case.seed.child("round", round);
        self.depths
            .par_iter()
            .enumerate()
            .map(|(run, &depth)| {
                let seed = seed.child("play", run as u64);
                let mut planner = Mcts::new(MctsConfig::bold(depth), seed.child("planner", 0));
                play(
                    case.game,
                    case.level,
                    &mut planner,
                    Budget(self.decision),
                    seed.child("chance", 0),
                    limits,
                )
            })
            .collect()
    }
}

impl Validator for Winnable {
    fn name(&self) -> &'static str {
        "winnable"
    }

    fn validate(&self, case: Case<'_>) -> Finding {
        let mut played: Vec<Play> = Vec::new();
        let mut left = self.budget;
        let is_win = |play: &&Play| play.episode.outcome == Outcome::Won;
        for round in 0..MAX_ROUNDS {
            if left == 0 || played.iter().any(|play| is_win(&play)) {
                break;
            }
            let plays = self.round(case, round, left);
            left = left.saturating_sub(plays.iter().map(|play| play.calls).sum());
            played.extend(plays);
        }
        let measured = Rate::of(&played);
        let verdict = match played.iter().filter(is_win).min_by_key(|play| play.episode.actions.len()) {
            Some(play) => Verdict::Pass { witness: Some(play.episode.clone()) },
            None => Verdict::Unknown { spent: measured.calls },
        };
        Finding::from(verdict).measured(measured).played(played.into_iter().map(|play| play.episode))
    }
}

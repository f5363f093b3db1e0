//! The `not-random` criterion: random play seldom wins.

use crate::ending::Ending;
use crate::idle::broken_off;
use crate::verdict::{Case, Finding, Rate, Validator, Verdict};
use agents::{Budget, Limits, Play, Random, play};
use engine::Outcome;
use rayon::prelude::*;

/// Random play wins at most a given share of its episodes.
#[derive(Clone, Copy, Debug)]
pub struct NotRandom {
    /// Episodes to play.
    pub plays: u32,
    /// The greatest share that may be won.
    pub most: f64,
}

impl Validator for NotRandom {
    fn name(&self) -> &'static str {
        "not-random"
    }

    fn validate(&self, case: Case<'_>) -> Finding {
        self.judge(case, usize::MAX)
    }
}

impl NotRandom {
    /// Judges by plays of at most `ticks` ticks; a play that was broken off gives no answer.
    pub(crate) fn judge(&self, case: Case<'_>, ticks: usize) -> Finding {
        let limits = Limits { ticks, ..Limits::default() };
        let played: Vec<Play> = (0..u64::from(self.plays))
            .into_par_iter()
            .map(|run| {
                let seed = case.seed.child("random", run);
                let mut planner = Random::new(seed.child("planner", 0));
                let chance = seed.child("chance", 0);
                play(case.game, case.level, &mut planner, Budget(0), chance, limits)
            })
            .collect();
        let measured = Rate::of(&played);
        let share = measured.wins as f64 / measured.plays.max(1) as f64;
        let won = played.iter().map(|play| &play.episode).filter(|episode| episode.outcome == Outcome::Won);
        let shortest = won.min_by_key(|episode| episode.actions.len());
        let finding = match shortest.filter(|_| share > self.most) {
            None => broken_off(&played, ticks).unwrap_or_else(|| Finding::from(Verdict::pass())),
            Some(shortest) => {
                let Rate { wins, plays, .. } = measured;
                let most = 100.0 * self.most;
                let reason = format!("random play wins {wins} of {plays} episodes, more than {most:.0} %");
                let ending = Ending::of(case.analysis, case.level, shortest).evidence(case.game);
                let advice = "move the goal farther away, or add an obstacle that takes a plan";
                let ending = ending.into_iter().map(|seen| seen.advise(advice));
                Finding::from(Verdict::fail_with(reason, shortest.clone())).seen(ending)
            }
        };
        finding.measured(measured).played(played.into_iter().map(|play| play.episode))
    }
}

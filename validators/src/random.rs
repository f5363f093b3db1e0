//! Is it won by pressing any key?

use crate::verdict::{Case, Finding, Rate, Reason, Validator, Verdict};
use agents::{Budget, Limits, Play, Random, play};
use engine::Outcome;
use rayon::prelude::*;

/// Random play wins at most a stated share of its episodes.
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
        let played: Vec<Play> = (0..u64::from(self.plays))
            .into_par_iter()
            .map(|run| {
                let seed = case.seed.child("random", run);
                let mut planner = Random::new(seed.child("planner", 0));
                play(
                    case.game,
                    case.level,
                    &mut planner,
                    Budget(0),
                    seed.child("chance", 0),
                    Limits::default(),
                )
            })
            .collect();
        let measured = Rate::of(&played);
        let share = measured.wins as f64 / measured.plays.max(1) as f64;
        let won = played.into_iter().find(|play| play.episode.outcome == Outcome::Won);
        let verdict = if share > self.most {
            let Rate { wins, plays, .. } = measured;
            let reason =
                format!("random play wins {wins} of {plays} episodes, more than {:.0} %", 100.0 * self.most);
            Verdict::Fail { reason: Reason(reason), witness: won.map(|play| play.episode) }
        } else {
            Verdict::pass()
        };
        Finding { verdict, measured: Some(measured) }
    }
}

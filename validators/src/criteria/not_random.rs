//! The `not-random` criterion: checks that random play rarely wins.

use crate::allowance::Setting;
use crate::case::Case;
use crate::criteria::not_idle::{Failure, finding};
use crate::measures::ladder::Rate;
use crate::validator::Validator;
use crate::verdict::Finding;
use agents::{Budget, Limits, Play, Random, play};
use engine::Outcome;
use rayon::prelude::*;

/// Passes if a random player wins at most a given fraction of its episodes.
#[derive(Clone, Copy, Debug)]
pub struct NotRandom {
    /// The number of episodes to play.
    pub plays: u32,
    /// The maximum fraction of episodes that may be won.
    pub most: f64,
    /// The maximum number of ticks per episode. If the limit stops an episode, a pass becomes unknown.
    pub ticks: usize,
}

pub(crate) const QUESTION: &str = "do random keys rarely win?";

pub(crate) fn judge(setting: &Setting<'_>) -> NotRandom {
    let criteria = setting.criteria;
    NotRandom { plays: criteria.random_plays, most: criteria.random_wins, ticks: setting.random_ticks() }
}

impl Validator for NotRandom {
    fn validate(&self, case: Case<'_>) -> Finding {
        let limits = Limits { ticks: self.ticks, ..Limits::default() };
        let played: Vec<Play> = (0..u64::from(self.plays))
            .into_par_iter()
            .map(|run| {
                let seed = case.seed.child("random", run);
                let mut planner = Random::new(seed.seed().child("planner", 0));
                let chance = seed.child("chance", 0);
                play(case.game, case.level, &mut planner, Budget(0), chance, limits)
            })
            .collect();
        let Rate { wins, plays, .. } = Rate::of(&played);
        let share = wins as f64 / plays.max(1) as f64;
        let won = played.iter().map(|play| &play.episode).filter(|episode| episode.outcome == Outcome::Won);
        let shortest = won.min_by_key(|episode| episode.actions.len());
        let most = 100.0 * self.most;
        let failure = shortest.filter(|_| share > self.most).map(|shortest| Failure {
            reason: format!("random play wins {wins} of {plays} episodes, more than {most:.0}%"),
            advice: "move the goal farther away, or add an obstacle that requires a plan",
            witness: shortest.clone(),
        });
        finding(case, played, self.ticks, failure)
    }
}

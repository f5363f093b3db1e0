//! Is it won by doing nothing?

use crate::verdict::{Case, Finding, Rate, Reason, Validator, Verdict};
use agents::{Budget, DoNothing, Limits, play};
use engine::Outcome;

/// A player who does nothing never wins, in so many games of different chance (one if chance plays no part).
#[derive(Clone, Copy, Debug)]
pub struct NotIdle {
    /// Episodes to play.
    pub plays: u32,
}

impl Validator for NotIdle {
    fn name(&self) -> &'static str {
        "not-idle"
    }

    fn validate(&self, case: Case<'_>) -> Finding {
        let plays = if case.game.is_deterministic() { 1 } else { self.plays };
        let mut played = Vec::new();
        for run in 0..u64::from(plays) {
            let seed = case.seed.child("idle", run);
            played.push(play(case.game, case.level, &mut DoNothing, Budget(0), seed, Limits::default()));
        }
        let won = played.iter().find(|play| play.episode.outcome == Outcome::Won);
        let verdict = match won {
            None => Verdict::pass(),
            Some(play) => Verdict::Fail {
                reason: Reason(format!("doing nothing wins after {} ticks", play.episode.actions.len())),
                witness: Some(play.episode.clone()),
            },
        };
        Finding { verdict, measured: Some(Rate::of(&played)) }
    }
}

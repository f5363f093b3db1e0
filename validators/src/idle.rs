//! Is it won by doing nothing?

use crate::ending::Ending;
use crate::verdict::{Case, Finding, Rate, Validator, Verdict};
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
        let measured = Rate::of(&played);
        let won = played.iter().find(|play| play.episode.outcome == Outcome::Won);
        let finding = match won {
            None => Finding::from(Verdict::pass()),
            Some(play) => {
                let ticks = play.episode.actions.len();
                let reason = format!("doing nothing wins after {ticks} ticks");
                let ending = Ending::of(case.analysis, case.level, &play.episode).evidence(case.game);
                let advice = "let the win ask for something that only the player can do";
                let ending = ending.into_iter().map(|seen| seen.advise(advice));
                Finding::from(Verdict::fail_with(reason, play.episode.clone())).seen(ending)
            }
        };
        finding.measured(measured).played(played.into_iter().map(|play| play.episode))
    }
}

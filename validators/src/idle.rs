//! The `not-idle` criterion: doing nothing does not win.

use crate::ending::Ending;
use crate::evidence::Evidence;
use crate::verdict::{Case, Finding, Rate, Validator, Verdict};
use agents::{Budget, DoNothing, Limits, Play, play};
use engine::Outcome;

/// A player who does nothing never wins, under several random seeds (one for a deterministic game).
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
        self.judge(case, usize::MAX)
    }
}

impl NotIdle {
    /// Judges by plays of at most `ticks` ticks; a play that was broken off gives no answer.
    pub(crate) fn judge(&self, case: Case<'_>, ticks: usize) -> Finding {
        let plays = if case.game.is_deterministic() { 1 } else { self.plays };
        let limits = Limits { ticks, ..Limits::default() };
        let mut played = Vec::new();
        for run in 0..u64::from(plays) {
            let seed = case.seed.child("idle", run);
            played.push(play(case.game, case.level, &mut DoNothing, Budget(0), seed, limits));
        }
        let measured = Rate::of(&played);
        let won = played.iter().find(|play| play.episode.outcome == Outcome::Won);
        let finding = match won {
            None => broken_off(&played, ticks).unwrap_or_else(|| Finding::from(Verdict::pass())),
            Some(play) => {
                let ticks = play.episode.actions.len();
                let reason = format!("doing nothing wins after {ticks} ticks");
                let ending = Ending::of(case.analysis, case.level, &play.episode).evidence(case.game);
                let advice = "make the win require an action of the player";
                let ending = ending.into_iter().map(|seen| seen.advise(advice));
                Finding::from(Verdict::fail_with(reason, play.episode.clone())).seen(ending)
            }
        };
        finding.measured(measured).played(played.into_iter().map(|play| play.episode))
    }
}

/// Returns a finding if some plays were broken off after `ticks` ticks.
pub(crate) fn broken_off(played: &[Play], ticks: usize) -> Option<Finding> {
    let is_cut =
        |play: &&Play| play.episode.outcome == Outcome::Ongoing && play.episode.actions.len() >= ticks;
    let cut = played.iter().filter(is_cut).count();
    let spent = played.iter().map(|play| play.episode.actions.len() as u64).sum();
    let text = format!("{cut} of {} plays were stopped after {ticks} ticks by the budget", played.len());
    (cut > 0).then(|| Finding::from(Verdict::Unknown { spent }).seen([Evidence::new(text)]))
}

//! The `not-idle` criterion: checks that doing nothing does not win.

use crate::allowance::Setting;
use crate::case::Case;
use crate::evidence::Evidence;
use crate::explain::ending::Ending;
use crate::measures::ladder::Rate;
use crate::validator::Validator;
use crate::verdict::{Finding, Verdict};
use agents::{Budget, DoNothing, Limits, Play, play};
use engine::{Episode, Outcome};

/// Passes if an idle player does not win with any of several random seeds. On a deterministic level, one seed is
/// enough.
#[derive(Clone, Copy, Debug)]
pub struct NotIdle {
    /// The number of episodes to play.
    pub plays: u32,
    /// The maximum number of ticks per episode. If the limit stops an episode, a pass becomes unknown.
    pub ticks: usize,
}

pub(crate) const QUESTION: &str = "is the level safe from being won by doing nothing?";

pub(crate) fn judge(setting: &Setting<'_>) -> NotIdle {
    NotIdle { plays: setting.criteria.idle_plays, ticks: setting.idle_ticks() }
}

impl Validator for NotIdle {
    fn validate(&self, case: Case<'_>) -> Finding {
        let plays = if case.analysis.is_deterministic_in(case.level) { 1 } else { self.plays };
        let limits = Limits { ticks: self.ticks, ..Limits::default() };
        let mut played = Vec::new();
        for run in 0..u64::from(plays) {
            let seed = case.seed.child("idle", run);
            played.push(play(case.game, case.level, &mut DoNothing, Budget(0), seed, limits));
        }
        let won = played.iter().map(|play| &play.episode).find(|episode| episode.outcome == Outcome::Won);
        let failure = won.map(|won| Failure {
            reason: format!("doing nothing wins after {}", base::count(won.actions.len(), "tick")),
            advice: "make the win require an action of the player",
            witness: won.clone(),
        });
        finding(case, played, self.ticks, failure)
    }
}

/// A win by a player that should not have won.
pub(crate) struct Failure {
    pub(crate) reason: String,
    pub(crate) advice: &'static str,
    pub(crate) witness: Episode,
}

/// Returns the finding for episodes of at most `ticks` ticks. Without a failure, any episode that was stopped early
/// makes the verdict unknown.
pub(crate) fn finding(case: Case<'_>, played: Vec<Play>, ticks: usize, failure: Option<Failure>) -> Finding {
    let finding = match failure {
        None => broken_off(&played, ticks).unwrap_or_else(|| Finding::from(Verdict::pass())),
        Some(Failure { reason, advice, witness }) => {
            let ending = Ending::of(case.analysis, case.level, &witness).evidence(case.game);
            let ending = ending.into_iter().map(|seen| seen.advise(advice));
            Finding::from(Verdict::fail_with(reason, witness)).seen(ending)
        }
    };
    finding.measured(Rate::of(&played)).played(played.into_iter().map(|play| play.episode))
}

/// Returns a finding if any episodes were stopped after `ticks` ticks.
fn broken_off(played: &[Play], ticks: usize) -> Option<Finding> {
    let is_cut =
        |play: &&Play| play.episode.outcome == Outcome::Ongoing && play.episode.actions.len() >= ticks;
    let cut = played.iter().filter(is_cut).count();
    let spent = played.iter().map(|play| play.episode.actions.len() as u64).sum();
    let text = format!(
        "{cut} of {} episodes were stopped after {} by the budget",
        played.len(),
        base::count(ticks, "tick")
    );
    (cut > 0).then(|| Finding::from(Verdict::Unknown { spent }).seen([Evidence::new(text)]))
}

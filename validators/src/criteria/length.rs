//! The `length` criterion: checks that a level neither ends immediately nor takes too long.

use crate::allowance::Setting;
use crate::case::Case;
use crate::criterion::Criterion;
use crate::evidence::Evidence;
use crate::explain::ending::Ending;
use crate::report::Report;
use crate::validator::Validator;
use crate::verdict::{Finding, Verdict};

/// Passes if the number of ticks in the witness is within bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LengthWithin {
    /// The minimum number of ticks of the witness.
    least: usize,
    /// The maximum number of ticks of the witness.
    most: usize,
}

/// The start of the reason for a win that takes too long. A shorter win may exist.
const TOO_LONG: &str = "the shortest win found takes";

/// Changes a failure to an unknown verdict if the search did not prove its win to be the shortest, because a shorter
/// win might exist.
pub(crate) fn without_proof(finding: &mut Finding, report: &Report) {
    let Verdict::Fail { reason, .. } = &finding.verdict else { return };
    let searched = report.finding(Criterion::Winnable);
    let is_proved = searched.is_some_and(|searched| searched.optimal.is_some());
    if !reason.0.starts_with(TOO_LONG) || is_proved {
        return;
    }
    let note = Evidence::new(format!("{}; a shorter win may exist", reason.0));
    finding.verdict = Verdict::Unknown { spent: searched.map_or(0, Finding::calls).max(1) };
    finding.evidence.insert(0, note);
}

pub(crate) const QUESTION: &str = "is the win neither too short nor too long?";

pub(crate) fn judge(setting: &Setting<'_>) -> LengthWithin {
    LengthWithin { least: setting.criteria.least_ticks, most: setting.criteria.most_ticks }
}

impl Validator for LengthWithin {
    fn validate(&self, case: Case<'_>) -> Finding {
        let Some(witness) = case.witness else { return Verdict::Unknown { spent: 0 }.into() };
        let ticks = witness.actions.len();
        let ending = Ending::of(case.analysis, case.level, witness);
        let seen = |advice: &str| {
            let evidence = ending.evidence(case.game).into_iter().next();
            evidence.map(|seen| seen.advise(advice))
        };
        if ticks < self.least {
            let reason = format!("won in {}, fewer than {}", base::count(ticks, "tick"), self.least);
            Finding::from(Verdict::fail(reason)).seen(seen("move the goal farther away"))
        } else if ticks > self.most {
            let reason = format!("{TOO_LONG} {ticks} ticks, more than {}", self.most);
            Finding::from(Verdict::fail(reason)).seen(seen("make the level smaller, or raise `most_ticks`"))
        } else {
            Verdict::pass().into()
        }
    }
}

//! Judgements as text for people.

use crate::criterion::Criterion;
use crate::evidence::Evidence;
use crate::explain::culprits::CAN_BE_WON;
use crate::report::Judgement;
use crate::verdict::Verdict;

impl Judgement {
    /// Returns `true` if the criterion was skipped because it does not apply.
    pub fn is_skipped(&self) -> bool {
        self.finding.evidence.first().is_some_and(|seen| seen.text.starts_with("skipped"))
    }

    /// Returns the answer as one sentence, without the evidence; empty for a pass with nothing to report.
    pub fn answer(&self) -> String {
        let Judgement { criterion, finding } = self;
        match &finding.verdict {
            Verdict::Pass { witness: Some(witness) } => {
                format!(
                    "the witness wins in {}, score {}",
                    base::count(witness.actions.len(), "tick"),
                    witness.score
                )
            }
            Verdict::Pass { witness: None } => String::new(),
            Verdict::Fail { reason, .. } => reason.0.clone(),
            Verdict::Unknown { .. } if self.is_skipped() => finding.evidence[0].text.clone(),
            Verdict::Unknown { spent: 0 } if *criterion == Criterion::Winnable => {
                "no win found: the budget allows no search".to_owned()
            }
            Verdict::Unknown { spent: 0 } => "needs a win, but no win was found".to_owned(),
            // If the budget stopped some work, the evidence about it comes first.
            Verdict::Unknown { .. } if finding.evidence.first().is_some_and(is_budget_note) => {
                finding.evidence[0].text.clone()
            }
            Verdict::Unknown { spent } => match *criterion {
                Criterion::Winnable => {
                    let found = finding.evidence.iter().find(|seen| seen.text.starts_with(CAN_BE_WON));
                    let found = found.map_or("a win may still exist", |seen| seen.text.as_str());
                    format!("no win found with {spent} forward-model calls; {found}")
                }
                Criterion::EarlyDeath => {
                    format!(
                        "found no sequence of actions that survives the first ticks, with {spent} \
                         forward-model calls"
                    )
                }
                Criterion::Skill => "too few wins for a verdict".to_owned(),
                _ => {
                    let first = finding.evidence.first().map_or("not shown", |seen| seen.text.as_str());
                    let others = finding.evidence.iter().filter(|seen| seen.advice.is_some()).count();
                    match others {
                        0 | 1 => first.to_owned(),
                        _ => format!("{first}, and {} more", others - 1),
                    }
                }
            },
        }
    }
}

fn is_budget_note(seen: &Evidence) -> bool {
    seen.text.ends_with("by the budget")
}

//! A judgement in words, for people.

use crate::culprits::CAN_BE_WON;
use crate::evidence::Evidence;
use crate::level_report::Judgement;
use crate::verdict::Verdict;

impl Judgement {
    /// Returns `true` if the criterion was skipped because it does not apply.
    pub fn is_skipped(&self) -> bool {
        self.finding.evidence.first().is_some_and(|seen| seen.text.starts_with("skipped"))
    }

    /// Returns the answer in a sentence, without the evidence; empty for a pass that has nothing to show.
    pub fn answer(&self) -> String {
        let Judgement { criterion, finding } = self;
        match &finding.verdict {
            Verdict::Pass { witness: Some(witness) } => {
                format!("the witness wins in {} ticks, score {}", witness.actions.len(), witness.score)
            }
            Verdict::Pass { witness: None } => String::new(),
            Verdict::Fail { reason, .. } => reason.0.clone(),
            Verdict::Unknown { .. } if self.is_skipped() => finding.evidence[0].text.clone(),
            Verdict::Unknown { spent: 0 } if *criterion == "winnable" => {
                "no win found: the budget allows no search".to_owned()
            }
            Verdict::Unknown { spent: 0 } => "needs a win, and none was found".to_owned(),
            // Work that the budget broke off comes first.
            Verdict::Unknown { .. } if finding.evidence.first().is_some_and(is_budget_note) => {
                finding.evidence[0].text.clone()
            }
            Verdict::Unknown { spent } => match *criterion {
                "winnable" => {
                    let found = finding.evidence.iter().find(|seen| seen.text.starts_with(CAN_BE_WON));
                    let found = found.map_or("a win may still exist", |seen| seen.text.as_str());
                    format!("no win found with {spent} forward-model calls; {found}")
                }
                "early-death" => {
                    format!("no play found that survives the first ticks, with {spent} forward-model calls")
                }
                "skill" => "too few wins for a verdict".to_owned(),
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

/// Returns the question that a criterion asks, in one sentence; `None` for a name that is no criterion's.
pub fn question(criterion: &str) -> Option<&'static str> {
    Some(match criterion {
        "well-formed" => "can the rules be won at all, and does the game go on after its first tick?",
        "readable" => "can the player see everything that decides the game?",
        "not-idle" => "is the level safe from being won by doing nothing?",
        "not-random" => "do random keys win seldom?",
        "early-death" => "can the player live through the first ticks?",
        "winnable" => "is there a win?",
        "length" => "is the win neither too short nor too long?",
        "skill" => "do planners that look ahead win more, or score more, than those that do not?",
        "skill-overall" => "do planners that look ahead win more over all levels together?",
        "rule-use" => "does every rule run, and every type appear, in some play?",
        "ablation" => {
            "does each rule matter: with the rule switched off, does some play end or score otherwise?"
        }
        "open-ground" => "is there room to move?",
        "progression" => "does each level bring something new, and ask for more than the one before?",
        "drama" => "does the way to the win have ups and downs?",
        "no-dead-time" => "is no stretch of the win without progress?",
        "not-instant" => "does a win take time, and does the time limit leave a sensible margin?",
        "actors-matter" => "does what moves by itself come in the player's way?",
        "tight" => "does a win use up most of the resources, and does a careless player seldom win?",
        "necessity" => "does winning depend on each rule and each placed type?",
        _ => return None,
    })
}

fn is_budget_note(seen: &Evidence) -> bool {
    seen.text.ends_with("by the budget")
}

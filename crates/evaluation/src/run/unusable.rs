//! Counts decisions without a usable answer during an evaluation.

use crate::player::{Halt, Validity};
use serde::Serialize;
use std::fmt;
use std::sync::Mutex;

/// The number of decisions after which a player without a single usable answer is stopped. No warning is
/// shown before then.
const FIRST: u64 = 20;

/// The reciprocal of the fraction of decisions without a usable answer above which a warning is shown.
const ONE_IN: u64 = 5;

/// The total number of decisions, and the number in which the player did nothing because no answer was
/// usable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Answers {
    /// The total number of decisions.
    pub steps: u64,
    /// The number of decisions without a usable answer: the sum of the next three fields.
    pub unusable: u64,
    /// The number of decisions whose last answer stated no available action.
    pub invalid: u64,
    /// The number of decisions whose last answer was cut off.
    pub truncated: u64,
    /// The number of decisions whose last answer was a refusal.
    pub refused: u64,
}

impl Answers {
    pub(crate) fn add(&mut self, validity: Validity) {
        self.steps += 1;
        match validity {
            Validity::Valid => return,
            Validity::Invalid => self.invalid += 1,
            Validity::Truncated => self.truncated += 1,
            Validity::Refused => self.refused += 1,
        }
        self.unusable += 1;
    }
}

impl fmt::Display for Answers {
    /// Formats the counts, as in `6 of 25 decisions have no usable answer (4 invalid, 2 cut off)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Answers { steps, unusable, invalid, truncated, refused } = self;
        let has = if *unusable == 1 { "has" } else { "have" };
        write!(f, "{unusable} of {steps} decisions {has} no usable answer")?;
        let kinds = [(invalid, "invalid"), (truncated, "cut off"), (refused, "refused")];
        let mut kinds = kinds.into_iter().filter(|(count, _)| **count > 0);
        if let Some((count, kind)) = kinds.next() {
            write!(f, " ({count} {kind}")?;
            kinds.try_for_each(|(count, kind)| write!(f, ", {count} {kind}"))?;
            write!(f, ")")?;
        }
        Ok(())
    }
}

/// The answer counts over all episodes of a run, shared between threads.
#[derive(Debug, Default)]
pub(crate) struct Watch(Mutex<Watched>);

#[derive(Debug, Default)]
struct Watched {
    answers: Answers,
    is_told: bool,
    halt: Option<Halt>,
}

impl Watch {
    /// Counts a decision. Calls `tell` once, when too many decisions lack a usable answer. The second
    /// argument of `tell` is `true` if no decision has a usable answer. `tell` returns `false` to stop the
    /// evaluation.
    pub(crate) fn decided(
        &self,
        validity: Validity,
        tell: impl FnOnce(&Answers, bool) -> bool,
    ) -> Option<Halt> {
        let mut watched = self.0.lock().expect("no holder panics");
        watched.answers.add(validity);
        let answers = watched.answers;
        let many = answers.steps >= FIRST && answers.unusable * ONE_IN > answers.steps;
        if many && !watched.is_told {
            watched.is_told = true;
            let is_all = answers.unusable == answers.steps;
            if !tell(&answers, is_all) {
                watched.halt = Some(Halt::Unusable(format!(
                    "the evaluation was stopped because {answers}; the logs contain the answers"
                )));
            }
        }
        watched.halt.clone()
    }

    /// Returns the reason for stopping the evaluation, if any.
    pub(crate) fn halt(&self) -> Option<Halt> {
        self.0.lock().expect("no holder panics").halt.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the decisions at which a notice is shown, each with `true` if no answer was usable. In
    /// `decisions`, `v` stands for a valid answer.
    #[track_caller]
    fn check(decisions: &str, expect: &[(u64, bool)]) {
        let (watch, mut told) = (Watch::default(), Vec::new());
        for decision in decisions.chars() {
            let validity = match decision {
                'v' => Validity::Valid,
                't' => Validity::Truncated,
                _ => Validity::Invalid,
            };
            watch.decided(validity, |answers, is_all| {
                told.push((answers.steps, is_all));
                true
            });
        }
        assert_eq!(told, expect, "{decisions}");
    }

    #[test]
    fn many_unusable_answers_are_told_once() {
        check(&"i".repeat(19), &[]);
        check(&"i".repeat(40), &[(20, true)]);
        check(&format!("v{}", "t".repeat(40)), &[(20, false)]);
        // A fraction of exactly one fifth is not more than a fifth.
        check(&format!("iiii{}", "v".repeat(20)), &[]);
        check(&format!("iiii{}ii", "v".repeat(17)), &[(22, false)]);
        check(&"v".repeat(100), &[]);
    }

    #[test]
    fn a_stop_holds_for_all_episodes() {
        let watch = Watch::default();
        for _ in 0..19 {
            assert_eq!(watch.decided(Validity::Invalid, |_, _| unreachable!("too early")), None);
        }
        let halt = watch.decided(Validity::Refused, |_, is_all| !is_all);
        let reason = "the evaluation was stopped because 20 of 20 decisions have no usable answer (19 invalid, 1 refused); the logs \
                      contain the answers";
        assert_eq!(halt, Some(Halt::Unusable(reason.to_owned())));
        assert_eq!(watch.decided(Validity::Valid, |_, _| unreachable!("it is told once")), halt);
        assert_eq!(watch.halt(), halt);
    }
}

//! A stage of the pipeline, and a candidate's walk through a list of stages.

use crate::tally::Tally;
use std::borrow::Cow;
use validators::{Criterion, CriterionSet};

/// A stage for candidates of type `T`.
pub(super) struct Stage<T> {
    /// The stage's name in the documentation. The counts of failed candidates also use it if the stage has its own
    /// judges.
    pub(super) name: &'static str,
    /// The stage's question or task, as a phrase.
    pub(super) purpose: &'static str,
    /// The typical cost, as text.
    pub(super) cost: &'static str,
    /// The criteria by which the stage can reject a candidate.
    pub(super) criteria: CriterionSet,
    /// The other reasons for which the stage can reject a candidate. A final `N` in a reason represents any number.
    pub(super) reasons: &'static [&'static str],
    /// The part that the stage can replace instead of rejecting the candidate; `None` if it replaces nothing.
    pub(super) replaces: Option<&'static str>,
    pub(super) run: Run<T>,
}

/// The function that a stage runs, of one of the supported kinds.
pub(super) enum Run<T> {
    /// Judges the candidate, and changes it if the stage replaces a part.
    Once(fn(&mut T, &mut Tally) -> Passage),
    /// Creates versions of the candidate, and takes each through the later stages until one passes.
    Versions(fn(&mut T, &[Stage<T>], &mut Tally) -> Passage),
}

/// A stage's rejection of a candidate.
#[derive(Debug)]
pub(crate) enum Refusal {
    /// A reason that has not been counted yet.
    Because(Cow<'static, str>),
    /// The reason has been counted by the stage.
    Counted,
}

/// The outcome of a stage for a candidate.
pub(crate) type Passage = Result<(), Refusal>;

impl From<&'static str> for Refusal {
    fn from(why: &'static str) -> Refusal {
        Refusal::Because(why.into())
    }
}

impl From<Criterion> for Refusal {
    fn from(criterion: Criterion) -> Refusal {
        criterion.name().into()
    }
}

/// Takes a candidate through the stages until one rejects it.
pub(super) fn walk<T>(stages: &[Stage<T>], candidate: &mut T, tally: &mut Tally) -> Passage {
    for (at, stage) in stages.iter().enumerate() {
        match stage.run {
            Run::Once(run) => run(candidate, tally).inspect_err(|refusal| stage.check(refusal))?,
            Run::Versions(run) => return run(candidate, &stages[at + 1..], tally),
        }
    }
    Ok(())
}

impl<T> Stage<T> {
    /// Creates a stage with the given code and an empty description.
    pub(super) const fn once(run: fn(&mut T, &mut Tally) -> Passage) -> Stage<T> {
        Stage::of(Run::Once(run))
    }

    /// Creates a stage that generates versions of the candidate, with an empty description.
    pub(super) const fn versions(run: fn(&mut T, &[Stage<T>], &mut Tally) -> Passage) -> Stage<T> {
        Stage::of(Run::Versions(run))
    }

    const fn of(run: Run<T>) -> Stage<T> {
        let criteria = CriterionSet::of(&[]);
        Stage { name: "", purpose: "", cost: "none", criteria, reasons: &[], replaces: None, run }
    }

    /// Asserts in tests that the stage's description lists the reason for a rejection.
    fn check(&self, refusal: &Refusal) {
        let Refusal::Because(why) = refusal else { return };
        if !cfg!(test) {
            return;
        }
        let is_reason = |reason: &&str| match reason.strip_suffix('N') {
            Some(start) => why.starts_with(start),
            None => why == reason,
        };
        let is_criterion = self.criteria.iter().any(|criterion| criterion.name() == *why);
        assert!(is_criterion || self.reasons.iter().any(is_reason), "{} rejects for {why}", self.name);
    }

    /// Returns the stage's row in the documentation's table.
    pub(super) fn row(&self) -> String {
        let criteria = self.criteria.iter().map(|criterion| format!("`{criterion}`"));
        let refuses: Vec<String> =
            criteria.chain(self.reasons.iter().map(|reason| (*reason).to_owned())).collect();
        let refuses = if refuses.is_empty() { "nothing".to_owned() } else { refuses.join(", ") };
        let replaces = self.replaces.unwrap_or("nothing");
        format!("| {} | {} | {} | {refuses} | {replaces} |\n", self.name, self.purpose, self.cost)
    }
}

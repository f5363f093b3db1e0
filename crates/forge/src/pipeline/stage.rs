//! A stage of the pipeline, and the walk of a candidate through a list of stages.

use crate::tally::Tally;
use std::borrow::Cow;
use validators::{Criterion, CriterionSet};

/// A stage for candidates of type `T`.
pub(super) struct Stage<T> {
    /// The name in the documentation. Tallies also use the name if the stage has its own judges.
    pub(super) name: &'static str,
    /// The question or the task of the stage, as a phrase.
    pub(super) purpose: &'static str,
    /// The usual cost, in words.
    pub(super) cost: &'static str,
    /// The criteria by which the stage can reject a candidate.
    pub(super) criteria: CriterionSet,
    /// The other reasons for which the stage can reject a candidate. A final `N` in a reason stands for any number.
    pub(super) reasons: &'static [&'static str],
    /// The part that the stage can replace instead of rejecting the candidate.
    pub(super) replaces: Option<&'static str>,
    pub(super) run: Run<T>,
}

/// The code of a stage.
pub(super) enum Run<T> {
    /// Judges the candidate, and changes it if the stage replaces something.
    Once(fn(&mut T, &mut Tally) -> Passage),
    /// Makes versions of the candidate, and takes each version through the later stages until one passes.
    Versions(fn(&mut T, &[Stage<T>], &mut Tally) -> Passage),
}

/// The rejection of a candidate by a stage.
#[derive(Debug)]
pub(crate) enum Refusal {
    /// The reason, which must still be counted.
    Because(Cow<'static, str>),
    /// The stage has already counted the reason.
    Counted,
}

/// The result of a candidate's passage through a stage.
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

    /// Creates a stage that makes versions of the candidate, with an empty description.
    pub(super) const fn versions(run: fn(&mut T, &[Stage<T>], &mut Tally) -> Passage) -> Stage<T> {
        Stage::of(Run::Versions(run))
    }

    const fn of(run: Run<T>) -> Stage<T> {
        let criteria = CriterionSet::of(&[]);
        Stage { name: "", purpose: "", cost: "none", criteria, reasons: &[], replaces: None, run }
    }

    /// Asserts, in the tests of this crate, that the description of the stage lists the reason.
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

    /// Returns the stage's row in the table of the documentation.
    pub(super) fn row(&self) -> String {
        let criteria = self.criteria.iter().map(|criterion| format!("`{criterion}`"));
        let refuses: Vec<String> =
            criteria.chain(self.reasons.iter().map(|reason| (*reason).to_owned())).collect();
        let refuses = if refuses.is_empty() { "nothing".to_owned() } else { refuses.join(", ") };
        let replaces = self.replaces.unwrap_or("nothing");
        format!("| {} | {} | {} | {refuses} | {replaces} |\n", self.name, self.purpose, self.cost)
    }
}

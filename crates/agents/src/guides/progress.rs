//! The distance of a state from a win.

use engine::State;
use engine::analysis::{Analysis, Attainable, Condition, Goal};

/// The winning goals by which the distance from a win is measured.
#[derive(Clone, Debug)]
pub(crate) struct Progress<'a> {
    analysis: &'a Analysis,
    goals: Vec<&'a Goal>,
}

impl<'a> Progress<'a> {
    pub(crate) fn of(analysis: &'a Analysis) -> Progress<'a> {
        let winning = analysis.goals().iter().filter(|goal| goal.win && goal.attainable != Attainable::Never);
        Progress { analysis, goals: winning.collect() }
    }

    /// Returns how many sprites must still disappear or appear to reach the nearest goal that counts sprites,
    /// or 0 if there is no such goal.
    pub(crate) fn sprites_missing(&self, state: &State) -> u32 {
        let counted = self.goals.iter().filter(|goal| !matches!(goal.condition, Condition::Tick(_)));
        counted.map(|goal| self.analysis.missing(goal, state)).min().unwrap_or(0)
    }

    /// Returns how many sprites must still disappear or appear, or how many ticks must pass, to reach the
    /// nearest goal.
    pub(crate) fn missing(&self, state: &State) -> u32 {
        self.goals.iter().map(|goal| self.analysis.missing(goal, state)).min().unwrap_or(u32::MAX)
    }
}

//! Reference planners: planners with fixed calls of a decision, whose win rates say how hard a level is.

use crate::planner::Budget;
use crate::registry::{PlannerSpec, Player, UnknownPlanner};
use base::Seed;

/// A registered planner with the forward-model calls of a decision, written `mcts:500`. It depends on nothing but its name and these
/// calls, so that its wins can be compared between levels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReferencePlanner {
    name: String,
    planner: PlannerSpec,
    budget: Budget,
}

impl ReferencePlanner {
    /// Reads `planner:calls`, or `planner` with `calls` calls.
    ///
    /// # Errors
    /// There is no such planner, or the text after the colon is not a number of calls.
    pub fn new(name: &str, calls: u64) -> Result<ReferencePlanner, UnknownPlanner> {
        let planner: PlannerSpec = name.parse()?;
        let budget = planner.budget().unwrap_or(Budget(calls));
        Ok(ReferencePlanner { name: name.to_owned(), planner, budget })
    }

    /// Returns the name as it was read.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the calls of a decision.
    pub fn budget(&self) -> Budget {
        self.budget
    }

    /// Returns `true` if the planner looks ahead: see [`PlannerSpec::looks_ahead`].
    pub fn looks_ahead(&self) -> bool {
        self.planner.looks_ahead()
    }

    /// Returns the planner, with its own random streams.
    pub fn player(&self, seed: Seed) -> Player {
        self.planner.player(seed)
    }
}

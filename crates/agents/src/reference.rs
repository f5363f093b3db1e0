//! Reference planners with a fixed number of forward-model calls per decision. Their win rates measure the difficulty
//! of a level.

use crate::planner::Budget;
use crate::registry::{PlannerSpec, Player, UnknownPlanner};
use base::Seed;

/// A registered planner with a fixed number of forward-model calls per decision, such as `mcts:500`. The planner
/// depends only on its name and on the number of calls, so its wins are comparable across levels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReferencePlanner {
    name: String,
    planner: PlannerSpec,
    budget: Budget,
}

impl ReferencePlanner {
    /// Parses `planner:calls`. If the text states no number of calls, the planner gets `calls` calls per decision.
    ///
    /// # Errors
    ///
    /// Returns an error if no such planner exists, or if the text after the colon is not a number.
    pub fn new(name: &str, calls: u64) -> Result<ReferencePlanner, UnknownPlanner> {
        let planner: PlannerSpec = name.parse()?;
        let budget = planner.budget().unwrap_or(Budget(calls));
        Ok(ReferencePlanner { name: name.to_owned(), planner, budget })
    }

    /// Returns the planner's name as passed to [`ReferencePlanner::new`].
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the number of forward-model calls per decision.
    pub fn budget(&self) -> Budget {
        self.budget
    }

    /// Returns `true` if the planner looks ahead: see [`PlannerSpec::looks_ahead`].
    pub fn looks_ahead(&self) -> bool {
        self.planner.looks_ahead()
    }

    /// Returns a new player for the planner, with its own random-number streams.
    pub fn player(&self, seed: Seed) -> Player {
        self.planner.player(seed)
    }
}

//! What a planner is.

use engine::{Action, Game, State};
use serde::{Deserialize, Serialize};

/// How many forward-model calls a decision may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Budget(pub u64);

/// Chooses actions by looking ahead on copies of the state.
pub trait Planner {
    /// The next action, and the forward-model calls that it cost. A search checks its budget before each iteration, so
    /// it may overshoot by one iteration.
    fn plan(&mut self, game: &Game, state: &State, budget: Budget) -> (Action, u64);
}

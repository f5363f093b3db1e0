//! The planner interface.

use base::{Sampler, Seed};
use engine::{Action, Chance, Game, State};
use serde::{Deserialize, Serialize};

/// The maximum number of forward-model calls that one decision may make.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Budget(pub u64);

impl Budget {
    /// The maximum budget that users can set. A decision that makes a billion calls takes most of an hour.
    pub const MOST: Budget = Budget(1_000_000_000);
}

/// A player that chooses actions by looking ahead on copies of the state.
pub trait Planner {
    /// Returns the next action, and its cost in forward-model calls. A search checks its budget before each
    /// iteration, so it may exceed the budget by one iteration.
    fn plan(&mut self, game: &Game, state: &State, budget: Budget) -> (Action, u64);
}

/// The source of the random-number streams for a planner's decisions. Each decision has its own streams, so it is
/// enough to save a planner's seed and its number of decisions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Streams {
    seed: Seed,
    decisions: u64,
}

/// The random-number streams for one decision: one for the planner's choices, and one for the imagined outcomes.
pub(crate) struct Decision {
    pub(crate) choices: Sampler,
    imagined: Sampler,
}

impl Streams {
    pub(crate) fn new(seed: Seed) -> Streams {
        Streams { seed, decisions: 0 }
    }

    /// Returns the random-number streams for the next decision.
    pub(crate) fn next(&mut self) -> Decision {
        let seed = self.seed.child("decision", self.decisions);
        self.decisions += 1;
        Decision {
            choices: seed.child("choices", 0).sampler(),
            imagined: seed.child("imagined", 0).sampler(),
        }
    }
}

impl Decision {
    /// Overwrites `copy` with a copy of the state whose future is imagined.
    pub(crate) fn fork_with_random_future(&mut self, copy: &mut State, state: &State) {
        copy.fork_from(state, Chance::from_java(self.imagined.bits() as i64));
    }
}

//! What a planner is.

use engine::{Action, Chance, Game, Sampler, Seed, State};
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

/// Where the streams of a planner's decisions come from: each decision has its own, so a planner is saved as its seed and
/// a count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Streams {
    seed: Seed,
    decisions: u64,
}

/// The streams of one decision: what the planner chooses, and the chance that it imagines.
pub(crate) struct Decision {
    pub(crate) choices: Sampler,
    imagined: Sampler,
}

impl Streams {
    pub(crate) fn new(seed: Seed) -> Streams {
        Streams { seed, decisions: 0 }
    }

    /// The streams of the next decision.
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
    /// Makes `copy` a copy of the state with an imagined future.
    pub(crate) fn imagine(&mut self, copy: &mut State, state: &State) {
        copy.fork_from(state, Chance::from_java(self.imagined.bits() as i64));
    }
}

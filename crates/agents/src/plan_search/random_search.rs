//! Random search, like the reference's `sampleRS` (`spec/04` §4). It is a baseline for evolution with the same number
//! of calls.

use super::sequences::Sequences;
use crate::guides::heuristics::Heuristic;
use crate::planner::{Budget, Planner, Streams};
use base::Seed;
use engine::{Action, Game, State};
use serde::{Deserialize, Serialize};

base::with_defaults! {
    /// The parameters of [`RandomSearch`]. The defaults match the reference.
    #[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct RandomSearchConfig {
        /// The length of a sequence in ticks.
        pub horizon: usize = 10,
        /// The heuristic that evaluates a sequence's final state.
        pub heuristic: Heuristic = Heuristic::WinScore,
    }
}

/// A planner that tries random action sequences, which may contain [`Action::Nil`], and plays the first
/// action of the best sequence.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RandomSearch {
    config: RandomSearchConfig,
    streams: Streams,
    #[serde(skip)]
    scratch: Option<State>,
}

impl RandomSearch {
    /// Creates a planner with its own random-number streams for choices and imagined outcomes.
    pub fn new(config: RandomSearchConfig, seed: Seed) -> RandomSearch {
        RandomSearch { config, streams: Streams::new(seed), scratch: None }
    }
}

impl Planner for RandomSearch {
    fn plan(&mut self, game: &Game, state: &State, budget: Budget) -> (Action, u64) {
        let mut decision = self.streams.next();
        let mut sequences = Sequences::new(game, state, self.config.heuristic, budget, self.scratch.take());
        let mut best = (0, f64::NEG_INFINITY);
        loop {
            let genes = sequences.random(self.config.horizon.max(1), &mut decision);
            let value = sequences.value(&genes, &mut decision);
            if value > best.1 {
                best = (genes[0], value);
            }
            if sequences.is_spent() {
                break;
            }
        }
        let (action, calls) = (sequences.action(best.0), sequences.calls());
        self.scratch = Some(sequences.into_scratch());
        (action, calls)
    }
}

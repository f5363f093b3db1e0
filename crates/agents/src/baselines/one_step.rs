//! One-step look-ahead: the reference's `sampleonesteplookahead` (`spec/04` §5).

use crate::guides::heuristics::Heuristic;
use crate::planner::{Budget, Planner, Streams};
use crate::tree_search::branches::blurred;
use base::Seed;
use engine::{Action, Game, State};
use serde::{Deserialize, Serialize};

/// The scale of the tie-breaking noise, as in the reference.
const EPSILON: f64 = 1e-6;

base::with_defaults! {
    /// The parameters of [`OneStep`]. The defaults match the reference.
    #[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct OneStepConfig {
        /// The heuristic that evaluates the next states.
        pub heuristic: Heuristic = Heuristic::Simple,
        /// The number of times that each action is tried, at least 1. The results of all tries are averaged. The
        /// reference tries each action once, so a single random draw decides.
        pub samples: u32 = 1,
    }
}

/// A player that looks one tick ahead. A decision costs one call per action and sample, regardless of the
/// budget.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct OneStep {
    config: OneStepConfig,
    streams: Streams,
    #[serde(skip)]
    scratch: Option<State>,
}

impl OneStep {
    /// Creates a planner with its own random-number streams for choices and imagined outcomes.
    pub fn new(config: OneStepConfig, seed: Seed) -> OneStep {
        OneStep { config, streams: Streams::new(seed), scratch: None }
    }
}

impl Planner for OneStep {
    fn plan(&mut self, game: &Game, state: &State, _: Budget) -> (Action, u64) {
        let mut decision = self.streams.next();
        let mut copy = self.scratch.take().unwrap_or_else(|| state.clone());
        let mut best = (Action::Nil, f64::NEG_INFINITY);
        let mut calls = 0;
        for &action in game.actions(state) {
            let samples = self.config.samples.max(1);
            let mut total = 0.0;
            for _ in 0..samples {
                decision.fork_with_random_future(&mut copy, state);
                game.step(&mut copy, action);
                calls += 1;
                total += self.config.heuristic.value(game, state, &copy);
            }
            let value = blurred(total / f64::from(samples), EPSILON, decision.choices.unit());
            if value > best.1 {
                best = (action, value);
            }
        }
        self.scratch = Some(copy);
        (best.0, calls)
    }
}

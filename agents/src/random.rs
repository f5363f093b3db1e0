//! The players who press any key: the floor of every comparison (`spec/04` §7).

use crate::planner::{Budget, Planner};
use engine::{Action, Game, Sampler, Seed, State};
use serde::{Deserialize, Serialize};

/// Uniform over the avatar's actions: the reference's `simpleRandom`, doing nothing left out, or with it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Random {
    with_nil: bool,
    choices: Sampler,
}

impl Random {
    /// A player of its own stream of choices, who always does something.
    pub fn new(seed: Seed) -> Random {
        Random { with_nil: false, choices: seed.child("choices", 0).sampler() }
    }

    /// One for whom doing nothing is an action like the others.
    pub fn with_nil(seed: Seed) -> Random {
        Random { with_nil: true, ..Random::new(seed) }
    }
}

impl Planner for Random {
    fn plan(&mut self, game: &Game, state: &State, _: Budget) -> (Action, u64) {
        let actions = game.actions(state);
        if self.with_nil && self.choices.below(actions.len() + 1) == 0 {
            return (Action::Nil, 0);
        }
        (*self.choices.choose(actions), 0)
    }
}

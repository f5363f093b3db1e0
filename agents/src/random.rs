//! The player who presses any key: the floor of every comparison (`spec/04` §7).

use crate::planner::{Budget, Planner};
use engine::{Action, Game, Sampler, Seed, State};

/// Uniform over the avatar's actions, doing nothing left out.
#[derive(Clone, Debug)]
pub struct Random {
    choices: Sampler,
}

impl Random {
    /// A player of its own stream of choices.
    pub fn new(seed: Seed) -> Random {
        Random { choices: seed.child("choices", 0).sampler() }
    }
}

impl Planner for Random {
    fn plan(&mut self, game: &Game, state: &State, _: Budget) -> (Action, u64) {
        (*self.choices.choose(game.actions(state)), 0)
    }
}

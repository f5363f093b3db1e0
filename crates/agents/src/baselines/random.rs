//! Random players, the baseline of every comparison (`spec/04` §7).

use crate::planner::{Budget, Planner};
use base::{Sampler, Seed};
use engine::{Action, Game, State};
use serde::{Deserialize, Serialize};

/// A player that draws uniformly from the avatar's actions, like the reference's `simpleRandom`. Only players created
/// by [`Random::with_nil`] also draw [`Action::Nil`].
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Random {
    with_nil: bool,
    choices: Sampler,
}

impl Random {
    /// Creates a player that never draws [`Action::Nil`], with its own random-number stream of choices.
    pub fn new(seed: Seed) -> Random {
        Random { with_nil: false, choices: seed.child("choices", 0).sampler() }
    }

    /// Creates a player that also draws [`Action::Nil`].
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

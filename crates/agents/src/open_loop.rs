//! Planning several actions in advance.

use crate::{Budget, Planner};
use base::Seed;
use engine::{Action, Game, State};
use serde::{Deserialize, Serialize};

/// A player that commits to several actions at a time. It plans each action in the state that it imagines after the
/// previous actions. In a deterministic game, the imagined state is the actual next state. In a stochastic game, it
/// is one of many possible states, drawn from a random-number stream that is separate from those of the planner and the
/// game. Like its planner, a player can be saved between two decisions.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct OpenLoop<P> {
    planner: P,
    budget: Budget,
    futures: Seed,
    plans: u64,
}

impl<P: Planner> OpenLoop<P> {
    /// Creates a player with a budget for each action, and with a seed for the imagined states.
    pub fn new(planner: P, budget: Budget, seed: Seed) -> OpenLoop<P> {
        OpenLoop { planner, budget, futures: seed.child("imagined plan", 0), plans: 0 }
    }

    /// Returns `count` actions, and their cost in forward-model calls. Returns fewer actions if the game ends in the
    /// imagined future. If `count` is 1, the action is the one that the planner would choose.
    pub fn plan(&mut self, game: &Game, state: &State, count: u64) -> (Vec<Action>, u64) {
        let (first, mut calls) = self.planner.plan(game, state, self.budget);
        let mut actions = vec![first];
        if count > 1 {
            let mut imagined = state.fork(self.futures.child("plan", self.plans));
            self.plans += 1;
            for _ in 1..count {
                game.step(&mut imagined, actions[actions.len() - 1]);
                calls += 1;
                if imagined.is_over() {
                    break;
                }
                let (action, spent) = self.planner.plan(game, &imagined, self.budget);
                actions.push(action);
                calls += spent;
            }
        }
        (actions, calls)
    }
}

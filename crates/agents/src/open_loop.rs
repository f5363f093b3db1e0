//! Planning several actions in advance.

use crate::{Budget, Planner};
use base::Seed;
use engine::{Action, Game, State};

/// A planner that commits to several actions at once: it plans each in the state that it imagines after those before. In a
/// game without chance that state is the one that follows; otherwise it is one of many, imagined by a random stream that is
/// neither the planner's own nor the game's.
#[derive(Clone, Debug)]
pub struct OpenLoop<P> {
    planner: P,
    budget: Budget,
    futures: Seed,
    plans: u64,
}

impl<P: Planner> OpenLoop<P> {
    /// Creates it with the forward-model calls for each action, and the seed of what it imagines.
    pub fn new(planner: P, budget: Budget, seed: Seed) -> OpenLoop<P> {
        OpenLoop { planner, budget, futures: seed.child("imagined plan", 0), plans: 0 }
    }

    /// Returns `count` actions, fewer if the game is over in the future that is imagined, and the forward-model calls that
    /// they cost. One action is exactly what the planner chooses.
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

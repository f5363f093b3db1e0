//! The nearest-goal player, which walks straight to the nearest useful sprite.

use crate::guides::goal_guide::{Distances, GoalGuide};
use crate::planner::{Budget, Planner, Streams};
use base::Seed;
use engine::{Action, Game, Outcome, State};
use serde::{Deserialize, Serialize};

/// A greedy player that chooses the action that makes the most progress towards a win. Among equally good actions, it
/// chooses the one that brings the avatar closest to a sprite that is needed for a win. The player looks only one tick
/// ahead. It neither plans nor waits, and notices a danger only in an adjacent cell. A level that this player wins
/// requires nothing but walking.
///
/// The player presses a random key in the fraction `slips` of its ticks. If `slips` is not 0, the player is called
/// *careless*.
///
/// Cost: one forward-model call per available action, regardless of the budget.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct NearestGoal {
    slips: f64,
    streams: Streams,
    #[serde(skip)]
    guide: Option<GoalGuide>,
    #[serde(skip)]
    distances: Distances,
    #[serde(skip)]
    scratch: Option<State>,
}

impl NearestGoal {
    /// Creates a player that presses a random key in the fraction `slips` of its ticks, with its own random-number
    /// streams.
    pub fn new(slips: f64, seed: Seed) -> NearestGoal {
        let (streams, distances) = (Streams::new(seed), Distances::default());
        NearestGoal { slips, streams, guide: None, distances, scratch: None }
    }
}

impl Planner for NearestGoal {
    fn plan(&mut self, game: &Game, state: &State, _: Budget) -> (Action, u64) {
        let mut decision = self.streams.next();
        let actions = game.actions(state);
        if decision.choices.unit() < self.slips {
            return (*decision.choices.choose(actions), 0);
        }
        let guide = match self.guide.take() {
            Some(guide) if guide.fits(game) => guide,
            _ => GoalGuide::of(game),
        };
        let mut copy = self.scratch.take().unwrap_or_else(|| state.clone());
        let mut best = (Action::Nil, f64::NEG_INFINITY);
        for &action in actions {
            decision.fork_with_random_future(&mut copy, state);
            game.step(&mut copy, action);
            let value = match copy.outcome() {
                Outcome::Won => f64::INFINITY,
                Outcome::Lost => f64::MIN,
                _ => guide.progress(&copy) + guide.closeness(&copy, &mut self.distances),
            };
            let value = value + TIE * decision.choices.unit();
            if value > best.1 {
                best = (action, value);
            }
        }
        (self.guide, self.scratch) = (Some(guide), Some(copy));
        (best.0, actions.len() as u64)
    }
}

/// The scale of the noise that breaks ties between actions.
const TIE: f64 = 1e-6;

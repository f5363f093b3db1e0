//! The fraction of dead ends near a win.

use crate::measures::actions;
use agents::search::{Answer, Pushes, SearchLimits, best_first};
use base::Seed;
use engine::{Analysis, Episode, Level, Outcome, State};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The states that are one or two actions off a win, counted by the result of a bounded search from each state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeadEnds {
    /// The number of distinct states.
    pub states: usize,
    /// The number of states from which winning is proven impossible, including lost states.
    pub dead: usize,
    /// The number of states from which a win was found. All other states are undecided.
    pub won: usize,
}

/// The number of evenly spaced ticks at which the search departs from the win.
const TICKS: usize = 40;
/// The number of forward-model calls per search from a state.
const CALLS: u64 = 3000;

impl DeadEnds {
    /// Departs from the win at up to [`TICKS`] of its ticks, with each action that the win does not take there and then
    /// with a random action. States that are part of the win do not count. Returns `None` if the level is stochastic.
    /// Cost: up to 320 searches of [`CALLS`] calls.
    pub(super) fn of(analysis: &Analysis, level: &Level, win: &Episode, seed: Seed) -> Option<DeadEnds> {
        let game = analysis.game();
        let start = game.start(level, win.seed);
        if !analysis.is_deterministic_from(&start) {
            return None;
        }
        let mut path = vec![start];
        for &action in &win.actions {
            let mut next = path[path.len() - 1].clone();
            game.step(&mut next, action);
            path.push(next);
        }
        let mut met: BTreeSet<_> = path.iter().map(|state| state.search_key(game)).collect();
        let pushes = Pushes::of(analysis, level);
        let mut sampler = seed.child("second action", 0).sampler();
        let mut found = DeadEnds::default();
        let stride = win.actions.len().div_ceil(TICKS).max(1);
        for (state, &taken) in path.iter().zip(&win.actions).step_by(stride) {
            for action in actions(game, state).into_iter().filter(|&action| action != taken) {
                let mut off = state.clone();
                for number in 0..2 {
                    let action = match number {
                        0 => action,
                        _ => *sampler.choose(&actions(game, &off)),
                    };
                    game.step(&mut off, action);
                    if met.insert(off.search_key(game)) {
                        found.add(analysis, &pushes, &off);
                    }
                    if off.is_over() {
                        break;
                    }
                }
            }
        }
        Some(found)
    }

    fn add(&mut self, analysis: &Analysis, pushes: &Pushes, state: &State) {
        self.states += 1;
        let is_won = match state.outcome() {
            Outcome::Won => Some(true),
            Outcome::Ongoing => {
                let limits = SearchLimits { calls: CALLS, bytes: 1 << 28 };
                match best_first(analysis, pushes, state, limits).answer {
                    Answer::Won { .. } => Some(true),
                    Answer::Impossible => Some(false),
                    Answer::OutOfCalls | Answer::OutOfMemory => None,
                }
            }
            Outcome::Lost | Outcome::Ended | Outcome::Stopped(_) => Some(false),
        };
        self.won += usize::from(is_won == Some(true));
        self.dead += usize::from(is_won == Some(false));
    }

    /// Returns the fraction of states that are proven dead.
    pub fn share(&self) -> f64 {
        self.dead as f64 / self.states.max(1) as f64
    }
}

//! Playing an episode with a planner.

use crate::planner::{Budget, Planner};
use base::SeedPath;
use engine::{Episode, Game, Level};

/// A played episode and what it cost.
#[derive(Clone, Debug)]
pub struct Play {
    /// The episode, which replays bit for bit.
    pub episode: Episode,
    /// Forward-model calls of all decisions together.
    pub calls: u64,
}

base::with_defaults! {
    /// The limits at which a play is broken off; by default none beyond the engine's own tick limit.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Limits {
        /// The most ticks of a play.
        pub ticks: usize = usize::MAX,
        /// Forward-model calls of all decisions together: checked before each decision.
        pub calls: u64 = u64::MAX,
    }
}

/// Plays until the episode is over or a limit is reached. `seed` decides the game's randomness; the planner has its
/// own streams, and the episode keeps the steps of a [`SeedPath`].
pub fn play(
    game: &Game,
    level: &Level,
    planner: &mut dyn Planner,
    budget: Budget,
    seed: impl Into<SeedPath>,
    limits: Limits,
) -> Play {
    play_until(game, level, planner, budget, seed, limits, &|| false)
}

/// Returns `true` once nobody waits for an answer any more. An answer that arrives before does not depend on it.
pub type Stopped<'a> = &'a (dyn Fn() -> bool + Sync);

/// [`play`], until nobody waits for it: the play is broken off before the next decision.
pub fn play_until(
    game: &Game,
    level: &Level,
    planner: &mut dyn Planner,
    budget: Budget,
    seed: impl Into<SeedPath>,
    limits: Limits,
    stopped: Stopped<'_>,
) -> Play {
    let (mut episode, mut state) = Episode::begin(game, level, seed);
    let mut calls = 0;
    while !state.is_over() && episode.actions.len() < limits.ticks && calls < limits.calls && !stopped() {
        let (action, cost) = planner.plan(game, &state, budget);
        calls += cost;
        episode.play(game, &mut state, action);
    }
    Play { episode, calls }
}

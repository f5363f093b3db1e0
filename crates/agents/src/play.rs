//! Playing an episode with a planner.

use crate::planner::{Budget, Planner};
use base::SeedPath;
use engine::{Episode, Game, Level};

/// A played episode and its cost.
#[derive(Clone, Debug)]
pub struct Play {
    /// The episode, which replays bit for bit.
    pub episode: Episode,
    /// The number of forward-model calls across all decisions.
    pub calls: u64,
}

base::with_defaults! {
    /// The limits that stop an episode early. By default, only the engine's own tick limit applies.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Limits {
        /// The maximum number of ticks in the episode.
        pub ticks: usize = usize::MAX,
        /// The maximum number of forward-model calls across all decisions. The limit is checked before each
        /// decision.
        pub calls: u64 = u64::MAX,
    }
}

/// Plays until the episode is over or a limit is reached. `seed` determines the game's randomness; the planner has
/// its own random-number streams. If `seed` is a [`SeedPath`], the episode records the path.
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

/// A function that returns `true` once the result is no longer needed. A result that is completed before that does
/// not depend on the function.
pub type Stopped<'a> = &'a (dyn Fn() -> bool + Sync);

/// Plays like [`play`], but stops before the next decision once `stopped` returns `true`.
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

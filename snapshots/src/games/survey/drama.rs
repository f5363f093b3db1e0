//! Is the outcome open until late?

use agents::{Budget, Planner, planner};
use engine::{Episode, Game, Level, Outcome, Seed};

/// Moments of a winning play that are looked at, evenly spread.
const MOMENTS: usize = 8;
/// Futures of each moment.
const FUTURES: u64 = 4;
/// Ticks of a future at most, and at least: otherwise twice what the winning play takes from there.
const TICKS: [usize; 2] = [20, 200];
/// Who plays them.
const PLAYER: &str = "mcts";
/// With so many forward-model calls for a decision.
const CALLS: Budget = Budget(30);

/// How far behind the winner of a play is, from 0 to 1: the severity of the positions from which it recovers (C. Browne and
/// F. Maire, "Evolutionary Game Design", 2010, drama), in the mean over [`MOMENTS`] of the play. A modest player takes over at
/// such a moment, under fresh dice: if it wins less than half of its plays, the winner is behind by the square root of the share
/// that it does not win less the share that it does. 0: the win was in hand from the start.
pub(super) fn drama(game: &Game, level: &Level, won: &Episode, seed: Seed) -> f64 {
    let mut state = game.start(level, won.seed);
    let (mut sum, mut moments) = (0.0, 0u64);
    let stride = won.actions.len().div_ceil(MOMENTS).max(1);
    for (tick, &action) in won.actions.iter().enumerate() {
        if tick % stride == 0 {
            let left = won.actions.len() - tick;
            let ticks = (2 * left).clamp(TICKS[0], TICKS[1]);
            let wins = |number: &u64| {
                future(game, &state, ticks, seed.child("tick", tick as u64).child("future", *number))
            };
            let share = (0..FUTURES).filter(wins).count() as f64 / FUTURES as f64;
            sum += (1.0 - 2.0 * share).max(0.0).sqrt();
            moments += 1;
        }
        game.step(&mut state, action);
    }
    sum / moments.max(1) as f64
}

/// Whether a modest player wins from here.
fn future(game: &Game, from: &engine::State, ticks: usize, seed: Seed) -> bool {
    let mut player: Box<dyn Planner> =
        planner(PLAYER, seed.child("player", 0)).expect("there is such a planner");
    let mut state = from.fork(seed.child("chance", 0));
    for _ in 0..ticks {
        if state.is_over() {
            break;
        }
        let (action, _) = player.plan(game, &state, CALLS);
        game.step(&mut state, action);
    }
    state.outcome() == Outcome::Won
}

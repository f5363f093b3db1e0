//! The win rate of plain Monte-Carlo tree search, reported on every level's card next to its witness.

use crate::Criteria;
use crate::verdict::Rate;
use agents::{Budget, Limits, Mcts, MctsConfig, Play, play};
use base::Seed;
use engine::{Episode, Game, Level};
use rayon::prelude::*;

/// Plays the reference's tree search ([`Mcts`]) on a level that has a win, and returns its win rate. A play is broken
/// off after [`Criteria::patience`] times the ticks of the witness, and 50 more. Cost: `mcts_plays` plays of
/// `decision` calls a tick.
pub fn mcts_rate(game: &Game, level: &Level, witness: &Episode, criteria: &Criteria, seed: Seed) -> Rate {
    let ticks = witness.actions.len().saturating_mul(criteria.patience).saturating_add(50);
    let limits = Limits { ticks, ..Limits::default() };
    let plays: Vec<Play> = (0..u64::from(criteria.mcts_plays))
        .into_par_iter()
        .map(|run| {
            let seed = seed.child("mcts", run);
            let mut planner = Mcts::new(MctsConfig::default(), seed.child("planner", 0));
            play(game, level, &mut planner, Budget(criteria.decision), seed.child("chance", 0), limits)
        })
        .collect();
    Rate::of(&plays)
}

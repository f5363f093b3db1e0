//! Careless players: the nearest-goal player, with slips.

use super::WonLevel;
use crate::game_report::GameCase;
use agents::{Budget, Limits, NearestGoal, play};
use engine::{Episode, Outcome};
use rayon::prelude::*;

/// A play is broken off after this multiple of the ticks of the win, and [`GRACE`] more.
const PATIENCE: usize = 4;
const GRACE: usize = 50;

/// Plays of the nearest-goal player on a level, with a share of slips. Cost: a call for each action and tick.
pub(super) fn plays(case: GameCase<'_>, won: WonLevel<'_>, slips: f64, plays: u32) -> Vec<Episode> {
    let seed = case.seed.child("level", won.number as u64);
    let limits = Limits { ticks: PATIENCE * won.ticks() + GRACE, calls: u64::MAX };
    let run = |number: u32| {
        let seed = seed.child("play", u64::from(number));
        let mut player = NearestGoal::new(slips, seed.child("player", 0));
        play(case.game, won.level, &mut player, Budget(0), seed.child("chance", 0), limits).episode
    };
    (0..plays).into_par_iter().map(run).collect()
}

/// The share of plays that are won.
pub(super) fn win_share(plays: &[Episode]) -> f64 {
    let won = plays.iter().filter(|episode| episode.outcome == Outcome::Won).count();
    won as f64 / plays.len().max(1) as f64
}

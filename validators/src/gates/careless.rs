//! Careless players: the nearest-goal player, with slips.

use super::Gates;
use agents::{Budget, Limits, NearestGoal, play};
use base::Seed;
use engine::{Episode, Game, Level, Outcome};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::OnceLock;

/// A play is broken off after this multiple of the ticks of the win, and [`GRACE`] more.
const PATIENCE: usize = 4;
const GRACE: usize = 50;

/// The plays of a closer look, as a multiple of those of the first: a gate that few plays speak against asks more of them before
/// it fails.
pub(super) const CLOSER: u32 = 4;

/// The plays of careless players, made when the first gate asks, and shared by all.
pub(crate) struct CarelessPlays<'a> {
    game: &'a Game,
    seed: Seed,
    levels: Vec<OnceLock<Vec<Episode>>>,
    /// The share of wins in a closer look, by level.
    closer: Vec<OnceLock<f64>>,
}

impl<'a> CarelessPlays<'a> {
    /// The plays on so many levels of a game; none is made yet.
    pub(crate) fn new(game: &'a Game, levels: usize, seed: Seed) -> CarelessPlays<'a> {
        let (plays, closer) = (vec![OnceLock::new(); levels], vec![OnceLock::new(); levels]);
        CarelessPlays { game, seed, levels: plays, closer }
    }

    /// The plays of careless players on a level. Cost, once: a call for each action and tick.
    pub(super) fn plays(&self, won: WonLevel<'_>, gates: &Gates) -> &[Episode] {
        self.levels[won.number].get_or_init(|| self.numbered_plays(won, gates, 0..gates.careless_plays))
    }

    /// The share of the careless plays on a level that are won, from [`CLOSER`] times as many plays. Cost, once: these plays.
    pub(super) fn closer_win_share(&self, won: WonLevel<'_>, gates: &Gates) -> f64 {
        *self.closer[won.number].get_or_init(|| {
            let first = gates.careless_plays;
            let further = self.numbered_plays(won, gates, first..first.saturating_mul(CLOSER));
            win_share(&[self.plays(won, gates), &further].concat())
        })
    }

    fn numbered_plays(&self, won: WonLevel<'_>, gates: &Gates, numbers: Range<u32>) -> Vec<Episode> {
        let seed = self.seed.child("level", won.number as u64);
        nearest_goal(self.game, won.level, won.ticks(), gates.careless_slips, numbers, seed)
    }
}

/// A level with the shortest win that is known.
#[derive(Clone, Copy)]
pub(super) struct WonLevel<'a> {
    /// Its number in the game, from 0.
    pub(super) number: usize,
    pub(super) level: &'a Level,
    pub(super) win: &'a Episode,
}

impl WonLevel<'_> {
    /// Ticks of the win.
    pub(super) fn ticks(&self) -> usize {
        self.win.actions.len()
    }
}

/// The plays of these numbers by the nearest-goal player on a level that is won in so many ticks, with a share of slips. Cost: a
/// call for each action and tick.
pub(super) fn nearest_goal(
    game: &Game,
    level: &Level,
    ticks: usize,
    slips: f64,
    numbers: Range<u32>,
    seed: Seed,
) -> Vec<Episode> {
    let limits = Limits { ticks: PATIENCE * ticks + GRACE, calls: u64::MAX };
    let run = |number: u32| {
        let seed = seed.child("play", u64::from(number));
        let mut player = NearestGoal::new(slips, seed.child("player", 0));
        play(game, level, &mut player, Budget(0), seed.child("chance", 0), limits).episode
    };
    numbers.into_par_iter().map(run).collect()
}

/// The share of the plays of careless players on a level that the rules bring to an end, won or lost: in the others nothing happens
/// any more. Cost: [`Gates::careless_plays`] plays, a call for each action and tick.
pub fn ended_share(game: &Game, level: &Level, win: &Episode, gates: &Gates, seed: Seed) -> f64 {
    let numbers = 0..gates.careless_plays;
    let plays = nearest_goal(game, level, win.actions.len(), gates.careless_slips, numbers, seed);
    let ended =
        plays.iter().filter(|episode| matches!(episode.outcome, Outcome::Won | Outcome::Lost)).count();
    ended as f64 / plays.len().max(1) as f64
}

/// The share of plays that are won.
pub(super) fn win_share(plays: &[Episode]) -> f64 {
    let won = plays.iter().filter(|episode| episode.outcome == Outcome::Won).count();
    won as f64 / plays.len().max(1) as f64
}

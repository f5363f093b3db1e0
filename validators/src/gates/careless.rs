//! Careless players, which head for the nearest goal ([`NearestGoal`]) but press a random key in some ticks.

use super::Gates;
use agents::{Budget, Limits, NearestGoal, play};
use base::Seed;
use engine::{Episode, Game, Level, Outcome};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::OnceLock;

/// The maximum length of an episode, as a multiple of the number of ticks in the win. [`GRACE`] is added to it.
const PATIENCE: usize = 4;
const GRACE: usize = 50;

/// The number of episodes in a closer evaluation, as a multiple of the number in the first evaluation. A gate requests
/// a closer evaluation before it fails because of only a few episodes.
pub(super) const CLOSER: u32 = 4;

/// The episodes of careless players, which press a random key in some ticks. They are played when a gate first requests
/// them, and all gates share them.
pub(crate) struct CarelessPlays<'a> {
    game: &'a Game,
    seed: Seed,
    levels: Vec<OnceLock<Vec<Episode>>>,
    /// The win rate in a closer evaluation, by level.
    closer: Vec<OnceLock<f64>>,
}

impl<'a> CarelessPlays<'a> {
    /// Creates the record for a game with `levels` levels, before any episode is played.
    pub(crate) fn new(game: &'a Game, levels: usize, seed: Seed) -> CarelessPlays<'a> {
        let (plays, closer) = (vec![OnceLock::new(); levels], vec![OnceLock::new(); levels]);
        CarelessPlays { game, seed, levels: plays, closer }
    }

    /// Returns the episodes that careless players, who press a random key in some ticks, played on a level. The first
    /// call costs one forward-model call per action and tick.
    pub(super) fn plays(&self, won: WonLevel<'_>, gates: &Gates) -> &[Episode] {
        self.levels[won.number].get_or_init(|| self.numbered_plays(won, gates, 0..gates.careless_plays))
    }

    /// Returns the win rate of careless players on a level, measured over [`CLOSER`] times the usual number of
    /// episodes. The first call costs these episodes.
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

/// A level with its shortest known win.
#[derive(Clone, Copy)]
pub(super) struct WonLevel<'a> {
    /// The level's index in the game.
    pub(super) number: usize,
    pub(super) level: &'a Level,
    pub(super) win: &'a Episode,
}

impl WonLevel<'_> {
    /// Returns the win's number of ticks.
    pub(super) fn ticks(&self) -> usize {
        self.win.actions.len()
    }
}

/// Plays the episodes with the given numbers on a level that can be won in `ticks` ticks. The player walks to the
/// nearest goal, but presses a random key in a fraction of its ticks. Cost: one call per action and tick.
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

/// Returns the fraction of careless players' episodes on a level that the rules end with a win or a loss. All other
/// episodes get stuck. Cost: [`Gates::careless_plays`] episodes, with one call per action and tick.
pub fn ended_share(game: &Game, level: &Level, win: &Episode, gates: &Gates, seed: Seed) -> f64 {
    let numbers = 0..gates.careless_plays;
    let plays = nearest_goal(game, level, win.actions.len(), gates.careless_slips, numbers, seed);
    let ended =
        plays.iter().filter(|episode| matches!(episode.outcome, Outcome::Won | Outcome::Lost)).count();
    ended as f64 / plays.len().max(1) as f64
}

/// Returns the fraction of episodes that were won.
pub(super) fn win_share(plays: &[Episode]) -> f64 {
    let won = plays.iter().filter(|episode| episode.outcome == Outcome::Won).count();
    won as f64 / plays.len().max(1) as f64
}

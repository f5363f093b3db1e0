//! Random futures from a moment in an episode, compared with the episode as played. They show whether the player or the
//! game is in the lead, and how far ahead a player must look.
//!
//! The futures press random keys, but replace a key that loses immediately. Otherwise, every deadly game would look
//! hopeless at all times.

use base::{Sampler, Seed};
use engine::{Game, Outcome, State};
use std::cmp::Ordering;
use std::mem;

/// The number of ticks for which random futures are played.
pub const SIGHT: usize = 64;
/// The number of random futures per moment.
pub const FUTURES: u64 = 8;
/// The ticks at which futures are compared.
const CHECKPOINTS: [usize; 7] = [1, 2, 4, 8, 16, 32, SIGHT];
/// The number of random keys to try per tick.
const KEYS_TRIED: usize = 3;
/// The number of futures that must be worse than the actual play in order for the play to count as visibly better.
const WORSE: usize = 6;

/// A future being played.
struct Future<'a> {
    game: &'a Game,
    state: State,
    /// A buffer for the state after a key.
    after: State,
    keys: Sampler,
}

impl Future<'_> {
    /// Plays for `ticks` ticks, or until the game is over.
    fn play_on(&mut self, ticks: usize) {
        for _ in 0..ticks {
            if self.state.is_over() {
                return;
            }
            for _ in 0..KEYS_TRIED {
                self.after.clone_from(&self.state);
                let action = *self.keys.choose(self.game.actions(&self.state));
                self.game.step(&mut self.after, action);
                if self.after.outcome() != Outcome::Lost {
                    break;
                }
            }
            mem::swap(&mut self.state, &mut self.after);
        }
    }
}

/// The standing in a game, compared first by outcome and then by score.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Standing {
    outcome: i8,
    score: f64,
}

impl Standing {
    pub(super) fn of(state: &State) -> Standing {
        let outcome = match state.outcome() {
            Outcome::Won => 1,
            Outcome::Lost => -1,
            Outcome::Ongoing | Outcome::Ended | Outcome::Stopped(_) => 0,
        };
        Standing { outcome, score: state.score() }
    }

    fn beats(self, other: Standing) -> bool {
        let order = self.outcome.cmp(&other.outcome).then(self.score.total_cmp(&other.score));
        order == Ordering::Greater
    }
}

/// The standings of a moment's futures after 1, 2, 4 … [`SIGHT`] ticks.
pub(super) struct Futures(Vec<[Standing; CHECKPOINTS.len()]>);

impl Futures {
    /// Plays the futures, each with its own random seed. Cost: [`FUTURES`] × [`SIGHT`] forward-model calls,
    /// or up to three times as many.
    pub(super) fn of(game: &Game, state: &State, seed: Seed) -> Futures {
        let play = |number: u64| {
            let seed = seed.child("future", number);
            let forked = state.fork(seed.child("chance", 0));
            let keys = seed.child("keys", 0).sampler();
            let mut future = Future { game, after: forked.clone(), state: forked, keys };
            let mut played = 0;
            CHECKPOINTS.map(|ticks| {
                future.play_on(ticks - played);
                played = ticks;
                Standing::of(&future.state)
            })
        };
        Futures((0..FUTURES).map(play).collect())
    }

    /// Returns the fraction of won futures minus the fraction of lost futures, from −1 to 1. Undecided futures count
    /// for neither side.
    pub(super) fn lead(&self) -> f64 {
        let sum: i32 = self.0.iter().map(|future| i32::from(future[CHECKPOINTS.len() - 1].outcome)).sum();
        f64::from(sum) / FUTURES as f64
    }

    /// Returns the number of ticks after which a line of play is better than most futures. The line is given
    /// by its standing at each tick, starting at the moment of the futures. Returns [`SIGHT`] if it becomes
    /// better later or never, and `None` if it wins but most futures do equally well.
    pub(super) fn sight(&self, line: &[Standing]) -> Option<usize> {
        let last = line.len() - 1;
        let seen = |checkpoint: &usize| {
            let stands = line[CHECKPOINTS[*checkpoint].min(last)];
            self.0.iter().filter(|future| stands.beats(future[*checkpoint])).count() >= WORSE
        };
        match (0..CHECKPOINTS.len()).find(seen) {
            Some(checkpoint) => Some(CHECKPOINTS[checkpoint]),
            None => (line[SIGHT.min(last)].outcome != 1).then_some(SIGHT),
        }
    }
}

//! Recorded episodes, which can be replayed and checked bit for bit.

use crate::game::Game;
use crate::level::Level;
use crate::rules::{Action, Outcome};
use crate::{State, StateHash};
use base::{Digest, Seed, SeedPath, SeedStep};
use serde::{Deserialize, Serialize};

/// A game's recorded actions, with their results. An episode serves as a validator's witness, as an
/// evaluation's log, or as a golden trace. [`Episode::replay`] checks all three.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Episode {
    /// The game's digest.
    pub game: Digest,
    /// The level's digest.
    pub level: Digest,
    /// The seed of the game's random numbers.
    pub seed: Seed,
    /// The actions, one per tick.
    pub actions: Vec<Action>,
    /// The state hash after each tick.
    pub hashes: Vec<StateHash>,
    /// The final outcome.
    pub outcome: Outcome,
    /// The final score.
    pub score: f64,
    /// The path from a root seed to the episode's seed. Empty if [`Episode::begin`] was called with only a
    /// seed. The path is not part of the record: neither files nor comparisons of episodes include it.
    #[serde(skip)]
    pub path: Vec<SeedStep>,
}

impl PartialEq for Episode {
    fn eq(&self, other: &Episode) -> bool {
        let Episode { game, level, seed, actions, hashes, outcome, score, path: _ } = self;
        (game, level, seed, outcome, score)
            == (&other.game, &other.level, &other.seed, &other.outcome, &other.score)
            && (actions, hashes) == (&other.actions, &other.hashes)
    }
}

/// The first difference between a replay and the record.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Divergence {
    /// The episode was recorded with a different game.
    #[error("the episode was recorded on game {recorded}, not on {given}")]
    Game {
        /// The recorded digest of the game.
        recorded: Digest,
        /// The digest of the game passed to the replay.
        given: Digest,
    },
    /// The episode was recorded on a different level.
    #[error("the episode was recorded on level {recorded}, not on {given}")]
    Level {
        /// The recorded digest of the level.
        recorded: Digest,
        /// The digest of the level passed to the replay.
        given: Digest,
    },
    /// The numbers of actions and hashes differ.
    #[error("the episode has {actions} actions but {hashes} state hashes")]
    Lengths {
        /// The number of actions.
        actions: usize,
        /// The number of hashes.
        hashes: usize,
    },
    /// The state after a tick differs.
    #[error("the state after tick {tick} has hash {got}, but the episode records {recorded}")]
    Hash {
        /// The tick, counted from 0.
        tick: usize,
        /// The recorded state hash.
        recorded: StateHash,
        /// The state hash in the replay.
        got: StateHash,
    },
    /// The final outcome or score differs.
    #[error(
        "the replay ends with outcome {got:?} and score {score}, but the episode records outcome {recorded:?} \
         and score {recorded_score}"
    )]
    End {
        /// The recorded outcome.
        recorded: Outcome,
        /// The recorded score.
        recorded_score: f64,
        /// The outcome of the replay.
        got: Outcome,
        /// The score of the replay.
        score: f64,
    },
}

impl Episode {
    /// Creates an episode before its first tick, and returns it with the initial state. If `seed` is a
    /// [`SeedPath`], the episode stores its steps.
    pub fn begin(game: &Game, level: &Level, seed: impl Into<SeedPath>) -> (Episode, State) {
        let path = seed.into();
        let (seed, path) = (path.seed(), path.into_steps());
        let state = game.start(level, seed);
        let (outcome, score) = (state.outcome(), state.score());
        let (game, level) = (game.digest(), level.digest());
        (Episode { game, level, seed, actions: Vec::new(), hashes: Vec::new(), outcome, score, path }, state)
    }

    /// Plays one tick and records it.
    pub fn play(&mut self, game: &Game, state: &mut State, action: Action) -> Outcome {
        self.outcome = game.step(state, action);
        self.score = state.score();
        self.actions.push(action);
        self.hashes.push(state.state_hash());
        self.outcome
    }

    /// Replays the actions, compares every state hash, and returns the final state.
    ///
    /// # Errors
    /// Returns the first difference between the replay and the record.
    pub fn replay(&self, game: &Game, level: &Level) -> Result<State, Divergence> {
        if self.game != game.digest() {
            return Err(Divergence::Game { recorded: self.game, given: game.digest() });
        }
        if self.level != level.digest() {
            return Err(Divergence::Level { recorded: self.level, given: level.digest() });
        }
        if self.actions.len() != self.hashes.len() {
            return Err(Divergence::Lengths { actions: self.actions.len(), hashes: self.hashes.len() });
        }
        let mut state = game.start(level, self.seed);
        for (tick, (&action, &recorded)) in self.actions.iter().zip(&self.hashes).enumerate() {
            game.step(&mut state, action);
            let got = state.state_hash();
            if got != recorded {
                return Err(Divergence::Hash { tick, recorded, got });
            }
        }
        let (got, score) = (state.outcome(), state.score());
        if got != self.outcome || score != self.score {
            let (recorded, recorded_score) = (self.outcome, self.score);
            return Err(Divergence::End { recorded, recorded_score, got, score });
        }
        Ok(state)
    }
}

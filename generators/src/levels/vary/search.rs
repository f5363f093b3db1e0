//! The choice of a variation for a game's levels: puzzles for puzzle games, and small edits for all other games.

use super::variation::LevelVariation;
use crate::levels::config::LevelConfig;
use crate::levels::construct::constructive::ConstructiveLevels;
use crate::levels::puzzles::{PuzzleConfig, PuzzleVariation};
use crate::{GenerateError, Variation};
use base::{Sampler, Seed};
use engine::{Game, Level};

/// The level variation suitable for a game.
pub enum LevelSearch<'a> {
    /// The variation for games that are won by pushing alone. It varies floor plans, and searches each of them
    /// backwards for the farthest position.
    Puzzles(PuzzleVariation<'a>),
    /// The variation for all other games. It edits levels.
    Edits(LevelVariation<'a>),
}

impl<'a> LevelSearch<'a> {
    /// Chooses puzzles if they suit the game and the requested sizes, and edits otherwise.
    ///
    /// # Errors
    /// Returns the errors of [`LevelVariation::new`].
    pub fn new(game: &'a Game, config: LevelConfig, puzzle: PuzzleConfig) -> Result<Self, GenerateError> {
        match PuzzleVariation::new(game, config.clone(), puzzle) {
            Ok(puzzles) => Ok(LevelSearch::Puzzles(puzzles)),
            Err(_) => LevelVariation::new(game, config).map(LevelSearch::Edits),
        }
    }

    /// Returns the constructive generator for the game, with its analysis.
    pub fn constructive(&self) -> &ConstructiveLevels<'a> {
        match self {
            LevelSearch::Puzzles(puzzles) => puzzles.constructive(),
            LevelSearch::Edits(edits) => edits.constructive(),
        }
    }
}

impl Variation for LevelSearch<'_> {
    type Candidate = Level;

    fn create(&self, seed: Seed) -> Option<Level> {
        match self {
            LevelSearch::Puzzles(puzzles) => puzzles.create(seed),
            LevelSearch::Edits(edits) => edits.create(seed),
        }
    }

    fn mutate(&self, parent: &Level, sampler: &mut Sampler) -> Level {
        match self {
            LevelSearch::Puzzles(puzzles) => puzzles.mutate(parent, sampler),
            LevelSearch::Edits(edits) => edits.mutate(parent, sampler),
        }
    }

    fn cross(&self, one: &Level, two: &Level, sampler: &mut Sampler) -> Level {
        match self {
            LevelSearch::Puzzles(puzzles) => puzzles.cross(one, two, sampler),
            LevelSearch::Edits(edits) => edits.cross(one, two, sampler),
        }
    }
}

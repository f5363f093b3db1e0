//! A level to judge.

use base::SeedPath;
use engine::{Analysis, Episode, Game, Level};

/// A level to judge, with the data that its judges need.
#[derive(Clone, Copy)]
pub struct Case<'a> {
    /// The level's game.
    pub game: &'a Game,
    /// The level to judge.
    pub level: &'a Level,
    /// The source of the validator's own randomness.
    pub seed: &'a SeedPath,
    /// The analysis of the game's rules.
    pub analysis: &'a Analysis,
    /// A winning episode, if an earlier validator found one.
    pub witness: Option<&'a Episode>,
}

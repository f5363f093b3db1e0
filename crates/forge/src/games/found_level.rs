//! A level that its judges accepted, within a game.

use base::SeedPath;
use engine::Level;
use validators::{Demand, Report};

/// A level that its judges accepted.
#[derive(Clone, Debug)]
pub struct FoundLevel {
    /// The level.
    pub level: Level,
    /// The findings of the level's judges, including a witness that wins the level.
    pub report: Report,
    /// The generator that made the level.
    pub generator: &'static str,
    /// A sentence about the problem that the level poses to the player, if the level was made for a position in the
    /// game.
    pub asks: Option<String>,
    /// The difficulty requested from the generator, from 0 to 1.
    pub difficulty: f64,
    /// The level's index among the candidates for its position, from 0.
    pub candidate: u32,
    /// The candidate's seed.
    pub seed: SeedPath,
    /// The measured demands on a player, such as the number of decisions, if the level was made for a tier.
    pub demand: Option<Demand>,
}

/// Returns the seed for a candidate's judges.
pub(crate) fn judges_seed(candidate: &SeedPath) -> SeedPath {
    candidate.child("judges", 0)
}

//! Pure functions of a configuration and a seed that make levels and games.
//!
//! Generators never judge what they make: `snapshots::mint` is where a candidate meets its judges.

mod error;
pub mod games;
pub mod levels;

pub use error::GenerateError;

use engine::Seed;

/// Makes one thing from a seed: the same seed gives the same thing, on every machine.
pub trait Generator: Sync {
    /// What it makes.
    type Output;

    /// Makes the output of this seed.
    ///
    /// # Errors
    /// If this seed, or the configuration, gives nothing.
    fn generate(&self, seed: Seed) -> Result<Self::Output, GenerateError>;
}

/// Bumped when any minted byte moves for an unchanged recipe.
pub const GENERATION: u32 = 1;

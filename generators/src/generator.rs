//! What a generator is.

use crate::GenerateError;
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

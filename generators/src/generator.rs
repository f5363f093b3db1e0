//! The interface of generators.

use crate::GenerateError;
use base::Seed;

/// A generator, which makes an object from a seed. The same seed gives the same object on every machine.
pub trait Generator: Sync {
    /// The type of the result.
    type Output;

    /// Generates the output for a seed.
    ///
    /// # Errors
    /// Returns an error if the seed or the configuration leads to no result.
    fn generate(&self, seed: Seed) -> Result<Self::Output, GenerateError>;
}

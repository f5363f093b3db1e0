//! The generator interface.

use crate::GenerateError;
use base::Seed;

/// A generator that creates an object from a seed. The same seed yields the same object on every
/// machine.
pub trait Generator: Sync {
    /// The type of the generated object.
    type Output;

    /// Generates the output for a seed.
    ///
    /// # Errors
    /// Returns an error if nothing can be generated for the seed or the configuration.
    fn generate(&self, seed: Seed) -> Result<Self::Output, GenerateError>;
}

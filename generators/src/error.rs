//! The reasons why a generator has no result.

/// An error that prevents a generator from returning a result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GenerateError {
    /// The generator cannot make anything for the game, with any seed.
    #[error("no level can be made for this game: {0}")]
    Unsuitable(String),
    /// Generation fails with this seed, but may succeed with a different one.
    #[error("generation failed with this seed: {0}")]
    Unlucky(String),
}

//! The reasons why a generator fails.

/// An error that prevents a generator from returning a result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GenerateError {
    /// The generator cannot support the game, whatever the seed.
    #[error("no level can be made for this game: {0}")]
    Unsuitable(String),
    /// Generation failed with this seed, but might succeed with a different one.
    #[error("generation failed with this seed: {0}")]
    Unlucky(String),
}

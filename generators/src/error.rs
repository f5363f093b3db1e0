//! The reasons why a generator returns nothing.

/// A failure to generate anything.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GenerateError {
    /// The generator can make nothing for the game, whatever the seed.
    #[error("no level can be made for this game: {0}")]
    Unsuitable(String),
    /// Generation fails with this seed; another may succeed.
    #[error("generation failed with this seed: {0}")]
    Unlucky(String),
}

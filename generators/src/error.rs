//! The reasons why a generator returns nothing.

/// An error that prevents a generator from returning anything.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GenerateError {
    /// The generator cannot make anything for the game, whatever the seed.
    #[error("no level can be made for this game: {0}")]
    Unsuitable(String),
    /// Generation fails with this seed; another may succeed.
    #[error("generation failed with this seed: {0}")]
    Unlucky(String),
}

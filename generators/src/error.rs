//! Why a generator gives nothing.

/// Nothing was made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GenerateError {
    /// The game leaves the generator no way, whatever the seed.
    #[error("no level can be made for this game: {0}")]
    Unsuitable(String),
    /// This seed leads nowhere; another may not.
    #[error("this seed leads nowhere: {0}")]
    Unlucky(String),
}

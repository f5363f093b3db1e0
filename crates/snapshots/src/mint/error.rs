//! The errors that minting can return.

use crate::error::SnapshotError;
use crate::recipe::error::RecipeError;
use validators::CriteriaError;

/// A reason why minting fails.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MintError {
    /// The recipe is invalid, or it is sealed and its secret is missing.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// The recipe requests more corpus games than the corpus contains.
    #[error("`corpus.games` is {asked}, but the corpus has {known} games")]
    SmallCorpus {
        /// The requested number of games.
        asked: u32,
        /// The number of games in the corpus.
        known: usize,
    },
    /// A corpus game does not compile.
    #[error("the corpus game `{name}` does not compile: {problems}")]
    BrokenCorpus {
        /// The game's name.
        name: String,
        /// The compiler's diagnostics.
        problems: engine::Diagnostics,
    },
    /// The recipe's criteria are invalid.
    #[error("`criteria.{}` {}", .0.key, .0.message)]
    Criteria(#[from] CriteriaError),
    /// A job's result is missing from the store.
    #[error("the job `{0}` is missing: mint it again")]
    Missing(String),
    /// A job's result contains text that is not a game, or a game that differs from its card.
    #[error("the job `{0}` holds an invalid game: mint it again")]
    Unsound(String),
    /// Too few candidates passed.
    #[error("`{part}.games` is {asked}, but only {there} candidates can be selected ({why}); {advice}")]
    TooFew {
        /// The recipe section.
        part: &'static str,
        /// The requested number of games.
        asked: usize,
        /// The number of candidates that passed, not counting duplicates.
        there: usize,
        /// The reasons why the other candidates failed, or the games that they duplicate.
        why: String,
        /// The recommended next step.
        advice: String,
    },
    /// The recipe requests more games than can be generated. This is detected before anything is minted.
    #[error("`{part}.games` is {asked}, but the limit is {most}: {why}; {advice}")]
    Unfillable {
        /// The recipe section.
        part: &'static str,
        /// The requested number of games.
        asked: usize,
        /// The maximum number of games.
        most: usize,
        /// The reason for the limit.
        why: String,
        /// The recommended next step.
        advice: String,
    },
    /// No selection of candidates that meets the quotas was found.
    #[error("no selection from {candidates} candidates satisfies the recipe: {missed}; {advice}")]
    Uneven {
        /// The number of candidates.
        candidates: usize,
        /// The requirements that the best selection does not meet.
        missed: String,
        /// The recommended next step.
        advice: String,
    },
    /// The drawn secret does not look random. This happens by chance only once in a billion draws.
    #[error("the drawn secret is unusable: {0}; draw again")]
    Unlucky(String),
    /// A recipe section adds a part to games, but the part could not be created.
    #[error("{section}: {message}")]
    Section {
        /// The section's name.
        section: &'static str,
        /// The reason why the part could not be created.
        message: String,
    },
    /// The files or the manifest could not be created.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

//! The reasons why minting fails.

use crate::error::SnapshotError;
use crate::recipe::error::RecipeError;
use validators::CriteriaError;

/// The reasons why minting fails.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MintError {
    /// The recipe is not sound, or it is sealed and its secret is missing.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// The recipe asks for more corpus games than there are.
    #[error("`corpus.games` is {asked}, but the corpus has {known} games")]
    SmallCorpus {
        /// The number that the recipe asks for.
        asked: u32,
        /// The number of games in the corpus.
        known: usize,
    },
    /// A corpus game does not compile.
    #[error("the corpus game `{name}` does not compile: {problems}")]
    BrokenCorpus {
        /// The game.
        name: String,
        /// The diagnostics of the compiler.
        problems: engine::Diagnostics,
    },
    /// The criteria are invalid.
    #[error("`criteria.{}` {}", .0.key, .0.message)]
    Criteria(#[from] CriteriaError),
    /// A job's result is not in the store.
    #[error("the job `{0}` is missing: mint it again")]
    Missing(String),
    /// A job's result holds something that is no game, or not the one that its card describes.
    #[error("the job `{0}` holds a game that is not one: mint it again")]
    Unsound(String),
    /// Too few candidates passed.
    #[error("`{part}.games` is {asked}, but only {there} candidates can be taken ({why}); {advice}")]
    TooFew {
        /// The part of the recipe.
        part: &'static str,
        /// The number that the recipe asks for.
        asked: usize,
        /// The number of candidates that passed and are no copies.
        there: usize,
        /// The reasons why the others failed, or the games that they copy.
        why: String,
        /// The next move.
        advice: String,
    },
    /// The recipe asks for more games than can be made, as is known before anything is minted.
    #[error("`{part}.games` is {asked}, but at most {most} can be asked for: {why}; {advice}")]
    Unfillable {
        /// The part of the recipe.
        part: &'static str,
        /// The number that the recipe asks for.
        asked: usize,
        /// The maximum number.
        most: usize,
        /// The limit.
        why: String,
        /// The next move.
        advice: String,
    },
    /// No selection of candidates meets the quotas.
    #[error("no selection of {candidates} candidates meets the recipe: {missed}; {advice}")]
    Uneven {
        /// The number of candidates.
        candidates: usize,
        /// The requirements that the nearest selection misses.
        missed: String,
        /// The next move.
        advice: String,
    },
    /// The secret that was drawn looks made up, which one in a billion does.
    #[error("the secret that was drawn: {0}; draw again")]
    Unlucky(String),
    /// A part of a game that a section of the recipe adds cannot be made.
    #[error("{section}: {message}")]
    Section {
        /// The section.
        section: &'static str,
        /// The reason.
        message: String,
    },
    /// The files or the manifest cannot be made.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

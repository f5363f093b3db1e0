//! The error type of recipes.

use validators::CriteriaError;

/// The maximum size of a recipe, in bytes.
pub const MAX_RECIPE: usize = 1 << 16;

/// A problem with a recipe.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecipeError {
    /// The recipe is not TOML, or does not have the expected structure. The message contains the
    /// line, column and key.
    #[error("{0}")]
    Syntax(Box<toml::de::Error>),
    /// A key belongs in a different table, or at the top level.
    #[error("{}\n{help}", .source.to_string().trim_end())]
    Misplaced {
        /// The error, with its position.
        source: Box<toml::de::Error>,
        /// The table to which the key belongs.
        help: String,
    },
    /// A value is out of range.
    #[error("`{key}` {message}")]
    Value {
        /// The key, in dotted form.
        key: &'static str,
        /// The requirement that the value does not meet.
        message: String,
    },
    /// A criterion's value is out of range.
    #[error("`{table}.{}` {}", .problem.key, .problem.message)]
    Criteria {
        /// The criterion's table.
        table: &'static str,
        /// The problem with the criterion.
        problem: CriteriaError,
    },
    /// The release is sealed, and its secret was not provided.
    #[error("the release is sealed: its recipe holds a commitment, so minting it requires `--secret FILE`")]
    Sealed,
    /// The secret does not match the commitment.
    #[error(
        "the secret does not match the recipe's `commitment`: pass the file that `--commit` wrote with \
         the commitment"
    )]
    OtherSecret,
    /// The secret is correct, but the recipe has been changed.
    #[error(
        "the recipe does not match its `commitment`: more than that line was changed after `--commit`; \
         {0}, or commit again with `arcade release RECIPE --commit`"
    )]
    OtherRecipe(&'static str),
    /// The recipe states a beacon whose value was not provided.
    #[error(
        "the recipe specifies round {round} of {source_name}: pass its value with --beacon FILE, once it is \
         published"
    )]
    NoBeacon {
        /// The beacon's source.
        source_name: String,
        /// The beacon's round.
        round: u64,
    },
    /// A secret was provided for an open release.
    #[error(
        "the release is open: its recipe has a `seed`, so omit --secret; to seal it, replace `seed` with the \
         secret's `commitment`"
    )]
    Open,
    /// The recipe is longer than [`MAX_RECIPE`].
    #[error("the recipe is larger than {MAX_RECIPE} bytes")]
    TooLarge,
}

/// Returns the error for a value that is out of range.
pub(crate) fn wrong(key: &'static str, message: impl Into<String>) -> Result<(), RecipeError> {
    Err(RecipeError::Value { key, message: message.into() })
}

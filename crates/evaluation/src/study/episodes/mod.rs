//! The episodes of a study: scores, endings, failures and predictions.

pub(super) mod endings;
pub(super) mod failures;
pub(super) mod predictions;
pub(super) mod scores;

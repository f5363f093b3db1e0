//! Comparisons between players, and the certainty of results.

pub(super) mod contrast;
pub(super) mod correlations;
pub(super) mod matrix;
pub(super) mod power;
pub(super) mod verdict;

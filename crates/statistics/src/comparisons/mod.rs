//! Comparisons between two groups or two measures: tests, effect sizes and corrections.

pub(crate) mod cohen;
pub(crate) mod contamination;
pub(crate) mod correction;
pub(crate) mod fisher;
pub(crate) mod pearson;
pub(crate) mod spearman;
pub(crate) mod stratified;
pub(crate) mod welch;

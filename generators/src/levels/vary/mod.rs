//! Variation of levels for searches: small edits and crossover.

pub(crate) mod draft;
pub(crate) mod edits;
pub(crate) mod search;
pub(crate) mod variation;

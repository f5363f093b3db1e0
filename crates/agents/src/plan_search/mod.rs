//! Planners that search among sequences of actions.

pub(crate) mod random_search;
pub(crate) mod rhea;
pub(crate) mod sequences;

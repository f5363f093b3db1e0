//! Planners that search among action sequences.

pub(crate) mod random_search;
pub(crate) mod rhea;
pub(crate) mod sequences;

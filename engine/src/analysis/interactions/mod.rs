//! Summaries of interactions, by encounter, pair and touch.

pub(crate) mod encounter;
pub(crate) mod lock;
pub(crate) mod pairs;
pub(crate) mod touch;

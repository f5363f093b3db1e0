//! Summaries of interactions: by rule and pair of types (encounters), by pair, and by what the avatar touches.

pub(crate) mod encounter;
pub(crate) mod lock;
pub(crate) mod pairs;
pub(crate) mod touch;
